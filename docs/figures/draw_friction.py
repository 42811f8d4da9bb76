"""Draw the figure of docs/friction.md: `python docs/figures/draw_friction.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import hyst

HERE = Path(__file__).resolve().parent
Array = NDArray[np.float64]


def minor_loops(samples: int = 4000) -> Array:
    """Give three strokes, the second with loops on its way."""
    t = np.linspace(0.0, 3.0, samples)
    u = np.interp(t, [0.0, 0.4, 1.0, 2.4, 3.0], [0.0, 1.0, -1.0, 1.0, -1.0])
    inside = (t > 1.0) & (t < 2.4)
    return np.asarray(u + np.where(inside, 0.16 * np.sin(np.pi * (t - 1.0) / 0.2), 0.0))


def draw() -> None:
    """Draw friction over displacement, and over velocity."""
    u = minor_loops()
    figure = Figure((9.0, 4.4), layout="constrained")
    over_way, over_velocity = figure.subplots(1, 2)
    springs = hyst.MaxwellSlip([4.0, 1.5, 0.6], [0.4, 0.35, 0.25])
    for friction, name in (
        (springs, "Maxwell-slip: loops close"),
        (hyst.Dahl(6.0, 1.0), "Dahl: they wander"),
    ):
        over_way.plot(u, friction(u), linewidth=1.0, label=name)
    over_way.set(xlabel="displacement", ylabel="force")
    t = np.arange(8000) * 1e-3
    motion = 0.5 * np.sin(2.0 * np.pi * 0.25 * t)
    v = np.gradient(motion, 1e-3)
    curves = {
        "LuGre: falls, then grows": hyst.LuGre(120.0, 0.3, 0.35, 0.6, 1.1, 0.2, 1e-3),
        "LuGre, viscosity that saturates": hyst.LuGre(
            60.0, 0.3, 0.1, 0.4, 0.4, 1.0, 1e-3, 0.6, 0.2
        ),
    }
    for name, friction in curves.items():
        over_velocity.plot(v[4000:], friction(motion)[4000:], linewidth=1.0, label=name)
    over_velocity.set(xlabel="velocity", ylabel="force")
    for axes in (over_way, over_velocity):
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, fontsize="small")
        axes.grid(alpha=0.3)
    figure.savefig(HERE / "friction.png", dpi=100)


if __name__ == "__main__":
    draw()
