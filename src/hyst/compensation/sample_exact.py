"""Inversion of a rate-dependent model sample by sample: exact and causal, but it may chatter."""

from __future__ import annotations

import numpy as np

from hyst import _engine
from hyst.compensation.rate_dependent_task import RateDependentTask
from hyst.compensation.solved_drive import SOLVED, SolvedDrive
from hyst.errors import NotInvertibleError


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
    slope = task.plays.sample_equation_slope()
    notes: tuple[str, ...] = ()
    if slope <= 0.0:
        notes = (
            f"p0 + (1 - beta/dt) sum p = {slope:.4g} is not positive: {several} of {drive.size} "
            "samples had several solutions, the one nearest to the previous drive was taken; the "
            "drive chatters",
        )
    return SolvedDrive(drive, SOLVED, 1, notes)
