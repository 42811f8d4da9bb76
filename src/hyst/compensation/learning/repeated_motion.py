"""What learning keeps of a repeated motion, and how it decides on the next command."""

from __future__ import annotations

import math
from abc import ABC
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import finite_vector
from hyst.compensation.learning.along_branches import along_branches
from hyst.compensation.learning.along_the_motion import AlongTheMotion, Made
from hyst.compensation.learning.contraction import Contraction
from hyst.compensation.learning.learnt import Learnt
from hyst.compensation.learning.linear_fit import Pair
from hyst.compensation.learning.measured_output import Measured, stuck_samples
from hyst.compensation.learning.measured_slopes import measured_slopes
from hyst.compensation.learning.mixing import mixed
from hyst.compensation.learning.noise_floor import noise_between, noise_in
from hyst.compensation.learning.repetition import Repetition
from hyst.compensation.learning.states import AT_THE_NOISE, DIVERGED, LEARNING, SETTLED
from hyst.compensation.learning.trial import Trial

Array = NDArray[np.float64]

_AT_THE_NOISE, _NEAR, _PATIENCE = 1.1, 1.6, 2
_NOTHING_LEFT, _LEAST_SHARE, _NO_WORSE = 0.02, 0.05, 0.5
_MOST_STRIKES, _BETTER, _HALVED = 4, 0.98, 0.5
_MIXED, _FAR = 2, 20.0
_EARLIER = (0, 1, 2, 4, 8)
_BRANCHES, _FORESEEN = 10.0, 0.05
SAVED_AS_THEY_ARE = ("noise", "repeated", "held", "state", "strikes", "gain", "unlike")


