"""Draw the figure of docs/butterfly.md: `python docs/figures/draw_butterfly.py`."""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hyst.cli import main

HERE = Path(__file__).resolve().parent
SAMPLES = 2000


def strain(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the strain of a ferroelectric of 40,000 relays with Gaussian fields, in um."""
    grid = np.linspace(-1.3, 1.3, 283)
    up, down = (each[np.tril_indices(grid.size)] for each in np.meshgrid(grid, grid, indexing="ij"))
    share = np.exp(-0.5 * (((up - down) / 2.0 - 0.35) / 0.1) ** 2)
    share *= np.exp(-0.5 * (((up + down) / 2.0 - 0.03) / 0.1) ** 2)
    share /= share.sum()
    state, z = np.where(up + down > 0.0, -1.0, 1.0), np.empty(u.size)
    for k, now in enumerate(u):
        state[up <= now], state[down >= now] = 1.0, -1.0
        z[k] = share @ state
    return 3.0 * (z**2 + 0.25 * z * u + 0.05 * u)


def draw() -> None:
    """Simulate a record, identify it and keep the figure of its loop."""
    t = np.arange(SAMPLES) / SAMPLES
    u = np.sin(2.0 * np.pi * 6.25 * t) * np.where(t < 0.3, 1.0, np.exp(0.3 - t))
    y = strain(u)
    y += 0.002 * np.ptp(y) * np.random.default_rng(1).normal(size=u.size)
    with tempfile.TemporaryDirectory() as folder:
        record, out = Path(folder, "strain.csv"), Path(folder, "out")
        table = np.column_stack([1e-3 * np.arange(SAMPLES), 2.0 * u, y])
        np.savetxt(
            record, table, delimiter=",", comments="", header="t [s],field [kV/mm],strain [um]"
        )
        columns = ["--input", "1", "--output", "2", "--time", "0"]
        if main(["identify", str(record), *columns, "--family", "butterfly", "-o", str(out)]):
            sys.exit("the record could not be identified")
        shutil.copy(out / "loop.png", HERE / "butterfly-loop.png")


if __name__ == "__main__":
    draw()
