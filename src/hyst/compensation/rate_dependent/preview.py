"""Inversion of a rate-dependent model with no more than a few samples of the reference to come.

At every sample the drive over the next few samples is planned by a short trajectory inversion from
the present memory; only its first sample is used. What the actuator does next never depends on the
reference beyond the preview. The record is given as a whole all the same: this is no stepper.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.rate_dependent.scales import Scales, scales_of
from hyst.compensation.rate_dependent.solved_drive import SOLVED, SolvedDrive
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.compensation.rate_dependent.trajectory_descent import Descent, Stage, within_limits

Array = NDArray[np.float64]

# From smooth to sharp: roughness over the squared gain; rounding over the largest change per
# sample and over the range. Sharper ones follow better where they succeed and jump where they
# do not.
_STAGES = ((0.5, 0.3, 0.04), (0.1, 0.05, 0.007), (0.1, 0.01, 0.001))
_ITERATIONS = 10


def drive_with_preview(
    task: RateDependentTask,
    samples: int,
    change: float,
    progress: Callable[[float], None],
) -> SolvedDrive:
    """Plan ahead at every sample and use the first sample of the plan.

    Parameters
    ----------
    task
        Plays, state and target.
    samples
        Samples of the reference known beyond the present one.
    change
        Largest change of the drive per sample; infinite if there is no limit.
    progress
        Told the share done.

    Returns
    -------
    SolvedDrive
    """
    inverse, memory = task.explicit_inverse()
    explicit, _ = inverse.run(task.target, memory)
    note = (
        f"each sample knows the next {samples} samples ({samples * task.plays.dt:.4g} s) of "
        "the reference",
    )
    planner = _Planner(task, explicit, change)
    return SolvedDrive(planner.run(samples, progress), SOLVED, planner.steps, note)


class _Planner:
    """Plans from the present memory on; steps counts the Gauss-Newton steps."""

    def __init__(self, task: RateDependentTask, explicit: Array, change: float) -> None:
        self.task, self.explicit, self.change = task, explicit, change
        self.chain = task.chain()
        self.steps = 0

    def run(self, samples: int, progress: Callable[[float], None]) -> Array:
        plays, target = self.task.plays, self.task.target
        step = plays.stepper(self.task.state())
        n = plays.p.size
        drive = np.empty_like(target)
        plan = np.empty(0)
        for k in range(target.size):
            ahead = slice(k, min(k + samples + 1, target.size))
            # The scales, too, are those of the samples known by now.
            scales = scales_of(self.task, self.explicit[: ahead.stop])
            if scales is None:
                plan = self.explicit[ahead]
            else:
                plan = self._best(step.state.copy(), ahead, plan, scales)
            started = step.state[n + 1] > 0.0
            # Without a past a drive whose rate is limited starts from where the reference does.
            last = float(step.state[n] if started else self._first())
            first = within_limits(plan[:1], last, self.task.low, self.task.high, self.change)
            drive[k] = first[0]
            step(float(first[0]))
            plan = plan[1:]
            if k % 256 == 0:
                progress(k / target.size)
        return drive

    def _first(self) -> float:
        return min(max(float(self.explicit[0]), self.task.low), self.task.high)

    def _best(self, state: Array, ahead: slice, plan: Array, scales: Scales) -> Array:
        """Best of the plan carried on, as it is and smoothed first, and the explicit drive."""
        stages = [scales.stage(*each) for each in _STAGES]
        limits = (self.task.low, self.task.high, self.change, scales.penalty)
        problem = Descent(self.chain, state, self.task.target[ahead], *limits)
        explicit = self.explicit[ahead]
        starts = [(explicit, stages)]
        if plan.size:
            grown = self._grown(plan, ahead)
            starts += [(grown, stages), (grown, stages[-1:])]
        found = [self._descend(problem, *start) for start in starts]
        return min(found, key=lambda each: each[1])[0]

    def _grown(self, plan: Array, ahead: slice) -> Array:
        """Carry a plan on to the end of the preview as the explicit drive moves there."""
        length = ahead.stop - ahead.start
        if plan.size >= length:
            return plan[:length]
        tail = self.explicit[ahead.stop - 1] - self.explicit[ahead.stop - 2]
        return np.append(plan, plan[-1] + tail)

    def _descend(self, problem: Descent, drive: Array, stages: list[Stage]) -> tuple[Array, float]:
        cost = np.inf
        for stage in stages:
            drive, cost, tried, _ = problem.descend(drive, stage, _ITERATIONS)
            self.steps += tried
        return drive, cost
