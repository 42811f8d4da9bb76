"""Draw the figure of docs/two_envelope.md: `python docs/figures/draw_two_envelope.py`."""

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


def stroke(temperature: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the stroke of a simulated shape-memory wire, in mm.

    It shortens steeply when it is heated to some 75 degrees, and lengthens more gradually when it
    is cooled below 60.
    """
    r, z, y = np.array([0.02, 0.06, 0.1]), np.full(3, 0.0), []
    for now in temperature:
        up = 0.5 * (1.0 + np.tanh((now - 76.0) / 6.0))
        down = 0.5 * (1.0 + np.tanh((now - 57.0) / 11.0))
        z = np.maximum(up - r, np.minimum(down + r, z))
        y.append(6.0 * float(z.mean()) + 0.012 * now)
    return np.array(y)


def draw() -> None:
    """Simulate a record, identify it and keep the figure of its loop."""
    t = np.arange(SAMPLES) / SAMPLES
    share = np.sin(2.0 * np.pi * 6.25 * t) * np.where(t < 0.3, 1.0, np.exp(1.5 * (0.3 - t)))
    heat = 65.0 + 40.0 * share
    y = stroke(heat)
    y += 0.002 * np.ptp(y) * np.random.default_rng(1).normal(size=y.size)
    with tempfile.TemporaryDirectory() as folder:
        record, out = Path(folder, "wire.csv"), Path(folder, "out")
        table = np.column_stack([0.1 * np.arange(SAMPLES), heat, y])
        heading = "t [s],temperature [degC],stroke [mm]"
        np.savetxt(record, table, delimiter=",", comments="", header=heading)
        columns = ["--input", "1", "--output", "2", "--time", "0"]
        if main(["identify", str(record), *columns, "--family", "two-envelope", "-o", str(out)]):
            sys.exit("the record could not be identified")
        shutil.copy(out / "loop.png", HERE / "two-envelope-loop.png")


if __name__ == "__main__":
    draw()
