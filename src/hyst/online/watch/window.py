"""What a window of watched samples says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.online.alarms import AlarmEvent
from hyst.online.knowledge import Knowledge

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Window:
    """What a window of samples says.

    Parameters
    ----------
    time
        Seconds since the first sample, of the last one.
    error, model_error
        Root mean square of the errors of prediction, of the estimate before it learnt and of the
        model as it was given, output units; NaN where nothing is known.
    noise
        As the estimator estimates it, output units; NaN before it has learnt from a sample.
    parameters
        Shape (m,), the estimate when it was last asked for.
    knowledge
        Bands of the estimate when it was last asked for them.
    has_bands
        Whether that was in this window.
    innovation
        Whether what is left can be noise, in a sentence; and whether it can.
    is_consistent
        The same as a truth value.
    paused
        Why nothing was learnt; empty where something was.
    counts
        Since the start: samples, samples learnt from, and what was wrong with the others.
    events
        Alarms that start or end here.
    active
        Names of the alarms that are on.
    """

    time: float
    error: float
    model_error: float
    noise: float
    parameters: Array
    knowledge: Knowledge
    has_bands: bool
    innovation: str
    is_consistent: bool
    paused: str
    counts: dict[str, int]
    events: tuple[AlarmEvent, ...]
    active: tuple[str, ...]
