"""How far the rate of the input widens the thresholds of plays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_number
from hyst.errors import InputError
from hyst.models.rate_law_tables import (
    RATIONAL,
    require_form,
    saturating_table,
    square_root_table,
)
from hyst.operators.parameters import Parameters, numbered

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False)
class RateCurve:
    """Widening over the rate ``x = |du/dt|``: a polynomial plus ramps, 0 at rest.

        g(x) = beta x + c_2 x^2 + c_3 x^3 + .. + sum_j b_j max(x - x_j, 0)

    Where the sum is negative, g is 0. Slopes may be such that it falls, which no physical law does;
    tables are refused if they fall.

    Parameters
    ----------
    beta
        Coefficient of the rate, >= 0, seconds.
    powers
        Shape (m,), coefficients c_2, c_3, .., >= 0.
    slopes, knees
        Shape (j,), what is added to the slope beyond each knee, and the knees, input units per
        second, > 0.

    Raises
    ------
    InputError
        If beta or a power is negative, a knee is not positive, the lengths of slopes and knees
        differ, or a number is not finite.

    Notes
    -----
    S4 eqs. 19 and 24.

    Examples
    --------
    >>> RateCurve.table([0.0, 100.0, 300.0], [0.0, 1.0, 2.0])([50.0, 200.0, 500.0])
    array([0.5, 1.5, 3. ])
    """

    beta: float
    powers: Array
    slopes: Array
    knees: Array

    def __init__(
        self,
        beta: float,
        powers: ArrayLike = (),
        slopes: ArrayLike = (),
        knees: ArrayLike = (),
    ) -> None:
        linear, c = as_number(beta, "beta"), as_constants(powers, "powers")
        b, x = as_constants(slopes, "slopes"), as_constants(knees, "knees")
        if linear < 0.0:
            raise InputError(
                f"beta is {linear}; thresholds cannot shrink with the rate, so give "
                "zero or a positive number"
            )
        if c.size and c.min() < 0.0:
            bad = int(np.flatnonzero(c < 0.0)[0])
            raise InputError(f"powers[{bad}] is {c[bad]}; give coefficients that are not negative")
        if b.size != x.size:
            raise InputError(f"{b.size} slopes but {x.size} knees; give one for each")
        if x.size and x.min() <= 0.0:
            bad = int(np.flatnonzero(x <= 0.0)[0])
            raise InputError(f"knees[{bad}] is {x[bad]}; a knee is a positive rate")
        object.__setattr__(self, "beta", linear)
        object.__setattr__(self, "powers", c)
        object.__setattr__(self, "slopes", b)
        object.__setattr__(self, "knees", x)

    @classmethod
    def polynomial(cls, coefficients: ArrayLike) -> RateCurve:
        """Give ``g(x) = c_1 x + c_2 x^2 + ..``.

        Parameters
        ----------
        coefficients
            Shape (m,), m >= 1: c_1, c_2, .., none negative.

        Returns
        -------
        RateCurve

        Raises
        ------
        InputError
            If there is no coefficient, or one is negative or not finite.
        """
        c = as_constants(coefficients, "coefficients")
        if c.size == 0:
            raise InputError("a polynomial of the rate needs at least one coefficient")
        return cls(float(c[0]), c[1:])

    @classmethod
    def table(cls, rates: ArrayLike, widenings: ArrayLike) -> RateCurve:
        """Give the curve that is straight between given points and goes on as it ends.

        Parameters
        ----------
        rates
            Shape (m,), m >= 2, ascending from 0, input units per second.
        widenings
            Shape (m,), not falling, from 0, input units.

        Returns
        -------
        RateCurve

        Raises
        ------
        InputError
            If the lengths differ, there are fewer than two points, the first is not (0, 0), the
            rates do not ascend or the widenings fall.
        """
        x, g = as_constants(rates, "rates"), as_constants(widenings, "widenings")
        if x.size != g.size or x.size < 2:
            raise InputError(
                f"{x.size} rates and {g.size} widenings; give as many of each, at least two"
            )
        if x[0] != 0.0 or g[0] != 0.0:
            raise InputError(f"the first point is ({x[0]}, {g[0]}); at rest nothing widens: (0, 0)")
        if np.diff(x).min() <= 0.0 or np.diff(g).min() < 0.0:
            raise InputError("rates must ascend and widenings must not fall; sort the points")
        slopes = np.diff(g) / np.diff(x)
        return cls(float(slopes[0]), (), np.diff(slopes), x[1:-1])

    @classmethod
    def square_root(cls, coefficient: float, fastest: float) -> RateCurve:
        """Give ``g(x) = coefficient sqrt(x)`` as a table of straight pieces.

        The pieces are off by less than 0.1 % of ``g(fastest)`` anywhere up to ``fastest``, and
        steepest at rest, with a finite slope; beyond ``fastest`` the last one goes on.

        Parameters
        ----------
        coefficient
            >= 0, input units times the root of (seconds per input unit).
        fastest
            Rate up to which the table follows the law, > 0, input units per second.

        Returns
        -------
        RateCurve

        Raises
        ------
        InputError
            If the coefficient is negative, ``fastest`` is not positive, or one is not finite.

        Examples
        --------
        >>> bool(abs(RateCurve.square_root(0.5, 1e4)(2500.0) - 25.0) < 0.03)
        True
        """
        c, end = _as_growing(coefficient, "coefficient"), _as_rate(fastest, "fastest")
        x, g = square_root_table()
        return cls.table(end * x, c * np.sqrt(end) * g)

    @classmethod
    def saturating(
        cls, slope: float, rate: float, fastest: float, form: str = RATIONAL
    ) -> RateCurve:
        """Give a widening that approaches ``slope rate`` at high rates, as a table.

        ``"rational"``: ``g(x) = slope x / (1 + x / rate)``; ``"exponential"``:
        ``g(x) = slope rate (1 - exp(-x / rate))``. The pieces are off by less than 0.2 % of
        ``slope rate`` anywhere up to ``fastest``; beyond it the last one goes on.

        Parameters
        ----------
        slope
            Of g at rest, >= 0, seconds.
        rate
            At which the curve has bent, > 0, input units per second.
        fastest
            Rate up to which the table follows the law, > 0, input units per second.
        form
            ``"rational"`` or ``"exponential"``.

        Returns
        -------
        RateCurve

        Raises
        ------
        InputError
            If the slope is negative, a rate is not positive, or the form is unknown.

        Examples
        --------
        >>> curve = RateCurve.saturating(0.002, 100.0, 1e3)
        >>> bool(abs(curve(1e3) - 0.2 / 1.1) < 4e-4)
        True
        """
        a, b = _as_growing(slope, "slope"), _as_rate(rate, "rate")
        end = _as_rate(fastest, "fastest")
        x, g = saturating_table(end / b, require_form(form))
        return cls.table(b * x, a * b * g)

    def __call__(self, rate: ArrayLike) -> Array:
        """Give the widening.

        Parameters
        ----------
        rate
            Any shape, input units per second; its sign does not matter.

        Returns
        -------
        numpy.ndarray
            In the shape of ``rate``, input units, >= 0.
        """
        x = np.abs(np.asarray(rate, dtype=np.float64))
        slope = np.zeros_like(x)
        for coefficient in self.powers[::-1]:
            slope = (slope + coefficient) * x
        ramps = np.maximum(x[..., None] - self.knees, 0.0) @ self.slopes
        return np.maximum((slope + self.beta) * x + ramps, 0.0)

    @property
    def is_zero(self) -> bool:
        """Whether nothing widens at any rate."""
        return self.beta == 0.0 and not self.powers.any() and not (self.slopes > 0.0).any()

    @property
    def is_linear(self) -> bool:
        """Whether beta says it all."""
        return not self.powers.any() and not self.slopes.any()

    def steepest(self) -> float:
        """Give the largest slope at any rate, seconds; infinity for a curve with powers."""
        if self.powers.any():
            return float("inf")
        return float(self._slopes().max())

    def lipschitz_constant(self) -> float:
        """Give the largest size of a slope, falling or not; infinity for a curve with powers."""
        return float("inf") if self.powers.any() else float(np.abs(self._slopes()).max())

    def _slopes(self) -> Array:
        """Give the slopes of the pieces of a curve without powers, shape (j + 1,)."""
        order = np.argsort(self.knees, kind="stable")
        return np.cumsum(np.concatenate([[self.beta], self.slopes[order]]))

    def scaled(self, factor: float) -> RateCurve:
        """Give ``factor g``.

        Parameters
        ----------
        factor
            >= 0.

        Returns
        -------
        RateCurve
        """
        return RateCurve(factor * self.beta, factor * self.powers, factor * self.slopes, self.knees)

    def parameters(self) -> Parameters:
        """Give beta, the powers, then the slopes; the knees stay as they are."""
        return Parameters(
            values=np.concatenate([[self.beta], self.powers, self.slopes]),
            names=(
                "beta",
                *numbered("powers", self.powers.size, 2),
                *numbered("slopes", self.slopes.size),
            ),
            lower=np.concatenate(
                [np.zeros(1 + self.powers.size), -np.full(self.slopes.size, np.inf)]
            ),
            upper=np.full(1 + self.powers.size + self.slopes.size, np.inf),
        )

    def with_parameters(self, theta: Array) -> RateCurve:
        """Give a curve of the same knees with other coefficients.

        Parameters
        ----------
        theta
            beta, then the powers, then the slopes, in one vector.
        """
        m = 1 + self.powers.size
        return RateCurve(float(theta[0]), theta[1:m], theta[m:], self.knees)

    def to_dict(self) -> dict[str, Any]:
        """Give the entries of a model file; those that are empty are left out."""
        more = {"powers": self.powers, "slopes": self.slopes, "knees": self.knees}
        return {"beta": self.beta} | {key: v.tolist() for key, v in more.items() if v.size}


def _as_growing(value: float, name: str) -> float:
    number = as_number(value, name)
    if number < 0.0:
        raise InputError(
            f"{name} is {number}; thresholds cannot shrink with the rate, so give zero or a "
            "positive number"
        )
    return number


def _as_rate(value: float, name: str) -> float:
    number = as_number(value, name)
    if number <= 0.0:
        raise InputError(f"{name} is {number}; give a positive rate, input units per second")
    return number
