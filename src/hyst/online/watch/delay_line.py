"""The model's delay: input and output side by side, sample by sample."""

from __future__ import annotations

import math

import numpy as np

from hyst.online.watch.sample_clock import SLOT, Slots

_MARKS = ("lost", "repeated", "unreadable", "backwards", "gap")


class DelayLine:
    """Set the input that the output of a sample answers beside it.

    Outputs that answer inputs from before the first sample, or before a gap of unknown length, are
    left out. Part of a sample is interpolated: a cubic through the four samples around, kept
    between the two next to it; a turn stays what it is, at the sample next to it.

    Parameters
    ----------
    delay
        Samples; negative where the output is ahead.

    Examples
    --------
    >>> slots = np.zeros(4, dtype=SLOT)
    >>> slots["u"], slots["y"] = [0.0, 1.0, 2.0, 3.0], [9.0, 0.0, 10.0, 20.0]
    >>> late = DelayLine(1).take(slots)
    >>> late["u"].tolist(), late["y"].tolist()
    ([0.0, 1.0, 2.0], [0.0, 10.0, 20.0])
    """

    def __init__(self, delay: float) -> None:
        whole = math.floor(delay)
        self._part = delay - whole
        # The newest input that a sample needs comes so much later than the sample itself.
        self._ahead = -whole + (1 if self._part else 0)
        self._past = max(whole, 0) + 4
        self._unanswered = max(whole + (1 if self._part else 0), 0)
        self._before_gap = max(-whole, 0)
        self._left_out = self._unanswered
        self._marks = np.zeros((), dtype=SLOT)
        self._has_marks = False
        self._waiting = np.zeros(0, dtype=SLOT)
        self._inputs = np.full(self._past, math.nan)

    def take(self, slots: Slots) -> Slots:
        """Give the samples whose inputs are known now."""
        if self._ahead == 0 and self._part == 0.0:
            return slots
        waiting = np.concatenate([self._waiting, slots])
        inputs = np.concatenate([self._inputs, slots["u"]])
        ready = max(waiting.size - max(self._ahead, 0), 0)
        out = waiting[:ready].copy()
        # inputs[k + past] belongs to waiting[k].
        at = np.arange(ready) + self._past + self._ahead
        out["u"] = inputs[at] if self._part == 0.0 else _later(inputs, at - 1, self._part)
        out = self._without_unanswered(out, waiting["gap"])
        self._waiting = waiting[ready:]
        self._inputs = inputs[ready:]
        return out

    def _without_unanswered(self, out: Slots, gaps: np.ndarray) -> Slots:
        """Leave out samples whose input lies on the other side of a gap, which moves on."""
        if not (self._left_out or self._has_marks or gaps.any()):
            return out
        kept = np.ones(out.size, dtype=np.bool_)
        for k in range(out.size):
            if out["gap"][k]:
                self._left_out = self._unanswered
            answers_beyond = gaps[k + 1 : k + 1 + self._before_gap].any()
            if self._left_out or answers_beyond:
                self._left_out = max(self._left_out - 1, 0)
                kept[k] = False
                self._keep_marks(out[k])
            elif self._has_marks:
                for name in _MARKS:
                    out[name][k] += self._marks[name]
                self._marks, self._has_marks = np.zeros((), dtype=SLOT), False
        return out[kept]

    def _keep_marks(self, slot: np.void) -> None:
        """Let what is told of a sample that is left out be told of the next one."""
        for name in _MARKS:
            self._marks[name] += slot[name]
            self._has_marks |= bool(slot[name])


def _later(u: np.ndarray, at: np.ndarray, part: float) -> np.ndarray:
    """Give ``u`` at ``at - part``."""
    before, left, right = u[at - 2], u[at - 1], u[at]
    after = u[np.minimum(at + 1, u.size - 1)]
    s = 1.0 - part
    before = np.where(np.isfinite(before), before, 2.0 * left - right)
    after = np.where(np.isfinite(after), after, 2.0 * right - left)
    moved = (
        -s * (s - 1.0) * (s - 2.0) / 6.0 * before
        + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * left
        - (s + 1.0) * s * (s - 2.0) / 2.0 * right
        + (s + 1.0) * s * (s - 1.0) / 6.0 * after
    )
    moved = np.clip(moved, np.minimum(left, right), np.maximum(left, right))
    if part < 0.5:
        is_turn = (right - left) * (after - right) < 0.0
        return np.asarray(np.where(is_turn, right, moved))
    is_turn = (left - before) * (right - left) < 0.0
    return np.asarray(np.where(is_turn, left, moved))
