"""The core, compiled by itself as a user of the C code would, gives the bits of the engine.

Whatever the optimisation level and the processor's fused multiply-add: contraction is off, so that
what was validated in Python is what runs on the target.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from hyst import _engine
from hyst.operators.stage import Stage

CORE = Path(__file__).resolve().parents[2] / "core"
# Four times four plays for vectors, and a rest of three, where compilers would contract.
P0 = 0.37
P = [0.41 / k for k in range(1, 20)]
R = [0.1 + 0.23 * k for k in range(19)]


def structure(real: type) -> type[ctypes.Structure]:
    """hyst_pi of prandtl_ishlinskii.h."""

    class PrandtlIshlinskii(ctypes.Structure):
        _fields_ = [
            ("count", ctypes.c_size_t),
            ("p0", real),
            ("p", ctypes.POINTER(real)),
            ("r", ctypes.POINTER(real)),
        ]

    return PrandtlIshlinskii


def compiled(folder: Path, options: list[str]) -> ctypes.CDLL:
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler called cc")
    library = folder / "libcore.so"
    sources = [str(CORE / name) for name in (CORE / "SOURCES").read_text().split()]
    command = [compiler, "-std=c99", "-ffp-contract=off", "-shared", "-fPIC", *options]
    command += [f"-I{CORE / 'include'}", *sources, "-o", str(library)]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    if finished.returncode != 0 and "-march=native" in options:
        pytest.skip(f"the compiler does not take -march=native: {finished.stderr.strip()}")
    assert finished.returncode == 0, finished.stderr
    return ctypes.CDLL(str(library))


def run_alone(library: ctypes.CDLL, real: type, u: np.ndarray) -> np.ndarray:
    step = library.hyst_pi_step
    step.restype = real
    step.argtypes = [ctypes.c_void_p, ctypes.c_void_p, real]
    p, r, z = (real * 19)(*P), (real * 19)(*R), (real * 19)()
    pi = structure(real)(19, P0, p, r)
    return np.array([step(ctypes.byref(pi), z, value) for value in u.tolist()])


def run_in_engine(u: np.ndarray) -> np.ndarray:
    chain = _engine.Chain([Stage("pi", (P0, *P, *R))])
    y = np.empty((1, u.size))
    chain.run(np.zeros((1, 19)), u.reshape(1, -1), y)
    return y[0]


@pytest.mark.parametrize(
    "options", [["-O0"], ["-Os"], ["-O3", "-march=native"]], ids=lambda options: " ".join(options)
)
def test_double_is_the_same_to_the_bit(
    options: list[str], noise: np.ndarray, tmp_path: Path
) -> None:
    alone = run_alone(compiled(tmp_path, options), ctypes.c_double, noise)
    assert alone.tobytes() == run_in_engine(noise).tobytes()


def test_float_is_as_near_as_float_can_be(noise: np.ndarray, tmp_path: Path) -> None:
    single = noise.astype(np.float32).astype(float)  # the same input for both
    alone = run_alone(compiled(tmp_path, ["-O2", "-DHYST_SINGLE"]), ctypes.c_float, single)
    difference = np.max(np.abs(alone - run_in_engine(single)))
    # Twenty sums of numbers up to max|u| times 1.83, the sum of the weights, half an epsilon each:
    # 18 epsilon; constants, play outputs and products, rounded too, make it at most 22.
    assert 0 < difference <= 30 * np.finfo(np.float32).eps * np.max(np.abs(single))
