"""The whole story on a simulated stage: measure, identify, invert, track, compare."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.compensation import Compensation, invert_trajectory
from hyst.demo.stage import HIGHEST_DRIVE, SimulatedStage
from hyst.demo.trajectories import staircase_and_sines, through, with_holds
from hyst.identification import Identified, earlier, identify
from hyst.operators import Affine
from hyst.signals import Metrics, Record, error_metrics

Array = NDArray[np.float64]

BANNER = "SIMULATED: every number here comes from a simulated stage, none was measured"

_TRAINING_LEVELS = (
    *(0.0, 100.0, 0.0, 100.0, 15.0, 85.0, 30.0, 70.0, 42.0, 60.0),
    *(0.0, 50.0, 20.0, 40.0, 10.0, 100.0, 55.0, 90.0, 70.0, 100.0, 0.0),
)
_VALIDATION_LEVELS = (0.0, 100.0, 0.0, 65.0, 25.0, 95.0, 45.0, 80.0, 5.0, 35.0, 0.0)
_SPEED = 160.0
_HOLDS = dict.fromkeys((0.0, 100.0, 15.0, 85.0, 42.0, 90.0, 70.0, 30.0), 1.0) | {
    20.0: 6.0,
    55.0: 5.0,
}
_VALIDATION_HOLDS = {65.0: 2.5, 45.0: 2.0}
"""s, by level: while the drive rests the stage shows its creep."""

_LOW, _HIGH = 8.0, 48.0
_SWEEP = (0.0, HIGHEST_DRIVE, 0.0)


@dataclass(frozen=True, eq=False)
class Tracking:
    """How the simulated stage followed the reference with one command.

    Parameters
    ----------
    name
        Where the command came from.
    u
        Command, V.
    y
        True position of the simulated stage, um.
    metrics
        Of ``y`` against the reference.
    """

    name: str
    u: Array
    y: Array
    metrics: Metrics


@dataclass(frozen=True, eq=False)
class Story:
    """Everything that happened.

    Parameters
    ----------
    training, validation
        Simulated records, with sensor.
    identified
        The model found in the training record.
    y_ref
        Wanted position, um.
    history
        Drive of the stage before it tracks, V.
    compensation
        The command from the exact inverse, and its prediction.
    tracking
        First with the command of a straight line, then with the compensated one.
    """

    training: Record
    validation: Record
    identified: Identified
    y_ref: Array
    history: Array
    compensation: Compensation
    tracking: tuple[Tracking, Tracking]

    @property
    def improvement(self) -> float:
        """How many times smaller compensation made the rms tracking error."""
        plain, compensated = self.tracking
        return plain.metrics.rms / compensated.metrics.rms


def tell(stage: SimulatedStage | None = None, say: Callable[[str], None] | None = None) -> Story:
    """Go through the whole story; the same every time.

    Parameters
    ----------
    stage
        The stage; the standard one if left out.
    say
        Called with a line of text before each step.

    Returns
    -------
    Story
    """
    rig = stage or SimulatedStage()
    say = say or _say_nothing
    say("driving the stage")
    training = _record(rig, _TRAINING_LEVELS, _HOLDS)
    validation = _record(rig, _VALIDATION_LEVELS, _VALIDATION_HOLDS)
    identified = identify(training, validation=validation, progress=say)
    say("tracking")
    history = through(_SWEEP, _SPEED, rig.dt)
    y_ref = _reference(float(identified.model(history)[-1]), rig.dt)
    limits = (0.0, HIGHEST_DRIVE)
    # The command is given earlier by what the output lags.
    wanted = earlier(y_ref, identified.delay)
    done = invert_trajectory(identified.model, wanted, input_range=limits, history=history)
    line = _straight_line(training)
    plain = np.clip(line.inverse()(y_ref), *limits)
    tracking = (
        _track(rig, "straight line", plain, y_ref, history),
        _track(rig, "exact inverse", done.u, y_ref, history),
    )
    return Story(training, validation, identified, y_ref, history, done, tracking)


def _say_nothing(_: str) -> None:
    """Tell nobody."""


def _reference(start: float, dt: float) -> Array:
    """Go from where the stage rests to the stairs, and up and down them."""
    return np.concatenate(
        [through([start, _LOW], _HIGH - _LOW, dt), staircase_and_sines(_LOW, _HIGH, dt)]
    )


def _record(
    stage: SimulatedStage, levels: tuple[float, ...], holds: Mapping[float, float]
) -> Record:
    u = with_holds(levels, holds, _SPEED, stage.dt)
    y = stage.measure(stage.position(u))
    names = {"input_name": "drive", "output_name": "position"}
    units = {"input_unit": "V", "output_unit": "um"}
    return Record(u, y, stage.dt, **names, **units, notes=("simulated, not measured",))


def _straight_line(record: Record) -> Affine:
    """Fit the line a user without hysteresis compensation would calibrate."""
    gain, offset = np.polyfit(record.u, record.y, 1)
    return Affine(float(gain), float(offset))


def _track(stage: SimulatedStage, name: str, u: Array, y_ref: Array, history: Array) -> Tracking:
    y = stage.position(u, history)
    return Tracking(name, u, y, error_metrics(y_ref, y))
