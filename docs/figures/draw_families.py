"""Draw a loop of every family for the gallery: `python docs/figures/draw_families.py`.

The actuators are those that the tests of the families take (tests/reference/family_examples.py).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import hyst

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "tests"))

from reference.family_examples import family_example  # noqa: E402

Array = NDArray[np.float64]
COLOURS = {"": "#1d4fbf", "slow": "#1d4fbf", "fast": "#c2410c"}


def drives(name: str) -> dict[str, Array]:
    """Give what drives the actuator: strokes that shrink; of one that knows time, slow and fast."""
    example = family_example(name)
    low = min(float(u.min()) for u in example.drives)
    high = max(float(u.max()) for u in example.drives)
    count = 3000
    t = np.arange(count) / count
    size = np.where(t < 0.34, 1.0, np.exp(-1.5 * (t - 0.34)))
    shrinking = np.sin(2.0 * np.pi * 6.25 * t) * size
    signals = {"": shrinking}
    if not example.model.traits().held()["rate_independent"]:
        strokes = np.sin(2.0 * np.pi * 3.25 * t)
        signals = {"slow": strokes, "fast": np.sin(2.0 * np.pi * 32.5 * t)[:1000]}
    return {key: 0.5 * (low + high) + 0.5 * (high - low) * u for key, u in signals.items()}


def draw(name: str) -> None:
    """Draw the loops of one family."""
    figure = Figure((3.2, 2.6), layout="constrained")
    axes = figure.subplots()
    model, sign = family_example(name).model, 0.0
    for key, u in drives(name).items():
        y = model(u)
        sign = sign or np.sign(y[u.argmax()] - y[u.argmin()])
        y *= sign  # some examples fall where the drive rises; the shape is what is shown
        axes.plot(u, y, color=COLOURS[key], linewidth=1.1, label=key)
        if key:
            axes.legend(frameon=False, fontsize="small")
    axes.set(xlabel="input", ylabel="output")
    axes.grid(alpha=0.3)
    figure.savefig(HERE / "families" / f"{name}.png", dpi=100)


if __name__ == "__main__":
    for each in hyst.families:
        draw(each)
