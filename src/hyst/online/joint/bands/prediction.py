"""What a model says of folded samples, and its derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.parts import Map, Parts

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Plays:
    """Outputs of plays at the end of every way.

    Parameters
    ----------
    z
        Shape (n, R).
    by_r
        Shape (n, R): -1 on the lower envelope, +1 on the upper, 0 where the way never moved it.
    source
        Shape (n, R), which point of the way left it there; -1 for none.
    """

    z: Array
    by_r: Array
    source: NDArray[np.intp]


def plays_after(way: Array, r: Array, z0: Array) -> Plays:
    """Lead plays of radii ``r`` from ``z0`` along ways.

    Parameters
    ----------
    way
        Shape (T, R), inputs of the plays.
    r, z0
        Shape (n,).

    Returns
    -------
    Plays

    Examples
    --------
    >>> found = plays_after(np.array([[3.0], [1.5]]), np.array([0.5, 1.0]), np.zeros(2))
    >>> found.z[:, 0], found.by_r[:, 0]
    (array([2., 2.]), array([ 1., -1.]))
    """
    z = np.repeat(z0[:, np.newaxis], way.shape[1], axis=1)
    by_r, source = np.zeros_like(z), np.full(z.shape, -1)
    radius = r[:, np.newaxis]
    for place, u in enumerate(way):
        led = np.minimum(np.maximum(z, u - radius), u + radius)
        moved = led != z
        np.copyto(by_r, np.sign(z - led), where=moved)
        np.copyto(source, place, where=moved)
        z = led
    return Plays(z, by_r, source)


def terms(x: Array, thresholds: Array) -> Array:
    """Give the terms of a dead-zone map.

    Parameters
    ----------
    x
        Where, any shape.
    thresholds
        Shape (k,), as the core orders them.

    Returns
    -------
    numpy.ndarray
        Shape (k, *x.shape).
    """
    rho = thresholds.reshape(-1, *(1,) * x.ndim)
    above = np.where(rho > 0.0, np.maximum(x - rho, 0.0), np.minimum(x - rho, 0.0))
    return np.asarray(np.where(rho == 0.0, x, above))


def _slope(x: Array, each: Map, weights: Array) -> Array:
    acts = np.sign(terms(x, each.thresholds)) != 0.0
    acts[each.thresholds == 0.0] = True
    return np.asarray(weights @ acts)


def predicted(parts: Parts, theta: Array, way: Array) -> tuple[Array, Array]:
    """Give outputs in the plays' units and their derivatives by all parameters.

    Parameters
    ----------
    parts
        The model.
    theta
        Shape (m,), its parameters in the core's order.
    way
        Shape (T, R).

    Returns
    -------
    y : numpy.ndarray
        Shape (R,).
    jacobian : numpy.ndarray
        Shape (m, R).
    """
    n = parts.pi.p.size
    p, r = theta[1 : n + 1], theta[n + 1 : 2 * n + 1]
    first = 2 * n + 2
    jacobian = np.empty((theta.size, way.shape[1]))
    v, by_front = way, None
    if parts.front is not None:
        count = parts.front.weights.size
        by_front = terms(way, parts.front.thresholds)
        v = np.tensordot(theta[first : first + count], by_front, 1)
    plays = plays_after(v, r, np.interp(r, parts.pi.r, parts.pi.z0))
    w = theta[0] * v[-1] + p @ plays.z
    jacobian[0], jacobian[1 : n + 1] = v[-1], plays.z
    jacobian[n + 1 : 2 * n + 1] = p[:, np.newaxis] * plays.by_r
    if by_front is not None:
        rows = np.arange(way.shape[1])
        for j, each in enumerate(by_front):
            moved = np.where(plays.source >= 0, each[plays.source, rows], 0.0)
            jacobian[first + j] = theta[0] * each[-1] + p @ moved
        first += by_front.shape[0]
    y = w
    if parts.back is not None:
        weights = theta[first:]
        by_back = terms(w, parts.back.thresholds)
        y = weights @ by_back
        jacobian[:first] *= _slope(w, parts.back, weights)
        jacobian[first:] = by_back
    jacobian[2 * n + 1] = 1.0
    return y + theta[2 * n + 1], jacobian
