"""The examples with limits that their drive meets, and a history within them."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from c_builds import stepped, wandering

from hyst.control.limited_drive.drive import LimitedDrive
from reference.examples import EXAMPLES

# The operator of which they are the exact inverse is not known.
WITHOUT_LIMITS = {
    "inverse of hysteresis behind a delay",
    "rate-dependent preview",
    "delay taken back by preview",
}
HISTORY = (0.0, 1.0, 0.0, 0.75, 0.25, 0.5)  # parts of the range


@cache
def limited_example(name: str) -> LimitedDrive | None:
    """The example with limits in the midst of where its drive goes; None without."""
    if name in WITHOUT_LIMITS:
        return None
    model = EXAMPLES[name]
    u = wandering(600)
    drive = u if _is_model(name) else stepped(model.stepper(), u)
    low, high = np.quantile(drive[np.isfinite(drive)], [0.2, 0.85])
    return LimitedDrive(model, (float(low), float(high)))


def with_drive(name: str) -> dict[str, Any]:
    """What an export is told of the drive of an example; nothing where it can have no limits."""
    drive = limited_example(name)
    return {} if drive is None else {"limits": drive.limits, "history": history_of(drive)}


def history_of(drive: LimitedDrive) -> list[float]:
    """Some turns within the limits."""
    assert drive.limits is not None
    low, high = drive.limits
    return np.clip([low + part * (high - low) for part in HISTORY], low, high).tolist()


def _is_model(name: str) -> bool:
    return LimitedDrive(EXAMPLES[name], "none", 1.0, dt=EXAMPLES[name].dt or 1.0).drive == "input"
