"""Exported Rust against exported C: the same models, one record, one run.

C is compiled as its README says, -O2; Rust with cargo's release profile. Both are called for whole
records through a shared library, so what is compared is the step. Also printed: whether both give
the same bits, and what of the crate's object can panic, by its symbols.
"""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.export import MODELS, SAMPLES, run_of
from benchmarks.timing import interleaved
from hyst.export import c_project, rust
from hyst.operators import Operator

_CARGO = """\
[workspace]
members = ["stage"]
[package]
name = "called"
version = "0.1.0"
edition = "2021"
[lib]
crate-type = ["cdylib"]
[dependencies]
stage = {{ path = "stage" }}
"""

_LIBRARY = """\
/// # Safety
/// Both point to so many numbers.
#[no_mangle]
pub unsafe extern "C" fn run(u: *const stage::Real, y: *mut stage::Real, samples: usize) {{
    let u = std::slice::from_raw_parts(u, samples);
    let y = std::slice::from_raw_parts_mut(y, samples);
    stage::Stage::new().run(u, y);
}}
"""


def main() -> None:
    """Print the table."""
    print("nanoseconds a sample: exported C and Rust, double and single; the same bits; panics")
    head = ("C", "Rust", "C single", "Rust single", "ratio", "bits", "panics")
    print(f"  {'model':30s}" + "".join(f"{each:>12s}" for each in head))
    u = np.sin(np.arange(SAMPLES) / 50.0) * np.linspace(0.2, 4.0, SAMPLES)
    with tempfile.TemporaryDirectory() as folder:
        for name, model in MODELS.items():
            print(f"  {name:30s}{row_of(model, u, Path(folder) / name.replace(' ', '_'))}")


def row_of(model: Operator, u: NDArray[np.float64], folder: Path) -> str:
    """Time all of them in turn."""
    works: dict[str, Callable[[], object]] = {}
    same, panics = True, 0
    for precision in ("double", "single"):
        home = folder / precision
        home.mkdir(parents=True)
        project = c_project(model, home / "c", precision=precision)
        works[f"C {precision}"] = run_of(project, u)
        works[f"Rust {precision}"], y, count = rust_run(model, u, home, precision)
        expected = _run_c(home / "c" / "stage.so", u, precision, project.state_bytes)
        same = same and y.tobytes() == expected.tobytes()
        panics += count
    times = interleaved(works, seconds=1.0)
    each = {key: 1e9 * float(np.median(value)) / SAMPLES for key, value in times.items()}
    ratio = each["Rust double"] / each["C double"]
    numbers = "".join(f"{value:12.1f}" for value in each.values())
    return f"{numbers}{ratio:12.2f}{'equal' if same else 'DIFFER':>12s}{panics:12d}"


def rust_run(
    model: Operator, u: NDArray[np.float64], home: Path, precision: str
) -> tuple[Callable[[], object], NDArray[np.floating], int]:
    """Build a crate and give what runs a record through it, its output, and calls that panic."""
    (home / "called" / "src").mkdir(parents=True)
    rust(model, home / "called" / "stage", precision=precision)
    (home / "called" / "Cargo.toml").write_text(_CARGO.format())
    (home / "called" / "src" / "lib.rs").write_text(_LIBRARY.format())
    build = ["cargo", "build", "--offline", "-q", "--release"]
    subprocess.run(build, cwd=home / "called", check=True)
    release = home / "called" / "target" / "release"
    code = ctypes.CDLL(str(release / "libcalled.so"))
    signal = u.astype(np.float32 if precision == "single" else np.float64)
    y = np.empty_like(signal)
    pointers = ctypes.c_void_p(signal.ctypes.data), ctypes.c_void_p(y.ctypes.data)

    def run() -> None:
        # Both arrays are named, so that they live as long as what points to them.
        code.run(*pointers, ctypes.c_size_t(min(signal.size, y.size)))

    run()
    return run, y.copy(), _panics(next((release / "deps").glob("libstage-*.rlib")))


def _panics(library: Path) -> int:
    """Count what an object asks of the panics of the core library."""
    done = subprocess.run(["nm", "-C", str(library)], capture_output=True, text=True, check=False)
    return sum("panic" in line for line in done.stdout.splitlines())


def _run_c(
    library: Path, u: NDArray[np.float64], precision: str, state_bytes: int
) -> NDArray[np.floating]:
    code = ctypes.CDLL(str(library))
    state = ctypes.create_string_buffer(state_bytes)
    code.stage_init(state)
    signal = u.astype(np.float32 if precision == "single" else np.float64)
    y = np.empty_like(signal)
    pointers = ctypes.c_void_p(signal.ctypes.data), ctypes.c_void_p(y.ctypes.data)
    code.stage_run(state, *pointers, ctypes.c_size_t(signal.size))
    return y


if __name__ == "__main__":
    main()
