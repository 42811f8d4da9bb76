"""Exported C against the stepper and the engine of hyst, on one record in one run.

The exported code is compiled as its README says, -O2, and called for whole records through its
`stage_run`, in double and in single. Also printed: how long an export takes, and its sizes.
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved
from hyst.export import CProject, c_project
from hyst.operators import Operator

SAMPLES = 100_000

PLAYS = hyst.PrandtlIshlinskii(np.linspace(0.3, 0.05, 10), np.linspace(0.1, 2.0, 10), p0=1.0)
OUTPUT_MAP = hyst.DeadZone([1.0, 0.2, 0.1, 0.3], [0.0, 0.5, 1.5, -0.4])
MODELS: dict[str, Operator] = {
    "inverse of 10 plays and a map": hyst.ModifiedPrandtlIshlinskii(PLAYS, OUTPUT_MAP).inverse(),
    "10 plays": PLAYS,
    "10 rate-dependent plays": hyst.RateDependentPrandtlIshlinskii(
        PLAYS.p, PLAYS.r, 0.01, 1e-3, 1.0
    ),
    "order 4": hyst.LinearDynamics.from_transfer_function(
        [0.0, 0.1, 0.2, 0.1, 0.05], [1.0, -1.8, 1.3, -0.5, 0.1], dt=1e-3
    ),
    "Ramberg-Osgood": hyst.RambergOsgood(1.0, 0.5, 1.2),
    "its inverse": hyst.RambergOsgood(1.0, 0.5, 1.2).inverse(),
}


def main() -> None:
    """Print the table."""
    print("nanoseconds a sample: exported C in double and in single, the stepper called from")
    print("Python, the engine's whole record; the state in single; seconds to export")
    head = ("double", "single", "stepper", "engine", "bytes", "s")
    print(f"  {'model':30s}" + "".join(f"{each:>9s}" for each in head))
    u = np.sin(np.arange(SAMPLES) / 50.0) * np.linspace(0.2, 4.0, SAMPLES)
    with tempfile.TemporaryDirectory() as folder:
        for name, model in MODELS.items():
            times, project, seconds = compare(model, u, Path(folder) / name.replace(" ", "_"))
            row = [f"{1e9 * np.median(each) / SAMPLES:9.1f}" for each in times.values()]
            print(f"  {name:30s}{''.join(row)}{project.state_bytes:9d}{seconds:9.2f}")


def compare(
    model: Operator, u: NDArray[np.float64], folder: Path
) -> tuple[dict[str, list[float]], CProject, float]:
    """Time all of them in turn; the project is the one in single."""
    folder.mkdir()
    begin = time.perf_counter()
    projects = {
        each: c_project(model, folder / each, precision=each) for each in ("double", "single")
    }
    seconds = (time.perf_counter() - begin) / 2.0
    step, samples = model.stepper(), u.tolist()
    works: dict[str, Callable[[], object]] = {
        precision: run_of(project, u) for precision, project in projects.items()
    }
    works["stepper"] = lambda: [step(each) for each in samples]
    works["engine"] = lambda: model.run(u)
    return interleaved(works, seconds=1.0), projects["single"], seconds


def run_of(project: CProject, u: NDArray[np.float64]) -> Callable[[], object]:
    """Compile a project and give what runs a record through it."""
    single = project.precision == "single"
    library = project.path / "stage.so"
    sources = [f for f in project.files if f.endswith(".c") and not f.endswith("_selftest.c")]
    flags = ["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared"]
    command = ["cc", *flags, *sources, "-o", library.name]
    subprocess.run(command, cwd=project.path, check=True)
    code = ctypes.CDLL(str(library))
    state = ctypes.create_string_buffer(project.state_bytes)
    signal = u.astype(np.float32 if single else np.float64)
    y = np.empty_like(signal)
    pointers = ctypes.c_void_p(signal.ctypes.data), ctypes.c_void_p(y.ctypes.data)
    code.stage_init(state)
    # Both arrays are named, so that they live as long as what points to them.
    return lambda: code.stage_run(state, *pointers, ctypes.c_size_t(min(signal.size, y.size)))


if __name__ == "__main__":
    main()
