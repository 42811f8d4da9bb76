"""Draw the first figure of the README: `python docs/figures/draw_before_after.py`.

The model is identified from examples/stage.csv; the simulated stage behind that file then follows
examples/trajectory.csv with the command of a straight line and with that of the model's inverse.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import rc_context
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
    """Draw position over wanted position, before and after, and both errors over time."""
    y_ref, went = follow()
    t = SimulatedStage().dt * np.arange(y_ref.size)
    figure = Figure((7.2, 3.9), layout="constrained")
    loop, error = figure.subplots(1, 2, width_ratios=[1.0, 1.0])
    for (name, y), colour, width in zip(went.items(), (BEFORE, AFTER), (1.2, 2.0), strict=True):
        rms = np.sqrt(np.mean((y - y_ref) ** 2))
        loop.plot(y_ref, y, color=colour, linewidth=width, label=name)
        error.plot(t, y - y_ref, color=colour, linewidth=width, label=f"{rms:.2g} um rms")
    loop.set(xlabel="wanted position [um]", ylabel="position [um]", box_aspect=1)
    loop.legend(frameon=False, title="command of")
    error.set(xlabel="time [s]", ylabel="position minus wanted [um]", box_aspect=1)
    error.legend(frameon=False, loc="upper right", bbox_to_anchor=(1.0, 1.0))
    error.set_ylim(-4.2, 3.2)
    for axes in (loop, error):
        axes.grid(alpha=0.3)
    figure.savefig(HERE / "before-after.png", dpi=100)


if __name__ == "__main__":
    with rc_context({"font.size": 12.0}):
        draw()
