"""Magnetic materials: what loops of small amplitude are predicted from the largest measured ones.

Quasi-static B(H) loops of two MnZn ferrites and a steel (an amorphous alloy has one loop only and
is fitted), one turn of each, without time. Every family is identified from the largest loop, the
two and, of four, the three largest, each repeated, and runs along the others, which it has not
seen, after laps of the largest that shrink to their size. Printed for each loop, from the smallest:
rms error in percent of that loop's own range, and in brackets of the largest loop's; a star marks
loops that were trained on. Each loop has its own zero, which a coil does not tell.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import scipy.io
from numpy.typing import NDArray

import hyst

Array = NDArray[np.float64]

DATA = Path(__file__).parents[2] / "shared" / "data" / "magnetic-bh"
MATERIALS = ("MnZn_ferrite", "MnZn_HP_ferrite", "M130_27s", "amorf")
LAPS = 3
SHRINKING = 15

ROWS: tuple[tuple[str, dict[str, object]], ...] = (
    ("pi", {}),
    ("mpi", {}),
    ("gpi", {}),
    ("two-envelope", {}),
    ("coleman-hodgdon", {"pieces": 4}),
    ("coleman-hodgdon", {"pieces": 8}),
    ("jiles-atherton", {}),
    ("jiles-atherton", {"variant": "jiles-thoelke-devine-1992"}),
    ("jiles-atherton", {"variant": "jiles-atherton-1986"}),
    ("preisach", {}),
)


def main() -> None:
    """Print a table for each material and number of loops trained on."""
    if not DATA.is_dir():
        print(f"skipped: no measured records in {DATA}")
        return
    for material in MATERIALS:
        h, b = loops(material)
        for count in range(1, max(h.shape[1], 2)):
            print(f"{material}, trained on {count} of {h.shape[1]} loops")
            for family, options in ROWS:
                print(f"  {line_of(family, options, h, b, count)}", flush=True)


def loops(material: str) -> tuple[Array, Array]:
    """Give H and B, a loop a column, the smallest first."""
    h, b = (_columns(DATA / f"{signal}_{material}.mat") for signal in "HB")
    order = np.argsort(np.ptp(h, axis=0))
    return h[:, order], b[:, order]


def _columns(path: Path) -> Array:
    content = scipy.io.loadmat(path)
    return np.asarray(next(value for key, value in content.items() if not key.startswith("_")))


def line_of(family: str, options: dict[str, object], h: Array, b: Array, count: int) -> str:
    """Identify from the largest loops and tell the error on every loop."""
    said = " ".join([family, *(f"{key}={value}" for key, value in options.items())])
    records = [
        hyst.Record(np.tile(h[:, k], LAPS), np.tile(b[:, k], LAPS), dt=1.0)
        for k in range(h.shape[1] - count, h.shape[1])
    ]
    start = time.perf_counter()
    try:
        found = hyst.identify(records, family=family, delay=0, allow_unconverged=True, **options)
    except hyst.HystError as refused:
        return f"{said:50s} refused: {refused}"
    seconds = time.perf_counter() - start
    told = []
    for k in range(h.shape[1]):
        left = found.model(approach(h, k))[-h.shape[0] :] - b[:, k]
        error = 100.0 * float(np.std(left))
        star = "*" if k >= h.shape[1] - count else " "
        told.append(f"{error / np.ptp(b[:, k]):6.2f} ({error / np.ptp(b[:, -1]):5.2f}){star}")
    return f"{said:50s} {' '.join(told)} {found.verdict.level:5s} {seconds:5.1f} s"


def approach(h: Array, k: int) -> Array:
    """Give laps that shrink from the largest loop to this one, and laps of it."""
    shares = np.linspace(1.0, np.ptp(h[:, k]) / np.ptp(h[:, -1]), SHRINKING)
    return np.concatenate([h[:, -1], *(share * h[:, -1] for share in shares), *[h[:, k]] * LAPS])


if __name__ == "__main__":
    main()
