"""Draw the figure of docs/degrading_bouc_wen.md: `python docs/figures/draw_wear.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import hyst
from hyst.report.canvas import blank, drawn

HERE = Path(__file__).resolve().parent


@drawn
def wear() -> Figure:
    """Draw eight loops that grow, of a joint that wears out and of one that pinches as well."""
    figure, axes = blank(2, 1, 9.6, 3.8)
    t = np.linspace(0.0, 8.0, 6000)
    u = (0.5 + 0.35 * t) * np.sin(2.0 * np.pi * t)
    worn = hyst.DegradingBoucWen(0.1, 1.0, 0.6, 0.4, delta_nu=0.015, delta_eta=0.04)
    pinched = hyst.DegradingBoucWen(
        0.1, 1.0, 0.6, 0.4, 1.0, 0.015, 0.04, zeta=0.9, p=0.3, q=0.15, psi=0.25, lam=0.4
    )
    shown = {"strength and stiffness degrade": worn, "and loops pinch": pinched}
    for each, (name, model) in zip(axes, shown.items(), strict=True):
        each.plot(u, model(u))
        each.set(xlabel="u", ylabel="y", title=name)
    return figure


if __name__ == "__main__":
    (HERE / "degrading-bouc-wen-loops.png").write_bytes(wear())
