"""Draw the figure of docs/bouc_wen.md: `python docs/figures/draw_bouc_wen.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import hyst

HERE = Path(__file__).resolve().parent


def draw() -> None:
    """Draw loops of a piezo with minor ones, and what exponent and asymmetry do to a spring."""
    figure = Figure((9.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    turns = [0.0, 100.0, 0.0, 60.0, 35.0, 60.0, 0.0, 80.0, 40.0, 70.0, 0.0]
    u = np.interp(np.linspace(0.0, len(turns) - 1.0, 4000), range(len(turns)), turns)
    piezo = hyst.BoucWen(k=0.6, A=0.35, beta=0.012, gamma=0.006, h=-1.0)
    left.plot(u, piezo(u), linewidth=1.0)
    left.set(xlabel="voltage, V", ylabel="position, um")
    left.set_title("h = -1, a piezo: minor loops stay open", fontsize="small")
    x = 2.0 * np.sin(np.linspace(0.0, 4.5 * np.pi, 4000))
    for name, spring in {
        "n = 1": hyst.BoucWen(0.1, 1.0, 0.6, 0.4),
        "n = 5": hyst.BoucWen(0.1, 1.0, 0.6, 0.4, n=5.0),
        "n = 1, phi = 0.2": hyst.BoucWen(0.1, 1.0, 0.6, 0.4, phi=0.2),
    }.items():
        right.plot(x[1000:], spring(x)[1000:], linewidth=1.0, label=name)
    right.set(xlabel="displacement", ylabel="force")
    right.set_title("h = 1, a spring that yields", fontsize="small")
    right.legend(frameon=False, fontsize="small")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    figure.savefig(HERE / "bouc-wen-loops.png", dpi=100)


if __name__ == "__main__":
    draw()
