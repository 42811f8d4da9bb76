"""Draw the first figure of the README: `python docs/figures/draw_before_after.py`.

The model is identified from examples/stage.csv; the simulated stage behind that file then follows
examples/trajectory.csv with the command of a straight line and with that of the model's inverse.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import hyst
from hyst.compensation import invert_trajectory
from hyst.demo import SimulatedStage
from hyst.identification import earlier

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"
LIMITS = (0.0, 100.0)
BEFORE, AFTER = "#1d4fbf", "#c2410c"

Array = NDArray[np.float64]


def follow() -> tuple[Array, dict[str, Array]]:
    """Give the reference, um, and where the stage went, by what its command came from."""
    record = hyst.read_record(EXAMPLES / "stage.csv", input="drive", output="position", time="time")
    y_ref, _, _ = hyst.io.read_column(EXAMPLES / "trajectory.csv", "position")
    found = hyst.identify(record)
    wanted = earlier(y_ref, found.delay)
    inverse = invert_trajectory(found.model, wanted, input_range=LIMITS, history=record.u)
    gain, offset = np.polyfit(record.u, record.y, 1)
    line = np.clip((y_ref - offset) / gain, *LIMITS)
    stage = SimulatedStage()
    went = {"straight line": line, "exact inverse": inverse.u}
    return y_ref, {name: stage.position(u, record.u) for name, u in went.items()}


def draw() -> None:
    """Draw position over reference, before and after, and both errors over time."""
    y_ref, went = follow()
    t = SimulatedStage().dt * np.arange(y_ref.size)
    figure = Figure((10.0, 3.9), layout="constrained")
    before, after, error = figure.subplots(1, 3, width_ratios=[1.0, 1.0, 1.5])
    for axes, (name, y), colour in zip((before, after), went.items(), (BEFORE, AFTER), strict=True):
        rms = np.sqrt(np.mean((y - y_ref) ** 2))
        axes.plot([8, 48], [8, 48], color="0.75", linewidth=4.0, zorder=0)
        axes.plot(y_ref, y, color=colour, linewidth=1.2)
        axes.set(xlabel="wanted position [um]", aspect="equal", box_aspect=1)
        axes.set_title(f"command of the {name}:\n{rms:.2g} um rms", fontsize="medium")
        error.plot(t, y - y_ref, color=colour, linewidth=1.2, label=name)
    before.set_ylabel("position [um]")
    error.set(xlabel="time [s]", ylabel="position minus wanted [um]")
    error.set_title("tracking error of the simulated stage", fontsize="medium")
    error.legend(frameon=False, loc="lower right")
    for axes in (before, after, error):
        axes.grid(alpha=0.3)
    figure.savefig(HERE / "before-after.png", dpi=100)


if __name__ == "__main__":
    draw()
