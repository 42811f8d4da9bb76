"""The classical Q-filters: low passes of gain 1 at zero, of chosen order and relative degree."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_array
from hyst.checks.numbers import as_positive, whole_number
from hyst.control.linear_system import LinearSystem, transfer_function_of
from hyst.control.q_filters.realization import shared_realization
from hyst.control.zeros_and_poles import Points, ZerosAndPoles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

COEFFICIENTS = ("binomial", "butterworth")
LARGEST_ORDER = 12


@final
@dataclass(frozen=True, eq=False)
class QFilter:
    """A Q-filter: a stable low pass with Q(0) = 1, or Q(1) = 1 if it is sampled.

    ``Q = gain prod(s - zeros) / prod(s - poles)``

    Parameters
    ----------
    factors
        Zeros, poles (1/s, or in the z plane) and gain.
    tau
        Its time constant, s; None if it has none of its own.
    dt
        Sample time, s; 0 means continuous time.
    """

    factors: ZerosAndPoles
    tau: float | None = None
    dt: float = 0.0

    @property
    def order(self) -> int:
        """Number of poles, m."""
        return int(self.factors.poles.size)

    @property
    def relative_degree(self) -> int:
        """By how many poles it has more than zeros, rho."""
        return int(self.factors.poles.size - self.factors.zeros.size)

    @property
    def numerator(self) -> Array:
        """Polynomial above, highest power first."""
        return np.real(self.factors.gain * np.atleast_1d(np.poly(self.factors.zeros)))

    @property
    def denominator(self) -> Array:
        """Polynomial below, highest power first, monic."""
        return np.real(np.atleast_1d(np.poly(self.factors.poles)))

    @property
    def system(self) -> LinearSystem:
        """The same in state space."""
        scale = unit_of(self.factors.poles, self.dt)
        above = scaled_polynomial(self.factors.zeros, scale)
        gain = self.factors.gain * scale ** (-self.relative_degree)
        return shared_realization(self.factors.poles, [gain * above], scale, self.dt)

    def response(self, s: Points) -> ComplexArray:
        """Values of the filter, (K,).

        Parameters
        ----------
        s
            Complex numbers, 1/s; z if it is sampled.
        """
        return self.factors.response(np.asarray(s, dtype=np.complex128))

    def as_control(self) -> Any:
        """Give the ``control.TransferFunction``, continuous; a sampled one as ``control.ss``.

        Raises
        ------
        MissingExtraError
            If python-control is not installed.
        """
        if self.dt:
            return self.system.as_control()
        return transfer_function_of(self.numerator, self.denominator)


def q_filter(
    order: int,
    *,
    tau: float,
    relative_degree: int | None = None,
    coefficients: str | ArrayLike = "binomial",
    kept_zeros: Sequence[complex] | ComplexArray = (),
) -> QFilter:
    r"""Give the Q-filter of the literature with one time constant.

    ``Q(s) = [1 + sum_{k=1}^{m-rho} a_k (tau s)^k] / [1 + sum_{k=1}^{m} a_k (tau s)^k]``

    With binomial a_k the denominator is (tau s + 1)^m; with relative_degree = order the numerator
    is 1. Every power more in the numerator rejects one more power of time: 1 - Q starts with
    s^(m - rho + 1).

    Parameters
    ----------
    order
        m, 1 to 12.
    tau
        Time constant, s, > 0.
    relative_degree
        rho, 1 to order, at least that of the plant; the order if left out.
    coefficients
        ``"binomial"``, ``"butterworth"``, or a_1 .. a_m, each > 0.
    kept_zeros
        Zeros of a plant that Q must have, 1/s, in conjugate pairs: those that the inverse of the
        plant must not have as poles. The numerator is then kept(s) l(s), with l the lowest powers
        of denominator / kept, so that 1 - Q still starts as high as m - rho minus their number
        allows.

    Returns
    -------
    QFilter

    Raises
    ------
    InputError
        If order or relative degree are out of range, tau is not above 0, the coefficients are of
        another number, not above 0 or make an unstable filter, or a kept zero is 0, has no
        conjugate or leaves no room in the order.

    Source
    ------
    El-Shaer, Al Janaideh, Krejci and Tomizuka 2013, eq. 28. Positive a_k alone do not make it
    stable from order 3 on, which is checked here.

    Examples
    --------
    >>> Q = q_filter(3, relative_degree=2, tau=0.5)
    >>> Q.numerator.round(9).tolist(), Q.denominator.round(9).tolist()
    ([12.0, 8.0], [1.0, 6.0, 12.0, 8.0])
    """
    m = whole_number(order, "order", 1, LARGEST_ORDER)
    rho = m if relative_degree is None else whole_number(relative_degree, "relative_degree", 1)
    if rho > m:
        raise InputError(
            f"relative_degree is {rho}, above the order {m}; raise the order or lower it"
        )
    time = as_positive(tau, "tau", "a time in seconds")
    a, poles = _denominator(coefficients, m)
    kept = _checked_zeros(kept_zeros)
    if kept.size > m - rho:
        raise InputError(
            f"{kept.size} kept zeros and relative degree {rho} need order {kept.size + rho} at "
            f"least, not {m}; raise the order"
        )
    return with_numerator(np.concatenate([[1.0], a]), poles, m - rho, kept, time)


def with_numerator(
    a: Array, poles: ComplexArray, degree: int, kept: ComplexArray, tau: float
) -> QFilter:
    """Give the filter whose numerator matches as many powers of the denominator as it can.

    Parameters
    ----------
    a
        Denominator in x = tau s, lowest power first: 1, a_1, ..
    poles
        Its roots, in x.
    degree
        Of the numerator, the kept zeros among it.
    kept
        Zeros it must have, 1/s.
    tau
        Time constant, s.
    """
    # kept(s)/kept(0) as a polynomial in x = tau s, lowest power first.
    fixed = np.array([1.0])
    if kept.size:
        fixed = np.real(np.poly(1.0 / (tau * kept)))
    free = _series(a, fixed, degree - kept.size)
    zeros = np.roots(free[::-1]).astype(complex) if free.size > 1 else np.zeros(0, complex)
    top = float(free[-1] * np.real(np.prod(-1.0 / (tau * kept)))) / float(a[-1])
    gain = top * tau ** (zeros.size + kept.size - poles.size)
    return QFilter(ZerosAndPoles(np.concatenate([zeros / tau, kept]), poles / tau, gain), tau)


def _series(above: Array, below: Array, degree: int) -> Array:
    """Give the powers 0 to degree of the power series above / below, where below starts with 1."""
    found = np.zeros(degree + 1)
    for k in range(degree + 1):
        value = above[k] if k < above.size else 0.0
        for j in range(1, min(k, below.size - 1) + 1):
            value -= below[j] * found[k - j]
        found[k] = value
    # A leading zero would be a zero at infinity.
    return found if found[-1] != 0.0 or degree == 0 else np.trim_zeros(found, "b")


def _denominator(coefficients: str | ArrayLike, m: int) -> tuple[Array, ComplexArray]:
    """a_1 .. a_m, and the poles for tau = 1."""
    if isinstance(coefficients, str):
        if coefficients not in COEFFICIENTS:
            raise InputError(
                f"coefficients is {coefficients!r}; give one of {', '.join(COEFFICIENTS)} or "
                "a_1 .. a_m"
            )
        if coefficients == "binomial":
            return np.array([math.comb(m, k) for k in range(1, m + 1)], float), -np.ones(m, complex)
        poles = -np.exp(1j * np.pi * (np.arange(m) - 0.5 * (m - 1)) / m)
        poles = np.where(np.abs(poles.imag) < 1e-12, poles.real, poles)
        return np.real(np.poly(poles))[-2::-1], poles.astype(complex)
    a = finite_array(coefficients, "coefficients").ravel()
    if a.size != m:
        raise InputError(f"coefficients has {a.size} numbers; give {m}, a_1 to a_{m}")
    if a.min() <= 0.0:
        raise InputError(
            f"coefficients[{int(a.argmin())}] is {a.min():g}; a stable filter needs all above 0"
        )
    poles = np.roots(np.concatenate([a[::-1], [1.0]])).astype(complex)
    if poles.real.max() >= 0.0:
        worst = poles[np.argmax(poles.real)]
        raise InputError(
            f"the coefficients make an unstable filter, pole at {worst.real:.4g} "
            f"{worst.imag:+.4g}j in units of 1/tau; raise those in the middle"
        )
    return a, poles


def _checked_zeros(kept_zeros: Sequence[complex] | ComplexArray) -> ComplexArray:
    kept = np.atleast_1d(np.asarray(kept_zeros, dtype=np.complex128)).ravel()
    if not np.isfinite(kept).all():
        raise InputError(
            "a kept zero is not finite; leave those at infinity to the relative degree"
        )
    if kept.size and np.abs(kept).min() == 0.0:
        raise InputError("a kept zero is 0, where Q must be 1; no filter can do both")
    for value in kept[kept.imag != 0.0]:
        if not np.isclose(kept, np.conj(value), rtol=1e-9).any():
            raise InputError(f"the kept zero {value:.6g} has no conjugate; give both")
    return kept


def unit_of(roots: ComplexArray, dt: float = 0.0) -> float:
    """Give a power of two in the middle of the roots of continuous polynomials; 1 if sampled.

    Parameters
    ----------
    roots
        1/s.
    dt
        Sample time, s; 0 means continuous time.
    """
    size = np.abs(roots)
    size = size[size > 0.0]
    if dt or not size.size:
        return 1.0
    return float(2.0 ** round(float(np.mean(np.log2(size)))))


def scaled_polynomial(roots: ComplexArray, scale: float) -> Array:
    """Give prod(s - roots) in powers of s/scale, monic in it, highest first."""
    return np.real(np.atleast_1d(np.poly(roots / scale)))
