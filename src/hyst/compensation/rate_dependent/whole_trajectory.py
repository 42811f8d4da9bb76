"""Inversion of a rate-dependent model along a whole known trajectory.

The simulated tracking error and a small roughness penalty are minimised over the whole drive. The
plays make this problem kinked and full of local minima, so it is solved smoothed first: corners
rounded and roughness weighted, both taken back stage by stage. Several courses from smooth to
sharp are tried, and the drive that follows best, as simulated without any smoothing, is kept: that
is how the roughness weight is chosen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.rate_dependent.preview import drive_with_preview
from hyst.compensation.rate_dependent.scales import Scales, scales_of
from hyst.compensation.rate_dependent.solved_drive import (
    CONVERGED,
    ITERATION_LIMIT,
    SOLVED,
    SolvedDrive,
)
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.compensation.rate_dependent.trajectory_descent import Descent, Stage, within_limits

Array = NDArray[np.float64]

# A drive that moves more than this over the best one so far is not worth a smaller error.
_MOST_VARIATION = 1.15

# The preview's drive is one more start while it costs no more than a few seconds.
_MOST_SAMPLES_FOR_PREVIEW = 2000
_PREVIEW = 20


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
_FROM_EXPLICIT = (
    _Course(1.4, 0.3, 0.04, 3.0, 11),
    _Course(1.4, 0.03, 0.04, 2.0, 11),
    _Course(1.4, 0.3, 0.01, 2.0, 11),
)
_FROM_PREVIEW = _Course(0.1, 0.01, 0.001, 3.0, 5)


def drive_along_trajectory(
    task: RateDependentTask,
    change: float,
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
    max_iterations
        Of each stage.
    progress
        Told the share done.

    Returns
    -------
    SolvedDrive
        The best drive met, never worse than the explicit one.
    """
    inverse, memory = task.explicit_inverse()
    explicit, _ = inverse.run(task.target, memory)
    scales = scales_of(task, explicit)
    search = _Search(task, change, max_iterations)
    search.offer(explicit, 0.0, False)
    if scales is None:
        return SolvedDrive(search.drive, SOLVED, 1, ())
    short = explicit.size <= _MOST_SAMPLES_FOR_PREVIEW
    courses = [(explicit, each) for each in _FROM_EXPLICIT]
    if short:
        planned = drive_with_preview(task, _PREVIEW, change, lambda share: progress(0.5 * share))
        courses.append((planned.drive, _FROM_PREVIEW))
    first = 0.5 if short else 0.0
    for number, (drive, course) in enumerate(courses):
        search.follow(drive, course, scales)
        progress(first + (1.0 - first) * (number + 1) / len(courses))
    note = (f"roughness weight {search.roughness:.3g}",)
    # A first guess that no course has bettered is an answer if all courses have come to their end.
    status = CONVERGED if search.converged or search.all_converged else ITERATION_LIMIT
    return SolvedDrive(search.drive, status, search.steps, note)


class _Search:
    """The drive that follows best so far, held within the limits and simulated as it is."""

    def __init__(self, task: RateDependentTask, change: float, max_iterations: int) -> None:
        self.task, self.change, self.max_iterations = task, change, max_iterations
        started = task.start[-1] > 0.0
        self.before = float(task.start[-2]) if started else None
        self.score, self.roughness, self.steps = np.inf, 0.0, 0
        self.converged, self.all_converged = False, True
        self.drive, self.variation = task.target, np.inf
        self.extent = float(np.ptp(task.target)) or 1.0
        self.chain = task.chain()

    def follow(self, drive: Array, course: _Course, scales: Scales) -> None:
        """Go through the stages of a course."""
        task = self.task
        limited = np.isfinite([task.low, task.high, self.change]).any()
        limits = (task.low, task.high, self.change, scales.penalty if limited else 0.0)
        problem = Descent(self.chain, task.state(), task.target, *limits)
        self.offer(drive, 0.0, False)
        for number in range(course.stages):
            stage = course.stage(number, scales)
            drive, _, tried, converged = problem.descend(drive, stage, self.max_iterations)
            self.steps += tried
            self.all_converged = self.all_converged and converged
            self.offer(drive, stage.roughness, converged)

    def offer(self, drive: Array, roughness: float, converged: bool) -> None:
        """Keep a drive if it is the best."""
        task = self.task
        held = within_limits(drive, self.before, task.low, task.high, self.change)
        error = (task.plays.run(held, task.state())[0] - task.target) / self.extent
        # Eighth powers look at the largest errors, and beyond one that cannot be helped.
        score = float(np.sum(error**8))
        variation = float(np.abs(np.diff(held)).sum())
        if score < self.score and variation <= _MOST_VARIATION * self.variation:
            self.score, self.drive, self.variation = score, held, variation
            self.roughness, self.converged = roughness, converged
