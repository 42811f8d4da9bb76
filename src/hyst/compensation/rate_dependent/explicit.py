"""The paper's explicit inverse of a rate-dependent model: causal, smooth, and not exact."""

from __future__ import annotations

import numpy as np

from hyst.compensation.rate_dependent.limits_kept import refuse_or_tell
from hyst.compensation.rate_dependent.solved_drive import SolvedDrive
from hyst.compensation.rate_dependent.task import RateDependentTask


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
    InputError
        If the drive leaves its range and must not be clipped.
    NotInvertibleError
        If a cumulative weight is not positive.

    Notes
    -----
    S4 eqs. 12-16.
    """
    inverse, memory = task.explicit_inverse()
    drive, _ = inverse.run(task.target, memory)
    held = np.clip(drive, task.low, task.high)
    # The inverse is exact to rounding only where it just touches the end of the range.
    slack = 1e-12 * float(np.abs(drive).max())
    clipped = refuse_or_tell(task, np.abs(drive - held) > slack)
    note = (
        "thresholds are taken from the rate of the reference, the actuator's follow the rate of "
        "its drive: not exact",
    )
    return SolvedDrive(held, "solved", 1, note + clipped)
