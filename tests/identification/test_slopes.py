"""Plays from the slopes of a loop."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.identification import identify_weights_from_slopes

TRUTH = hyst.PrandtlIshlinskii([0.5, 0.8, 0.3], [0.4, 1.5, 3.6], 0.3)


def record(noise: float) -> hyst.Record:
    u = 15.0 * np.sin(2 * np.pi * np.arange(4000) / 1000.0)
    return hyst.Record(u, TRUTH(u) + noise * np.random.default_rng(0).standard_normal(u.size), 1e-3)


def test_number_weights_and_radii_without_noise() -> None:
    found = identify_weights_from_slopes(record(0.0)).model
    # On a stroke the data are a segmented line; what is left is rounding of some thousand samples.
    assert found.p0 == pytest.approx(0.3, abs=1e-9)
    assert found.p == pytest.approx([0.5, 0.8, 0.3], abs=1e-9)
    assert found.r == pytest.approx([0.4, 1.5, 3.6], abs=1e-9)


def test_number_weights_and_radii_with_noise() -> None:
    found = identify_weights_from_slopes(record(0.03)).model
    # 5 strokes; a slope over a stretch of 0.8 with 15 samples a stroke is known to about 0.02.
    assert found.p == pytest.approx([0.5, 0.8, 0.3], abs=0.06)
    assert found.r == pytest.approx([0.4, 1.5, 3.6], abs=0.08)


def test_the_plays_one_asks_for() -> None:
    found = identify_weights_from_slopes(record(0.03), plays=2)
    assert found.model.p.size == 2
    assert found.strokes == 7
    # Fewer pieces fit worse.
    assert found.rms > identify_weights_from_slopes(record(0.03), plays=3).rms


def test_a_straight_line_has_no_plays() -> None:
    u = np.sin(np.arange(1000) / 30.0)
    y = 2.0 * u + 0.01 * np.random.default_rng(1).standard_normal(u.size)
    found = identify_weights_from_slopes(hyst.Record(u, y, 1.0)).model
    assert found.p.size == 0
    assert found.p0 == pytest.approx(2.0, abs=0.01)


def test_an_input_that_never_turns() -> None:
    u = np.linspace(0.0, 1.0, 100)
    with pytest.raises(hyst.NotIdentifiableError, match="0 reversals"):
        identify_weights_from_slopes(hyst.Record(u, u, 1.0))


@pytest.mark.parametrize("plays", [-1, 1.5, "many"])
def test_a_number_of_plays_that_is_none(plays: object) -> None:
    with pytest.raises(hyst.InputError, match="plays is"):
        identify_weights_from_slopes(record(0.0), plays=plays)  # type: ignore[arg-type]


def test_an_output_that_rests_has_no_slopes() -> None:
    u = 5.0 * np.sin(np.arange(2000) / 50.0)
    with pytest.raises(hyst.NotIdentifiableError, match="the output rests"):
        identify_weights_from_slopes(hyst.Record(u, np.ones(2000), 1.0))


def test_it_says_when_noise_hides_plays() -> None:
    # The five plays of S2 sec. IV at 20 dB: all knots are within the first eighth of a stroke.
    truth = hyst.PrandtlIshlinskii([0.3, 0.5, 0.8, 0.3, 0.2], [0.4, 1.0, 1.5, 2.0, 3.6])
    u = 30.0 * np.sin(2 * np.pi * np.arange(4000) / 1000.0)
    y = truth(u)
    noise = 0.1 * float(np.std(y)) * np.random.default_rng(0).standard_normal(u.size)
    found = identify_weights_from_slopes(hyst.Record(u, y + noise, 1e-3))
    assert found.knots.size < 5
    assert found.noise_hides_plays
    assert found.least_steps.shape == found.slopes.shape
    assert "The noise hides plays: between radii 0 and" in found.summary()
    clean = identify_weights_from_slopes(hyst.Record(u, y, 1e-3))
    assert clean.knots.size == 5
    assert not clean.noise_hides_plays
    assert clean.summary().startswith("5 plays from 7 strokes")
    assert "hides" not in clean.summary()


def test_what_is_said_to_be_seen_is_seen() -> None:
    # One play in the middle of the strokes of a line, heavier and lighter than the limit.
    u = 15.0 * np.sin(2 * np.pi * np.arange(4000) / 1000.0)
    scatter = 0.3 * np.random.default_rng(2).standard_normal(u.size)
    line = identify_weights_from_slopes(hyst.Record(u, 2.0 * u + scatter, 1e-3))
    assert line.knots.size == 0
    (limit,) = line.least_steps
    for factor, plays in ((0.3, 0), (3.0, 1)):
        bent = hyst.PrandtlIshlinskii([factor * limit], [7.5], 2.0)(u)
        found = identify_weights_from_slopes(hyst.Record(u, bent + scatter, 1e-3))
        assert found.knots.size == plays
    assert not line.noise_hides_plays
    loud = identify_weights_from_slopes(hyst.Record(u, 2.0 * u + 100.0 * scatter, 1e-3))
    assert loud.noise_hides_plays
    assert "between radii 0 and the widest" in loud.summary()
