"""A stage stated by its resonances and plays: what one knows before the first record."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_positive, as_sample_time
from hyst.errors import InputError
from hyst.models import LinearDynamics, PrandtlIshlinskii
from hyst.operators import Operator

_OF_THE_INPUT = 0.6  # weight of the input in a front of weights not given; all add up to 1


def sketched_stage(
    dt: float,
    resonances: Sequence[tuple[float, float]],
    *,
    delay: int = 0,
    front: Operator,
) -> Operator:
    """Put resonances one after the other, of gain 1 at rest, behind a hysteresis.

    ``G(s) = prod_i w_i^2 / (s^2 + 2 d_i w_i s + w_i^2)``, sampled with a held input.

    Parameters
    ----------
    dt
        Sample time, s.
    resonances
        Pairs of frequency, Hz, below half the sample rate, and damping ratio, above 0.
    delay
        Whole samples.
    front
        The hysteresis.

    Returns
    -------
    Operator
        ``G @ front``.

    Raises
    ------
    InputError
        If there is no resonance, or a number cannot be used.

    Examples
    --------
    >>> stage = sketched_stage(1e-4, [(200.0, 0.03)], delay=3, front=sketched_plays([0.2]))
    >>> stage.parts[-1].order, stage.parts[-1].delay
    (2, 3)
    """
    time = as_sample_time(dt)
    if not resonances:
        raise InputError("no resonance is given; give frequency and damping of at least one")
    pairs = [_checked(frequency, damping, time) for frequency, damping in resonances]
    # In the unit of time in which the resonances are near 1: powers of 2 pi f lose digits.
    unit = math.exp(
        -sum(math.log(2.0 * math.pi * frequency) for frequency, _ in pairs) / len(pairs)
    )
    num, den = 1.0, np.ones(1)
    for frequency, damping in pairs:
        w = 2.0 * math.pi * frequency * unit
        num, den = num * w**2, np.convolve(den, [1.0, 2.0 * damping * w, w**2])
    G = LinearDynamics.from_continuous([num], den, time / unit)
    return LinearDynamics(G.A, G.B, G.C, G.D, time, delay) @ front


def sketched_plays(radii: ArrayLike, weights: ArrayLike | None = None) -> PrandtlIshlinskii:
    """Give plays of stated radii.

    Parameters
    ----------
    radii
        Shape (n,), input units, ascending, above 0.
    weights
        Shape (n + 1,): of the input, then of each play; 0.6 and the rest evenly, 1 in all, if left
        out.

    Raises
    ------
    InputError
        If there are not as many weights as radii and one more, or a number cannot be used.

    Examples
    --------
    >>> sketched_plays([0.1, 0.3]).p.tolist()
    [0.2, 0.2]
    """
    r = finite_vector(radii, "radii")
    if weights is None:
        return PrandtlIshlinskii(np.full(r.size, (1.0 - _OF_THE_INPUT) / r.size), r, _OF_THE_INPUT)
    p = finite_vector(weights, "weights")
    if p.size != r.size + 1:
        raise InputError(
            f"{p.size} weights are given for {r.size} radii; give that of the input first, then "
            "one for each radius"
        )
    return PrandtlIshlinskii(p[1:], r, float(p[0]))


def _checked(frequency: float, damping: float, dt: float) -> tuple[float, float]:
    hertz = as_positive(frequency, "the frequency of a resonance", "Hz")
    if hertz >= 0.5 / dt:
        raise InputError(
            f"a resonance is at {hertz:.6g} Hz, not below half the sample rate, {0.5 / dt:.6g} Hz; "
            "sample faster"
        )
    return hertz, as_positive(damping, "the damping of a resonance", "a damping ratio", most=10.0)
