"""Inversion of a hysteresis with linear dynamics behind it: look ahead through the dynamics.

The wanted output passes the stable, two-sided inverse of the dynamics, then the exact inverse of
the hysteresis. Before and after the trajectory the wanted output is taken to rest.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.compensation.result import Compensation
from hyst.errors import InputError
from hyst.models import LinearDynamics, StableInverse
from hyst.models.linear_properties import settling_samples
from hyst.operators import Composition, Operator

Array = NDArray[np.float64]

_FORGOTTEN = 1e-9  # of the sum of the absolute impulse response


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
        One ``LinearDynamics`` stage among stages with exact inverses.
    y_ref, input_range, history
        As in ``invert_trajectory``.
    clip
        Whether to hold the input at an end of its range instead of refusing.
    band
        Highest frequency that is inverted, Hz; None inverts all.

    Returns
    -------
    Compensation

    Raises
    ------
    InputError
        If the model has not exactly one linear stage, or the input leaves its range.
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
    before, dynamics, after = stages_around_dynamics(model)
    reference = finite_vector(y_ref, "y_ref")
    past = None if history is None else finite_vector(history, "history")
    start = model.initial_state() if past is None else model.run(past)[1]
    inverse = StableInverse.of(dynamics, band=band)
    v = inverse(_through(after, reference, None))
    u = _through(before, v, past)
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
    known = inverse.valid(reference.size)
    first = min(known.start + _settled_after(dynamics), reference.size)
    inside = (first, max(first, known.stop))
    where = f"exact for samples {inside[0]} to {inside[1] - 1}, and before and after"
    if inside[0] == inside[1]:
        where = "the record is too short for it to be exact anywhere but"
    note = (
        f"looks {inverse.preview} samples ahead; {where} as far as the reference rests there; "
        f"noise gain {inverse.noise_gain:.3g}"
    )
    return Compensation(
        u, reference, y_predicted, "noncausal", clipped, notes=(note,), interior=inside
    )


def _settled_after(dynamics: LinearDynamics) -> int:
    """Give the samples after which what the dynamics held at the start is as good as forgotten."""
    samples = settling_samples(dynamics.A) + dynamics.delay
    grown = np.cumsum(np.abs(dynamics.impulse_response(samples)))
    return int(np.searchsorted(grown, (1.0 - _FORGOTTEN) * grown[-1]))


def stages_around_dynamics(
    model: Operator,
) -> tuple[Operator | None, LinearDynamics, Operator | None]:
    """Split a model at its one stage of linear dynamics.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    before, dynamics, after
        What stands before and after the dynamics is None where nothing does.

    Raises
    ------
    InputError
        If there is not exactly one such stage.
    """
    stages = list(model.parts) if isinstance(model, Composition) else [model]
    places = [i for i, stage in enumerate(stages) if isinstance(stage, LinearDynamics)]
    if len(places) != 1:
        raise InputError(
            f"the model has {len(places)} stages of linear dynamics; method 'noncausal' is for "
            "models with one"
        )
    at = places[0]
    before = Composition(stages[:at]) if at > 0 else None
    after = Composition(stages[at + 1 :]) if at + 1 < len(stages) else None
    dynamics = stages[at]
    assert isinstance(dynamics, LinearDynamics)
    return before, dynamics, after


def _through(operator: Operator | None, signal: Array, past: Array | None) -> Array:
    """Pass the exact inverse of an operator, with the memory its past has left."""
    if operator is None:
        return signal
    inverse = operator.inverse()
    state = None if past is None else inverse.run(operator(past))[1]
    return inverse.run(signal, state)[0]
