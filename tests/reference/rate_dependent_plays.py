"""Rate-dependent plays written from S4 eqs. 4 and 34-38 and from nothing else."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# The example of S4 sec. III-F and the actuator of sec. IV-C.
EXAMPLE = {
    "p": [0.3667, 0.2690, 0.1973, 0.1447],
    "r": [3.0, 6.0, 9.0, 12.0],
    "beta": 28.0 / 40000.0,
    "p0": 0.5,
}
ACTUATOR = {
    "p": [0.2906, 0.0461, 0.1512],
    "r": [9.715, 19.43, 29.145],
    "beta": 8.572e-4,
    "p0": 0.7124,
}
DT = 1e-4


def reference_signal(f: float, periods: int = 3) -> Array:
    """S4 sec. III-F, whole periods of f."""
    t = np.arange(round(periods / f / DT)) * DT
    return 22.0 * np.sin(2.0 * np.pi * f * t) + 25.0 * np.sin(6.0 * np.pi * f * t)


def output(
    p: list[float],
    r: list[float],
    p0: float,
    u: Array,
    widening: Array,
    z: list[float] | None = None,
) -> Array:
    """Eq. 38 for a widening of all thresholds given at every sample."""
    memory = list(z) if z is not None else [0.0] * len(p)
    y = []
    for value, b in zip(u.tolist(), widening.tolist(), strict=True):
        total = p0 * value
        for i, (weight, threshold) in enumerate(zip(p, r, strict=True)):
            # Eq. 4: P(U, R, Z) = max(U - R, min(U + R, Z)).
            memory[i] = max(value - (threshold + b), min(value + (threshold + b), memory[i]))
            total += weight * memory[i]
        y.append(total)
    return np.array(y)


def rate(u: Array, dt: float) -> Array:
    """Eq. 34, absolute; 0 at the first sample, which has none before it."""
    return np.abs(np.concatenate([[0.0], np.diff(u)])) / dt
