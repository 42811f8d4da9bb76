"""What evidence is counted with, by independent methods and by hand."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.stats

from hyst.identification.judgement.drive_cycles import (
    branch_frequencies,
    frequency_of,
    last_turns,
    octaves_of,
    swings_alike,
)
from hyst.identification.judgement.regression import (
    Regression,
    chance,
    correlation_time,
    is_white,
)
from hyst.identification.judgement.remainder import Part
from hyst.identification.judgement.repetition import period_of, repeating
from hyst.identification.judgement.validation import validated
from hyst.signals import error_metrics

RNG = np.random.default_rng(0)


def part(u: np.ndarray, error: np.ndarray | None = None) -> Part:
    y = np.zeros(u.size) if error is None else error
    return Part(np.empty(0), u, y, np.zeros(u.size), np.arange(u.size), 0.01, 1, np.arange(u.size))


def coloured(pole: float, samples: int = 100_000) -> np.ndarray:
    noise, state = np.empty(samples), 0.0
    for k, each in enumerate(RNG.normal(size=samples)):
        state = pole * state + each
        noise[k] = state
    return noise


def test_what_is_left_is_that_of_least_squares() -> None:
    groups = {"one": RNG.normal(size=(300, 3)), "two": 1e-6 * RNG.normal(size=(300, 2))}
    error = groups["one"] @ [1.0, -2.0, 0.5] + RNG.normal(size=300)
    regression = Regression(error, groups)
    columns = np.column_stack([groups["one"], groups["two"], np.ones(300)])
    solved, squares, _, _ = np.linalg.lstsq(columns, error, rcond=None)
    left, directions = regression.left(["one", "two"])
    # Sums of products keep half of the digits of a well-posed problem.
    assert left * regression.total == pytest.approx(float(squares[0]), rel=1e-9)
    assert directions == 5
    np.testing.assert_allclose(regression.coefficients(["one", "two"], "two"), solved[3:5], 1e-7)
    np.testing.assert_allclose(regression.rest(["one", "two"]), error - columns @ solved, atol=1e-9)


def test_columns_that_say_the_same_count_once() -> None:
    one = RNG.normal(size=(200, 2))
    regression = Regression(RNG.normal(size=200), {"one": one, "again": one @ [[1.0], [2.0]]})
    assert regression.left(["one", "again"]) == pytest.approx(regression.left(["one"]))


def test_the_chance_is_that_of_the_f_distribution() -> None:
    ratio = (10.0 - 7.0) / 4 / (7.0 / 90.0)
    assert chance(10.0, 7.0, 4, 90.0) == pytest.approx(scipy.stats.f.sf(ratio, 4, 90), rel=1e-9)
    assert chance(10.0, 10.0, 4, 90.0) == 1.0
    assert chance(10.0, 0.0, 4, 90.0) == 0.0


@pytest.mark.parametrize("pole", [0.0, 0.5, 0.9])
def test_the_correlation_time_of_an_autoregression(pole: float) -> None:
    """It is (1 + a) / (1 - a); the sum ends where 0.05 is left, which loses up to 5 %."""
    expected = (1.0 + pole) / (1.0 - pole)
    assert correlation_time(coloured(pole)) == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("samples", [60, 500, 5000])
def test_white_noise_is_white_and_other_noise_is_not(samples: int) -> None:
    assert all(is_white(RNG.normal(size=samples)) for _ in range(50))
    ringing = np.convolve(RNG.normal(size=samples), np.cos(np.arange(40)) * 0.95 ** np.arange(40))
    if samples > 100:
        assert not is_white(coloured(0.7, samples))
        assert not is_white(ringing[:samples])


def test_the_period_of_a_drive_is_its_shortest() -> None:
    k = np.arange(1000)
    two_tones = np.sin(2.0 * np.pi * k / 50.0) + np.sin(2.0 * np.pi * k / 40.0)
    assert period_of(part(two_tones)) == 200
    assert period_of(part(np.sin(2.0 * np.pi * k / 50.0))) == 50
    assert period_of(part(np.sin(2.0 * np.pi * k / 50.0) * (1.0 - k / 2000.0))) == 0
    assert period_of(part(np.cumsum(RNG.normal(size=1000)))) == 0


@pytest.mark.parametrize("size", [0.0, 0.3, 1.0])
def test_what_repeats_is_told_from_noise(size: float) -> None:
    k = np.arange(5000)
    error = size * np.sin(2.0 * np.pi * k / 100.0) + RNG.normal(size=k.size)
    squares = repeating(error, k, 100, 1e-5)
    # size^2 / 2 a sample; its estimate scatters by some 4 size / sqrt(2 n).
    assert squares / k.size == pytest.approx(size**2 / 2.0, abs=0.04 * size + 1e-12)


def test_frequencies_and_turns_of_a_triangle() -> None:
    u = np.interp(np.arange(401), [0, 100, 200, 300, 400], [0.0, 1.0, -1.0, 1.0, 0.0])
    assert frequency_of(part(u)) == pytest.approx(0.5)
    np.testing.assert_allclose(branch_frequencies(part(u)), 0.5)
    last, before = last_turns(part(u))
    assert [last[50], last[150], last[250], last[350]] == [-1.0, 1.0, -1.0, 1.0]
    assert [before[50], before[150], before[250], before[350]] == [1.0, -1.0, 1.0, -1.0]
    assert swings_alike([part(u)])
    assert octaves_of([part(u)]) == 0.0
    assert octaves_of([part(u), part(u[::4])]) == pytest.approx(2.0)


def test_validation_is_told_from_three_times_the_training_error() -> None:
    y = np.sin(np.arange(400) / 10.0)
    training = error_metrics(y, y + 0.01 * (-1.0) ** np.arange(400))
    for factor, told in ((2.9, 0), (3.1, 1)):
        judged = error_metrics(y, y + factor * 0.01 * (-1.0) ** np.arange(400))
        seen = validated({"training": training, "validation": judged}, 0.01, "um")
        assert len(seen.sentences) == told
        assert seen.level == ("fair" if told else "good")


def test_a_zero_that_is_off_on_validation_is_told_as_that() -> None:
    y = np.sin(np.arange(400) / 10.0)
    training = error_metrics(y, y + 0.01 * (-1.0) ** np.arange(400))
    off = y + 0.2
    metrics = {
        "training": training,
        "validation": error_metrics(y, off),
        "validation, free offset": error_metrics(y, off, free_offset=True),
    }
    assert "zero is off by 0.2" in validated(metrics, 0.01, "um").sentences[0]
