"""The paper's explicit inverse of a rate-dependent model: causal, smooth, and not exact."""

from __future__ import annotations

import numpy as np

from hyst.compensation.rate_dependent_task import RateDependentTask
from hyst.compensation.solved_drive import SolvedDrive


def drive_explicitly(task: RateDependentTask) -> SolvedDrive:
    """Give the drive of the explicit inverse, thresholds from the rate of the reference.

    Parameters
    ----------
    task
        Plays, state and target.

    Returns
    -------
    SolvedDrive

    Raises
    ------
    NotInvertibleError
        If a cumulative weight is not positive.

    Notes
    -----
    S4 eqs. 12-16.
    """
    inverse, memory = task.explicit_inverse()
    drive, _ = inverse.run(task.target, memory)
    note = (
        "thresholds are taken from the rate of the reference, the actuator's follow the rate of "
        "its drive: not exact",
    )
    return SolvedDrive(np.clip(drive, task.low, task.high), "solved", 1, note)
