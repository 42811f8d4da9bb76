"""First guesses of a butterfly: where a material switches, how steeply, and how unevenly.

An envelope that is steep at two inputs, one on either side, makes the state of plays switch at the
one while the input rises and at the other while it falls. For each such guess the coefficients of
the map are a linear least squares problem.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.butterfly_layout import Hysteresis, parametrize_butterfly
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import model_output, problem_of
from hyst.identification.record_use.overview import Overview
from hyst.models.butterfly import terms
from hyst.operators import Operator

Array = NDArray[np.float64]

_COERCIVE = (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
_WIDTHS = (0.05, 0.15, 0.4)
_BIASES = (-0.4, -0.15, 0.0, 0.15, 0.4)
"""Of the envelope, over half the input range."""

_RADII = ((0.25, 0.75), (0.02, 0.4))
"""Narrowest and widest of the plays of a guess, over half the input range: 0.5 switches where half
of either step is passed; narrow ones go along with the envelope, as in what hardly remembers."""

_PLAYS_OF_A_GRID = 2
_TRIED, _STEPS_TRIED = 4, 40
_CURVE_DEGREE = 12


def best_guesses(
    overview: Overview, plays: int, knots: int, degree: int, most: int
) -> list[Hysteresis]:
    """Give guesses of a butterfly, the best first.

    Parameters
    ----------
    overview
        The records.
    plays
        How many.
    knots
        Of the envelope.
    degree
        Of the map.
    most
        How many guesses.

    Returns
    -------
    list of Hysteresis
    """
    places = overview.once(
        ("butterfly", knots, degree), lambda: _places_of_switching(overview, knots, degree)
    )
    first = _first(overview, knots, degree)
    return [_guess(overview, first, each, plays) for each in places[:most]]


def residual_of_a_curve(overview: Overview) -> float:
    """Give the root mean square that a polynomial of the input alone leaves.

    Parameters
    ----------
    overview
        The records.
    """
    x = (overview.input - overview.input.mean()) / overview.data.half_range
    columns = np.polynomial.chebyshev.chebvander(x / np.abs(x).max(), _CURVE_DEGREE)
    return _fitted(columns, overview.data.measured())[1]


_Place = tuple[float, float, float, tuple[float, float]]


def _places_of_switching(overview: Overview, knots: int, degree: int) -> list[_Place]:
    """Give where and how steeply the material may switch, and its plays, the best first.

    Neighbours on the grid end in the same minimum: it is the best of every place of switching.
    """
    first = _first(overview, knots, degree)
    best = []
    for coercive in _COERCIVE:
        here = [
            (coercive, width, bias, radii)
            for radii in _RADII
            for width in _WIDTHS
            for bias in _BIASES
        ]
        left = [_guess(overview, first, each, _PLAYS_OF_A_GRID).residual for each in here]
        at = int(np.argmin(left))
        best.append((left[at], here[at]))
    places = [place for _, place in sorted(best)]
    # What is nearest at first may end in a minimum of its own: the best few are gone on with.
    tried = [(_cost(overview, first, each), each) for each in places[:_TRIED]]
    return [place for _, place in sorted(tried)] + places[_TRIED:]


def _cost(overview: Overview, first: Hysteresis, place: _Place) -> float:
    """Give what a guess with few plays leaves after a few steps."""
    guess = _guess(overview, first, place, _PLAYS_OF_A_GRID)
    parametrization, theta = parametrize_butterfly(guess)
    problem = problem_of(overview.data, parametrization, overview.kept)
    return minimize(problem, theta, _STEPS_TRIED).cost


def _first(overview: Overview, knots: int, degree: int) -> Hysteresis:
    """Give the range and the knots of the envelope, the rest to be filled in."""
    records = overview.data.records
    low, high = min(float(r.u.min()) for r in records), max(float(r.u.max()) for r in records)
    places = np.linspace(low, high, knots + 2)[1:-1]
    places = places[np.abs(places) > 1e-6 * (high - low)]
    none = np.empty(0)
    return Hysteresis(low, high, places, none, none, none, np.zeros((degree + 1, degree + 1)))


def _guess(overview: Overview, first: Hysteresis, place: _Place, plays: int) -> Hysteresis:
    """Give a guess with plays evenly between two radii and the best coefficients of its map."""
    coercive, width, bias, (narrow, wide) = place
    r = first.half * (narrow + (wide - narrow) * (np.arange(plays) + 0.5) / plays)
    slopes = _slopes(first, coercive, width, bias)
    return _with_map(overview, replace(first, slopes=slopes, p=np.ones(plays), r=r))


def _slopes(first: Hysteresis, coercive: float, width: float, bias: float) -> Array:
    """Give the slopes of an envelope with a step on either side of the middle of the input."""
    half, middle = 0.5 * (first.high - first.low), 0.5 * (first.high + first.low)
    ends = np.concatenate([[first.low], first.knots, [first.high]])
    x = (ends - middle) / half - bias
    steps = np.tanh((x - coercive) / width) + np.tanh((x + coercive) / width)
    return np.asarray(np.diff(steps) / np.diff(ends))


def _with_map(overview: Overview, guess: Hysteresis) -> Hysteresis:
    """Give the guess with the best coefficients of its map."""
    degree = guess.c.shape[0] - 1
    c, residual = coefficients_of(overview, guess.model().hysteresis, degree)
    return replace(guess, c=c, residual=residual)


def coefficients_of(overview: Overview, hysteresis: Operator, degree: int) -> tuple[Array, float]:
    """Give the best coefficients of a map of a hysteresis and the input, and what it leaves.

    Parameters
    ----------
    overview
        The records.
    hysteresis
        What makes the state.
    degree
        Of the map.

    Returns
    -------
    c : numpy.ndarray
        Shape (degree + 1, degree + 1).
    residual : float
        Root mean square.
    """
    z, half = model_output(overview.data, hysteresis), overview.data.half_range
    x, (i, j) = overview.input / half, terms(degree)
    columns = np.column_stack([x**a * z**b for a, b in zip(i, j, strict=True)])
    coefficients, residual = _fitted(columns, overview.data.measured())
    c = np.zeros((degree + 1, degree + 1))
    c[i, j] = coefficients
    return c / half ** np.arange(degree + 1.0)[:, None], residual


def _fitted(columns: Array, y: Array) -> tuple[Array, float]:
    scale = np.maximum(np.abs(columns).max(axis=0), np.finfo(np.float64).tiny)
    coefficients = np.linalg.lstsq(columns / scale, y, rcond=1e-9)[0] / scale
    return coefficients, float(np.sqrt(np.mean((columns @ coefficients - y) ** 2)))
