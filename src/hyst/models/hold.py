"""Between continuous time and samples whose input is held, with any part of a sample of dead time.

Time is counted in samples. With L the continuous state matrix, b its input column, c its row, and a
dead time of ``d - g`` samples, d whole and 0 <= g < 1, a held input changes the system g samples
before each sampling instant. Hence, with ``J(t) = int_0^t exp(L s) ds``,

    A = exp(L),  B = J(1) exp(L g) b,  D = c J(g) b + feedthrough,  delay d

which has one numerator coefficient more than without g. The way back is ``L = log(A)`` and
``b = exp(-L g) J(1)^-1 B``, where g solves ``D = c int_0^g exp(-L s) ds J(1)^-1 B``.
"""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_not_negative
from hyst.errors import InputError, NotInvertibleError
from hyst.models.matrices import LARGEST_DELAY
from hyst.models.realizations import Matrices, companion, zero_order_hold

Array = NDArray[np.float64]

_AT_ZERO = 1e-9
_ON_THE_AXIS = 1e-6  # radians: two equal poles there come out of rounding as a pair beside it
_NEGLIGIBLE = 1e-12
_KEPT = 1e-8  # what exp(log(A)) may differ from A by
_STEEPEST = 7  # of a higher relative degree, D is rounding
_WHOLE = 1e-9  # samples: what is left of a whole number after a division by dt
_GRID = 256
_SAME, _FLAT, _ROUNDING = 1e-9, 1e-6, 1e-13  # of D, and of the size of the system


def held_late(num: ArrayLike, den: ArrayLike, dt: float, delay: float) -> tuple[Matrices, int]:
    """Sample ``num(s)/den(s)`` with a dead time, the input being held between samples.

    Parameters
    ----------
    num, den
        Coefficients in descending powers of s.
    dt
        Sample time, s, > 0.
    delay
        Dead time in samples, whole or not.

    Returns
    -------
    A, B, C, D
    delay : int
        Whole samples; the matrices hold what is left.

    Raises
    ------
    InputError
        As ``companion``, or if the delay is negative or above a million.
    """
    import scipy.linalg  # slow, and few models need it

    late = as_not_negative(delay, "delay", "samples")
    if late > LARGEST_DELAY:
        raise InputError(f"delay is {late:.6g} samples; it may be {LARGEST_DELAY} at most")
    whole = round(late) if abs(late - round(late)) <= _WHOLE else math.ceil(late)
    ahead = max(whole - late, 0.0)
    A, B, C, D = zero_order_hold(num, den, dt)
    if ahead <= _WHOLE or B.size == 0:
        return (A, B, C, D), whole
    L, b = _continuous(num, den, dt)
    part, rest = _held(L, b, ahead)[1], _held(L, b, 1.0 - ahead)
    # Over a sample the old value acts first, and exp(L g) of it is left at the end.
    old = scipy.linalg.expm(L * ahead) @ rest[1]
    return (A, old + A @ part, C, float(C @ part) + D), whole


def _continuous(num: ArrayLike, den: ArrayLike, dt: float) -> tuple[Array, Array]:
    """Give L and b in the coordinates of ``zero_order_hold``."""
    below = np.trim_zeros(np.atleast_1d(np.asarray(den, dtype=np.float64)), "f")
    L, b, _, _ = companion([1.0], below * dt ** np.arange(below.size))
    return L, b


def _held(L: Array, b: Array, time: float) -> tuple[Array, Array]:
    """Give ``exp(L t)`` and ``int_0^t exp(L s) ds b``."""
    import scipy.linalg  # slow, and few models need it

    n = b.size
    block = np.zeros((n + 1, n + 1))
    block[:n, :n], block[:n, n] = L * time, b * time
    sampled = scipy.linalg.expm(block)
    return sampled[:n, :n], sampled[:n, n]


