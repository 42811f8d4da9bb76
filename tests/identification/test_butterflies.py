"""Butterflies identified: strain of relays on a plain grid, the cases, and what is none."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst import NotIdentifiableError, Record
from hyst.report.words import invertible_sentence
from reference.foreign_records import switching

Array = NDArray[np.float64]
DT = 1e-3
SAMPLES = 1500


def strokes(turns: float, decay: float) -> Array:
    """A sine of amplitude 1 that decays after a third of the record."""
    t = np.arange(SAMPLES) / SAMPLES
    return np.sin(2.0 * np.pi * turns * t) * np.where(t < 0.3, 1.0, np.exp(-decay * (t - 0.3)))


def strain_of_relays(u: Array, coercive: float, spread: float, bias: float) -> Array:
    """Strain over the mean of 20,000 relays, their fields Gaussian: a Preisach material."""
    grid = np.linspace(-1.3, 1.3, 200)
    up, down = (each[np.tril_indices(grid.size)] for each in np.meshgrid(grid, grid, indexing="ij"))
    field, middle = (up - down) / 2.0 - coercive, (up + down) / 2.0 - bias
    share = np.exp(-0.5 * (field / spread) ** 2 - 0.5 * (middle / 0.1) ** 2)
    share /= share.sum()
    state, z = np.where(up + down > 0.0, -1.0, 1.0), np.empty(u.size)
    for k, now in enumerate(u):
        state[up <= now], state[down >= now] = 1.0, -1.0
        z[k] = share @ state
    return z**2 + 0.25 * z * u + 0.05 * u + 0.03 * z + 0.02 * u**2


def noisy(u: Array, y: Array, noise: float = 0.002) -> Record:
    return Record(u, y + noise * np.ptp(y) * np.random.default_rng(7).normal(size=u.size), DT)


@pytest.mark.parametrize(
    ("turns", "coercive", "spread", "bias", "most"),
    # Noise is 0.2 % of the range; minor loops of plays are not those of relays, which leaves more.
    [(3.0, 0.35, 0.12, 0.06, 0.6), (6.25, 0.3, 0.15, -0.04, 1.5)],
)
def test_strain_of_relays_is_described(
    turns: float, coercive: float, spread: float, bias: float, most: float
) -> None:
    u = strokes(turns, 1.0 if turns > 3.0 else 0.0)
    y = strain_of_relays(u, coercive, spread, bias)
    found = hyst.identify(noisy(50.0 * u, 3.0 - 2.0 * y), family="butterfly", delay=0)
    assert found.metrics["training"].rms_percent < most
    assert found.verdict.level != "unfit"
    assert not any("doubtful" in each for each in found.verdict.sentences)
    inner = strokes(4.0, 2.0)
    low, high = found.band(50.0 * inner)
    true = 3.0 - 2.0 * strain_of_relays(inner, coercive, spread, bias)
    # A band of 95 % over a drive it has not seen, at worst by a model of another kind.
    assert np.mean((true >= low) & (true <= high)) > 0.9


def test_what_it_knows_does_not_depend_on_samples_after_another_start() -> None:
    """Twice the same record are two records of one actuator."""
    u = strokes(3.0, 0.0)
    record = noisy(u, strain_of_relays(u, 0.35, 0.12, 0.0))
    options = {"family": "butterfly", "delay": 0, "plays": 2, "knots": 8}
    once, twice = (hyst.identify(each, **options) for each in (record, [record, record]))
    np.testing.assert_allclose(
        twice.model(u), once.model(u), rtol=0.0, atol=1e-3 * float(np.ptp(record.y))
    )  # the same minimum; fits end where a step promises a thousandth of the noise


@pytest.mark.parametrize(
    ("case", "how", "most"),
    [
        # The record's own noise is 0.107 % of the range.
        ("butterfly", {"input": 1, "output": 2, "time": 0}, 0.15),
        # A staircase of 20 relays a side: steps of 1 % of the range and more are in the record.
        ("butterfly-of-switching", {"input": "u", "output": "y", "rate": 100}, 1.1),
    ],
)
def test_the_cases_are_described_and_promise_no_exact_command(
    cases: Path, case: str, how: dict[str, object], most: float
) -> None:
    record = hyst.read_record(cases / case / "loop.csv", **how)
    found = hyst.identify(record, family="butterfly")
    assert found.metrics["training"].rms_percent < most
    assert found.verdict.level == "fair"
    assert not found.model.is_invertible()
    assert "not monotone in the input" in invertible_sentence(found.model)


@pytest.mark.parametrize(
    ("what", "output", "why"),
    [
        ("a loop that rises", switching, "never falls while the input rises"),
        ("a loop that falls", lambda u: -switching(u), "or never rises"),
        ("a curve", lambda u: u**2 + 0.1 * u, "shows no hysteresis of a butterfly"),
        ("plays", hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], 1.0), "use family 'pi'"),
    ],
)
def test_what_is_no_butterfly_is_refused(what: str, output: object, why: str) -> None:
    u = strokes(3.0, 0.0)
    y = output(u)  # type: ignore[operator]
    with pytest.raises(NotIdentifiableError, match=why):
        hyst.identify(noisy(u, y, 0.01), family="butterfly", delay=0)


def test_noise_is_refused() -> None:
    u = strokes(3.0, 0.0)
    record = Record(u, np.random.default_rng(3).normal(size=u.size), DT)
    with pytest.raises(NotIdentifiableError):
        hyst.identify(record, family="butterfly", delay=0)


def test_a_falling_butterfly_is_the_rising_one_upside_down() -> None:
    u = strokes(3.0, 0.0)
    record = noisy(u, strain_of_relays(u, 0.35, 0.12, 0.05))
    options = {"family": "butterfly", "delay": 0, "plays": 2, "knots": 8}
    upright = hyst.identify(record, **options)
    turned = hyst.identify(dataclasses.replace(record, y=-record.y), **options)
    c = next(i for i, name in enumerate(upright.parameter_names) if name == "c[0,0]")
    np.testing.assert_allclose(
        turned.parameter_values[c:], -upright.parameter_values[c:], rtol=1e-6, atol=1e-9
    )
    np.testing.assert_allclose(
        turned.parameter_values[:c], upright.parameter_values[:c], rtol=1e-6, atol=1e-9
    )


def test_options_out_of_range_are_refused() -> None:
    for option, value in (("degree", 1), ("degree", 7), ("plays", 0), ("knots", 51)):
        with pytest.raises(hyst.InputError, match=f"{option} is {value}"):
            hyst.families.Butterfly(**{option: value})


def minor_loops() -> Record:
    """A material with many minor loops, asymmetric and narrow: hard for plays."""
    u = strokes(6.25, 1.0)
    return noisy(50.0 * u, 3.0 - 2.0 * strain_of_relays(u, 0.3, 0.15, -0.04))


def test_relays_inside_describe_minor_loops_of_any_shape() -> None:
    record = minor_loops()
    plays = hyst.identify(record, family="butterfly", delay=0, plays=4)
    assert any("inside='relays'" in each for each in plays.undetermined)
    relays = hyst.identify(record, family="butterfly", delay=0, inside="relays")
    # Noise of 0.2 % and a grid of 24 cells a side; plays leave 1.2 %.
    assert relays.metrics["training"].rms_percent < 0.75
    inner = strokes(4.0, 2.0)
    true = 3.0 - 2.0 * strain_of_relays(inner, 0.3, 0.15, -0.04)
    errors = [np.sqrt(np.mean((each.model(50.0 * inner) - true) ** 2)) for each in (plays, relays)]
    assert errors[1] < 0.6 * errors[0]
    low, high = relays.band(50.0 * inner)
    assert np.mean((true >= low) & (true <= high)) > 0.9
    assert set(relays.parameter_names) == {
        "c[0,0]", "c[0,1]", "c[0,2]", "c[1,0]", "c[1,1]", "c[2,0]",
    }  # fmt: skip
    assert np.isfinite(relays.standard_errors).all()


def test_relays_inside_do_not_depend_on_units() -> None:
    options = {"family": "butterfly", "delay": 0, "inside": "relays", "cells": 8}
    record = minor_loops()
    scaled = dataclasses.replace(record, u=record.u * 2.0**-30, y=record.y * 2.0**50)
    plain, other = (hyst.identify(each, **options) for each in (record, scaled))
    expected = plain.model.in_units(2.0**-30, 2.0**50).parameters().values
    np.testing.assert_array_equal(other.model.parameters().values, expected)


def test_cells_that_no_sample_crossed_are_told() -> None:
    u = strokes(3.0, 0.0)
    record = noisy(u, strain_of_relays(u, 0.35, 0.12, 0.0))
    found = hyst.identify(record, family="butterfly", delay=0, inside="relays", cells=12)
    assert any("no minor loops" in each for each in found.undetermined)


def test_no_delay_is_told_that_only_loops_of_another_kind_would_show() -> None:
    """Loops that go one way with the input take this material for one that lags by 57 samples."""
    u = strokes(3.0, 0.0)
    record = noisy(u, strain_of_relays(u, 0.35, 0.12, 0.06))
    found = hyst.identify(record, family="butterfly", plays=2, knots=8)
    assert found.delay == 0
    low, high = found.delay_interval
    assert low <= 0.0 <= high
