"""Draw the figure of docs/loops.md, and print what the page quotes.

    python docs/figures/draw_loops.py

The stage is simulated: plays that widen with the rate, before a resonance of 200 Hz with three
samples of delay. The model's plays do not widen; its dynamics are right.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

import numpy as np

import hyst
from hyst.cli import main

HERE = Path(__file__).resolve().parent
DT = 1e-4
WEIGHTS, RADII = [0.12, 0.09, 0.08, 0.06, 0.05], [0.5, 1.5, 3.0, 5.0, 8.0]
FREQUENCIES = (5, 20, 60, 100)


def draw() -> None:
    """Run the command of the page, and keep its figure."""
    w = 2.0 * np.pi * 200.0
    G = hyst.LinearDynamics.from_continuous([w**2], [1.0, 0.06 * w, w**2], DT)
    G = hyst.LinearDynamics(G.A, G.B, G.C, G.D, DT, 3)
    model = G @ hyst.PrandtlIshlinskii(WEIGHTS, RADII, p0=0.6)
    stage = G @ hyst.RateDependentPrandtlIshlinskii(WEIGHTS, RADII, 2e-4, DT, p0=0.6)
    with tempfile.TemporaryDirectory() as name:
        folder, files = Path(name), []
        model.save(folder / "model.json")
        for frequency in FREQUENCIES:
            k = np.arange(int(max(4.0 / frequency, 0.3) / DT))
            u = 10.0 * np.sin(2.0 * np.pi * frequency * DT * k)
            y = stage(u) + np.random.default_rng(frequency).normal(0.0, 0.03, u.size)
            files.append(str(folder / f"{frequency}hz.csv"))
            hyst.io.write_columns(files[-1], ["drive [V]", "position [um]"], [u, y])
        columns = ["--input", "drive", "--output", "position", "--rate", "10000"]
        main(["loop", str(folder / "model.json"), *files, *columns, "-o", str(folder / "out")])
        shutil.copy(folder / "out" / "loops.png", HERE / "loops.png")


if __name__ == "__main__":
    draw()
