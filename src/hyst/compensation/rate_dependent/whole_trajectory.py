"""Inversion of a rate-dependent model along a whole known trajectory.

The plays make the simulated tracking error kinked and full of local minima, so it is first
minimised smoothed over the whole drive: corners rounded and second differences weighted, both taken
back stage by stage. Several courses from smooth to sharp are tried; the drive that follows best, as
simulated without any smoothing, is where the polish starts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.rate_dependent.scales import Scales, scales_of
from hyst.compensation.rate_dependent.solved_drive import (
    CONVERGED,
    ITERATION_LIMIT,
    SOLVED,
    SolvedDrive,
)
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.compensation.rate_dependent.trajectory_descent import Descent, Stage, within_limits
from hyst.compensation.rate_dependent.trajectory_polish import Aim, polish_drive
from hyst.compensation.rate_dependent.unit_size import in_unit_size

Array = NDArray[np.float64]

# A drive that moves more than this over the best one so far is not worth a smaller error.
_MOST_VARIATION = 1.15

# Share of the time that the courses take.
_SHARE_OF_COURSES = 0.3


@dataclass(frozen=True)
class _Course:
    """Roughness and rounding of the first stage, the factor between stages, and their number."""

    roughness: float
    rate: float
    contact: float
    factor: float
    stages: int

    def stage(self, number: int, scales: Scales) -> Stage:
        sharper = self.factor**-number
        return scales.stage(
            self.roughness * sharper, self.rate * sharper**0.7, self.contact * sharper**0.9
        )


# Which course ends lowest depends on the signal: see docs/rate_dependent.md.
_COURSES = (
    _Course(1.4, 0.3, 0.04, 3.0, 11),
    _Course(1.4, 0.03, 0.04, 2.0, 11),
    _Course(1.4, 0.3, 0.01, 2.0, 11),
)


def drive_along_trajectory(
    task: RateDependentTask,
    change: float,
    aim: Aim,
    max_iterations: int,
    progress: Callable[[float], None],
) -> SolvedDrive:
    """Find the drive whose simulated output follows the reference best.

    Parameters
    ----------
    task
        Plays, state and target.
    change
        Largest change of the drive per sample; infinite if there is no limit.
    aim
        What the drive is polished for.
    max_iterations
        Of each stage of a course, and in each window of the polish.
    progress
        Told the share done.

    Returns
    -------
    SolvedDrive
        Better than the explicit one held within the limits.
    """
    # The explicit inverse takes the reference's rate for the drive's: it, too, needs like sizes.
    unit, by_input, by_output = in_unit_size(task)
    inverse, memory = unit.explicit_inverse()
    explicit, _ = inverse.run(unit.target, memory)
    search = _Search(unit, change * by_input, max_iterations)
    search.offer(explicit)
    scales = scales_of(unit, explicit)
    if scales is None:
        return SolvedDrive(search.drive / by_input, SOLVED, 1, ())
    for number, course in enumerate(_COURSES):
        search.follow(explicit, course, scales)
        progress(_SHARE_OF_COURSES * (number + 1) / len(_COURSES))
    rest = 1.0 - _SHARE_OF_COURSES
    gain = task.plays.p0 + float(np.abs(task.plays.p).sum())
    roughness = aim.weight(gain)
    polished = polish_drive(
        unit,
        search.drive,
        change * by_input,
        aim.objective,
        roughness * by_output / by_input,
        max_iterations,
        lambda share: progress(_SHARE_OF_COURSES + rest * share),
    )
    return SolvedDrive(
        polished.drive / by_input,
        CONVERGED if polished.converged else ITERATION_LIMIT,
        search.steps + polished.rounds,
        (),
        search.drive / by_input,
        roughness,
    )


class _Search:
    """The drive that follows best so far, held within the limits and simulated as it is."""

    def __init__(self, task: RateDependentTask, change: float, max_iterations: int) -> None:
        self.task, self.change, self.max_iterations = task, change, max_iterations
        started = task.plays_state[-1] > 0.0
        self.before = float(task.plays_state[-2]) if started else None
        self.score, self.steps = np.inf, 0
        self.drive, self.variation = task.target, np.inf
        self.extent = float(np.ptp(task.target)) or 1.0
        self.chain = task.chain()

    def follow(self, drive: Array, course: _Course, scales: Scales) -> None:
        """Go through the stages of a course."""
        task = self.task
        limited = np.isfinite([task.low, task.high, self.change]).any()
        limits = (task.low, task.high, self.change, scales.penalty if limited else 0.0)
        problem = Descent(self.chain, task.state(), task.target, *limits)
        for number in range(course.stages):
            stage = course.stage(number, scales)
            drive, _, tried, _ = problem.descend(drive, stage, self.max_iterations)
            self.steps += tried
            self.offer(drive)

    def offer(self, drive: Array) -> None:
        """Keep a drive if it is the best."""
        task = self.task
        held = within_limits(drive, self.before, task.low, task.high, self.change)
        error = (task.plays.run(held, task.state())[0] - task.target) / self.extent
        # Eighth powers look at the largest errors, and beyond one that cannot be helped.
        score = float(np.sum(error**8))
        variation = float(np.abs(np.diff(held)).sum())
        if score < self.score and variation <= _MOST_VARIATION * self.variation:
            self.score, self.drive, self.variation = score, held, variation
