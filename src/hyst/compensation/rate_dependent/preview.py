"""Inversion of a rate-dependent model with no more than a few samples of the reference to come.

The command is that of ``RateDependentPreview``, which plans in the core, sample by sample: what a
controller gets in real time, a record gets here at once.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hyst.compensation.rate_dependent.solved_drive import SOLVED, SolvedDrive
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.models import RateDependentPreview

_STEPS_A_SAMPLE = 2  # of plan and rival


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
        After the record the target is taken to go on as it ended.
    """
    target = task.target
    planner = RateDependentPreview(
        task.plays,
        samples,
        (task.low, task.high) if np.isfinite(task.low) else None,
        change if np.isfinite(change) else None,
    )
    last = float(target[-1] - target[-2]) if target.size > 1 else 0.0
    longer = np.concatenate([target, target[-1] + last * np.arange(1.0, samples + 1.0)])
    drive, _ = planner.run(longer, planner.state_within_a_record(task.state()))
    progress(1.0)
    note = (
        f"each sample knows the next {samples} samples ({samples * task.plays.dt:.4g} s) of "
        "the reference",
    )
    return SolvedDrive(drive[samples:], SOLVED, _STEPS_A_SAMPLE * longer.size, note)
