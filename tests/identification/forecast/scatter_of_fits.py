"""Scatter of a least squares fit of two plays and a resonance, in NumPy alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

Array = NDArray[np.float64]

NAMES = ("resonance [Hz]", "damping of 80 Hz", "p0", "p[1]", "p[2]", "r[1]", "r[2]")
"""In the order of theta, which has the split of the numerator and an offset behind them."""

TRUE = np.array([80.0, 0.05, 0.6, 0.25, 0.15, 0.15, 0.45])
DT, DELAY = 1e-3, 2


def resonance(frequency: float, damping: float) -> tuple[Array, Array]:
    """Give ``w^2 / (s^2 + 2 d w s + w^2)`` with a held input, from its step response."""
    w = 2.0 * np.pi * frequency
    decay, turn = -damping * w, w * np.sqrt(1.0 - damping**2)
    e, c, s = np.exp(decay * DT), np.cos(turn * DT), np.sin(turn * DT)
    first = 1.0 - e * (c - decay / turn * s)
    second = e * e - e * (c + decay / turn * s)
    return np.array([first, second]), np.array([1.0, -2.0 * e * c, e * e])


def start() -> Array:
    """Give the true theta."""
    b, _ = resonance(*TRUE[:2])
    return np.concatenate([TRUE, [b[1] / b.sum(), 0.0]])


def outputs(u: Array, thetas: Array) -> Array:
    """Give the output for each row of theta, shape (rows, N)."""
    radii = thetas[:, 5:7]
    z, plays = np.zeros_like(radii), np.empty((u.size, *radii.shape))
    for k, now in enumerate(u):
        z = np.clip(z, now - radii, now + radii)
        plays[k] = z
    v = thetas[:, 2, None] * u + np.einsum("kij,ij->ik", plays, thetas[:, 3:5])
    y = np.empty_like(v)
    for row, (theta, each) in enumerate(zip(thetas, v, strict=True)):
        _, a = resonance(theta[0], theta[1])
        b = a.sum() * np.array([1.0 - theta[7], theta[7]])
        y[row] = lfilter([*np.zeros(1 + DELAY), *b], a, each) + theta[8]
    return y


def scatter(u: Array, noise: float, runs: int, seed: int) -> Array:
    """Give the standard deviation of the estimates of ``NAMES`` over runs of other noise."""
    theta = start()
    truth = outputs(u, theta[None])[0]
    y = truth + noise * np.random.default_rng(seed).normal(size=(runs, u.size))
    step = 1e-5 * np.maximum(np.abs(theta), 0.1)
    found = np.tile(theta, (runs, 1))
    for _ in range(3):  # Gauss-Newton from the truth, each run from its own estimate
        moves = np.concatenate([np.zeros((1, theta.size)), np.diag(step), -np.diag(step)])
        tried = outputs(u, (found[:, None] + moves).reshape(-1, theta.size))
        tried = tried.reshape(runs, len(moves), u.size)
        half = 1 + theta.size
        for run in range(runs):
            jacobian = ((tried[run, 1:half] - tried[run, half:]) / (2.0 * step[:, None])).T
            found[run] += np.linalg.lstsq(jacobian, y[run] - tried[run, 0], rcond=None)[0]
    return np.asarray(found[:, : len(NAMES)].std(axis=0, ddof=1))
