"""The input for a wanted output, from the memory the estimate has."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.operators import Operator
from hyst.operators.composition import leaves_of
from hyst.operators.stepper import Stepper

Array = NDArray[np.float64]

_MOST_DOUBLINGS, _MOST_PASSES = 2100, 400


def refusal_of(model: Operator) -> str:
    """Say why a model gives no command, exact or by a causal inverse; nothing if it does."""
    for leaf in leaves_of(model):
        if leaf.is_invertible():
            continue
        try:
            leaf.causal_inverse(leaf.initial_state())
        except (InputError, NotInvertibleError) as error:
            return str(error)
    return ""


@final
class Commands:
    """Commands of one model from the memory it has.

    Stages with an exact inverse are solved for their present sample, from the memory they have:
    the output rises or falls with the input, so that there is one solution, found to rounding. The
    others have their causal inverse step beside them, which is not exact, and goes on with what was
    wanted as long as its commands are those that were applied. (Beginning anew with every sample
    from the memory of the stage, it would go to and fro between fast and slow.)

    Parameters
    ----------
    model
        Every stage has one of both.
    state
        Shape (n,), its memory.
    """

    def __init__(self, model: Operator, state: Array) -> None:
        self.is_exact = model.is_invertible()
        self._parts = (model,) if self.is_exact else leaves_of(model)
        self._steps = [part.stepper() for part in self._parts]
        sizes = [part.initial_state().size for part in self._parts]
        self._ends = np.concatenate([[0], np.cumsum(sizes)])
        self._backward: dict[int, Stepper] = {}
        self._pending: tuple[float, dict[int, Array]] | None = None
        if not self.is_exact:
            self._begin(state)

    def input_for(self, y_ref: float, state: Array, near: float) -> float:
        """Give the command.

        Parameters
        ----------
        y_ref
            Wanted output.
        state
            Shape (n,), memory of the model.
        near
            Where to begin to look, an input.
        """
        target, after = y_ref, {}
        for i in reversed(range(len(self._parts))):
            if i in self._backward:
                step = self._backward[i]
                kept = np.array(step.state)
                target = step(target)
                after[i] = np.array(step.state)
                step.state[:] = kept
            else:
                target = self._solved(i, target, self._own(i, state), near)
        self._pending = (target, after)
        return target

    def passed(self, u: float, state: Array) -> None:
        """Go on: this input was applied, and left the model with this memory."""
        if self.is_exact:
            return
        if self._pending is not None and self._pending[0] == u:
            for i, after in self._pending[1].items():
                self._backward[i].state[:] = after
        else:
            self._begin(state)
        self._pending = None

    def _begin(self, state: Array) -> None:
        for i, part in enumerate(self._parts):
            if not part.is_invertible():
                inverse, memory = part.causal_inverse(self._own(i, state))
                self._backward[i] = inverse.stepper(memory)

    def _own(self, i: int, state: Array) -> Array:
        return state[self._ends[i] : self._ends[i + 1]]

    def _solved(self, i: int, target: float, state: Array, near: float) -> float:
        step = self._steps[i]

        def miss(u: float) -> float:
            step.state[:] = state
            return step(u) - target

        return _root(miss, near)


def _root(miss: Callable[[float], float], near: float) -> float:
    """Give where a monotone function passes 0; NaN if it does not."""
    a = near if math.isfinite(near) else 0.0
    at = miss(a)
    if at == 0.0 or not math.isfinite(at):
        return a if at == 0.0 else math.nan
    size = max(abs(a), abs(at), 1e-300) * 2.0**-10
    ends = _bracket(miss, a, at, size)
    return math.nan if ends is None else _refined(miss, *ends)


def _bracket(
    miss: Callable[[float], float], a: float, at: float, size: float
) -> tuple[float, float, float, float] | None:
    """Go out on both sides in steps that double, until the sign changes."""
    left, left_at, right, right_at = a, at, a, at
    for _ in range(_MOST_DOUBLINGS):
        low, high = left - size, right + size
        if not (math.isfinite(low) and math.isfinite(high)):
            return None
        low_at, high_at = miss(low), miss(high)
        if math.isfinite(high_at) and high_at * at <= 0.0:
            return right, right_at, high, high_at
        if math.isfinite(low_at) and low_at * at <= 0.0:
            return left, left_at, low, low_at
        left, left_at, right, right_at = low, low_at, high, high_at
        size *= 2.0
    return None


def _refined(miss: Callable[[float], float], a: float, at: float, b: float, bt: float) -> float:
    """Close in by false position that halves a stale end (Illinois), and by halves where slow."""
    for k in range(_MOST_PASSES):
        if bt == 0.0:
            return b
        c = b - bt * (b - a) / (bt - at) if k % 3 < 2 and bt != at else 0.5 * (a + b)
        if not min(a, b) < c < max(a, b):
            c = 0.5 * (a + b)
        if c in (a, b):
            break
        ct = miss(c)
        if (ct > 0.0) == (bt > 0.0):
            at *= 0.5
        else:
            a, at = b, bt
        b, bt = c, ct
    return b
