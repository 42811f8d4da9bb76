"""Where the fit of a hysteresis starts whose dynamics are known.

No impulse response is needed, so the drive need not excite one: a slow triangle will do. The signal
behind the hysteresis is looked for in two ways. Going back through the dynamics is exact but for
noise, which it amplifies. Plays on a grid of radii, filtered by the dynamics and weighted by least
squares, take up hardly any noise but have corners of their own. What explains the output best comes
first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst import _engine
from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family, Start
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import (
    LONGEST_START,
    MOST_DELAY,
    shortened,
    signal_behind,
)
from hyst.identification.families.hammerstein.impulse_response.first_guess import first_fronts
from hyst.identification.families.hammerstein.known.given_dynamics import GivenDynamics
from hyst.identification.families.hammerstein.known.held_joint import joint_held
from hyst.identification.families.option import AUTO
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

_WARM_UP = 8_000
_NO_BETTER = 40  # samples of delay after the best, before the search ends
_AS_GOOD = 0.02  # of the squared error: plays on a grid tell delays no better
_DECAYED = 10.0  # time constants: what the dynamics did before has gone
_RADII = np.geomspace(0.01, 0.95, 24)  # of half the range of the drive


def starts_of_known(
    front: Family, dynamics: LinearDynamics, data: Data, size: int
) -> Sequence[Start]:
    """Give hysteresis to start from before dynamics that are held, the best first.

    Parameters
    ----------
    front
        The hysteresis.
    dynamics
        Known, of gain 1 at rest.
    data
        The records.
    size
        One of the sizes of the hysteresis.

    Raises
    ------
    NotIdentifiableError
        If the records do not show this hysteresis.
    """
    behind = [signal_of_plays(data, dynamics), signal_behind(data, dynamics)]
    fronts = fronts_before(front, dynamics, behind, data, size)
    return [joint_held(each, dynamics) for each in fronts]


def fronts_before(
    front: Family, dynamics: LinearDynamics, signals: Sequence[Data], data: Data, size: int
) -> list[Start]:
    """Fit the hysteresis to signals behind it, what explains the output best first.

    Parameters
    ----------
    front
        The hysteresis.
    dynamics
        What stands between the signals and the output.
    signals
        Records with what may be behind the hysteresis as their output.
    data
        The records.
    size
        One of the sizes of the hysteresis.

    Raises
    ------
    NotIdentifiableError
        If no signal shows this hysteresis.
    """
    fronts: list[Start] = []
    refusal: NotIdentifiableError | None = None
    for behind in signals:
        try:
            fronts += first_fronts(front, Overview(behind, rates_matter=True), size)
        except NotIdentifiableError as why:
            refusal = why
    if not fronts:
        assert refusal is not None, "either there is a start or why there is none"
        raise refusal
    short = shortened(data, _WARM_UP)

    def error(start: Start) -> float:
        whole, theta = joint_held(start, dynamics)
        residual = problem_of(short, whole).residual(whole.canonical(theta))
        return float(residual @ residual)

    return sorted(fronts, key=error)


def held_dynamics(given: GivenDynamics, overview: Overview) -> LinearDynamics:
    """Give the dynamics to hold: with the delay that is given, or the one that the records say.

    Parameters
    ----------
    given
        The dynamics.
    overview
        The records, and what the user says of the delay.

    Raises
    ------
    InputError
        If a delay is given that is not the one the dynamics have.
    """
    dynamics, wanted = given.at(overview.data.records[0].dt), overview.delay
    if wanted == AUTO:
        if given.says_delay:
            return dynamics
        return late(dynamics, int(_as_good(_costs_of_delays(overview.data, dynamics))[0]))
    delay = as_whole_number(wanted, "delay", 0, MOST_DELAY, " samples, or 'auto'")
    if dynamics.delay not in (0, delay):
        raise InputError(
            f"delay is {delay}, and the dynamics that are given have {dynamics.delay} samples; "
            "leave out delay"
        )
    return late(dynamics, delay)


def late(dynamics: LinearDynamics, delay: int) -> LinearDynamics:
    """Give dynamics with a delay."""
    G = dynamics
    return LinearDynamics(G.A, G.B, G.C, G.D, G.dt, delay)


def told_of_delay(given: GivenDynamics, held: LinearDynamics, data: Data) -> tuple[str, ...]:
    """Say which delay was taken beside dynamics that know of none, and which would do as well.

    Parameters
    ----------
    given
        The dynamics as they were given.
    held
        As they were held.
    data
        The records.
    """
    if given.says_delay:
        return ()
    costs = _costs_of_delays(data, late(held, 0))
    as_good = _as_good(costs)
    sure = as_good.size == 1 and as_good[0] == held.delay
    doubt = (
        "no other describes the records as well"
        if sure
        else f"{as_good.min()} to {as_good.max()} samples describe the records about as well, so "
        "give it as delay where you know it, or drive with several rates"
    )
    return (
        f"a delay of {held.delay} samples stands beside the dynamics that were given, which say "
        f"none: {doubt}",
    )


def _as_good(costs: Array) -> NDArray[np.intp]:
    """Give the delays that describe the records about as well as the best."""
    return np.flatnonzero(costs <= costs.min() * (1.0 + _AS_GOOD))


def _costs_of_delays(data: Data, dynamics: LinearDynamics) -> Array:
    """Give what plays before the dynamics leave, for delays from 0 on."""
    data = shortened(data, max(_WARM_UP // len(data.records), 1))
    filtered = [filtered_by(plays_of(each.u, data.half_range), dynamics) for each in data.records]
    longest = min(min(len(each) for each in filtered) // 4, MOST_DELAY)
    target, costs = data.measured(), list[float]()
    while len(costs) <= min(int(np.argmin([*costs, np.inf])) + _NO_BETTER, longest):
        columns = data.joined(
            [
                np.concatenate([np.repeat(each[:1], len(costs), axis=0), each])[window]
                for each, window in zip(filtered, data.windows(), strict=True)
            ]
        )
        left = target - columns @ best_weights(columns, target)
        costs.append(float(left @ left))
    return np.array(costs)


def filtered_by(bank: Array, dynamics: LinearDynamics) -> Array:
    """Give what dynamics answer to each column.

    Parameters
    ----------
    bank
        Shape (N, m).
    dynamics
        Stable.
    """
    return np.column_stack([dynamics(column) for column in bank.T])


def best_weights(columns: Array, target: Array) -> Array:
    """Give the weights of columns by least squares.

    Parameters
    ----------
    columns, target
        Shapes (N, m) and (N,).
    """
    scale = np.maximum(np.linalg.norm(columns, axis=0), np.finfo(np.float64).tiny)
    return np.asarray(scipy.linalg.lstsq(columns / scale, target)[0] / scale)


def signal_of_plays(data: Data, dynamics: LinearDynamics) -> Data:
    """Give the records of the hysteresis alone, as plays before known dynamics would have them.

    Parameters
    ----------
    data
        The records.
    dynamics
        Known, of gain 1 at rest.
    """
    data = shortened(data, max(LONGEST_START // len(data.records), 1))
    banks = [plays_of(each.u, data.half_range) for each in data.records]
    filtered = [
        filtered_by(bank, dynamics)[window]
        for bank, window in zip(banks, data.windows(), strict=True)
    ]
    columns, target = data.joined(filtered), data.measured()
    weights = best_weights(columns, target)
    records = tuple(
        replace(record, y=bank @ weights) for record, bank in zip(data.records, banks, strict=True)
    )
    return replace(data, records=records, lag=0.0, kept=(), disturbances=())


def settled(data: Data, dynamics: LinearDynamics) -> Data:
    """Leave out samples that the unknown state of the dynamics may have disturbed.

    Parameters
    ----------
    data
        The records.
    dynamics
        Known.
    """
    slowest = float(np.abs(dynamics.poles()[0])) if dynamics.order else 0.0
    most = dynamics.delay + (int(min(_DECAYED / -np.log(slowest), 1e9)) if slowest > 0.0 else 0)
    starts = tuple(
        max(start, min(most, len(record) // 4))
        for start, record in zip(data.starts, data.records, strict=True)
    )
    return replace(data, starts=starts)


def plays_of(u: Array, half_range: float) -> Array:
    """Give the drive, its plays on a grid of radii and a constant, shape (N, m).

    Parameters
    ----------
    u
        Shape (N,).
    half_range
        Of the drives of all records.
    """
    radii = half_range * _RADII
    plays = np.empty((u.size, radii.size))
    _engine.play_outputs(radii.tolist(), np.zeros(radii.size), np.ascontiguousarray(u), plays)
    return np.column_stack([u, plays, np.ones(u.size)])
