"""Repetitive controllers as C, FMU and in single precision: the bits of Python."""

from __future__ import annotations

import ctypes
from pathlib import Path

import numpy as np
import pytest
from c_builds import (
    AS_C,
    AS_CXX,
    Exported,
    Objects,
    build_library,
    run_selftest,
    same_bits,
    stepped,
    wandering,
)
from fmu_runs import FmuRun

import hyst.export
from hyst import PrandtlIshlinskii
from hyst.control import RepetitiveController
from hyst.export import c_project
from hyst.export.c.block import block_of, stepper_of
from reference.examples import EXAMPLES

Q, L = [0.5, 0.2, 0.05], [0.1, -0.2, 0.5, 0.3]
BLOCKS = {
    "without inverse": RepetitiveController(16, Q, L, 2, 1e-3),
    "inverse": RepetitiveController(40, Q, L, 3, 1e-3, EXAMPLES["inverse of mpi"]),
    "compared": RepetitiveController(
        7, [1.0], [0.5], 0, 0.1, EXAMPLES["inverse ramberg-osgood"], tolerance=1e-9
    ),
    "limited": RepetitiveController(
        16, Q, L, 0, 1e-3, PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0).inverse(),
        limits=(-1.7, 1.1), rate=700.0, u0=0.25, tolerance=0.0,
    ),
    "limited without inverse": RepetitiveController(16, Q, L, 2, 1e-3, limits=(0.1, 1.1)),
    "limited, of several stages": RepetitiveController(
        16, Q, L, 2, 1e-3, EXAMPLES["inverse of mpi"], limits=(0.3, 2.3)
    ),
}  # fmt: skip
CHANGED, LIMITED = 32, 16


def inputs(model: RepetitiveController, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """A reference that repeats, and is another one in the second half, and any output."""
    y_ref = np.resize(wandering(20 * model.period)[::20], samples)
    y_ref[samples // 2 :] *= 0.5
    return y_ref, wandering(samples, seed=8)


@pytest.mark.parametrize("name", BLOCKS)
def test_blocks_give_the_bits_of_python(name: str, tmp_path: Path, objects: Objects) -> None:
    model = BLOCKS[name]
    project = c_project(model, tmp_path / "out", name="loop")
    y_ref, y = inputs(model, 20_000)
    y_ref[300], y_ref[301] = np.nan, -np.inf
    in_python = model.stepper()
    u = stepped(in_python, y_ref, y)
    expected = 1 + LIMITED * in_python.limited + CHANGED * in_python.changed
    assert in_python.fault
    assert in_python.changed == (model.tolerance is not None)
    for driver, language in (("gcc", AS_C), ("clang++", AS_CXX)):
        library = build_library(project.path, objects, driver, language)
        code = Exported(library, project.state_length, project.saved_bytes, inputs=2)
        state = code.initial_state()
        first = code.run(state, y_ref[:7000], y[:7000])
        other = code.unset_state()
        assert code.load(other, code.save(state)) == 0
        second = code.run(other, y_ref[7000:], y[7000:])
        assert same_bits(np.concatenate([first, second]), u)
        assert same_bits(code.memory(other), np.asarray(in_python.state))
        assert code.fault(other) == expected
        # What is learned is forgotten, what the actuator is like is not.
        reset = ctypes.CDLL(str(library)).loop_reset
        reset.argtypes, reset.restype = [ctypes.c_void_p], None
        reset(ctypes.byref(other) if not isinstance(other, ctypes.Array) else other)
        assert same_bits(code.memory(other), model.reset(np.asarray(in_python.state)))


@pytest.mark.parametrize("name", BLOCKS)
@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_selftest_finds_no_difference(
    name: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    project = c_project(BLOCKS[name], tmp_path / "out", precision=precision)
    assert run_selftest(project.path, objects).stdout == "10000 samples, max difference 0\n"
    code = (project.path / "stage.c").read_text()
    assert "stage_core_repetitive_learn" in code
    files = {each.name for each in (project.path / "core" / "src").glob("*.c")}
    assert "stage_core_repetitive_memory.c" in files
    assert not files & {"stage_core_chain.c", "stage_core_repetitive_controller.c"}


def test_single_precision_follows_double() -> None:
    """And its limits hold: the filters shrink what rounding leaves."""
    model = BLOCKS["limited"]
    y_ref, y = np.resize(wandering(320)[::20], 3200), np.zeros(3200)
    single = stepped(stepper_of(block_of(model, "single"), "single"), y_ref, y)
    double = stepped(model.stepper(), y_ref, y)
    assert single.min() >= -1.7
    assert single.max() <= 1.1
    # Each period rounds some ten sums of numbers of up to 4, and Q and L forget none of them.
    assert np.abs(single - double).max() < 200 * 10 * 4 * np.finfo(np.float32).eps
    assert not same_bits(single, double)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_as_fmu(version: str, tmp_path: Path) -> None:
    model = BLOCKS["limited"]
    written = hyst.export.fmu(model, tmp_path / "model.fmu", version=version)
    assert (written.inputs, written.output) == (("y_ref", "y"), "u")
    run = FmuRun(written, tmp_path).initialize()
    y_ref, y = inputs(model, 250)
    u = np.empty(250)
    for k in range(250):
        run.set(y_ref=y_ref[k], y=y[k])
        run.step(k * 1e-3, 1e-3)
        u[k] = run.get("u")
    assert u.tobytes() == model.run(y_ref, y)[0].tobytes()
    # y counts from the next period on.
    assert [each.name for each in run.description.outputs[0].dependencies] == ["y_ref"]
    assert run.log == []
    run.free()