def released(
    A: Array, B: Array, C: Array, D: float, delay: int, split: bool
) -> tuple[Matrices, float]:
    """Give the continuous system whose zero-order hold a sampled one is, its time in samples.

    Parameters
    ----------
    A, B, C, D, delay
        Of the sampled system; the delay in samples.
    split
        Whether a feedthrough behind a delay is to be told as a part of a sample of dead time, where
        there is a system without feedthrough that has it.

    Returns
    -------
    A, B, C, D
    delay : float
        Samples.

    Raises
    ------
    NotInvertibleError
        If a pole lies at 0 or on the negative real axis, or the logarithm of A loses its digits.
    """
    import scipy.linalg  # slow, and few models need it

    _refuse_what_is_never_held(A)
    n = B.size
    if n == 0:
        return (A, B, C, D), float(delay)
    balanced, (scale, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
    L, b, c = _logarithm(balanced), B / scale, C * scale
    integral = np.array([_held(L, column, 1.0)[1] for column in np.eye(n)]).T
    b = np.linalg.solve(integral, b)
    size = max(abs(D), float(np.linalg.norm(b) * np.linalg.norm(c)))
    ahead = 0.0
    if abs(D) <= _NEGLIGIBLE * size:
        D = 0.0
    elif split and delay > 0:
        ahead = _change_before_sampling(L, b, c, D)
    if ahead > 0.0:
        D, b = 0.0, scipy.linalg.expm(-L * ahead) @ b
    return (L, b, c, D), delay - ahead


def _refuse_what_is_never_held(A: Array) -> None:
    for pole in np.linalg.eigvals(A):
        if abs(pole) <= _AT_ZERO:
            raise NotInvertibleError(
                f"the pole {pole:.6g} lies at 0, where no continuous system has one when it is "
                "sampled: it is a dead time, so give it as delay"
            )
        if math.pi - abs(math.atan2(pole.imag, pole.real)) <= _ON_THE_AXIS:
            raise NotInvertibleError(
                f"the pole {pole.real:.6g} lies on the negative real axis, where no continuous "
                "system of this order has one when it is sampled with a hold"
            )


def _logarithm(A: Array) -> Array:
    import scipy.linalg  # slow, and few models need it

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what it warns of is checked below
        L = scipy.linalg.logm(A)
    real = np.ascontiguousarray(np.real(L))
    error = float(np.abs(scipy.linalg.expm(real) - A).max() / np.abs(A).max())
    if not error <= _KEPT:
        raise NotInvertibleError(
            f"the logarithm of A keeps it to {error:.2g} only, where {_KEPT:g} is wanted: poles "
            "lie too close together; give the system in coordinates of modes"
        )
    return real


def _change_before_sampling(L: Array, b: Array, c: Array, D: float) -> float:
    """Give the g above 0, below 1, at which ``c int_0^g exp(-L s) ds b`` is D; 0 if there is none.

    The output of a system of relative degree r begins with r - 1 derivatives that are 0, so that g
    is a root r times over: it is found where the last of them changes its sign, the largest r
    first. Of several, the least g is taken, the longest dead time.
    """
    size = float(np.linalg.norm(b) * np.linalg.norm(c))
    grid = np.arange(_GRID + 1) / _GRID
    states = _along(L, b)
    rows = [c @ np.linalg.matrix_power(-L, j) for j in range(b.size)]

    def beginning(degree: int, g: float) -> float:
        """Give what is missing of D for degree 0, else the derivative of this degree."""
        if degree == 0:
            return float(c @ _held(-L, b, g)[1]) - D
        return float(rows[degree - 1] @ _held(-L, b, g)[0] @ b)

    for last in range(min(b.size - 1, _STEEPEST), -1, -1):
        values = states[1] @ c - D if last == 0 else states[0] @ rows[last - 1]
        for k in np.flatnonzero((values[:-1] * values[1:] <= 0.0) & (values[:-1] != values[1:])):
            ends = float(grid[k]), float(grid[k + 1])
            g = _between(functools.partial(beginning, last), *ends)
            misses = abs(beginning(0, g)) <= _SAME * abs(D) + _ROUNDING * size
            slopes = max((abs(beginning(j, g)) for j in range(1, last)), default=0.0)
            if 0.0 < g < 1.0 and misses and slopes <= _FLAT * abs(D) + _ROUNDING * size:
                return g
    return 0.0


def _between(function: Callable[[float], float], low: float, high: float) -> float:
    """Give the root between two ends; that end which is one, to rounding."""
    import scipy.optimize  # slow, and few models need it

    at_low, at_high = function(low), function(high)
    if at_low * at_high >= 0.0:
        return low if abs(at_low) < abs(at_high) else high
    return float(scipy.optimize.brentq(function, low, high, xtol=1e-15, rtol=1e-14))


def _along(L: Array, b: Array) -> tuple[Array, Array]:
    """Give ``exp(-L g) b`` and its integral from 0 over the grid of g, shapes (grid + 1, n)."""
    step, jump = _held(-L, b, 1.0 / _GRID)
    states, sums = [b], [np.zeros(b.size)]
    for _ in range(_GRID):
        states.append(step @ states[-1])
        sums.append(step @ sums[-1] + jump)
    return np.array(states), np.array(sums)
