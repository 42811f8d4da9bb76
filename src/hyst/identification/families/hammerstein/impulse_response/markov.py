"""Step 1: the impulse response between input and output, by least squares on a long FIR model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.signals import Record, persistence
from hyst.signals.lagged import lagged_factor, lagged_gram

Array = NDArray[np.float64]

ORDERS = (16, 32, 64, 128, 256, 512)
"""Tried one after the other where the order is to be chosen."""

_LARGEST_CONDITION = 1e12  # of the normal equations; beyond, a QR factor is used
_ILL_CONDITIONED = 1e6  # of the regressors; beyond, errors of the output drown the response
_DEAD_TAIL = 1e-3  # share of the energy
_ENOUGH = 1e-3  # share of the residual variance that the next order must explain
_LIVE_TAIL = 0.05
_BY_CHANCE = 2.0  # mean square of parameters that are 0, in standard errors: 1, hardly ever 2


@dataclass(frozen=True, eq=False)
class MarkovParameters:
    """Estimate of ``y_k = offset + sum_{i=0}^{mu} H_i u_{k-i} + e_k``.

    Parameters
    ----------
    values
        Shape (mu + 1,), H_0 .. H_mu. Behind a map without memory and a Gaussian white input they
        are those of the linear dynamics up to one unknown factor (Bussgang). Hysteresis remembers
        and adds slow parts that do not fall with the number of samples, only with an amplitude that
        is large beside its radii (S0 eq. 39): plays of 0.05 to 0.8 leave 0.067, 0.030, 0.018 of H_0
        at the next lags with an rms of 0.3, and 0.020, 0.002 with an rms of 3.
    standard_errors
        Shape (mu + 1,), as if the residual, distortion included, were white.
    offset
        Output units.
    residual_rms
        Output units; noise, nonlinear distortion and what lies beyond mu.
    condition
        Of the regressors.
    samples
        Rows.
    """

    values: Array
    standard_errors: Array
    offset: float
    residual_rms: float
    condition: float
    samples: int

    @property
    def order(self) -> int:
        """The last lag mu."""
        return int(self.values.size) - 1

    @property
    def tail(self) -> float:
        """Share of the energy in the last quarter: what has not died out."""
        energy = np.square(self.values)
        return float(energy[-max(energy.size // 4, 1) :].sum() / energy.sum())


def fit_markov(records: Record | Sequence[Record], order: int, start: int = 0) -> MarkovParameters:
    """Estimate the Markov parameters from one or more records.

    Parameters
    ----------
    records
        Of one system, with one sample time.
    order
        mu, the last lag.
    start
        First sample of each record to use as input.

    Returns
    -------
    MarkovParameters

    Raises
    ------
    InputError
        If a record is not longer than the order, the order is no number >= 0, or there is no
        record.
    NotIdentifiableError
        If the inputs do not excite all lags; rank and condition are told.

    Notes
    -----
    S0 eqs. 17-25, with an offset. The normal equations are summed without forming the regressors;
    where they are ill-conditioned, QR factors of blocks are used.

    Examples
    --------
    >>> u = np.random.default_rng(0).normal(size=200)
    >>> y = 3.0 + 2.0 * u + np.append(0.0, u[:-1])
    >>> (np.round(fit_markov(Record(u, y, 0.1), 2).values, 9) + 0.0).tolist()
    [2.0, 1.0, 0.0]
    """
    given = [records] if isinstance(records, Record) else list(records)
    if not given:
        raise InputError("no record is given; give at least one")
    if isinstance(order, bool) or not isinstance(order, int | np.integer) or order < 0:
        raise InputError(f"order is {order!r}; give the last lag, a whole number, at least 0")
    shortest = min(len(record) for record in given) - start
    if shortest < 2 * (order + 2):
        raise InputError(
            f"a record has {shortest} usable samples, but an impulse response of order {order} "
            f"needs at least {2 * (order + 2)}; give a longer record or lower fir_order"
        )
    width = order + 2
    gram, moment, power, rows = np.zeros((width, width)), np.zeros(width), 0.0, 0
    for record in given:
        u, y = record.u[start:], record.y[start:]
        part, right = lagged_gram(u, y, order)
        gram, moment = gram + part, moment + right
        power, rows = power + float(y[order:] @ y[order:]), rows + u.size - order
    scale = np.sqrt(np.maximum(np.diag(gram), np.finfo(np.float64).tiny))
    scaled = gram / np.outer(scale, scale)
    condition = float(np.linalg.cond(scaled))
    if condition < _LARGEST_CONDITION:
        solution = scipy.linalg.solve(scaled, moment / scale, assume_a="pos") / scale
        inverse = np.linalg.inv(scaled) / np.outer(scale, scale)
    else:
        solution, inverse = _by_qr(given, order, start, scale)
    residual = max(power - float(solution @ (2.0 * moment - gram @ solution)), 0.0)
    variance = residual / max(rows - width, 1)
    errors = np.sqrt(variance * np.maximum(np.diag(inverse), 0.0))
    return MarkovParameters(
        values=solution[:-1],
        standard_errors=errors[:-1],
        offset=float(solution[-1]),
        residual_rms=float(np.sqrt(variance)),
        condition=float(np.sqrt(condition)),
        samples=rows,
    )


def choose_markov(
    records: Sequence[Record], order: int | str, start: int = 0
) -> tuple[MarkovParameters, tuple[str, ...]]:
    """Estimate the Markov parameters; choose the order if it is ``"auto"``.

    Orders are doubled until the next one explains no more than a thousandth of what is left.

    Parameters
    ----------
    records
        Of one system.
    order
        mu, or ``"auto"``.
    start
        First sample of each record to use as input.

    Returns
    -------
    MarkovParameters
    tuple of str
        A sentence if the inputs excite barely as many lags as were taken.

    Raises
    ------
    InputError, NotIdentifiableError
        As ``fit_markov``; if the response does not die out within the largest order; and if the
        order is to be chosen and the inputs do not excite as many lags as the response has.
    """
    if order != "auto":
        found = _died_out(fit_markov(records, _as_order(order), start), chosen=False)
        if found.condition <= _ILL_CONDITIONED:
            return found, ()
        why = _weakly_excited(records, found.order, start, found.condition)
        return found, (f"{why}; trust G only where the input has power",)
    longest = min(len(record) for record in records) - start
    if longest < 2 * (ORDERS[0] + 2):
        raise NotIdentifiableError(
            f"a record has {longest} usable samples, too few for an impulse response of order "
            f"{ORDERS[0]}; give a longer record, or fir_order yourself"
        )
    orders = [each for each in ORDERS if 8 * (each + 2) <= longest] or [ORDERS[0]]
    best, why = _excited(records, orders[0], start)
    if best is None:
        raise NotIdentifiableError(f"{why}, or give fir_order yourself")
    for larger in orders[1:]:
        next_one, why = _excited(records, larger, start)
        if next_one is None:
            return _usable(best, why)
        if next_one.residual_rms**2 > best.residual_rms**2 * (1.0 - _ENOUGH) and (
            best.tail < _DEAD_TAIL
        ):
            break
        best = next_one
    return _died_out(best, chosen=True), ()


def markov_if_excited(records: Sequence[Record], order: int | str) -> MarkovParameters | None:
    """Estimate the Markov parameters for comparison; None where the inputs do not determine them.

    Parameters
    ----------
    records, order
        As of ``choose_markov``.
    """
    try:
        if order != "auto":
            return choose_markov(records, order)[0]
        return _longest_excited(records)
    except (InputError, NotIdentifiableError):
        return None


def _longest_excited(records: Sequence[Record]) -> MarkovParameters | None:
    """Give the shortest response that has died out; None where the inputs excite none so long."""
    longest = min(len(record) for record in records)
    for order in ORDERS:
        if 8 * (order + 2) > longest:
            return None
        found = fit_markov(records, order)
        if found.condition > _ILL_CONDITIONED:
            return None
        if found.tail < _DEAD_TAIL:
            return found
    return None


def _excited(
    records: Sequence[Record], order: int, start: int
) -> tuple[MarkovParameters | None, str]:
    """Give the estimate, or None and why the inputs do not determine it."""
    try:
        found = fit_markov(records, order, start)
    except NotIdentifiableError:
        return None, _weakly_excited(records, order, start, _ILL_CONDITIONED)
    if found.condition > _ILL_CONDITIONED:
        return None, _weakly_excited(records, order, start, found.condition)
    return found, ""


def _weakly_excited(records: Sequence[Record], order: int, start: int, least: float) -> str:
    """Tell rank and condition, which is at least so large, and what to change."""
    each = [persistence(record.u[start:], order) for record in records]
    best = min(each, key=lambda one: one.condition)
    condition = max(best.condition, least)
    return (
        f"the input hardly excites an impulse response of order {order}: rank {best.rank} of "
        f"{order + 1}, condition {condition:.2g} where {_ILL_CONDITIONED:.0e} is the most; "
        "drive a wider band, up to half the sample rate, or sample more slowly"
    )


def _usable(found: MarkovParameters, why: str) -> tuple[MarkovParameters, tuple[str, ...]]:
    """Keep a shorter response if it has died out; refuse it otherwise."""
    last = slice(-max(found.values.size // 4, 1), None)
    # A residual of exactly 0 says no more than that it is below the rounding of the response.
    real = np.finfo(np.float64)
    rounding = max(float(real.eps * np.abs(found.values).max()), float(real.tiny))
    errors = np.maximum(found.standard_errors[last], rounding)
    by_chance = float(np.mean(np.square(found.values[last] / errors))) < _BY_CHANCE
    if found.tail >= _DEAD_TAIL and not (by_chance and found.tail <= _LIVE_TAIL):
        raise NotIdentifiableError(
            f"{why}, or give fir_order yourself; {found.order} lags, which it does excite, are too "
            "few: the response has not died out"
        )
    return found, (f"{why}; {found.order} lags were taken, and what comes later is not known",)


def _died_out(found: MarkovParameters, chosen: bool) -> MarkovParameters:
    if found.tail > _LIVE_TAIL and found.order > 3:
        what = "the largest order tried" if chosen else "fir_order"
        raise NotIdentifiableError(
            f"the impulse response has not died out after {found.order} samples ({what}): its last "
            f"quarter holds {100.0 * found.tail:.3g} % of the energy; raise fir_order, sample more "
            "slowly, or take out a drift: unstable or integrating dynamics are not identified"
        )
    return found


def _as_order(order: int | str) -> int:
    if isinstance(order, bool) or not isinstance(order, int | np.integer) or not 1 <= order <= 5000:
        raise InputError(f"fir_order is {order!r}; give 1 to 5000, or 'auto'")
    return int(order)


def _by_qr(records: Sequence[Record], order: int, start: int, scale: Array) -> tuple[Array, Array]:
    for record in records:
        found = persistence(record.u[start:], order)
        if not found.sufficient and len(records) == 1:
            raise NotIdentifiableError(f"the input is {found.advice()}")
    factors = [lagged_factor(r.u[start:], r.y[start:], order) for r in records]
    factor = np.asarray(np.linalg.qr(np.concatenate(factors), mode="r"))
    triangle, target = factor[:-1, :-1] / scale, factor[:-1, -1]
    values = np.linalg.svd(triangle, compute_uv=False)
    if values[-1] <= 1e-10 * values[0]:
        rank = int((values > 1e-10 * values[0]).sum())
        raise NotIdentifiableError(
            f"the inputs are not persistently exciting for order {order}: rank {rank} of "
            f"{order + 2}; give inputs with more frequencies up to half the sample rate, sample "
            "more slowly, or lower fir_order"
        )
    inverse = np.linalg.inv(triangle)
    solution = inverse @ target / scale
    return solution, inverse @ inverse.T / np.outer(scale, scale)
