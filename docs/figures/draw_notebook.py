"""Draw the figures of docs/notebook.md, and print what the page quotes.

    python docs/figures/draw_notebook.py

The stage is simulated: plays before a map that bends, with noise of the sensor.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

import hyst

HERE = Path(__file__).resolve().parent
DT = 1e-3


def record(seed: int, shrinks_to: float, strokes: int) -> hyst.Record:
    """Strokes that shrink, and what the stage makes of them."""
    stage = hyst.Affine(0.4, 3.0) @ hyst.PrandtlIshlinskii(
        [0.25, 0.15, 0.1, 0.08], [4.0, 12.0, 25.0, 40.0], p0=0.8
    )
    k = np.arange(4000)
    u = 75.0 - 75.0 * np.cos(2.0 * np.pi * strokes * k / k.size) * np.linspace(
        1.0, shrinks_to, k.size
    )
    y = stage(u) + np.random.default_rng(seed).normal(0.0, 0.05, u.size)
    names = {"input_name": "drive", "output_name": "position"}
    return hyst.Record(u, y, DT, **names, input_unit="V", output_unit="um")


def draw() -> None:
    """Do what the page does."""
    training, fresh = record(1, 0.2, 8), record(2, 0.4, 5)
    save(training.plot(), "notebook-record")
    found = hyst.identify(training, family="pi,mpi")
    save(found.plot(), "notebook-found")
    rivals = {name: hyst.identify(training, family=name) for name in ("linear", "ramberg-osgood")}
    compared = hyst.compare({found.family: found, **rivals}, fresh)
    sys.stdout.write(f"{found}\n{compared.summary()}\n")
    save(compared.plot(what=("hysteresis", "errors")), "notebook-compare")
    save(found.model.plot(what=("loop", "weights")), "notebook-model")


def save(drawn: Any, name: str) -> None:
    """Write a figure."""
    drawn.figure.savefig(HERE / f"{name}.png", dpi=100)


if __name__ == "__main__":
    draw()
