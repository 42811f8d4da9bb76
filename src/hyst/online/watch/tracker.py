"""Model and estimator along the samples of a watch: what is learnt from, followed or left."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.online.estimator import Estimator
from hyst.online.watch.doubtful_memory import DoubtfulMemory
from hyst.online.watch.flat_output import FlatOutput
from hyst.online.watch.sample_clock import Slots
from hyst.operators import Operator
from hyst.signals import Record

Array = NDArray[np.float64]

# Memories are compared after so many samples.
_PIECE = 64
_LARGEST = 1e20
# So many ranges outside is no measurement of this actuator.
_FAR = 30.0
_OF_THE_ERROR = 0.3
_STANDS_STILL = 0.05


@dataclass(eq=False)
class Followed:
    """What a window gave.

    Parameters
    ----------
    u, y
        Shape (N,), NaN where there is no measurement.
    model_error, estimate_error
        Shape (N,), measured less predicted output of the model and of the estimate before it
        learnt from the sample; NaN where it is not known.
    stuck, saturated
        As of ``Flat``, the worst.
    level
        Where the output stands still.
    refused
        Samples that led to an overflow.
    far
        Outputs that are finite numbers but no measurements.
    """

    u: Array
    y: Array
    model_error: Array
    estimate_error: Array
    stuck: float = 0.0
    saturated: float = 0.0
    level: float = math.nan
    refused: int = 0
    far: int = 0


class Tracker:
    """Pass samples on to a model that stays as it is and to an estimator.

    Where the input is unknown, so is the memory after it: both then follow the input, and nothing
    is learnt or judged until a turn has wiped out what the gap may have left.

    Parameters
    ----------
    estimator
        It learns.
    model
        It does not.
    knows_memory
        Whether both stand as the actuator does before the first sample.
    stated_error
        Root mean square that the model states of itself, output units; 0 if it states none.
    """

    def __init__(
        self, estimator: Estimator, model: Operator, knows_memory: bool, stated_error: float
    ) -> None:
        self.estimator, self.model = estimator, model
        about = model.description
        self.stated_error = stated_error
        self.input_range = _range(about.input_low, about.input_high)
        """Values the input is known to take, input units; NaN where nothing is known yet."""
        self.output_range = _range(about.output_low, about.output_high)
        self.is_learning_allowed = True
        """Whether samples may be learnt from, as far as others can tell."""
        self.used = 0
        """Samples that were learnt from."""
        self._input_limits = _far(about.input_low, about.input_high)
        self._output_limits = _far(about.output_low, about.output_high)
        self._state = model.initial_state()
        self._flat = FlatOutput()
        self._doubt: DoubtfulMemory | None = None
        self._last = math.nan
        self._fastest, self._sharpest = 0.0, 0.0
        self._missing, self._is_unknown_gap = 0, not knows_memory

    @property
    def is_memory_known(self) -> bool:
        """Whether the memory is that of the actuator."""
        return self._doubt is None and not (self._missing or self._is_unknown_gap)

    def take(self, slots: Slots) -> Followed:
        """Take in a window of samples."""
        u = _within(slots["u"], self._input_limits)
        y = _within(slots["y"], self._output_limits)
        unknown = np.full(u.size, np.nan)
        found = Followed(u, y, unknown.copy(), unknown.copy())
        found.far = int((np.isfinite(slots["u"]) & np.isfinite(slots["y"]) & ~np.isfinite(y)).sum())
        refused = self.estimator.counts["refused"]
        known = np.isfinite(u)
        cuts = np.flatnonzero((known[1:] != known[:-1]) | slots["gap"][1:]) + 1
        for first, last in pairwise([0, *cuts.tolist(), u.size]):
            if first == last:
                continue
            self._is_unknown_gap |= bool(slots["gap"][first])
            if known[first]:
                self._pass(found, first, last)
            else:
                self._missing += int(np.maximum(slots["lost"][first:last], 1).sum())
        found.refused += self.estimator.counts["refused"] - refused
        return found

    def _pass(self, found: Followed, first: int, last: int) -> None:
        """Pass samples whose inputs are known, one after the other."""
        u, y = found.u[first:last], found.y[first:last]
        try:
            if self._missing or self._is_unknown_gap:
                self._cross_gap(float(u[0]))
            predicted, self._state = self.model.run(u, self._state)
            self._note(u, predicted)
            self._leave_flat(found, y, predicted)
            known = self._clear_doubt(u)
        except InputError:  # an overflow, after which no memory means anything
            found.refused += u.size
            self._doubt, self._is_unknown_gap = None, True
            return
        if known < u.size:
            rest = slice(first + known, last)
            found.model_error[rest] = y[known:] - predicted[known:]
            found.estimate_error[rest] = self._learn(u[known:], y[known:])

    def _leave_flat(self, found: Followed, y: Array, predicted: Array) -> None:
        """Take out what stands still while the model moves; changes ``y``."""
        span = float(np.ptp(self.output_range))
        flat = self._flat.look(y, predicted, max(6.0 * self.stated_error, _STANDS_STILL * span))
        y[flat.mask] = np.nan
        found.stuck = max(found.stuck, flat.stuck)
        found.saturated = max(found.saturated, flat.saturated)
        found.level = flat.level if math.isfinite(flat.level) else found.level

    def _note(self, u: Array, predicted: Array) -> None:
        self._last = float(u[-1])
        self._fastest = max(self._fastest, float(np.abs(np.diff(u)).max(initial=0.0)))
        self._sharpest = max(self._sharpest, float(np.abs(np.diff(u, 2)).max(initial=0.0)))
        for name, signal in (("input_range", u), ("output_range", predicted)):
            low, high = getattr(self, name)
            low, high = np.fmin(low, signal.min()), np.fmax(high, signal.max())
            setattr(self, name, (float(low), float(high)))

    def _cross_gap(self, after: float) -> None:
        """Say what the gap before a sample leaves unknown."""
        low, high = self.input_range
        missing, self._missing = self._missing, 0
        is_unknown, self._is_unknown_gap = self._is_unknown_gap, False
        if math.isnan(low) or low == high:
            return  # nobody knows how far the input goes, so nothing can be said
        before = None if is_unknown or self._fastest == 0.0 else self._last
        if before is not None:
            beyond = self._farthest(missing + 1, abs(after - before))
            low = max(low, min(after, before) - beyond)
            high = min(high, max(after, before) + beyond)
        if before is not None and self._doubt is not None:
            self._doubt.cross_gap(before, after, low, high, missing)
        else:
            own = self.estimator
            models = ((self.model, self._state), (own.model, own.memory))
            self._doubt = DoubtfulMemory(models, before, after, low, high, missing)
        if before is not None:
            way = np.linspace(before, after, missing + 2)[1:-1]
            self._state = self.model.run(way, self._state)[1]
            self.estimator.follow(way)

    def _farthest(self, steps: int, way: float) -> float:
        """Bound how far the input went beyond the ends of a gap.

        It moved no faster than it ever did, and did not turn more sharply: a parabola over
        ``steps`` of the sharpest bend leaves its chord by an eighth of that times their square.
        """
        by_speed = max(steps * self._fastest - way, 0.0) / 2.0
        return min(by_speed, self._sharpest * steps**2 / 8.0)

    def _clear_doubt(self, u: Array) -> int:
        """Let doubtful memories pass inputs until they are known; give how many that took."""
        passed = 0
        while self._doubt is not None and passed < u.size:
            # A gap in which nothing can have happened costs one sample.
            piece = u[passed : passed + (_PIECE if passed else 1)]
            passed += piece.size
            self._doubt.follow(piece)
            self.estimator.follow(piece)
            error = _OF_THE_ERROR * self.stated_error
            if self._doubt.is_wiped_out(float(piece[-1]), *self.input_range, error):
                self._doubt = None
        return passed

    def _learn(self, u: Array, y: Array) -> Array:
        """Learn where the output is known; give the errors before that."""
        errors = np.full(u.size, np.nan)
        known = np.isfinite(y) & self.is_learning_allowed
        cuts = np.flatnonzero(known[1:] != known[:-1]) + 1
        for first, last in pairwise([0, *cuts.tolist(), u.size]):
            if not known[first]:
                self.estimator.follow(u[first:last])
                continue
            record = Record(u[first:last], y[first:last], self.estimator.dt)
            errors[first:last] = self.estimator.run(record, last - first).error
            self.used += last - first
        return errors


def _range(low: float | None, high: float | None) -> tuple[float, float]:
    return (math.nan if low is None else low, math.nan if high is None else high)


def _far(low: float | None, high: float | None) -> tuple[float, float]:
    """Give the values beyond which a number is no measurement."""
    if low is None or high is None or low == high:
        return (-_LARGEST, _LARGEST)
    way = _FAR * (high - low)
    return (max(low - way, -_LARGEST), min(high + way, _LARGEST))


def _within(signal: Array, limits: tuple[float, float]) -> Array:
    is_usable = (signal > limits[0]) & (signal < limits[1])
    return np.where(is_usable, signal, np.nan)
