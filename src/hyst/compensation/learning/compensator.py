"""Learning a command from repetitions of one motion."""

from __future__ import annotations

import math
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.checks.numbers import as_not_negative, as_positive, as_sample_time
from hyst.compensation.exact import range_of_input
from hyst.compensation.learning.along_branches import along_branches
from hyst.compensation.learning.along_the_motion import AlongTheMotion, Made, suited_method
from hyst.compensation.learning.contraction import Contraction, given_slopes
from hyst.compensation.learning.learnt import Learnt
from hyst.compensation.learning.linear_fit import Pair
from hyst.compensation.learning.measured_output import (
    Measured,
    as_measured,
    refuse_at_rest,
    shift_between,
    stuck_samples,
)
from hyst.compensation.learning.measured_slopes import measured_slopes
from hyst.compensation.learning.mixing import mixed
from hyst.compensation.learning.noise_floor import noise_between, noise_in
from hyst.compensation.learning.repetition import Repetition
from hyst.compensation.learning.trial import Trial
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.verdict import refuse_if_unfit
from hyst.signals import Record

Array = NDArray[np.float64]

LEARNING, AT_THE_NOISE, SETTLED, DIVERGED = "learning", "at the noise", "settled", "diverged"

_AT_THE_NOISE = 1.1
_NOTHING_LEFT = 0.02
_MOST_STRIKES, _BETTER, _HALVED = 4, 0.98, 0.5
_LATEST = 0.125
_MIXED, _FAR = 2, 20.0
_BRANCHES = 10.0


