"""Polish of a drive: down to a minimum of what is asked of it, and out of the nearest minima.

Nothing is smoothed here. The drive is improved window by window with the exact derivative of its
simulated error; between rounds of that, windows are changed at random (the same numbers at every
call) and kept where they end lower. Time grows like the number of samples.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.errors import InputError

Array = NDArray[np.float64]
Objective = Literal["rms", "largest"]

# Rounds of changed windows: powers of the errors that are summed, one after the other. High powers
# look at the largest errors, but find their way less well than squares do.
_POWERS: dict[Objective, tuple[int, ...]] = {
    "rms": (2,) * 8,
    "largest": (2, 2, 2, 2, 4, 4, 8, 16),
}
_SAMPLES_PER_TRIAL = 2
_STEPS_OF_A_TRIAL = 100

# Rounds over all windows as they are, and the share of the error that one must gain to go on.
_MOST_ROUNDS = 100
_SMALL_GAIN = 0.005
_LARGEST_ROUGHNESS = 1e9  # over the gain of the plays
_NOTHING = 1e-6  # an error that is not worth a round, over the largest output

# A window is some times as long as the plays carry an error along, in samples.
_SHORTEST, _LONGEST, _TIMES = 24, 256, 5.0

# Worth of a second difference where none is given, over the gain: the drive then stays about as
# rough as it was, and answers no more to what a model lacks. Largest errors stand against largest
# second differences, so they need less.
_ROUGHNESS: dict[Objective, float] = {"rms": 0.1, "largest": 0.02}

# Where no range is given the drive may leave that of the first one by this share of it.
_ROOM = 0.015


@dataclass(frozen=True)
class Aim:
    """What a drive is polished for.

    Parameters
    ----------
    objective
        The mean square of the errors, or the largest of them.
    roughness
        Which error a second difference of the drive of one input unit is worth, output units per
        input unit; None for a small share of the gain of the plays.
    """

    objective: Objective = "rms"
    roughness: float | None = None

    def weight(self, gain: float) -> float:
        """Give the roughness for plays of a gain.

        Parameters
        ----------
        gain
            Output units per input unit.

        Returns
        -------
        float

        Raises
        ------
        InputError
            If it is so large that nothing else counts.
        """
        if self.roughness is None:
            return _ROUGHNESS[self.objective] * gain
        if self.roughness > _LARGEST_ROUGHNESS * gain:
            raise InputError(
                f"roughness is {self.roughness:.6g}, but the gain of the plays is {gain:.6g}; give "
                f"at most {_LARGEST_ROUGHNESS * gain:.6g}, beside which no error counts"
            )
        return self.roughness


@dataclass(frozen=True, eq=False)
class Polished:
    """A polished drive.

    Parameters
    ----------
    drive
        Shape (N,).
    rounds
        Over the record.
    converged
        Whether the last round over all windows found nothing left to gain.
    """

    drive: Array
    rounds: int
    converged: bool


def polish_drive(
    task: RateDependentTask,
    drive: Array,
    change: float,
    objective: Objective,
    roughness: float,
    max_iterations: int,
    progress: Callable[[float], None],
) -> Polished:
    """Improve a drive in what is asked of it; the result is never worse.

    Parameters
    ----------
    task
        Plays, state and target, in units in which signals are about 1.
    drive
        Shape (N,), within the limits.
    change
        Largest change of the drive per sample; infinite if there is no limit.
    objective
        What is asked.
    roughness
        Worth of a second difference.
    max_iterations
        Of the descent in a window.
    progress
        Told the share done.

    Returns
    -------
    Polished
    """
    polisher = _Polisher(task, drive, change, objective, roughness, max_iterations)
    powers = _POWERS[objective]
    polisher.settle(powers[0])
    for number, power in enumerate(powers):
        polisher.change(power, number)
        progress((number + 1) / (len(powers) + 1))
    converged = polisher.settle(powers[-1])
    return Polished(polisher.best, polisher.rounds, converged)


class _Polisher:
    """The drive, the best one so far, and how windows are polished."""

    def __init__(
        self,
        task: RateDependentTask,
        drive: Array,
        change: float,
        objective: Objective,
        roughness: float,
        max_iterations: int,
    ) -> None:
        self.task, self.change_limit = task, change
        self.objective, self.roughness = objective, roughness
        self.chain, self.state = task.chain(), task.state()
        self.drive, self.best = drive.copy(), drive
        self.value = self._value(drive)
        self.range = _range(task, drive)
        self.size = float(np.abs(np.diff(drive)).max(initial=0.0)) or 1.0
        self.window = _window(task, self.size)
        self.steps = max_iterations
        self.rounds = 0

    def settle(self, power: int) -> bool:
        """Go over all windows until there is nothing to gain; whether that was reached."""
        for _ in range(_MOST_ROUNDS):
            if self.value <= _NOTHING:
                return True
            before, after, cut_off = self._round(power, 0, self.steps, 1e-6, 0)
            if after >= before * (1.0 - _SMALL_GAIN) ** power:
                # Windows that go on for very little are no matter, those that hardly began are.
                return cut_off == 0 or self.steps >= _STEPS_OF_A_TRIAL
        return False

    def change(self, power: int, seed: int) -> None:
        """Try changed windows."""
        if self.value > _NOTHING:
            trials = max(1, self.drive.size // _SAMPLES_PER_TRIAL)
            self._round(power, trials, min(_STEPS_OF_A_TRIAL, self.steps), 1e-4, seed)

    def _round(
        self, power: int, trials: int, steps: int, least: float, seed: int
    ) -> tuple[float, float, int]:
        scale = 1.0 if power == 2 else self._largest(self.drive)
        terms = _engine.TrackingTerms(
            *self.range, self.change_limit, power, scale, self.roughness, _stray(scale)
        )
        how = _engine.Polish(self.window, self.window, trials, steps, least, self.size, seed)
        done = _engine.trajectory_polish(
            self.chain, self.state, self.task.target, self.drive, terms, how
        )
        self.rounds += 1
        value = self._value(self.drive)
        if value < self.value:
            self.value, self.best = value, self.drive.copy()
        return done

    def _residuals(self, drive: Array) -> Array:
        error = self.task.plays.run(drive, self.task.state())[0] - self.task.target
        return np.concatenate([error, self.roughness * np.diff(drive, 2)])

    def _largest(self, drive: Array) -> float:
        return float(np.abs(self._residuals(drive)).max()) or 1.0

    def _value(self, drive: Array) -> float:
        residuals = self._residuals(drive)
        if self.objective == "largest":
            return float(np.abs(residuals).max())
        return float(np.sqrt(np.sum(residuals**2) / drive.size))


def _stray(scale: float) -> float:
    """Weight of a drive beyond its limits, which only has to bring it back."""
    return 1e-3 / scale**2


def _range(task: RateDependentTask, drive: Array) -> tuple[float, float]:
    """Range of the drive: as given, or little more than it has."""
    room = _ROOM * float(np.ptp(drive))
    low = task.low if np.isfinite(task.low) else float(drive.min()) - room
    high = task.high if np.isfinite(task.high) else float(drive.max()) + room
    return low, high


def _window(task: RateDependentTask, change: float) -> int:
    """Give the samples of a window: plays carried along answer within S g' / (P dt) samples."""
    plays = task.plays
    moving = float(np.abs(plays.p).sum())
    widening = float(plays.rate_curve(change / plays.dt)) / change
    carried = moving * widening / (plays.p0 + moving)
    return int(np.clip(round(_TIMES * carried), _SHORTEST, _LONGEST))
