"""Laws of the widening over the rate, with the few constants that each leaves free.

A law is a ``RateCurve`` of fixed knees. Its coefficients, beta and the changes of slope, are an
affine function of the law's constants: exactly so where these only scale it, and along the tangent
where the rate at which it bends is one of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.used_samples import Data
from hyst.models import RateCurve
from hyst.models.rate_law_tables import (
    EXPONENTIAL,
    RATIONAL,
    saturating_law,
    saturating_law_slope,
    saturating_table,
    square_root_table,
)

Array = NDArray[np.float64]

LINEAR, SQRT, SATURATING, PIECEWISE = "linear", "sqrt", "saturating", "piecewise"
LAWS = (LINEAR, SQRT, SATURATING, PIECEWISE)

BEYOND = 2.0
"""Times the fastest rate of the records, up to which a table follows its law: a command that is
found from the model may ask for more than the records did."""

MOST_PIECES = 8

APART = 1.15
"""Least ratio of two knees, and of the fastest rate to the last one."""

_SLOWEST, _STRAIGHTEST = 1.0 / 200.0, 20.0
"""Bounds of the rate at which a law bends, over the fastest rate of the records."""

_STEP = 2.0
"""Factor by which that rate may move along one tangent."""


@dataclass(frozen=True, eq=False)
class RateLaw:
    """A curve and how its coefficients follow from the constants that are free.

    Parameters
    ----------
    name
        One of ``LAWS``.
    form
        Of a saturating one; else empty.
    fastest
        Rate that the constants without a unit are shares of, input units per second.
    curve
        With the knees; its coefficients are replaced.
    transform, fixed
        Shapes (coefficients, k) and (coefficients,): beta and slopes by the free constants.
    lower, upper
        Shape (k,), bounds of the free constants.
    renewed
        Gives the law with the tangent at other free constants; None where there is nothing to
        renew.
    """

    name: str
    form: str
    fastest: float
    curve: RateCurve
    transform: Array
    fixed: Array
    lower: Array
    upper: Array
    renewed: Callable[[Array], RateLaw] | None = None

    @property
    def size(self) -> int:
        """Number of free constants."""
        return int(self.lower.size)

    def at(self, constants: Array) -> RateCurve:
        """Give the curve of free constants."""
        return self.curve.with_parameters(self.fixed + self.transform @ constants)

    def widening(self, constants: Array) -> float:
        """Give the widening at the fastest rate of the records."""
        return float(self.at(constants)(self.fastest))


def linear_law(fastest: float) -> RateLaw:
    """Give ``g(x) = beta x``; its constant is beta.

    Parameters
    ----------
    fastest
        Of the records, input units per second.
    """
    return RateLaw(
        LINEAR,
        "",
        fastest,
        RateCurve(0.0),
        np.ones((1, 1)),
        np.zeros(1),
        np.zeros(1),
        np.full(1, np.inf),
    )


def square_root_law(fastest: float) -> RateLaw:
    """Give ``g(x) = a fastest sqrt(x / fastest)``; its constant is a, seconds.

    Parameters
    ----------
    fastest
        Of the records, input units per second.
    """
    x, root = square_root_table()
    # Up to the end of the table, so that a is the mean slope up to the fastest rate.
    end = BEYOND * fastest
    by_values = _coefficients(end * x) * fastest
    transform = by_values @ (np.sqrt(BEYOND) * root[1:, None])
    return RateLaw(
        SQRT,
        "",
        fastest,
        RateCurve(0.0, (), np.zeros(x.size - 2), end * x[1:-1]),
        transform,
        np.zeros(x.size - 1),
        np.zeros(1),
        np.full(1, np.inf),
    )


def saturating_rate_law(fastest: float, form: str, constants: Array) -> RateLaw:
    """Give the tangent of a saturating law; its constants are slope at rest and rate over fastest.

    Parameters
    ----------
    fastest
        Of the records, input units per second.
    form
        ``"rational"`` or ``"exponential"``.
    constants
        Shape (2,), where the tangent is taken.
    """
    slope, bend = float(constants[0]), float(np.clip(constants[1], _SLOWEST, _STRAIGHTEST))
    x, reached = saturating_table(BEYOND / bend, form)
    steep = saturating_law_slope(x, form)
    # At knees that stay where they are: g = slope bend h(rate / bend).
    by_slope, by_bend = bend * reached, slope * (reached - x * steep)
    by_values = _coefficients(fastest * bend * x) * fastest
    transform = by_values @ np.stack([by_slope, by_bend], axis=1)[1:]
    return RateLaw(
        SATURATING,
        form,
        fastest,
        RateCurve(0.0, (), np.zeros(x.size - 2), fastest * bend * x[1:-1]),
        transform,
        by_values @ (slope * by_slope)[1:] - transform @ np.array([slope, bend]),
        np.array([0.0, max(bend / _STEP, _SLOWEST)]),
        np.array([np.inf, min(bend * _STEP, _STRAIGHTEST)]),
        lambda there: saturating_rate_law(fastest, form, there),
    )


def piecewise_law(data: Data, fastest: float) -> RateLaw:
    """Give a curve of straight pieces; its constants are their slopes, seconds, none negative.

    Parameters
    ----------
    data
        Their rates say where the knees are: as many samples of each record lie between two.
    fastest
        Of the records, input units per second.
    """
    knees = _knees(data)
    pieces = knees.size + 1
    return RateLaw(
        PIECEWISE,
        "",
        fastest,
        RateCurve(0.0, (), np.zeros(knees.size), knees),
        np.eye(pieces) - np.eye(pieces, k=-1),
        np.zeros(pieces),
        np.zeros(pieces),
        np.full(pieces, np.inf),
    )


def first_constants(law: RateLaw, widening: float, bend: float) -> Array:
    """Give constants of a first guess.

    Parameters
    ----------
    law
        The law, whose tangent need not be there.
    widening
        At the fastest rate of the records, input units.
    bend
        Rate at which it bends over the fastest one; infinity for a straight line.
    """
    mean = widening / law.fastest
    if law.name in (LINEAR, SQRT):
        return np.array([mean])
    if law.name == SATURATING:
        return np.array(
            [mean / (bend * float(saturating_law(np.array(1.0 / bend), law.form))), bend]
        )
    places = np.concatenate([[0.0], law.curve.knees, [law.fastest]])
    if np.isinf(bend):
        return np.full(law.size, mean)
    values = saturating_law(places / law.fastest / bend, RATIONAL)
    return np.asarray(widening / values[-1] * np.diff(values) / np.diff(places))


def bends_to_try(law: RateLaw) -> tuple[float, ...]:
    """Give rates over the fastest one at which a law may bend in a first guess."""
    if law.name == SATURATING:
        return (0.03, 0.15, 0.7)
    return (np.inf, 0.05) if law.name == PIECEWISE else (np.inf,)


def law_for(name: str, form: str, data: Data) -> RateLaw:
    """Give a law for records, a saturating one with its tangent anywhere.

    Parameters
    ----------
    name, form
        Of the law.
    data
        The records.
    """
    fastest = fastest_rate(data)
    if name == SQRT:
        return square_root_law(fastest)
    if name == SATURATING:
        return saturating_rate_law(fastest, form, np.ones(2))
    return piecewise_law(data, fastest) if name == PIECEWISE else linear_law(fastest)


def forms_of(name: str) -> tuple[str, ...]:
    """Give the forms that a law comes in."""
    return (RATIONAL, EXPONENTIAL) if name == SATURATING else ("",)


def fastest_rate(data: Data) -> float:
    """Give the fastest rate of the inputs, input units per second."""
    return max(float(np.abs(np.diff(each.u)).max()) / each.dt for each in data.records)


def _coefficients(places: Array) -> Array:
    """Give what makes beta and changes of slope of the values at all places but the first, 0."""
    pieces = places.size - 1
    slopes = (np.eye(pieces) - np.eye(pieces, k=-1)) / np.diff(places)[:, None]
    changes: Array = slopes - np.concatenate([np.zeros((1, pieces)), slopes[:-1]])
    return changes


def _knees(data: Data) -> Array:
    """Quantiles of the rates, every record counting the same, not too close to one another."""
    rates = [np.abs(np.diff(each.u)) / each.dt for each in data.records]
    weights = np.concatenate([np.full(each.size, 1.0 / each.size) for each in rates])
    pooled = np.concatenate(rates)
    order = np.argsort(pooled, kind="stable")
    share = np.cumsum(weights[order]) / len(rates)
    wanted = np.arange(1.0, MOST_PIECES) / MOST_PIECES
    at = np.minimum(np.searchsorted(share, wanted), pooled.size - 1)
    knees: list[float] = []
    for each in pooled[order][at]:
        if each > APART * (knees[-1] if knees else 0.0) and APART * each < pooled.max():
            knees.append(float(each))
    return np.array(knees)