class RepeatedMotion(ABC):
    """The state of learning, and its rules; ``LearningCompensator`` is what users see of it."""

    _along: AlongTheMotion
    _dt: float | None
    _periodic: bool
    _given_noise: float | None
    _before: Array | None
    _given: Contraction | None
    _learnt: Learnt
    _y_ref: Array
    _history: list[Repetition]
    _trials: list[Trial]
    _best: Trial | None
    _last: Trial | None
    _noise: float | None
    _repeated: float | None

    def _begin(self, y_ref: Array) -> None:
        """Start with a reference."""
        self._y_ref = y_ref
        self._history = []
        self._best = None
        self._last = None
        self._trials = []
        self._state, self._strikes, self._gain = LEARNING, 0, 1.0
        self._unlike = False
        self._noise, self._repeated = self._given_noise, None
        self._contraction = self._given or Contraction(math.nan, math.nan, 1.0, "unknown")
        self._past = self._before
        self._set(self._along.command(y_ref, self._past))

    def _set(self, made: Made) -> None:
        self._command, self._held = made.u, made.held
        self._command.flags.writeable = False

    def _noise_of(self, measured: Measured) -> float:
        """Estimate what does not repeat: as given, from a repeated command, or from a spectrum."""
        if self._given_noise is not None:
            return self._given_noise
        last = self._last
        if last is not None and np.array_equal(last.u, measured.u):
            between = noise_between(last.y, measured.y)
            if between < 3.0 * (self._noise or between):
                before = between if self._repeated is None else self._repeated
                self._repeated = 0.5 * (before + between)
        if self._repeated is not None:  # what a spectrum shows may be an error that repeats
            return self._repeated
        found = noise_in(self._y_ref - measured.y)
        return found if self._noise is None else min(max(found, 0.5 * self._noise), self._noise * 2)

    def _expected(self, v: Array) -> Array:
        """Give what the last repetition, or the model, leads to expect."""
        near = self._best
        if near is None:
            return self._learnt.output(v, self._periodic)
        return near.y + self._learnt.output(v - near.v, self._periodic)

    def _trial(self, measured: Measured, v: Array, expected: Array) -> tuple[Trial, list[str]]:
        error = self._y_ref - measured.y
        notes = list[str]()
        self._stuck = stuck_samples(measured.y, expected)
        if self._stuck.any():
            notes.append(
                f"the sensor stands at an end of its range at {int(self._stuck.sum())} samples; "
                "nothing is learnt there"
            )
        if measured.is_told and not np.array_equal(measured.u, self._command):
            off = float(np.abs(measured.u - self._command).max())
            notes.append(
                f"the applied input is off the command by up to {off:.4g}; learnt is from what was "
                "applied"
            )
        return Trial(len(self._history) + 1, measured.u, v, measured.y, error), notes

    def _next(self, trial: Trial, measured: Measured, late: int, notes: list[str]) -> None:
        """Decide what the next command is made from, and make it."""
        noise = self._noise or 0.0
        how, expected = "better", self._expected(trial.v)
        if self._best is not None:
            how = trial.against(self._best, expected, noise)
        if how == "unlike" and self._unlike and trial.rms < self._history[0].error_rms:
            how = "changed"
        self._unlike = how == "unlike"
        if how == "changed":
            notes.append(self._take_change(trial, expected))
        elif how in ("worse", "unlike"):
            notes.append(self._step_back(how))
        elif self._best is None or trial.rms < _BETTER * self._best.rms:
            self._gain = min(1.0, 1.5 * self._gain)
            self._strikes = 0
        if not self._stuck.any() and how != "unlike":
            self._teach(trial, late, noise, how)
        if how in ("better", "changed"):
            self._best = trial
        base = self._best if how in ("worse", "unlike") else trial
        self._contract(trial, noise)
        if self._periodic:
            self._past = measured.u
        gain = self._command_from(base or trial, noise, notes)
        self._last = trial
        self._trials = (
            [*self._trials, trial][-1 - _MIXED :] if not self._stuck.any() else self._trials
        )
        self._history.append(
            Repetition(
                trial.number,
                trial.u,
                trial.y,
                trial.rms,
                trial.largest,
                noise,
                gain,
                "; ".join(notes),
            )
        )

    def _take_change(self, trial: Trial, expected: Array) -> str:
        """Take it that the plant has changed: what was best is no more."""
        gain = min(max(trial.gain_over(expected)[0], 0.5), 2.0)
        self._learnt = self._learnt.rescaled(gain)
        self._best, self._strikes, self._gain, self._state = None, 0, 1.0, LEARNING
        self._trials = []
        return f"the plant has changed, its gain by {100.0 * (gain - 1.0):+.3g} %; learning goes on"

    def _step_back(self, how: str) -> str:
        """Go back to the best command; give up after some times."""
        assert self._best is not None
        self._strikes += 1
        if self._strikes >= _MOST_STRIKES:
            halved = self._best.rms < _HALVED * self._history[0].error_rms
            self._state = SETTLED if halved and how == "worse" else DIVERGED
        if how == "unlike":
            return (
                f"unlike anything that the command explains; the one of repetition "
                f"{self._best.number} is sent again"
            )
        self._gain *= 0.5
        return f"worse than repetition {self._best.number}; back to it with half of the gain"

    def _teach(self, trial: Trial, late: int, noise: float, how: str) -> None:
        """Let what is known take in a repetition, unless there is nothing but noise in it."""
        near = None if how == "changed" else self._last
        if near is not None and trial.rms < _AT_THE_NOISE * noise:
            return
        whole = Pair(trial.v, trial.y)
        changes = [] if near is None else [Pair(trial.v - near.v, trial.y - near.y)]
        own = self._learnt.linear.delay
        # What the model's hysteresis misses looks like a delay too, so that it is often less.
        delays = {0} if late == own == 0 else {own, late + 1, *(late - k for k in _EARLIER)}
        allowed = tuple(sorted(each for each in delays if each >= 0))
        self._learnt = self._learnt.taught(whole, changes, noise, allowed, self._strikes > 1)

    def _contract(self, trial: Trial, noise: float) -> None:
        if self._given is not None:
            return
        expected = self._learnt.output(trial.v, self._periodic)
        found = measured_slopes(expected, trial.y, noise)
        if found is not None:
            self._contraction = Contraction.with_best_gain(*found, "measured")

    def _command_from(self, base: Trial, noise: float, notes: list[str]) -> float:
        """Set the next command; the share of the correction that it makes."""
        if self._state == DIVERGED or self._strikes >= _MOST_STRIKES:
            self._hold("the best command is kept", notes)
            return 0.0
        if self._unlike:
            self._hold("", notes)
            return 0.0
        error = np.where(self._stuck, 0.0, base.error)
        if base.rms <= _AT_THE_NOISE * noise or self._has_stalled(base, noise):
            self._state = AT_THE_NOISE
            self._hold("", notes)
            return 0.0
        gain = self._gain * self._contraction.gain
        v = base.v
        far = base.rms > _FAR * noise
        if far and not self._stuck.any() and self._gain == 1.0:
            others = [(one.v, one.error) for one in self._trials if one is not base]
            v, error = mixed(v, error, others[-_MIXED:], noise)
        step = self._learnt.step(error, noise, gain, self._periodic)
        if step.share < _NOTHING_LEFT:
            self._state = SETTLED
            self._hold("nothing is left that could be learnt", notes)
            return 0.0
        self._state = LEARNING
        if self._contraction.gain < 1.0:
            notes.append(f"gain {self._contraction.gain:.3g}, as slopes ask for")
        dv = self._foreseen_share(step.dv, error) * step.dv
        self._set(self._along.command(v + self._along_branches(dv, base, noise), self._past))
        if self._held:
            notes.append(f"{self._held} samples of the next command are held at a limit")
        return gain

    def _foreseen_share(self, dv: Array, error: Array) -> float:
        """Give the share of a change to make: all, if that is foreseen to make the error less.

        Otherwise the share that leaves the least error. A change is made through less than is
        known, where that is doubted, and may be too large for what is.
        """
        dy = self._learnt.output(dv, self._periodic)
        way = float(dy @ dy)
        share = float(error @ dy) / way if way > 0.0 else 1.0
        return 1.0 if share > _NO_WORSE else max(share, _LEAST_SHARE)

    def _is_foreseen(self, v: Array) -> bool:
        """Tell whether a command is so near to a measured one that a shift can be told."""
        if self._best is None:
            return not self._history
        moved = float(np.sqrt(np.mean((v - self._best.v) ** 2)))
        return moved < _FORESEEN * float(np.std(v))

    def _has_stalled(self, base: Trial, noise: float) -> bool:
        """Tell whether near the noise nothing has become better for two repetitions."""
        assert self._best is not None
        waited = len(self._history) + 1 - self._best.number
        return waited >= _PATIENCE and base.rms < _NEAR * noise

    def _along_branches(self, dv: Array, base: Trial, noise: float) -> Array:
        if base.rms < _BRANCHES * noise or self._learnt.linear.order:
            return dv
        if self._contraction.low <= 0.0:  # of a lag or a mode: no branch goes the other way
            return dv
        expected = self._learnt.output(base.v, self._periodic)
        return along_branches(dv, base.v, expected, base.y, noise)

    def _hold(self, why: str, notes: list[str]) -> None:
        """Keep the best command."""
        assert self._best is not None
        self._command = self._best.u
        if why:
            notes.append(why)

    def _take(self, data: dict[str, Any]) -> None:
        """Take over what was saved."""

        def trial(name: str) -> Trial | None:
            return None if data[name] is None else Trial.from_dict(data[name])

        self._learnt = Learnt.from_dict(data["learnt"])
        self._history = [Repetition.from_dict(each) for each in data["history"]]
        self._trials = [Trial.from_dict(each) for each in data["trials"]]
        self._best, self._last = trial("best"), trial("last")
        self._past = None if data["past"] is None else np.array(data["past"], dtype=float)
        self._command = finite_vector(data["command"], "command")
        self._contraction = Contraction.from_dict(data["contraction"])
        for name in SAVED_AS_THEY_ARE:
            setattr(self, f"_{name}", data[name])
