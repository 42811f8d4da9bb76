"""Designed drives: spectrum, limits, counts known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hyst import signals
from hyst.errors import InputError
from hyst.signals import Drive


def lines_of(u: np.ndarray) -> np.ndarray:
    spectrum = np.abs(np.fft.rfft(u))
    return np.flatnonzero(spectrum > 1e-9 * spectrum.max())


def test_multisine_has_the_lines_of_its_band_and_no_other() -> None:
    drive = signals.multisine(0.01, 1000, rms=30.0, band=(1.0, 10.0), periods=3)
    assert len(drive) == 3000
    assert drive.rms == pytest.approx(30.0, rel=1e-12)
    assert np.array_equal(lines_of(drive.u[:1000]), np.arange(10, 101))  # 0.1 Hz apart
    assert np.array_equal(drive.u[:1000], drive.u[1000:2000])


def test_odd_multisines_leave_lines_out() -> None:
    odd = lines_of(signals.multisine(0.01, 1000, amplitude=1.0, band=(1, 10), lines="odd").u)
    assert np.array_equal(odd, np.arange(11, 101, 2))
    thinned = lines_of(signals.multisine(0.01, 1000, amplitude=1, lines="odd-random").u)
    assert set(thinned) < set(range(1, 500, 2))
    assert len(thinned) == 250 - 250 // 4


def test_phases_decide_the_crest_factor() -> None:
    def crest(phases: str) -> float:
        return signals.multisine(0.01, 4000, amplitude=5.0, phases=phases).crest_factor

    assert crest("schroeder") < 1.8  # Schroeder 1970 reports about 1.7
    assert 3.0 < crest("random") < 6.0  # a Gaussian signal of that length
    peak = np.abs(signals.multisine(0.01, 4000, amplitude=5.0).u).max()
    assert 5.0 - 1e-12 < peak <= 5.0


def test_equal_seeds_give_equal_signals() -> None:
    one, same, other = (signals.multisine(0.01, 100, rms=1.0, seed=s).u for s in (3, 3, 4))
    assert np.array_equal(one, same)
    assert not np.allclose(one, other)


@pytest.mark.parametrize("register", range(2, 15))
def test_prbs_is_of_maximal_length(register: int) -> None:
    bits = np.sign(signals.prbs(1.0, 1.0, register=register).u)
    period = 2**register - 1
    assert bits.size == period
    assert abs(bits.sum()) == 1  # one level once more than the other
    correlation = np.fft.irfft(np.abs(np.fft.rfft(bits)) ** 2, period)
    # The autocorrelation of a maximal sequence is -1 at every lag but 0.
    assert correlation[1:] == pytest.approx(-np.ones(period - 1), abs=1e-8 * period)


LIMITED = {
    "multisine": lambda rate, acc: signals.multisine(
        1e-3,
        500,
        rms=3.0,
        offset=70.0,
        periods=2,
        max_rate=rate,
        max_acceleration=acc,
        keep="spectrum",
    ),
    "shaped multisine": lambda rate, acc: signals.multisine(
        1e-3, 5000, rms=1.0, offset=70.0, periods=2, max_rate=rate, max_acceleration=acc
    ),
    "even multisine": lambda rate, acc: signals.multisine(
        1e-3, 5000, amplitude=3.0, uniform=True, periods=2, max_rate=rate, max_acceleration=acc
    ),
    "noise": lambda rate, acc: signals.lowpassed_noise(
        1e-3, 5000, 90.0, amplitude=3.0, offset=-9.0, max_rate=rate, max_acceleration=acc
    ),
    "levels": lambda rate, acc: signals.levels(
        1e-3, 9000, 3.3, hold=7, offset=70.0, periods=2, max_rate=rate, max_acceleration=acc
    ),
    "levels held once": lambda rate, acc: signals.levels(
        1e-3, 9000, 3.3, hold=1, offset=70.0, periods=2, max_rate=rate, max_acceleration=acc
    ),
    "swept sine": lambda rate, acc: signals.swept_sine(
        1e-3,
        2000,
        (1.0, 200.0),
        5.0,
        periods=2,
        max_rate=rate,
        max_acceleration=acc,
        keep="spectrum",
    ),
    "shaped sweep": lambda rate, acc: signals.swept_sine(
        1e-3,
        9000,
        (1.0, 200.0),
        2.0,
        offset=70.0,
        spacing="logarithmic",
        periods=2,
        max_rate=rate,
        max_acceleration=acc,
    ),
    "triangle": lambda rate, acc: signals.triangle(
        1e-3, 7.3, rate, cycles=3, offset=-20.0, max_acceleration=acc
    ),
    "decaying": lambda rate, acc: signals.decaying_triangle(1e-3, 7.3, rate, max_acceleration=acc),
    "forc": lambda rate, acc: signals.forc(1e-3, -1.0, 9.0, rate, curves=7, max_acceleration=acc),
    "staircase": lambda rate, acc: signals.staircase(
        1e-3, -1.0, 9.0, rate, hold=0.05, max_acceleration=acc
    ),
    "prbs": lambda rate, acc: signals.prbs(
        1e-3, 0.7, register=6, clock=150, offset=33.3, max_rate=rate, max_acceleration=acc
    ),
}


@pytest.mark.parametrize("kind", LIMITED)
@pytest.mark.parametrize("acceleration", [math.inf, 1000.0])
def test_limits_hold_exactly_for_the_samples_written(kind: str, acceleration: float) -> None:
    rate = 40.0
    drive: Drive = LIMITED[kind](rate, acceleration)
    # No tolerance: what is sent to the amplifier obeys its limits as an amplifier would see them.
    assert np.abs(np.diff(drive.u)).max() / 1e-3 <= rate
    assert np.abs(np.diff(drive.u, 2)).max() / 1e-3**2 <= acceleration
    if acceleration == math.inf:
        assert drive.max_rate >= 0.9 * rate  # and is not needlessly slow


def test_forc_turns_at_the_reversal_points() -> None:
    drive = signals.forc(1e-3, -2.0, 6.0, 100.0, curves=4)
    turns = drive.u[signals.reversals(drive.u, 0.01)]
    assert turns.tolist() == [6.0, 4.0, 6.0, 2.0, 6.0, 0.0, 6.0, -2.0]


def test_decaying_triangle_shrinks_by_its_factor() -> None:
    drive = signals.decaying_triangle(1e-3, 8.0, 100.0, cycles=3, decay=0.5)
    turns = drive.u[signals.reversals(drive.u, 0.01)]
    assert turns.tolist() == [8.0, -8.0, 4.0, -4.0, 2.0, -2.0]


def test_staircase_rests_on_every_step() -> None:
    drive = signals.staircase(1e-2, 0.0, 3.0, 50.0, steps=3, hold=0.5)
    for level in (0.0, 1.0, 2.0, 3.0):
        assert (drive.u == level).sum() >= 50


def test_swept_sine_sweeps_its_band() -> None:
    drive = signals.swept_sine(1e-3, 20_000, (5.0, 100.0), 2.0)
    crossings = np.flatnonzero(np.diff(np.signbit(drive.u)))
    local = 0.5 / (np.diff(crossings) * 1e-3)
    assert 0.5 / (crossings[0] * 1e-3) == pytest.approx(5.0, rel=0.1)
    assert local[-9:].mean() == pytest.approx(100.0, rel=0.1)


def test_persistence_is_the_rank_and_condition_of_the_matrix() -> None:
    u = np.random.default_rng(0).normal(size=400)
    matrix = np.lib.stride_tricks.sliding_window_view(u, 11)[:, ::-1]
    found = signals.persistence(u, 10)
    assert found.rank == 11
    assert found.sufficient
    assert found.condition == pytest.approx(np.linalg.cond(matrix), rel=1e-9)


def test_persistence_of_few_frequencies_is_told() -> None:
    k = np.arange(5000)
    two_tones = np.sin(0.1 * k) + np.sin(0.7 * k)
    found = signals.persistence(two_tones, 30)
    assert found.rank == 4  # two for each frequency
    assert not found.sufficient
    assert "rank 4 of 31" in found.advice()


def test_printed_input_at_the_printed_sample_time_excites_six_directions() -> None:
    # S0 sec. V-C with T_s = 1e-5 s; rank and condition are those of the notes on the paper.
    half = 0.5e-5 * np.arange(1, 100_000)
    u = np.append(0.0, np.sin(1000 * half) * np.sin(1001 * half) / np.sin(half))
    found = signals.persistence(5.0 * u, 30)
    assert found.rank <= 8
    assert found.condition > 1e13


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: signals.multisine(0.01, 100, rms=1.0, band=(60, 70)), "half the sample rate"),
        (lambda: signals.multisine(0.01, 100, rms=1.0, band=(-1, 7)), "in ascending order"),
        (lambda: signals.multisine(0.01, 100, rms=1.0, band=(1.2, 1.8)), "no line"),
        (lambda: signals.multisine(0.01, 1000, rms=1.0, periods=10**6), "1e.09 samples"),
        (lambda: signals.multisine(0.01, 100), "either amplitude or rms"),
        (lambda: signals.multisine(0.01, 100, rms=1.0, lines="even"), "lines is 'even'"),
        (lambda: signals.prbs(0.01, 1.0, clock=2, max_rate=10.0), "edge takes 21 samples"),
        (lambda: signals.prbs(0.01, 1.0, register=40), "register is 40"),
        (lambda: signals.forc(0.01, 1.0, 0.0, 1.0), "low below high"),
        (lambda: signals.triangle(0.01, 1.0, 0.0), "rate is 0.0"),
        (lambda: signals.triangle(1e-3, 1.0, 1.0, max_acceleration=1e-12), "max_acceleration"),
        (lambda: signals.swept_sine(0.01, 100, (1, 50), 1.0), "half the sample rate"),
        (lambda: signals.persistence(np.ones(10), 10), "more samples"),
    ],
)
def test_what_cannot_be_is_refused(make: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()  # type: ignore[operator]
