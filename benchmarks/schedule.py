"""Constants over a second signal: what a sample costs beside the same model with fixed constants.

Prints, for a modified Prandtl-Ishlinskii model of 10 plays and 4 dead zones over three values and
one run, nanoseconds a sample and ratios to the frozen model's own loop, of
- the scheduled model with a signal that moves at every sample, and with one that rests,
- its inverse, which solves for every sample, beside the frozen inverse,
- and how far the way back is from the input.
"""

from __future__ import annotations

import numpy as np

import hyst
from benchmarks.timing import interleaved, ratio

SAMPLES = 200_000
PLAYS = 10


def main() -> None:
    model, inverse = scheduled(), scheduled().inverse()
    k = np.arange(SAMPLES)
    u = np.sin(0.01 * k) * np.sin(0.0003 * k)
    moving, resting = 35.0 + 14.0 * np.sin(0.0005 * k), np.full(SAMPLES, 33.0)
    y, still = model.run(u, moving).y, model.run(u, resting).y
    frozen, back = model.at(33.0), model.at(33.0).inverse()
    works = {
        "frozen, loop": lambda: frozen.run(u, engine="loop"),
        "frozen, auto": lambda: frozen.run(u),
        "scheduled, moving": lambda: model.run(u, moving),
        "scheduled, resting": lambda: model.run(u, resting),
        "frozen inverse, loop": lambda: back.run(still, engine="loop"),
        "inverse, moving": lambda: inverse.run(y, moving),
        "inverse, resting": lambda: inverse.run(still, resting),
    }
    times = interleaved(works, seconds=20.0, rounds=9)
    for name, each in times.items():
        beside = "frozen inverse, loop" if "inverse" in name else "frozen, loop"
        nanoseconds = 1e9 * float(np.median(each)) / SAMPLES
        print(
            f"{name:24s}{nanoseconds:8.1f} ns a sample{ratio(times, name, beside):8.2f} of {beside}"
        )
    missed = float(np.abs(inverse.run(y, moving).y - u).max())
    print(f"\nround trip while the signal moves: {missed:.2g} of a range of {np.ptp(u):.3g}")


def scheduled() -> hyst.Scheduled:
    return hyst.Scheduled([_at(x) for x in (0.0, 0.5, 1.0)], [20.0, 35.0, 50.0], "temperature")


def _at(x: float) -> hyst.Operator:
    weights = np.linspace(0.3, 0.05, PLAYS) * (1.0 + 0.3 * x)
    radii = np.linspace(0.02, 0.8, PLAYS) * (1.0 - 0.2 * x)
    output_map = hyst.DeadZone(
        [1.0, -0.2 - 0.1 * x, 0.1, 0.2], [0.0, 0.8, 1.5 + 0.2 * x, -0.9 - 0.1 * x]
    )
    return output_map @ hyst.PrandtlIshlinskii(weights, radii, p0=1.0 + 0.1 * x)
