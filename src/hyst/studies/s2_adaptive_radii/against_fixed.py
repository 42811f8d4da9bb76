"""Figs. 8 and 9 on any record: few plays of estimated radii against more of preassigned ones."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative
from hyst.errors import InputError
from hyst.identification import identify, identify_weights_from_slopes, later
from hyst.models import PrandtlIshlinskii
from hyst.online import JointEstimator, RadiusEstimator
from hyst.operators import Affine, Operator
from hyst.report.table import Table, number
from hyst.signals import Record, suggest_dead_band
from hyst.studies.s2_adaptive_radii.measured_piezo import COUNTS, fit_fixed
from hyst.studies.s2_adaptive_radii.paper import fixed_radii, triangle
from hyst.studies.simulated_piezo import DT, SimulatedPiezo

Array = NDArray[np.float64]

PLAYS = 3
"""Besides the one of radius 0, as in sec. V."""
# Filter and dead time of the law, in samples, and the share of an error its gradient takes back.
WINDOW, SHARE = 4, 0.01
_SETTLED = 0.95


def on_record(
    record: Record,
    validation: Record | None = None,
    delay: float | None = None,
    counts: Iterable[int] = COUNTS,
) -> tuple[Table, ...]:
    """Compare plays of estimated radii with more plays of preassigned ones on a record.

    Parameters
    ----------
    record
        All models are fitted to it, its lag taken out first.
    validation
        Another record of the same actuator, as fig. 9 has it; not fitted.
    delay
        By how many samples the output lags, at least 0; identified if left out. A lag that stays in
        widens the loop, and is taken for plays.
    counts
        Numbers of plays of preassigned radii, that of radius 0 counted.

    Returns
    -------
    tuple of Table

    Raises
    ------
    InputError
        If a count is below 2, the delay is out of range, or the validation has another sample time.
    NotIdentifiableError
        If the record does not show plays.
    """
    return (compared(record, validation, "Record", delay, counts),)


def simulated() -> Table:
    """Compare them on Bouc-Wen's equation with a resonance, simulated: no plays make it."""
    plant = SimulatedPiezo(asymmetric=False, creeps=False)
    step = 1000.0 * DT
    major = triangle([0.0, *([250.0, -250.0] * 4)], step)
    minor = triangle(
        [0.0, 250.0, -250.0, 250.0, -125.0, 250.0, 0.0, 250.0, 125.0, 250.0, -250.0], step
    )
    training, validation = (Record(u, plant.measure(u), DT) for u in (major, minor))
    name = "Simulated actuator, Bouc-Wen with a resonance [nm]"
    return compared(training, validation, name, 0)


def compared(
    record: Record,
    validation: Record | None,
    name: str,
    delay: float | None = None,
    counts: Iterable[int] = COUNTS,
) -> Table:
    """Give the table of ``on_record``, under a name.

    Parameters
    ----------
    record, validation, delay, counts
        As there.
    name
        What the title calls the record.

    Returns
    -------
    Table

    Raises
    ------
    InputError, NotIdentifiableError
        As there.
    """
    several = list(counts)
    for n in several:
        if n < 2:
            raise InputError(f"a count of plays is {n}; give 2 or more, that of radius 0 is one")
    if validation is not None and not math.isclose(validation.dt, record.dt, rel_tol=1e-9):
        raise InputError(
            f"the validation record has dt = {validation.dt:.9g} s and the other one "
            f"{record.dt:.9g} s; give records of one sample time"
        )
    if delay is not None:
        as_not_negative(delay, "delay", "samples of at least 0")
    found = identify(record, family="pi", plays=PLAYS, delay="auto" if delay is None else delay)
    lag = float(found.delay)
    records = [without_lag(each, lag) for each in (record, validation) if each is not None]
    fitted = records[0]
    models: dict[str, tuple[int, Operator]] = {}
    start = identify_weights_from_slopes(fitted, plays=PLAYS).model
    models["slopes by segmentation"] = (2 * PLAYS + 1, start)
    models["and radii by the paper's law"] = (2 * PLAYS + 1, _by_the_law(fitted, start))
    models["all by the joint estimator"] = (2 * PLAYS + 1, _by_joint(fitted, start))
    models["all by hyst identify"] = (2 * PLAYS + 1, found.model)
    for n in several:
        models[f"preassigned radii, n = {n}"] = (n, _preassigned(fitted, n))
    rows = tuple(
        (label, str(numbers), *(cell for each in records for cell in _errors(each, model)))
        for label, (numbers, model) in models.items()
    )
    shown = ("rms", "largest", "rms, validation", "largest")[: 2 * len(records)]
    title = (
        f"{name}: errors of {PLAYS + 1} plays of estimated radii and of n of preassigned ones, "
        f"their means and a lag of {lag:.4g} samples taken out (a play of radius 0 is counted)"
    )
    return Table(title, ("", "constants", *shown), rows)


def without_lag(record: Record, delay: float) -> Record:
    """Set input and output of a record side by side, the lag in samples.

    Parameters
    ----------
    record
        As measured.
    delay
        By which the output lags, at least 0.

    Returns
    -------
    Record
    """
    whole = int(np.floor(delay))
    u = later(record.u, delay - whole)[: record.samples - whole]
    return replace(record, u=u, y=record.y[whole:])


def settled(u: Array) -> int:
    """Give the first sample at which the input has spanned nearly all of its range."""
    span = np.maximum.accumulate(u) - np.minimum.accumulate(u)
    return int(np.argmax(span >= _SETTLED * np.ptp(u)))


def _by_the_law(record: Record, start: PrandtlIshlinskii) -> Operator:
    """Run the paper's law over the record, from the radii at which slopes change."""
    level = float(np.mean((record.y - start(record.u))[settled(record.u) :]))
    law = RadiusEstimator(
        np.maximum(start.p, 0.0),
        start.r,
        SHARE / (record.dt * float(start.p @ start.p)),
        record.dt,
        p0=start.p0,
        filter_time=WINDOW * record.dt,
        dead_time=WINDOW * record.dt,
        dead_band=suggest_dead_band(record.u),
        offset=level,
    )
    law.run(record)
    return PrandtlIshlinskii(np.maximum(start.p, 0.0), law.radii, start.p0)


def _by_joint(record: Record, start: PrandtlIshlinskii) -> Operator:
    level = float(np.mean((record.y - start(record.u))[settled(record.u) :]))
    joint = JointEstimator(Affine(1.0, level) @ start, dt=record.dt)
    joint.run(record)
    p, r = joint.parameters[1 : PLAYS + 1], joint.parameters[PLAYS + 1 : 2 * PLAYS + 1]
    return PrandtlIshlinskii(p, r, float(joint.parameters[0]))


def _preassigned(record: Record, n: int) -> Operator:
    r = fixed_radii(n, float(np.ptp(record.u)) / 2.0)
    weights, _ = fit_fixed(record.u, record.y, r, settled(record.u))
    return PrandtlIshlinskii(weights[1:], r, float(weights[0]))


def _errors(record: Record, model: Operator) -> tuple[str, str]:
    """Give the rms and the largest error, the mean taken out, once the input has turned."""
    error = (record.y - model(record.u))[settled(record.u) :]
    error = error - error.mean()
    return number(float(np.sqrt(np.mean(error**2)))), number(float(np.abs(error).max()))
