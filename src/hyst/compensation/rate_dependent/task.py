"""What all inversions of a rate-dependent model start from: its plays, their state, their target.

A model may have other stages before and after its plays: maps without memory, and a lag, a delay or
creep. The wanted output is taken back through those after, the drive found for the plays is taken
back through those before, by their exact inverses with the memory that belongs to the history.
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
    plays_state
        That of the plays.
    before_state
        That of the inverse of what stands before the plays; empty if nothing does.
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
    plays_state: Array
    before_state: Array
    y_ref: Array
    target: Array
    low: float
    high: float
    clip: bool

    def state(self) -> Array:
        """Give the state of the plays before the first sample, a fresh array."""
        return self.plays_state.copy()

    def chain(self) -> _engine.Chain:
        """Give the plays as the engine's chain of one stage."""
        return _engine.Chain(self.plays.stages())

    def input_of(self, drive: Array) -> Array:
        """Give the model's input for a drive of the plays."""
        if self.before is None:
            return drive
        return self.before.inverse().run(drive, self.before_state)[0]

    def input_range(self) -> tuple[float, float]:
        """Give the range of the model's input that the range of the drive was made of."""
        low, high = _resting(self.before, np.array([self.low, self.high]), back=True).tolist()
        return min(low, high), max(low, high)

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
        If the model has no rate-dependent plays, more than one bank of them, or other stages that
        cannot be taken back; or if the reference is out of reach within the range of the input.
    NotInvertibleError
        If a stage before or after the plays has no exact inverse, or p0 is not positive.
    """
    before, plays, after = stages_around_plays(model)
    reference = finite_vector(y_ref, "y_ref")
    past = None if history is None else finite_vector(history, "history")
    start = model.initial_state() if past is None else model.run(past)[1]
    before_state, past = _memory_of_inverse(before, past)
    plays_state = plays.initial_state()
    if past is not None:
        past, plays_state = plays.run(past, plays_state)
    target = reference
    if after is not None:
        target = after.inverse().run(reference, _memory_of_inverse(after, past)[0])[0]
    low, high = -np.inf, np.inf
    if input_range is not None:
        ends = np.array(range_of_input(input_range))
        low, high = np.sort(_resting(before, ends, back=False)).tolist()
        if not clip:
            _require_reach(plays, target, low, high)
    return RateDependentTask(
        model, plays, before, start, plays_state, before_state, reference, target, low, high, clip
    )


def _memory_of_inverse(stages: Operator | None, past: Array | None) -> tuple[Array, Array | None]:
    """Memory of the inverse of some stages after a past of their input, and their output then."""
    if stages is None:
        return np.empty(0), past
    inverse = stages.inverse()
    if past is None:
        return inverse.initial_state(), None
    output, _ = stages.run(past)
    return inverse.run(output)[1], output


def _resting(stages: Operator | None, values: Array, back: bool) -> Array:
    """Take values at rest through the maps of some stages, or back; lags and delays leave them."""
    maps = [] if stages is None else [each for each in leaves_of(stages) if _is_map(each)]
    if not maps or not np.isfinite(values).all():
        return values
    return Composition(maps).inverse()(values) if back else Composition(maps)(values)


def _is_map(stage: Operator) -> bool:
    return stage.traits().memoryless


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
        What stands before and after the plays is None where nothing does.

    Raises
    ------
    InputError
        If there is not exactly one bank, or another stage is neither a map nor a lag, a delay or
        creep.
    NotInvertibleError
        If p0 is not positive.
    """
    leaves = leaves_of(model)
    banks = [i for i, each in enumerate(leaves) if isinstance(each, RateDependentPrandtlIshlinskii)]
    others = [each for i, each in enumerate(leaves) if i not in banks]
    # A linear memory that keeps the unit of its signal: what it does to a signal is undone exactly.
    strange = [each.kind for each in others if not (_is_map(each) or each.keeps_unit())]
    if len(banks) != 1 or strange:
        named = f" ({', '.join(strange)})" if strange else ""
        raise InputError(
            f"the model is a {model.kind} with {len(banks)} banks of rate-dependent plays and "
            f"{len(strange)} other stages with memory{named}; this method is for one bank with "
            "maps, a lag, a delay or creep before and after it, use method='exact' for "
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
