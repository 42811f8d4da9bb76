"""An output that stands still while the model moves: a sensor that is stuck or at its end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FEWEST = 5


@dataclass(frozen=True, eq=False)
class Flat:
    """Where an output stands still.

    Parameters
    ----------
    mask
        Shape (N,): samples that tell nothing.
    stuck, saturated
        How far the model moves meanwhile, in units of what is allowed: within the range of the
        output and at its end; 0 where it does not stand still.
    level
        The value it stands at.
    """

    mask: NDArray[np.bool_]
    stuck: float
    saturated: float
    level: float


class FlatOutput:
    """Find values that repeat for five samples or more while the model predicts a way.

    Examples
    --------
    >>> y = np.array([0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.0])
    >>> predicted = np.array([0.0, 1.0, 2.0, 6.0, 10.0, 8.0, 4.0, 1.0])
    >>> found = FlatOutput().look(y, predicted, 0.5)
    >>> found.saturated, found.stuck, found.mask.tolist()
    (2.0, 0.0, [False, False, True, True, True, True, True, False])
    """

    def __init__(self) -> None:
        self._value = math.nan
        self._length = 0
        self._low, self._high = math.inf, -math.inf
        self._least, self._most = math.inf, -math.inf
        self._quantum = math.inf

    def look(self, y: Array, predicted: Array, allowed: float) -> Flat:
        """Look at the next samples.

        Parameters
        ----------
        y, predicted
            Shape (N,), measured and predicted output; NaN where unknown.
        allowed
            Way the model may go while the output stands still, at least 4 steps of its resolution.
        """
        mask = np.zeros(y.size, dtype=np.bool_)
        finite = np.flatnonzero(np.isfinite(y) & np.isfinite(predicted))
        if not finite.size:
            return Flat(mask, 0.0, 0.0, math.nan)
        values, model = y[finite], predicted[finite]
        self._note(values)
        allowed = max(allowed, 4.0 * self._quantum if math.isfinite(self._quantum) else 0.0)
        edges = np.concatenate([[0], np.flatnonzero(np.diff(values)) + 1, [values.size]])
        worst, level = {False: 0.0, True: 0.0}, math.nan
        for first, last in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
            if not (first == 0 or last == values.size or last - first >= _FEWEST):
                continue
            way = self._way(float(values[first]), model[first:last])
            if self._length >= _FEWEST and way > allowed:
                mask[finite[first:last]] = True
                is_end = not self._least < values[first] < self._most
                level = float(values[first])
                worst[is_end] = max(worst[is_end], way / allowed if allowed > 0.0 else math.inf)
        return Flat(mask, worst[False], worst[True], level)

    def _note(self, values: Array) -> None:
        steps = np.abs(np.diff(values))
        steps = steps[steps > 0.0]
        if steps.size:
            self._quantum = min(self._quantum, float(steps.min()))
        self._least = min(self._least, float(values.min()))
        self._most = max(self._most, float(values.max()))

    def _way(self, value: float, model: Array) -> float:
        """Give how far the model goes while the output has this value, also in windows before."""
        if value != self._value:
            self._value, self._length = value, 0
            self._low, self._high = math.inf, -math.inf
        self._length += model.size
        self._low = min(self._low, float(model.min()))
        self._high = max(self._high, float(model.max()))
        return self._high - self._low
