"""Inversion of a rate-dependent model sample by sample: exact and causal, but it may chatter."""

from __future__ import annotations

import numpy as np

from hyst import _engine
from hyst.compensation.rate_dependent.limits_kept import refuse_or_tell
from hyst.compensation.rate_dependent.solved_drive import SOLVED, SolvedDrive
from hyst.compensation.rate_dependent.task import RateDependentTask
from hyst.errors import NotInvertibleError

# A sample at the end of the range is clipped if it misses more than this of the largest output.
_ROUNDING = 1e-9


def drive_sample_by_sample(task: RateDependentTask) -> SolvedDrive:
    """Solve every sample's equation for the drive, thresholds from the drive's own rate.

    Parameters
    ----------
    task
        Plays, state and target.

    Returns
    -------
    SolvedDrive
        Of several solutions of a sample the one nearest to the previous drive is taken, and their
        number is noted.

    Raises
    ------
    InputError
        If the drive would leave its range and must not be clipped.
    NotInvertibleError
        If a sample's equation has no solution.
    """
    drive = np.empty_like(task.target)
    solved, several = _engine.sample_exact(
        task.chain(), task.state(), np.ascontiguousarray(task.target), drive, task.low, task.high
    )
    if solved < drive.size:
        raise NotInvertibleError(
            f"no drive gives the wanted output at sample {solved}; use method='trajectory'"
        )
    y, _ = task.plays.run(drive, task.state())
    missed = np.abs(y - task.target) > _ROUNDING * float(np.abs(task.target).max())
    clipped = refuse_or_tell(task, missed & ((drive <= task.low) | (drive >= task.high)))
    slope = task.plays.sample_equation_slope()
    notes: tuple[str, ...] = ()
    if slope <= 0.0:
        notes = (
            f"p0 + (1 - beta/dt) sum p = {slope:.4g} is not positive: {several} of {drive.size} "
            "samples had several solutions, the one nearest to the previous drive was taken; the "
            "drive chatters",
        )
    return SolvedDrive(drive, SOLVED, 1, notes + clipped)
