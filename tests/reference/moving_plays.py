"""Plays, a map and a line whose constants move, in plain Python: the truth of tests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Array = np.ndarray


@dataclass(frozen=True)
class Actuator:
    """Constants at one value of the second signal.

    ``v = p0 u + p z``, ``x = v + w max(v - rho, 0)``, ``y = gain x + offset``; z the plays of r.
    """

    p0: float
    p: Array
    r: Array
    w: float = 0.0
    rho: float = 1.0
    gain: float = 1.0
    offset: float = 0.0


def actuator(t: float, *, moving_radii: float = 0.0, map_weight: float = 0.0) -> Actuator:
    """An actuator that is stiffer when cold: constants are straight lines over t, from 20 to 50."""
    x = (t - 20.0) / 30.0
    return Actuator(
        p0=1.0 + 0.1 * x,
        p=np.array([0.4, 0.3, 0.2]) * (1.0 + 0.25 * x),
        r=np.array([0.1, 0.3, 0.55]) * (1.0 + moving_radii * x),
        w=map_weight * (1.0 - 0.5 * x),
        rho=0.5 + 0.1 * x,
        gain=1.0 + 0.2 * x if map_weight else 1.0,
        offset=0.2,
    )


def output(
    u: Array, t: Array, *, moving_radii: float = 0.0, map_weight: float = 0.0, low=20.0, high=50.0
) -> Array:
    """The output while t moves; outside low to high the constants are held."""
    z = np.zeros(3)
    y = np.empty(len(u))
    for k, (x, now) in enumerate(zip(u, np.clip(t, low, high), strict=True)):
        of = actuator(float(now), moving_radii=moving_radii, map_weight=map_weight)
        z = np.minimum(np.maximum(z, x - of.r), x + of.r)
        v = of.p0 * x + of.p @ z
        y[k] = of.gain * (v + of.w * max(v - of.rho, 0.0)) + of.offset
    return y


def sweep(samples: int, cycles: float = 5.0) -> Array:
    """Strokes that shrink, from 1 to 0.2, at even steps."""
    t = np.linspace(0.0, 1.0, samples)
    return np.sin(2.0 * np.pi * cycles * t) * (1.0 - 0.8 * t) + 0.02 * np.sin(40.0 * t)
