"""Fleets of several kinds: truth outside the class, no scatter, coverage, other families."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.fleet import SharedShape

NOISE = 3e-3


def drive(samples: int, amplitude: float = 1.0) -> np.ndarray:
    phase = np.linspace(0.0, 5.0 * np.pi, samples)
    return amplitude * np.sin(phase) * np.linspace(1.0, 0.4, samples)


def measured(device: hyst.Operator, samples: int, rng: np.random.Generator) -> hyst.Record:
    u = drive(samples)
    y = device(u)
    return hyst.Record(u, y + NOISE * np.ptp(y) * rng.standard_normal(samples), dt=1e-3)


def scattered(truth: hyst.Operator, rng: np.random.Generator) -> hyst.Operator:
    return hyst.Affine(1.0 + 0.05 * rng.standard_normal(), 0.0) @ truth


def missed(model: hyst.Operator, device: hyst.Operator) -> float:
    u = drive(2000)
    y = device(u)
    return float(np.sqrt(np.mean((model(u) - y)[800:] ** 2)) / np.ptp(y))


def test_plays_for_a_fleet_of_bouc_wen_devices() -> None:
    rng = np.random.default_rng(0)
    truth = hyst.BoucWen(k=2.0, A=0.8, beta=1.5, gamma=0.6, n=1.3)
    records = [measured(scattered(truth, rng), 300, rng) for _ in range(30)]
    radii = np.linspace(0.05, 0.8, 8)
    guess = hyst.PrandtlIshlinskii(np.full(8, 0.1), radii, p0=1.5)
    start = hyst.fit(guess, records[0]).model
    shape = SharedShape.estimate(start, records)
    devices = [scattered(truth, rng) for _ in range(4)]
    errors = [missed(shape.identify(measured(each, 200, rng)).model, each) for each in devices]
    # Less than the noise of a sample, although no plays are a Bouc-Wen element.
    assert np.sqrt(np.mean(np.square(errors))) < NOISE


def test_every_constant_of_bouc_wen_may_scatter() -> None:
    rng = np.random.default_rng(1)
    truth = hyst.BoucWen(k=2.0, A=0.8, beta=1.5, gamma=0.6, n=1.3)
    own = truth.parameters()
    free = (own.values > own.lower) & (own.values < own.upper)

    def device() -> hyst.Operator:
        moved = own.values * np.where(free, 1.0 + 0.05 * rng.standard_normal(free.size), 1.0)
        return truth.with_parameters(moved)

    shape = SharedShape.estimate(truth, [measured(device(), 300, rng) for _ in range(30)])
    devices = [device() for _ in range(5)]
    errors = [missed(shape.identify(measured(each, 200, rng)).model, each) for each in devices]
    # Six constants from 160 samples each would leave NOISE sqrt(6 / 160).
    assert np.sqrt(np.mean(np.square(errors))) < NOISE * np.sqrt(6.0 / 160.0)


def test_fleet_without_scatter_shares_everything() -> None:
    rng = np.random.default_rng(2)
    truth = hyst.PrandtlIshlinskii([0.5, 0.4], [0.1, 0.4], p0=1.0)
    shape = SharedShape.estimate(truth, [measured(truth, 200, rng) for _ in range(20)])
    assert sum(shape.scatter.values()) < 5e-3
    found = shape.identify(measured(truth, 200, rng))
    assert missed(found.model, truth) < 0.15 * NOISE
    assert found.told_by_record < 3.0


def test_relays_of_many_cells_scatter_along_few_directions() -> None:
    rng = np.random.default_rng(3)
    edges = np.linspace(-1.0, 1.0, 13)
    alpha, beta = np.meshgrid(edges[1:], edges[:-1], indexing="ij")
    weights = np.tril(0.02 * np.exp(-((alpha + beta) ** 2) - 0.5 * (alpha - beta)))
    truth = hyst.Preisach(weights, edges, p0=0.5)
    shape = SharedShape.estimate(
        truth, [measured(scattered(truth, rng), 300, rng) for _ in range(16)]
    )
    assert shape.scatter["gain"] == pytest.approx(0.05, rel=0.5)
    device = scattered(truth, rng)
    assert missed(shape.identify(measured(device, 200, rng)).model, device) < NOISE


def test_bands_hold_the_truth_as_often_as_they_say() -> None:
    rng = np.random.default_rng(4)
    truth = hyst.PrandtlIshlinskii([0.5, 0.4], [0.1, 0.4], p0=1.0)
    shape = SharedShape.estimate(
        truth, [measured(scattered(truth, rng), 200, rng) for _ in range(30)]
    )
    held, u = [], drive(400)
    for _ in range(60):
        device = scattered(truth, rng)
        low, high = shape.identify(measured(device, 150, rng)).band(u, 0.9)
        y = device(u)
        held.append(float(np.mean((low <= y) & (y <= high))))
    assert np.mean(held) == pytest.approx(0.9, abs=0.08)


def test_units_do_not_matter() -> None:
    rng = np.random.default_rng(5)
    truth = hyst.PrandtlIshlinskii([0.5, 0.4], [0.1, 0.4], p0=1.0)
    records = [measured(scattered(truth, rng), 150, rng) for _ in range(12)]
    small = [hyst.Record(each.u * 2.0**7, each.y * 2.0**-30, each.dt) for each in records]
    one = SharedShape.estimate(truth, records)
    other = SharedShape.estimate(truth.in_units(2.0**7, 2.0**-30), small)
    assert other.scatter == pytest.approx(one.scatter, rel=1e-6)
    found, again = one.identify(records[0]), other.identify(small[0])
    assert again.predicted_error * 2.0**30 == pytest.approx(found.predicted_error, rel=1e-6)


def test_rate_dependent_plays_keep_their_sample_time() -> None:
    rng = np.random.default_rng(6)
    truth = hyst.RateDependentPrandtlIshlinskii([0.5, 0.3], [0.1, 0.3], 1e-3, 1e-3, 1.0)
    shape = SharedShape.estimate(
        truth, [measured(scattered(truth, rng), 200, rng) for _ in range(12)]
    )
    device = scattered(truth, rng)
    assert missed(shape.identify(measured(device, 200, rng)).model, device) < NOISE
    assert shape.scatter["gain"] == pytest.approx(0.05, rel=0.6)
