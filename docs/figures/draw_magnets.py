"""Draw the figures of the pages of magnets: `python docs/figures/draw_magnets.py`."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import hyst
from hyst.models.jiles_atherton import VARIANTS
from hyst.report.canvas import blank, drawn

HERE = Path(__file__).resolve().parent


def way(*turns: float) -> NDArray[np.float64]:
    """Give straight strokes from turn to turn."""
    steps = [np.linspace(a, b, 200) for a, b in itertools.pairwise(turns)]
    return np.concatenate(steps)


@drawn
def variants() -> Figure:
    """Draw what variants make of the same constants: the initial curve, a loop, a minor loop."""
    figure, (axes,) = blank(1, 1, 6.4, 4.2)
    h = way(0.0, 6.0, -6.0, 1.5, -0.5, 6.0)
    for variant in VARIANTS:
        magnet = hyst.JilesAtherton(1.0, 1.0, 1.0, 0.2, 2.2, variant)
        axes.plot(h, magnet(h), label=variant)
    axes.set(xlabel="H / a", ylabel="M / Ms", title="k = a, c = 0.2, alpha Ms = 2.2 a")
    axes.legend()
    return figure


@drawn
def relaxations() -> Figure:
    """Draw one piece and three, each with the curve that it relaxes to and a minor loop."""
    figure, axes = blank(2, 1, 9.6, 3.8)
    shown = {
        "one piece": hyst.ColemanHodgdon(1.0, 1.0, 0.7),
        "three pieces": hyst.ColemanHodgdon(1.5, [1.0, 0.6, 0.1], [0.7, 0.5, 0.1], [1.0, 2.0]),
    }
    u = way(0.0, 3.0, -3.0, 1.0, -0.5, 1.0, -0.5, 3.0)
    curve = np.linspace(-3.0, 3.0, 301)
    for each, (name, model) in zip(axes, shown.items(), strict=True):
        straight = hyst.ColemanHodgdon(1.0, model.a, model.a, model.u_s)
        each.plot(u, model(u), label="y")
        each.plot(curve, straight(curve), "--", label="f(u)")
        each.set(xlabel="u", ylabel="y", title=name)
        each.legend()
    return figure


@drawn
def losses() -> Figure:
    """Draw loops of a sheet of steel whose eddy currents widen them with the frequency."""
    figure, (axes,) = blank(1, 1, 6.4, 4.2)
    magnet = hyst.JilesAtherton(1.6e6, 300.0, 150.0, 0.1, 4e-4, output="B")
    phase = 2.0 * np.pi * np.linspace(0.0, 2.25, 9000)
    for frequency in (1.0, 50.0, 200.0, 400.0):
        dt = float(phase[1] - phase[0]) / (2.0 * np.pi * frequency)
        sheet = hyst.DynamicJilesAtherton(magnet, k_cl=0.05, k_ex=1.5, dt=dt)
        h = 800.0 * np.sin(phase)
        axes.plot(h[1000:], sheet(h)[1000:], label=f"{frequency:.0f} Hz")
    axes.set(xlabel="H, A/m", ylabel="B, T", title="k_cl = 0.05, k_ex = 1.5 in A/m and T/s")
    axes.legend()
    return figure


if __name__ == "__main__":
    (HERE / "jiles-atherton-variants.png").write_bytes(variants())
    (HERE / "jiles-atherton-losses.png").write_bytes(losses())
    (HERE / "coleman-hodgdon-loops.png").write_bytes(relaxations())
