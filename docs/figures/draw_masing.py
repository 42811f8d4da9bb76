"""Draw the figure of docs/masing.md: `python docs/figures/draw_masing.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import hyst

HERE = Path(__file__).resolve().parent


def draw() -> None:
    """Draw loops of exponential curves whose slope falls and grows, and of joints."""
    u = np.sin(np.linspace(0.0, 8.5 * np.pi, 6000)) * np.linspace(1.0, 0.25, 6000)
    figure = Figure((9.0, 4.2), layout="constrained")
    exponential, joints = figure.subplots(1, 2)
    for name, curve in {
        "slope falls from 4 to 0.5": hyst.models.ExponentialCurve(0.5, -3.5, 0.3),
        "slope grows from 0.5 to 3": hyst.models.ExponentialCurve(3.0, 2.5, 0.6),
    }.items():
        exponential.plot(u, hyst.MasingOperator(curve)(u), linewidth=1.0, label=name)
    exponential.set_title("exponential loading curves", fontsize="small")
    for name, joint in {
        "uniform (Iwan)": hyst.Iwan(1.0, 3.0, 0.0, 0.0, 0.6),
        "chi = -0.6, beta = 0.5": hyst.Iwan(1.0, 3.0, -0.6, 0.5, 0.6),
    }.items():
        joints.plot(u, joint(u), linewidth=1.0, label=name)
    joints.set_title("Iwan: sliders whose ways to slip are spread", fontsize="small")
    for axes in (exponential, joints):
        axes.set(xlabel="input", ylabel="output")
        axes.legend(frameon=False, fontsize="small")
        axes.grid(alpha=0.3)
    figure.savefig(HERE / "masing-loops.png", dpi=100)


if __name__ == "__main__":
    draw()
