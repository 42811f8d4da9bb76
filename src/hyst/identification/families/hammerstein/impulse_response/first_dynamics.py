"""The first four steps, from the impulse response to the signal behind the hysteresis.

1. Markov parameters by least squares on a long FIR model; 2. a state space from them; 3. its stable
noncausal inverse; 4. the signal behind the hysteresis.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import NotIdentifiableError, NotInvertibleError
from hyst.identification.families.hammerstein.impulse_response.markov import MarkovParameters
from hyst.identification.families.hammerstein.impulse_response.realization import (
    Realization,
    realize,
)
from hyst.identification.families.option import AUTO
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics, StableInverse
from hyst.signals import Record

Array = NDArray[np.float64]

LONGEST_START = 20_000
"""Samples a first hysteresis is fitted to; the joint fit takes them all."""

MOST_DELAY = 10_000

_SIGNIFICANT = 4.0  # standard errors
_NEGLIGIBLE = 0.02  # of the largest Markov parameter


def delay_of(markov: MarkovParameters, wanted: float | str) -> int:
    """Give whole samples before the response begins; one is left to a strictly proper system.

    Parameters
    ----------
    markov
        The impulse response.
    wanted
        Samples, or ``"auto"``.

    Raises
    ------
    InputError
        If what is wanted is no number of samples.
    """
    if wanted != AUTO:
        return as_whole_delay(wanted)
    size = np.abs(markov.values)
    floor = np.maximum(_SIGNIFICANT * markov.standard_errors, _NEGLIGIBLE * size.max())
    begun = np.flatnonzero(size > floor)
    return max(int(begun[0]) - 1, 0) if begun.size else 0


def as_whole_delay(wanted: float | str) -> int:
    """Give a delay that was asked for.

    Parameters
    ----------
    wanted
        Samples.

    Raises
    ------
    InputError
        If it is no whole number of samples.
    """
    return as_whole_number(wanted, "delay", 0, MOST_DELAY, " samples, or 'auto'")


def orders_to_try(
    markov: MarkovParameters, delay: int, dt: float, state_order: int | str
) -> Sequence[int]:
    """Give numbers of states, ascending.

    Hysteresis itself looks like slow dynamics to the first step, so the singular values only bound
    the order from above.

    Parameters
    ----------
    markov, delay
        The impulse response.
    dt
        Sample time, s.
    state_order
        What is wanted: a number or ``"auto"``.
    """
    if state_order != AUTO:
        return (int(state_order),)
    return range(1, _realized(markov, delay, dt, AUTO).dynamics.order + 1)


def realized(markov: MarkovParameters, delay: int, dt: float, order: int) -> Realization:
    """Give a state space of gain 1 at rest.

    Parameters
    ----------
    markov, delay
        The impulse response.
    dt
        Sample time, s.
    order
        Number of states.

    Raises
    ------
    NotIdentifiableError
        If the gain at rest is next to nothing.
    """
    found = _realized(markov, delay, dt, order)
    return replace(found, dynamics=of_gain_one(found.dynamics))


def _realized(
    markov: MarkovParameters, delay: int, dt: float, state_order: int | str
) -> Realization:
    values, errors = markov.values[delay:], markov.standard_errors[delay:]
    feedthrough = abs(values[0]) > max(
        _SIGNIFICANT * errors[0], _NEGLIGIBLE * float(np.abs(values).max())
    )
    found = realize(values, dt, state_order, float(np.median(errors)), bool(feedthrough))
    G = found.dynamics
    return replace(found, dynamics=LinearDynamics(G.A, G.B, G.C, G.D, dt, delay))


def of_gain_one(dynamics: LinearDynamics) -> LinearDynamics:
    """Scale dynamics to a gain of 1 at rest.

    Parameters
    ----------
    dynamics
        Stable.

    Raises
    ------
    NotIdentifiableError
        If the gain at rest is next to nothing.
    """
    gain = dynamics.dc_gain()
    peak = float(np.abs(dynamics.impulse_response(64)).sum())
    if abs(gain) < 1e-3 * peak:
        raise NotIdentifiableError(
            f"the gain of the dynamics at rest is {gain:.3g}, next to nothing beside "
            f"{peak:.3g} in all; an actuator or sensor that does not pass constant values cannot "
            "be split into hysteresis and dynamics of DC gain 1"
        )
    return dynamics.in_units(1.0, 1.0 / gain)


def inverse_of(dynamics: LinearDynamics) -> tuple[StableInverse | None, tuple[str, ...]]:
    """Give the stable inverse, of a band only if a zero at high frequency forbids it for all.

    Parameters
    ----------
    dynamics
        Stable.

    Returns
    -------
    StableInverse or None
    tuple of str
        A sentence if it is limited or there is none.
    """
    try:
        return StableInverse.of(dynamics, tolerance=1e-9), ()
    except NotInvertibleError as error:
        zeros = dynamics.zeros()
        near = zeros[np.abs(np.abs(zeros) - 1.0) < 1e-2]
        frequency = float(np.abs(np.angle(near)).min(initial=np.pi)) / (2 * np.pi * dynamics.dt)
        if frequency > 0.02 / dynamics.dt:
            band = 0.7 * frequency
            return StableInverse.of(dynamics, tolerance=1e-9, band=band), (
                f"{error}; the loop was estimated below {band:.4g} Hz only",
            )
        return None, (f"{error}; so the loop could not be estimated without a model",)


def signal_behind(data: Data, dynamics: LinearDynamics) -> Data:
    """Give the records of the hysteresis alone: the input, and what the dynamics were driven by.

    Parameters
    ----------
    data
        The records.
    dynamics
        Of gain 1 at rest.

    Returns
    -------
    Data
        Of the beginning of each record. Where there is no inverse, or the records are too short for
        it, the delayed output serves as a guess.
    """
    data = shortened(data, max(LONGEST_START // len(data.records), 1))
    inverse, _ = inverse_of(dynamics)
    if inverse is None:
        return data.delayed(dynamics.delay)
    records, starts = [], []
    for record, start in zip(data.records, data.starts, strict=True):
        valid = inverse.valid(len(record))
        if valid.stop - max(valid.start, start) >= 4:
            v = inverse(record.y)
            records.append(Record(record.u[: valid.stop], v[: valid.stop], record.dt))
            starts.append(max(valid.start, start))
    if not records:
        return data.delayed(dynamics.delay)
    return replace(
        data, records=tuple(records), starts=tuple(starts), lag=0.0, kept=(), disturbances=()
    )


def behind_operator(data: Data, hysteresis: Callable[[Array], Array]) -> Data:
    """Give the records of the hysteresis alone: the input, and what a model of it makes of it.

    Parameters
    ----------
    data
        The records.
    hysteresis
        The model.
    """
    data = shortened(data, max(LONGEST_START // len(data.records), 1))
    records = tuple(replace(each, y=hysteresis(each.u)) for each in data.records)
    return replace(data, records=records, lag=0.0, kept=(), disturbances=())


def shortened(data: Data, samples: int) -> Data:
    """Keep the beginning of the records, so many samples of each after its start.

    Parameters
    ----------
    data
        The records.
    samples
        Of each.

    Returns
    -------
    Data
        ``data`` itself if its records are no longer than that.
    """
    if all(len(r) - s <= samples for r, s in zip(data.records, data.starts, strict=True)):
        return data
    records = tuple(
        r.slice(0, min(len(r), s + samples)) for r, s in zip(data.records, data.starts, strict=True)
    )
    kept = tuple(
        None if each is None else each[: len(r)]
        for each, r in zip(data.kept, records, strict=False)
    )
    return replace(data, records=records, kept=kept, disturbances=())
