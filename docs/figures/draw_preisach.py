"""Draw the FORC diagram of docs/preisach.md: `python docs/figures/draw_preisach.py`."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import hyst
from hyst.report import draw_forc_diagram
from hyst.signals import ForcDensity, forc_density, reversal_curves

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent))

from benchmarks.switching import DENSITIES, NOISE, Material, curves_from, strokes  # noqa: E402

POINTS = 60


def draw() -> None:
    """Simulate a switching material of tilted density and draw what is found of it."""
    density = DENSITIES["tilted"]
    u = strokes([-1.0, 1.0, -1.0, 1.0, *curves_from(np.linspace(-0.95, 0.95, 40))])
    y = 2.0 * Material(density)(u) - 1.0
    noise = NOISE * np.ptp(y) * np.random.default_rng(0).standard_normal(u.size)
    record = hyst.Record(u, y + noise, 0.01)
    found = hyst.identify(record, family="preisach", delay=0)
    relays = next(each for each in found.model.parts if isinstance(each, hyst.Preisach))
    side = 2.0 / POINTS
    grid = -1.0 + side * (np.arange(POINTS) + 0.5)
    alpha, beta = np.meshgrid(grid, grid, indexing="ij")
    true = np.where(alpha >= beta, density(alpha, beta), np.nan)
    true /= np.nansum(true) * side**2
    content = draw_forc_diagram(
        [
            ("true density", ForcDensity(grid, grid, true)),
            ("model of the record", relays),
            ("local polynomials", forc_density(reversal_curves(record))),
        ]
    )
    (HERE / "preisach-forc.png").write_bytes(content)


if __name__ == "__main__":
    draw()