@final
class LearningCompensator:
    """Iterative learning through a model's inverse, for a reference that is repeated.

        v[0] = y_ref,   u[k] = M^-1(v[k]),   v[k+1] = M(u[k]) + Q G^-1 (y_ref - y[k])

    M is the model, u[k] what was applied, y[k] what was measured, G the linear part of the plant
    behind the model's inverse (delay, modes, gain), which is learnt from the repetitions, and Q a
    filter without phase that passes what repeats. As M(u[k]) is of what was applied, nothing is
    added up at a limit. After the first, each repetition corrects what the model misses, whatever
    its turning points, if the slopes of the plant behind the model's inverse allow it
    (``contraction``).

    Parameters
    ----------
    model
        An operator with an inverse by some method of ``invert_trajectory``.
    y_ref
        Wanted output, shape (N,), output units.
    input_range
        Lowest and highest input; commands are held within.
    dt
        Sample time, s; the model's own if left out. Needed for ``rate_limit``.
    rate_limit
        Largest rate of the input, input units per second.
    periodic
        False: every repetition begins from rest, with the same ``history``. True: in the state that
        the one before has left.
    noise
        Rms of what does not repeat in a measured output; estimated if left out.
    history
        Inputs that the actuator passes before a repetition, shape (M,); before the first one only
        if ``periodic``.
    slopes
        Least and largest slope of the plant behind the model's inverse, if they are known.
    despite_verdict
        Make commands also of a model whose verdict is ``unfit``.

    Raises
    ------
    InputError
        If an argument cannot be used.
    NotInvertibleError
        If there is no way from an output to a command.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    >>> plant = PrandtlIshlinskii([0.6], [1.1], p0=0.9)
    >>> y_ref = 3.0 - 3.0 * np.cos(np.linspace(0.0, 4.0 * np.pi, 400))
    >>> learning = LearningCompensator(model, y_ref)
    >>> for _ in range(4):
    ...     command = learning.update(plant(learning.command))
    >>> errors = [each.error_rms for each in learning.history]
    >>> errors[3] < 0.01 * errors[0]
    True
    """

    def __init__(
        self,
        model: Operator,
        y_ref: ArrayLike,
        input_range: tuple[float, float] | None = None,
        *,
        dt: float | None = None,
        rate_limit: float | None = None,
        periodic: bool = False,
        noise: float | None = None,
        history: ArrayLike | None = None,
        slopes: tuple[float, float] | None = None,
        despite_verdict: bool = False,
    ) -> None:
        if not isinstance(model, Operator):
            raise InputError(f"model is {type(model).__name__}; give an operator")
        refuse_if_unfit(model.description.verdict, "no command is made", despite_verdict)
        own = model.dt if dt is None else as_sample_time(dt)
        if own is not None:
            model = model.at_sample_time(own)
        self._dt = own
        limits = None if input_range is None else range_of_input(input_range)
        rate = None if rate_limit is None else as_positive(rate_limit, "rate_limit")
        if rate is not None and own is None:
            raise InputError("a rate limit needs the sample time; give dt")
        step = math.inf if rate is None or own is None else rate * own
        self._along = AlongTheMotion(model, suited_method(model), limits, step, rate)
        self._periodic = bool(periodic)
        self._given_noise = None if noise is None else as_not_negative(noise, "noise")
        self._before = None if history is None else finite_vector(history, "history")
        self._given = None if slopes is None else given_slopes(slopes)
        self._learnt = Learnt()
        self._begin(finite_vector(y_ref, "y_ref"))

    @property
    def model(self) -> Operator:
        """The model whose inverse is used."""
        return self._along.model

    @property
    def y_ref(self) -> Array:
        """Wanted output, shape (N,)."""
        return self._y_ref

    @property
    def dt(self) -> float | None:
        """Sample time, s, if known."""
        return self._dt

    @property
    def command(self) -> Array:
        """The command of the next repetition, shape (N,), input units."""
        return self._command

    @property
    def history(self) -> tuple[Repetition, ...]:
        """All repetitions of this reference that were measured."""
        return tuple(self._history)

    @property
    def best(self) -> Repetition | None:
        """The repetition of the least error since the plant last changed; None before the first."""
        return None if self._best is None else self._history[self._best.number - 1]

    @property
    def state(self) -> str:
        """``"learning"``, ``"at the noise"``, ``"settled"`` or ``"diverged"``."""
        return self._state

    @property
    def noise(self) -> float | None:
        """Rms of what does not repeat, output units; None if not known yet."""
        return self._noise

    @property
    def contraction(self) -> Contraction:
        """Whether an error shrinks from repetition to repetition, and by how much."""
        return self._contraction

    @property
    def status(self) -> str:
        """How learning stands, in one sentence."""
        if not self._history or self._best is None:
            held = f"; {self._held} samples are held at a limit" if self._held else ""
            return f"nothing measured yet: the command is the model's inverse{held}"
        last, best = self._history[-1], self._history[self._best.number - 1]
        told = (
            f"{self._state} after {len(self._history)} repetitions: error {last.error_rms:.4g} rms"
        )
        told += f", at first {self._history[0].error_rms:.4g}, noise {last.noise:.3g}"
        if best is not last:
            told += f", best {best.error_rms:.4g} in repetition {best.number}"
        if self._state == DIVERGED:
            told += "; the best command is kept, look at model and plant and reset"
        return told + (f"; {self._held} samples are held at a limit" if self._held else "")

    def reset(self, y_ref: ArrayLike | None = None, *, forget: bool = False) -> Array:
        """Begin with another reference, or anew; what is known of the plant is kept.

        Parameters
        ----------
        y_ref
            Wanted output, shape (N,); the present one if left out.
        forget
            Whether the linear part of the plant is forgotten, too, as after a repair.

        Returns
        -------
        numpy.ndarray
            The first command.
        """
        wanted = self._y_ref if y_ref is None else finite_vector(y_ref, "y_ref")
        self._learnt = Learnt() if forget else self._learnt.without_pairs()
        self._begin(wanted)
        return self._command

    def update(self, y_measured: ArrayLike | Record, u_applied: ArrayLike | None = None) -> Array:
        """Learn from a repetition of ``command``.

        Parameters
        ----------
        y_measured
            Output, shape (N,), or a ``Record`` whose input is what was applied.
        u_applied
            Input that was applied, shape (N,), where it was not the command.

        Returns
        -------
        numpy.ndarray
            The next command, shape (N,).

        Raises
        ------
        InputError
            If lengths or sample times differ, a sample is not finite, the output does not move, or
            it is shifted against what was to be expected; nothing is learnt then.
        """
        measured = as_measured(y_measured, u_applied, self._command, self._dt)
        v = self._along.output(measured.u, self._past)
        noise = self._noise_of(measured)
        refuse_at_rest(measured.y, self._y_ref, measured.u, noise)
        expected = self._expected(v)
        late, notes = self._lateness(measured.y, expected, noise)
        trial, told = self._trial(measured, v, expected)
        notes += told
        self._noise = noise
        self._next(trial, measured, late, notes)
        return self._command

    def _begin(self, y_ref: Array) -> None:
        """Start with a reference."""
        self._y_ref = y_ref
        self._history: list[Repetition] = []
        self._best: Trial | None = None
        self._last: Trial | None = None
        self._trials: list[Trial] = []
        self._state, self._strikes, self._gain = LEARNING, 0, 1.0
        self._unlike = False
        self._noise = self._given_noise
        self._contraction = self._given or Contraction(math.nan, math.nan, 1.0, "unknown")
        self._past = self._before
        v = self._learnt.before_it(y_ref, self._periodic)
        self._set(self._along.command(v, self._past))

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
            known = self._noise or between
            if between < 3.0 * known:
                return max(0.5 * (known + between), noise_in(self._y_ref - measured.y))
        found = noise_in(self._y_ref - measured.y)
        return found if self._noise is None else min(max(found, 0.5 * self._noise), self._noise * 2)

    def _expected(self, v: Array) -> Array:
        """Give what the last repetition, or the model, leads to expect."""
        near = self._best
        if near is None:
            return self._learnt.output(v, self._periodic)
        return near.y + self._learnt.output(v - near.v, self._periodic)

    def _lateness(self, y: Array, expected: Array, noise: float) -> tuple[int, list[str]]:
        """Give the delay to learn, or refuse a shift.

        Raises
        ------
        InputError
            If the record is shifted.
        """
        late = shift_between(expected, y, y.size // 4, noise)
        if late == 0:
            return self._learnt.linear.delay, []
        samples = f"{abs(late)} sample{'s' if abs(late) > 1 else ''}"
        if not self._history and 0 < late <= _LATEST * y.size:
            return self._learnt.linear.delay + late, []
        way = "late" if late > 0 else "early"
        raise InputError(
            f"the measured output is {way} by {samples} against what was to be expected, so that "
            "nothing was learnt; start recording with the first sample of the command, or, if the "
            "plant itself has become so, begin anew with reset(forget=True)"
        )

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
        delays = {0} if late == own == 0 else {late - 1, late, late + 1, own}
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
        if base.rms <= _AT_THE_NOISE * noise:
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
        self._set(self._along.command(v + self._along_branches(step.dv, base, noise), self._past))
        if self._held:
            notes.append(f"{self._held} samples of the next command are held at a limit")
        return gain

    def _along_branches(self, dv: Array, base: Trial, noise: float) -> Array:
        if base.rms < _BRANCHES * noise or self._learnt.linear.order:
            return dv
        expected = self._learnt.output(base.v, self._periodic)
        return along_branches(dv, base.v, expected, base.y, noise)

    def _hold(self, why: str, notes: list[str]) -> None:
        """Keep the best command."""
        assert self._best is not None
        self._command = self._best.u
        if why:
            notes.append(why)
