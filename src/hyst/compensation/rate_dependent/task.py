"""What all inversions of a rate-dependent model start from: its plays, their state, their target.

A model may have maps without memory before and after its plays. The wanted output is taken back
through those after, the drive found for the plays is taken back through those before.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import finite_vector
from hyst.compensation.exact import range_of_input
from hyst.errors import InputError, NotInvertibleError
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import Composition, Operator
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RateDependentTask:
    """The plays of a model, and what their drive has to reach.

    Parameters
    ----------
    model
        The whole model.
    plays
        The one bank of rate-dependent plays in it.
    before
        What stands before the plays, or None.
    start
        State of the whole model before the first sample.
    y_ref
        Wanted output of the model, shape (N,).
    target
        Wanted output of the plays, shape (N,).
    low, high
        Range of the drive of the plays; infinite if there is none.
    clip
        Whether the drive may be clipped to its range.
    """

    model: Operator
    plays: RateDependentPrandtlIshlinskii
    before: Operator | None
    start: Array
    y_ref: Array
    target: Array
    low: float
    high: float
    clip: bool

    def state(self) -> Array:
        """Give the state of the plays before the first sample, a fresh array."""
        # Maps without memory have no state of their own.
        return self.start.copy()

    def chain(self) -> _engine.Chain:
        """Give the plays as the engine's chain of one stage."""
        return _engine.Chain(self.plays.stages())

    def input_of(self, drive: Array) -> Array:
        """Give the model's input for a drive of the plays."""
        return drive if self.before is None else self.before.inverse()(drive)

    def explicit_inverse(self) -> tuple[Operator, Array]:
        """Give the explicit inverse and its state before the first sample."""
        plays, state = self.plays, self.state()
        n = plays.p.size
        with_memory = RateDependentPrandtlIshlinskii(
            plays.p, plays.r, plays.rate_curve, plays.dt, plays.p0, state[:n]
        )
        inverse = with_memory.explicit_inverse()
        memory = inverse.initial_state()
        if state[n + 1] > 0.0:
            memory[n:] = plays.p0 * state[n] + float(plays.p @ state[:n]), 1.0
        return inverse, memory


def prepare_task(
    model: Operator,
    y_ref: ArrayLike,
    input_range: tuple[float, float] | None,
    clip: bool,
    history: ArrayLike | None,
) -> RateDependentTask:
    """Find the plays of a model and pass the reference back to them.

    Parameters
    ----------
    model, y_ref, input_range, history
        As in ``invert_trajectory``.
    clip
        Whether a reference out of reach is allowed.

    Returns
    -------
    RateDependentTask

    Raises
    ------
    InputError
        If the model has no rate-dependent plays, more than one bank of them, or other stages with
        memory; or if the reference is out of reach within the range of the input.
    NotInvertibleError
        If a map before or after the plays cannot be inverted, or p0 is not positive.
    """
    before, plays, after = stages_around_plays(model)
    reference = finite_vector(y_ref, "y_ref")
    target = reference if after is None else after.inverse()(reference)
    start = (
        model.initial_state()
        if history is None
        else model.run(finite_vector(history, "history"))[1]
    )
    low, high = -np.inf, np.inf
    if input_range is not None:
        ends = np.array(range_of_input(input_range))
        low, high = np.sort(ends if before is None else before(ends)).tolist()
        if not clip:
            _require_reach(plays, target, low, high)
    return RateDependentTask(model, plays, before, start, reference, target, low, high, clip)


def stages_around_plays(
    model: Operator,
) -> tuple[Operator | None, RateDependentPrandtlIshlinskii, Operator | None]:
    """Split a model at its one bank of rate-dependent plays.

    Parameters
    ----------
    model
        Any operator.

    Returns
    -------
    before, plays, after
        The maps before and after the plays are None where there are none.

    Raises
    ------
    InputError
        If there is not exactly one bank, or another stage has memory.
    NotInvertibleError
        If p0 is not positive.
    """
    leaves = leaves_of(model)
    banks = [i for i, each in enumerate(leaves) if isinstance(each, RateDependentPrandtlIshlinskii)]
    others = [each for i, each in enumerate(leaves) if i not in banks]
    if len(banks) != 1 or not all(each.traits().memoryless for each in others):
        raise InputError(
            f"the model is a {model.kind} with {len(banks)} banks of rate-dependent plays and "
            f"{sum(not each.traits().memoryless for each in others)} other stages with memory; "
            "this method is for one bank with maps before and after it, use method='exact' for "
            "rate-independent models"
        )
    plays = leaves[banks[0]]
    assert isinstance(plays, RateDependentPrandtlIshlinskii)
    if plays.p0 <= 0.0:
        raise NotInvertibleError(
            f"p0 is {plays.p0:.6g}: the output rests while the drive turns; identify or give p0 > 0"
        )
    before = Composition(leaves[: banks[0]]) if banks[0] else None
    after = Composition(leaves[banks[0] + 1 :]) if banks[0] + 1 < len(leaves) else None
    return before, plays, after


def _require_reach(
    plays: RateDependentPrandtlIshlinskii, target: Array, low: float, high: float
) -> None:
    """Refuse a target beyond what a drive at rest at the ends of its range gives."""
    rest = plays.at_rest()
    ends = [rest(path)[-1] for path in ([low], [high], [low, high], [high, low])]
    slack = 1e-9 * (max(ends) - min(ends))
    outside = (target < min(ends) - slack) | (target > max(ends) + slack)
    if outside.any():
        k = int(np.argmax(outside))
        raise InputError(
            f"y_ref[{k}] asks the plays for {target[k]:.6g}, but within the range of the input "
            f"they reach {min(ends):.6g} to {max(ends):.6g} only; keep the reference within, or "
            "choose to clip it"
        )
