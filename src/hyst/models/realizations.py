"""From transfer functions, zeros and poles, and continuous time to the matrices of a state space.

Matrices are those of ``x_{k+1} = A x_k + B u_k, y_k = C x_k + D u_k`` with one input and one
output: A (n, n), B and C (n,), D a number.
"""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_number
from hyst.errors import InputError

Array = NDArray[np.float64]
Matrices = tuple[Array, Array, Array, float]
Group = tuple[complex, ...]


def companion(num: ArrayLike, den: ArrayLike) -> Matrices:
    """Realize ``(num_0 z^m + .. + num_m) / (den_0 z^n + .. + den_n)``, m <= n, in companion form.

    Parameters
    ----------
    num, den
        Coefficients in descending powers; leading zeros are dropped.

    Returns
    -------
    A, B, C, D

    Raises
    ------
    InputError
        If the denominator is zero or of lower degree than the numerator.

    Examples
    --------
    >>> A, B, C, D = companion([1.0, 0.5], [1.0, -0.9])
    >>> A.tolist(), B.tolist(), [round(each, 12) for each in C.tolist()], D
    ([[0.9]], [1.0], [1.4], 1.0)
    """
    above = np.trim_zeros(as_constants(num, "num"), "f")
    below = np.trim_zeros(as_constants(den, "den"), "f")
    if below.size == 0:
        raise InputError("den is zero; give the denominator of a transfer function")
    if above.size > below.size:
        raise InputError(
            f"num has degree {above.size - 1}, den {below.size - 1}; a transfer function of higher "
            "degree above than below looks into the future"
        )
    a = below / below[0]
    b = np.concatenate([np.zeros(below.size - above.size), above]) / below[0]
    n = a.size - 1
    A = np.zeros((n, n))
    if n:
        A[0], A[1:, :-1] = -a[1:], np.eye(n - 1)
    B = np.zeros(n)
    B[:1] = 1.0
    return A, B, b[1:] - b[0] * a[1:], float(b[0])


def zero_order_hold(num: ArrayLike, den: ArrayLike, dt: float) -> Matrices:
    """Sample ``num(s)/den(s)`` whose input is held between samples.

    ``[Ad Bd; 0 1] = exp([Ac Bc; 0 0] dt)``, formed in units of ``dt`` so that coefficients of very
    different size, usual for fast actuators, do no harm.

    Parameters
    ----------
    num, den
        Coefficients in descending powers of s (1/s).
    dt
        Sample time, s, > 0.

    Returns
    -------
    A, B, C, D

    Raises
    ------
    InputError
        As ``companion``.
    """
    import scipy.linalg  # slow, and few models need it

    above = np.trim_zeros(as_constants(num, "num"), "f")
    below = np.trim_zeros(as_constants(den, "den"), "f")
    scale = float(as_number(dt, "dt")) ** np.arange(max(above.size, below.size, 1))
    A, B, C, D = companion(above * scale[: above.size], below * scale[: below.size])
    if above.size:
        # Both polynomials were divided by a power of s of their own degree.
        ratio = dt ** (below.size - above.size)
        C, D = C * ratio, D * ratio
    n = B.size
    block = np.zeros((n + 1, n + 1))
    block[:n, :n], block[:n, n] = A, B
    sampled = scipy.linalg.expm(block)
    return sampled[:n, :n], sampled[:n, n], C, D


