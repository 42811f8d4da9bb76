"""Inversion of a hysteresis with linear dynamics behind or before it, or on both sides.

From the output back to the input: dynamics by their stable, two-sided inverse, which looks ahead,
all between them by its exact inverse. Before and after the trajectory the wanted output is taken to
rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.compensation.result import Compensation
from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics, StableInverse
from hyst.models.linear_properties import settling_samples
from hyst.operators import Composition, Operator

Array = NDArray[np.float64]

_FORGOTTEN = 1e-9  # of the sum of the absolute impulse response
_ON_ITS_BRANCH = 1e-7  # of the reference's range: what series and rounding leave is far less


def invert_noncausally(
    model: Operator,
    y_ref: ArrayLike,
    input_range: tuple[float, float] | None,
    clip: bool,
    history: ArrayLike | None,
    band: float | None = None,
) -> Compensation:
    """Invert a trajectory through linear dynamics, looking ahead.

    Parameters
    ----------
    model
        ``LinearDynamics``, one stage or several, among stages with exact inverses.
    y_ref, input_range, history
        As in ``invert_trajectory``.
    clip
        Whether to hold the input at an end of its range instead of refusing.
    band
        Highest frequency that is inverted, Hz, by the dynamics behind all hysteresis, and by others
        that are not inverted beyond it either; None inverts all.

    Returns
    -------
    Compensation

    Raises
    ------
    InputError
        If the model has no stage of linear dynamics, or the input leaves its range.
    NotInvertibleError
        If the hysteresis has no exact inverse or the dynamics have no stable one.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> G = LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], dt=1e-3)
    >>> model = G @ PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    >>> y_ref = 3.0 * np.sin(np.linspace(0.0, 6.0, 200))
    >>> done = invert_noncausally(model, y_ref, None, False, None)
    >>> bool(np.abs(done.predicted_error[:-1]).max() < 1e-10)
    True
    """
    parts = split_at_dynamics(model)
    reference = finite_vector(y_ref, "y_ref")
    past = None if history is None else finite_vector(history, "history")
    start = model.initial_state() if past is None else model.run(past)[1]
    inverses = _inverses(parts, band)
    u = _inverted(parts, inverses, reference, past)
    clipped = 0
    if input_range is not None:
        low, high = float(input_range[0]), float(input_range[1])
        outside = (u < low) | (u > high)
        if outside.any() and not clip:
            k = int(outside.argmax())
            raise InputError(
                f"y_ref needs the input {u[k]:.6g} at sample {k}, outside its range {low:.6g} to "
                f"{high:.6g}; slow the reference down, limit the band, or choose to clip it"
            )
        clipped, u = int(outside.sum()), np.clip(u, low, high)
    y_predicted, _ = model.run(u, start)
    known = [each for each in inverses if each is not None]
    inside = _interior(parts, known, reference, None if band else y_predicted)
    how = "exact" if band is None else f"what lies below {band:.6g} Hz is exact"
    where = f"{how} for samples {inside[0]} to {inside[1] - 1}, and before and after"
    if inside[0] == inside[1]:
        where = "the record is too short for it to be exact anywhere but"
    gains = " and ".join(f"{each.noise_gain:.3g}" for each in reversed(known))
    several = ", of the dynamics from the output on" if len(known) > 1 else ""
    note = (
        f"looks {sum(each.preview for each in known)} samples ahead; {where} as far as the "
        f"reference rests there; noise gain {gains}{several}"
    )
    return Compensation(
        u, reference, y_predicted, "noncausal", clipped, notes=(note,), interior=inside
    )


def _inverses(parts: Sequence[Operator], band: float | None) -> list[StableInverse | None]:
    """Give the inverse of each stage of dynamics.

    Before a hysteresis, whose inverse has corners, a band is kept only where it must be.
    """
    inverses = list[StableInverse | None]()
    for i, part in enumerate(parts):
        if not isinstance(part, LinearDynamics):
            inverses.append(None)
        elif band is None or _has_memory(parts[i + 1 :]):
            inverses.append(_without_band(part, band))
        else:
            inverses.append(StableInverse.of(part, band=band))
    return inverses


def _without_band(dynamics: LinearDynamics, band: float | None) -> StableInverse:
    try:
        return StableInverse.of(dynamics)
    except NotInvertibleError:
        if band is None:
            raise
        return StableInverse.of(dynamics, band=band)


def _has_memory(parts: Sequence[Operator]) -> bool:
    """Tell whether a hysteresis is among stages."""
    return not all(isinstance(each, LinearDynamics) or each.traits().memoryless for each in parts)


def _inverted(
    parts: Sequence[Operator],
    inverses: Sequence[StableInverse | None],
    reference: Array,
    past: Array | None,
) -> Array:
    """Go back from the output to the input, part by part."""
    before = [past]
    for part in parts[:-1]:
        before.append(None if before[-1] is None else part(before[-1]))
    # What lies before a hysteresis looks ahead of it, where the reference rests already.
    ahead = sum(each.preview for each in [one for one in inverses if one is not None][:-1])
    signal = np.concatenate([reference, np.full(ahead, reference[-1])])
    for part, inverse, own_past in reversed(list(zip(parts, inverses, before, strict=True))):
        signal = _through(part, signal, own_past) if inverse is None else inverse(signal)
    return signal[: reference.size]


def _interior(
    parts: Sequence[Operator], inverses: Sequence[StableInverse], reference: Array, y: Array | None
) -> tuple[int, int]:
    """Give the samples that what is not known of start and end does not reach."""
    dynamics = [each for each in parts if isinstance(each, LinearDynamics)]
    first = sum(each.memory for each in inverses) + sum(map(_settled_after, dynamics))
    beyond = max(reference.size - sum(each.preview for each in inverses), 0)
    first = min(first, reference.size)
    behind = parts[[isinstance(each, LinearDynamics) for each in parts].index(True) :]
    if y is not None and _has_memory(behind):
        # Until the dynamics before it have settled, a memory may take a branch and keep to it.
        off = np.abs(y - reference)[first:beyond] > _ON_ITS_BRANCH * float(np.ptp(reference))
        first += int(np.flatnonzero(off)[-1]) + 1 if off.any() else 0
    return first, max(first, beyond)


def _settled_after(dynamics: LinearDynamics) -> int:
    """Give the samples after which what the dynamics held at the start is as good as forgotten."""
    samples = settling_samples(dynamics.A) + dynamics.delay
    grown = np.cumsum(np.abs(dynamics.impulse_response(samples)))
    return int(np.searchsorted(grown, (1.0 - _FORGOTTEN) * grown[-1]))


def split_at_dynamics(model: Operator) -> tuple[Operator, ...]:
    """Split a model at its stages of linear dynamics.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    tuple of Operator
        The stages of dynamics and what stands before, between and behind them, in the order of the
        signal.

    Raises
    ------
    InputError
        If there is no such stage.
    """
    stages = list(model.parts) if isinstance(model, Composition) else [model]
    parts, between = list[Operator](), list[Operator]()
    for stage in stages:
        if isinstance(stage, LinearDynamics):
            parts += [Composition(between), stage] if between else [stage]
            between = []
        else:
            between.append(stage)
    parts += [Composition(between)] if between else []
    if not any(isinstance(each, LinearDynamics) for each in parts):
        raise InputError(
            "the model has 0 stages of linear dynamics; method 'noncausal' is for models with some"
        )
    return tuple(parts)


def _through(operator: Operator, signal: Array, past: Array | None) -> Array:
    """Pass the exact inverse of an operator, with the memory its past has left."""
    inverse = operator.inverse()
    state = None if past is None else inverse.run(operator(past))[1]
    return inverse.run(signal, state)[0]
