"""How far a test signal must go so that every threshold of a model is passed."""

from __future__ import annotations

import numpy as np

from hyst.export.c.core_stage import CoreStage, core_stages
from hyst.export.c.drive import Drive
from hyst.operators import Operator
from hyst.operators.composition import leaves_of

_EXPONENTS = range(-20, 21)
_BEYOND = 1.25  # times the largest threshold
_SCALES = ("r", "threshold", "knot")


def drive_for(model: Operator) -> Drive:
    """Give a drive around zero, of the smallest power of two that passes as much as any does.

    Parameters
    ----------
    model
        What the signal passes.

    Returns
    -------
    Drive
    """
    stages = core_stages(model)
    best, most = 1.0, -1
    shape = np.concatenate([np.linspace(0, 1, 40), np.linspace(1, -1, 80), np.linspace(-1, 0, 40)])
    for exponent in _EXPONENTS:
        amplitude = 2.0**exponent
        passed = _stages_passed(model, stages, amplitude * shape)
        if passed > most:
            best, most = amplitude, passed
        if most == len(stages):
            break  # nothing passes more, and far beyond its thresholds a model may take long
    return Drive.between(-best, best)


def _stages_passed(model: Operator, stages: tuple[CoreStage, ...], u: np.ndarray) -> int:
    leaves = leaves_of(model)
    if len(leaves) != len(stages):
        leaves = (model,)
    passed = 0
    for leaf, stage in zip(leaves, stages, strict=False):
        passed += bool(np.abs(u).max() >= _BEYOND * _largest_scale(stage))
        with np.errstate(all="ignore"):
            step = leaf.stepper()
            u = np.array([step(float(each)) for each in u])
        if step.fault:
            return -1
    return passed


def _largest_scale(stage: CoreStage) -> float:
    scales = [abs(stage.numbers[key]) for key in _SCALES if key in stage.numbers]
    # The rate's thresholds of rate-dependent plays are in other units.
    rate = stage.kind == "rate_dependent_pi"
    for key in _SCALES:
        if key in stage.tables and not (rate and key == "threshold"):
            scales += [abs(each) for each in stage.tables[key]]
    return max(scales, default=1.0)
