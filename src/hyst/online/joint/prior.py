"""What is believed about a model before the first sample, as factors of a covariance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def radii_covariance(r: Array, spread: float) -> Array:
    """Give the covariance of ordered radii.

    The gaps ``r_i - r_{i-1}`` are believed to be off by the share ``spread``, independently. So
    radii stay in their order to all that is believed, which independent radii would not.

    Parameters
    ----------
    r
        Shape (n,), ascending.
    spread
        Standard error over gap; a gap below a twentieth of the mean one counts as that.

    Returns
    -------
    numpy.ndarray
        Shape (n, n).

    Examples
    --------
    >>> radii_covariance(np.array([1.0, 3.0]), 0.5)
    array([[0.25, 0.25],
           [0.25, 1.25]])
    """
    gaps = np.diff(r, prepend=0.0)
    least = 0.05 * float(r[-1]) / r.size if r.size else 0.0
    sums = np.tril(np.ones((r.size, r.size)))
    return np.asarray(sums * (spread * np.maximum(gaps, least)) ** 2 @ sums.T)


def start_covariance(
    theta: Array,
    plays: int,
    radius_spread: float,
    weight_spread: float,
    offset_spread: float,
    free: NDArray[np.bool_],
) -> Array:
    """Give the covariance of all parameters of a model, in the core's order.

    Parameters
    ----------
    theta
        Shape (m,).
    plays
        n.
    radius_spread, weight_spread
        Standard errors over values: of the gaps between radii and of the weights. Weights get a
        little of their sum besides, so that one that starts at 0 can grow.
    offset_spread
        Standard error of the offset.
    free
        Shape (m,), what is estimated.

    Returns
    -------
    numpy.ndarray
        Shape (m, m), zero where held.

    Examples
    --------
    >>> start_covariance(np.array([1.0, 2.0]), 0, 0.5, 0.3, 2.0, np.array([True, True])).round(4)
    array([[0.1089, 0.    ],
           [0.    , 4.    ]])
    """
    slopes, radii = slice(0, plays + 1), slice(plays + 1, 2 * plays + 1)
    total = float(np.abs(theta[slopes]).sum())
    errors = np.zeros(theta.size)
    errors[slopes] = np.abs(theta[slopes]) + 0.01 * total
    errors[0] += 0.09 * total
    errors[2 * plays + 2 :] = 0.2 + np.abs(theta[2 * plays + 2 :])
    errors *= weight_spread
    errors[2 * plays + 1] = offset_spread
    covariance = np.diag(errors**2)
    covariance[radii, radii] = radii_covariance(theta[radii], radius_spread)
    return np.asarray(covariance * np.outer(free, free))


def factors(covariance: Array) -> tuple[Array, Array]:
    """Factor ``P = U D U'``.

    Parameters
    ----------
    covariance
        Shape (m, m), symmetric, positive semidefinite.

    Returns
    -------
    d : numpy.ndarray
        Shape (m,), the diagonal of D.
    u : numpy.ndarray
        Shape (m (m - 1) / 2,), the columns of U above its unit diagonal, one after the other.

    Examples
    --------
    >>> factors(np.array([[4.0, 2.0], [2.0, 2.0]]))
    (array([2., 2.]), array([1.]))
    """
    rest = covariance.copy()
    count = rest.shape[0]
    d, columns = np.zeros(count), [np.zeros(j) for j in range(count)]
    for j in reversed(range(count)):
        d[j] = max(rest[j, j], 0.0)
        if d[j] > 0.0:
            columns[j] = rest[:j, j] / d[j]
            rest[:j, :j] -= d[j] * np.outer(columns[j], columns[j])
    return d, np.concatenate([np.zeros(0), *columns])


def covariance_of(d: Array, u: Array) -> Array:
    """Multiply the factors out again.

    Parameters
    ----------
    d, u
        As ``factors`` gives them.

    Returns
    -------
    numpy.ndarray
        Shape (m, m).

    Examples
    --------
    >>> covariance_of(np.array([2.0, 2.0]), np.array([1.0]))
    array([[4., 2.],
           [2., 2.]])
    """
    full = np.eye(d.size)
    full.T[np.tril_indices(d.size, -1)] = u
    return np.asarray(full * d @ full.T)
