"""Slopes of a hysteresis after an inexact inverse: simulated rates stay between them."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.compensation import reduce_inverse, slope_range
from hyst.errors import InputError
from hyst.models import GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii
from reference.random_plays import random_inverse, random_model, rich_reference

PAPER = hyst.PrandtlIshlinskii(
    [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7],
    np.arange(4.0, 41.0, 4.0),
    0.1,
)


def fine(turns: np.ndarray, samples: int = 40) -> np.ndarray:
    """Straight pieces between turning points."""
    places = np.arange(turns.size * samples) / samples
    return np.interp(places, np.arange(turns.size), turns)


@pytest.mark.parametrize("seed", range(4))
def test_no_simulated_rate_is_outside(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(100):
        model = random_model(rng)
        approximate = random_inverse(rng, model)
        y_max = float(rng.uniform(1.0, 15.0))
        low, high = slope_range(model, approximate, y_max)
        v = fine(np.append(0.0, rich_reference(rng, y_max)))
        w = model(approximate(v))
        step = np.diff(v)
        moving = np.abs(step) > 1e-6 * y_max
        slopes = np.diff(w)[moving] / step[moving]
        # Differences of numbers of order 100 over steps of 1e-6 at the least.
        slack = 1e-6 * max(1.0, abs(high), abs(low))
        assert low - slack <= slopes.min()
        assert slopes.max() <= high + slack


def test_of_plays_alone_both_ends_are_met() -> None:
    approximate = hyst.Affine(0.7) @ PAPER.inverse()
    low, high = slope_range(PAPER, approximate, 100.0)
    v = np.linspace(0.0, 100.0, 20001)
    slopes = np.diff(PAPER(approximate(v))) / np.diff(v)
    assert slopes.min() == pytest.approx(low, rel=1e-6)
    assert slopes.max() == pytest.approx(high, rel=1e-6)


@pytest.mark.parametrize("kind", ["pi", "gpi", "mpi"])
def test_an_exact_inverse_has_slope_one(kind: str) -> None:
    model = random_model(np.random.default_rng(7), kind)
    # Sums and quotients of weights, to rounding.
    assert slope_range(model, model.inverse(), 10.0) == pytest.approx((1.0, 1.0), rel=1e-9)


@pytest.mark.parametrize("plays", [0, 2, 4])
def test_exact_maps_do_not_widen_the_range(plays: int) -> None:
    bend = hyst.DeadZone.odd([0.65, 0.2], [0.0, 7.56])
    alone = slope_range(PAPER, reduce_inverse(PAPER, plays, 30.0), 30.0)
    model = GeneralizedPrandtlIshlinskii(bend, PAPER)
    assert slope_range(model, reduce_inverse(model, plays, 30.0), 30.0) == pytest.approx(alone)


def test_a_model_without_inverse_has_slopes_too() -> None:
    play = hyst.PrandtlIshlinskii([1.0], [1.0])
    assert slope_range(play, hyst.Affine(1.0), 3.0) == (0.0, 1.0)
    bend = hyst.DeadZone([0.5, 1.0], [0.0, 1.0])
    mapped = ModifiedPrandtlIshlinskii(hyst.PrandtlIshlinskii([], [], 2.0), bend)
    assert slope_range(mapped, hyst.Affine(1.0), 3.0) == (1.0, 3.0)


@pytest.mark.parametrize("y_max", [0.0, -1.0, float("inf")])
def test_refusals(y_max: float) -> None:
    with pytest.raises(InputError, match="y_max"):
        slope_range(PAPER, PAPER.inverse(), y_max)
