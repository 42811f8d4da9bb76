"""The step of a bank of plays in exported C: four partial sums against one.

Three programs are compiled alike (-O2, contraction off) and take one record in turn:
- plain: the same plays in a plain C loop, their products added one by one;
- one sum: the export with its limit for wide banks out of reach, so that it adds one by one too;
- export: as it is.
Below 16 plays the last two are the same program; where their ratio is not 1, the loop of few plays
lies better or worse in memory (-falign-functions=64 makes it 1).
"""

from __future__ import annotations

import ctypes
import re
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.export import run_of
from benchmarks.timing import interleaved, report_times
from hyst.export import c_project

Array = NDArray[np.float64]

SAMPLES = 20_000
SIZES = (1, 3, 10, 16, 31, 100)
WIDE = re.compile(r"(_WIDE_BANK) 16u")

PLAIN = """#include <stddef.h>
typedef {real} real;
static const real p[] = {{{p}}}, r[] = {{{r}}};
static real z[{n}];
/* Not inlined: how many plays there are is not known when it is compiled. */
__attribute__((noinline)) real plain_step(size_t n, const real *weight, const real *radius,
                                          real *memory, real u)
{{
    real y = (real)1.0 * u;
    for (size_t i = 0; i < n; ++i) {{
        const real low = u - radius[i], high = u + radius[i];
        const real below = memory[i] < high ? memory[i] : high;
        const real moved = below > low ? below : low;
        memory[i] = moved;
        y += weight[i] * moved;
    }}
    return y;
}}
void plain_run(size_t n, const real *u, real *y, size_t count)
{{
    for (size_t k = 0; k < count; ++k) y[k] = plain_step(n, p, r, z, u[k]);
}}
"""


def main() -> None:
    """Print nanoseconds a sample and ratios."""
    print("nanoseconds a sample: plain C, the export with one sum, the export; then the export")
    print("over either of the others, medians of ratios of runs in turn")
    head = ("plays", "plain", "one sum", "export", "/ plain", "/ one sum")
    u = np.sin(np.arange(SAMPLES) / 50.0) * np.linspace(0.2, 4.0, SAMPLES)
    # All stay to the end: a library in the place of one that was deleted would not be loaded.
    with tempfile.TemporaryDirectory() as folder:
        for precision in ("double", "single"):
            print(f"\n  {precision:8s}" + "".join(f"{each:>10s}" for each in head))
            for n in SIZES:
                place = Path(folder) / precision / str(n)
                place.mkdir(parents=True)
                times = interleaved(programs(n, precision, u, place), rounds=60)
                print_row(n, precision, times)


def print_row(n: int, precision: str, times: dict[str, list[float]]) -> None:
    """Print what one bank took."""
    cells = [f"{1e9 * np.median(each) / SAMPLES:10.2f}" for each in times.values()]
    for other in ("plain", "one sum"):
        name = f"export over {other}, {n} plays, {precision}"
        over = report_times(name, times, "export", other, better="smaller")
        cells.append(f"{over:10.2f}")
    print(f"  {'':8s}{n:10d}{''.join(cells)}")


def programs(n: int, precision: str, u: Array, folder: Path) -> dict[str, Callable[[], object]]:
    """Compile the three."""
    bank = hyst.PrandtlIshlinskii(1.0 / np.arange(1.0, n + 1.0), 2.0 * np.arange(1, n + 1) / n, 1.0)
    one = c_project(bank, folder / "one", precision=precision)
    for path in one.path.rglob("*.[ch]"):
        path.write_text(WIDE.sub(r"\1 1000000u", path.read_text(encoding="utf-8")))
    export = c_project(bank, folder / "export", precision=precision)
    return {
        "plain": plain(bank, precision, u, folder),
        "one sum": run_of(one, u),
        "export": run_of(export, u),
    }


def plain(
    bank: hyst.PrandtlIshlinskii, precision: str, u: Array, folder: Path
) -> Callable[[], object]:
    """Compile the plain loop and give what runs a record through it."""
    single = precision == "single"
    numbers = {
        name: ", ".join(f"(real){each!r}" for each in values.tolist())
        for name, values in (("p", bank.p), ("r", bank.r))
    }
    source, library = folder / "plain.c", folder / "plain.so"
    source.write_text(PLAIN.format(real="float" if single else "double", n=bank.p.size, **numbers))
    flags = ["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared"]
    subprocess.run(["cc", *flags, str(source), "-o", str(library)], check=True)
    code = ctypes.CDLL(str(library))
    signal = u.astype(np.float32 if single else np.float64)
    y = np.empty_like(signal)
    pointers = ctypes.c_void_p(signal.ctypes.data), ctypes.c_void_p(y.ctypes.data)
    plays, count = ctypes.c_size_t(bank.p.size), ctypes.c_size_t(signal.size)
    return lambda: (signal, y, code.plain_run(plays, *pointers, count))


if __name__ == "__main__":
    main()