def sections_of(zeros: ArrayLike, poles: ArrayLike, gain: float) -> Array:
    """Pair zeros and poles into second-order sections.

    ``gain prod(z - z_i) / prod(z - p_i)``; each pole, from the one nearest to the unit circle on,
    takes the zero nearest to it.

    Parameters
    ----------
    zeros, poles
        Complex ones in conjugate pairs; no more zeros than poles.
    gain
        Factor of the whole.

    Returns
    -------
    numpy.ndarray
        Shape (count, 5): b0 b1 b2 a1 a2 of ``(b0 + b1 q^-1 + b2 q^-2)/(1 + a1 q^-1 + a2 q^-2)``.

    Raises
    ------
    InputError
        If there are more zeros than poles or a complex one lacks its conjugate.

    Examples
    --------
    >>> (sections_of([], [0.5, -0.5], 3.0) + 0.0).tolist()
    [[0.0, 0.0, 3.0, 0.0, -0.25]]
    """
    below, above = _conjugate_pairs(poles, "poles"), _conjugate_pairs(zeros, "zeros")
    count = sum(len(each) for each in above)
    if count > sum(len(each) for each in below):
        raise InputError(f"there are {count} zeros but fewer poles; it would look into the future")
    below.sort(key=lambda pair: -max(abs(pole) for pole in pair))
    sections = np.zeros((len(below), 5))
    for index, (row, pair) in enumerate(zip(sections, below, strict=True)):
        fitting = [each for each in above if len(each) <= len(pair)]
        doubles: list[Group] = [each for each in fitting if len(each) == 2]
        if len(doubles) == sum(len(each) == 2 for each in below[index:]):
            fitting = doubles or fitting  # else two zeros would be left for a single pole
        nothing: Group = ()
        taken = min(fitting, key=functools.partial(_distance, pair), default=nothing)
        if taken:
            above.remove(taken)
        b = np.poly(np.array(taken)).real
        a = np.poly(np.array(pair)).real
        row[len(pair) - len(taken) : len(pair) + 1] = b
        row[3 : 3 + len(pair)] = a[1:]
    if len(sections) == 0:
        return np.array([[float(gain), 0.0, 0.0, 0.0, 0.0]])
    sections[0, :3] *= float(gain)
    return sections


def cascade(sections: Array) -> Matrices:
    """Realize second-order sections one after the other.

    Parameters
    ----------
    sections
        Shape (count, 5), as ``sections_of`` gives them.

    Returns
    -------
    A, B, C, D
        Section by section in transposed direct form II; a section of one pole has one state.
    """
    A, B, C, D = np.zeros((0, 0)), np.zeros(0), np.zeros(0), 1.0
    for b0, b1, b2, a1, a2 in sections:
        count = 1 if b2 == a2 == 0.0 else 2
        a = np.array([[-a1, 1.0], [-a2, 0.0]])[:count, :count]
        b, c = np.array([b1 - a1 * b0, b2 - a2 * b0])[:count], np.array([1.0, 0.0])[:count]
        n = B.size
        joined = np.zeros((n + count, n + count))
        joined[:n, :n], joined[n:, :n], joined[n:, n:] = A, np.outer(b, C), a
        A, B, C, D = joined, np.concatenate([B, b * D]), np.concatenate([b0 * C, c]), b0 * D
    return A, B, C, float(D)


def _distance(pair: Group, other: Group) -> float:
    return abs(other[0] - pair[0])


def _conjugate_pairs(values: ArrayLike, name: str) -> list[Group]:
    """Group conjugates; real ones two by two where the list is even, the rest alone."""
    given = np.atleast_1d(np.asarray(values, dtype=np.complex128))
    if given.ndim != 1 or not np.isfinite(given).all():
        raise InputError(f"{name} must be a list of finite numbers")
    tiny = 1e-9 * (1.0 + np.abs(given))
    reals = sorted(given[np.abs(given.imag) <= tiny].real.tolist(), key=abs, reverse=True)
    upper = [complex(each) for each in given[given.imag > tiny]]
    lower = [complex(each) for each in given[given.imag < -tiny]]
    pairs: list[Group] = []
    for each in upper:
        partner = min(lower, key=lambda other: abs(other - each.conjugate()), default=None)
        if partner is None or abs(partner - each.conjugate()) > 1e-6 * (1.0 + abs(each)):
            raise InputError(f"{name} has {each:.6g} without its conjugate; give both")
        lower.remove(partner)
        pairs.append((each, each.conjugate()))
    if lower:
        raise InputError(f"{name} has {lower[0]:.6g} without its conjugate; give both")
    pairs += [tuple(map(complex, reals[i : i + 2])) for i in range(0, len(reals), 2)]
    return pairs
