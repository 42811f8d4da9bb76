"""What a white Gaussian drive leaves of hysteresis in an impulse response: not nothing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.identification.families.hammerstein import fit_markov

Array = NDArray[np.float64]

RADII, WEIGHTS, DIRECT = (0.05, 0.15, 0.3, 0.5, 0.8), (0.12, 0.09, 0.08, 0.06, 0.05), 0.6
SAMPLES = 400_000


def taps_of_a_play(r: float, rms: float, count: int) -> Array:
    """Give ``E[z_k u_{k-i}] / E[u^2]``, i = 0 .., from the Markov chain of its output.

    The output before a sample is a chain on a grid; its stationary distribution and the mean of
    later outputs, given the present one, follow by sums. No signal is simulated.
    """
    u = np.linspace(-6.0, 6.0, 481) * rms
    chance = np.exp(-0.5 * (u / rms) ** 2)
    chance /= chance.sum()
    z = np.linspace(u[0], u[-1], 721)
    after = np.clip(z[:, None], u - r, u + r)  # shape (before, drive)
    place = np.clip((after - z[0]) / (z[1] - z[0]), 0.0, z.size - 1.000001)
    below, share = place.astype(int), place % 1.0
    matrix = np.zeros((z.size, z.size))
    for column, weight in enumerate(chance):
        rows = np.arange(z.size)
        np.add.at(matrix, (rows, below[:, column]), weight * (1.0 - share[:, column]))
        np.add.at(matrix, (rows, below[:, column] + 1), weight * share[:, column])
    stationary = np.where(np.abs(z) < 1e-9, 1.0, 0.0)
    for _ in range(400):
        stationary = stationary @ matrix
    taps, later = [], z
    for _ in range(count):
        there = np.interp(after, z, later)
        taps.append(float(stationary @ (there * u * chance).sum(axis=1)) / rms**2)
        later = matrix @ later
    return np.array(taps)


@pytest.mark.parametrize("rms", [0.3, 1.0, 3.0])
def test_plays_leave_slow_parts_in_the_impulse_response(rms: float) -> None:
    u = rms * np.random.default_rng(5).normal(size=SAMPLES)
    v = hyst.PrandtlIshlinskii(WEIGHTS, RADII, DIRECT)(u)
    found = fit_markov(hyst.Record(u, v, 1.0), 5)
    expected = sum(
        p * taps_of_a_play(r, rms, 4) for p, r in zip(WEIGHTS, RADII, strict=True)
    ) + np.array([DIRECT, 0.0, 0.0, 0.0])
    # Four standard errors, and half as much again, for the residual depends on the input; the grid
    # of the chain is good to a thousandth.
    errors = 6.0 * found.standard_errors[:4] + 1e-3 * expected[0]
    assert np.all(np.abs(found.values[:4] - expected) <= errors)
    assert expected[1] > 10.0 * errors[1]  # and it is no chance


@pytest.mark.parametrize(("rms", "first"), [(0.3, 0.068), (1.0, 0.050), (3.0, 0.020)])
def test_they_are_as_large_as_told(rms: float, first: float) -> None:
    taps = sum(p * taps_of_a_play(r, rms, 2) for p, r in zip(WEIGHTS, RADII, strict=True))
    assert taps[1] / (DIRECT + taps[0]) == pytest.approx(first, abs=1e-3)  # the digits of the docs


def test_a_map_without_memory_leaves_none() -> None:
    u = 0.7 * np.random.default_rng(6).normal(size=SAMPLES)
    found = fit_markov(hyst.Record(u, u + 2.0 * u**3, 1.0), 5)
    # Bussgang: only the gain is another one, 1 + 2 * 3 rms^2.
    assert np.abs(found.values[1:]).max() < 5.0 * found.standard_errors[1:].max()
    assert found.values[0] == pytest.approx(1.0 + 6.0 * 0.49, rel=0.02)
