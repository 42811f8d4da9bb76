"""Waveform tables: points, limits, slew, closed ends, codes, and the output that is predicted."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hyst
from hyst.errors import InputError, NotInvertibleError
from hyst.export import waveform

PLAYS = hyst.PrandtlIshlinskii(p=[0.02, 0.03, 0.02], r=[5.0, 15.0, 40.0], p0=0.06)


def sine(samples: int = 1000, amplitude: float = 50.0) -> np.ndarray:
    """One period around 75."""
    return 75.0 + amplitude * np.sin(2.0 * np.pi * np.arange(samples) / samples)


WIDE: dict[str, Any] = {"limits": (0.0, 150.0)}


def test_a_whole_ratio_takes_samples_as_they_are() -> None:
    u = sine()
    every = waveform(u, 1e-3, controller_rate=200.0, repeat=True, **WIDE)
    assert np.array_equal(every.u, u[::5])
    assert every.dt == 1.0 / 200.0
    finer = waveform(u, 1e-3, controller_rate=4000.0, repeat=True, **WIDE)
    assert np.array_equal(finer.u[::4], u)
    # Straight lines between, also from the last sample to the first.
    assert finer.u[-2] == pytest.approx(0.5 * (u[-1] + u[0]), abs=1e-12)
    assert np.array_equal(waveform(u, 1e-3, **WIDE).u, u)


@pytest.mark.parametrize("ratio", [0.37, 0.9, 3.3])
def test_other_ratios_are_straight_lines_whose_cost_is_told(ratio: float) -> None:
    u, dt = sine(400), 1e-3
    table = waveform(u, dt, controller_rate=1000.0 / ratio, **WIDE)
    times = np.arange(table.u.size) * table.dt
    assert times[-1] >= 399 * dt > times[-2]  # the end is reached and held
    # Times are products of two roundings, the sine moves 0.8 a sample.
    assert np.abs(table.u - np.interp(times, np.arange(400) * dt, u)).max() < 1e-9
    smooth = 75.0 + 50.0 * np.sin(2.0 * np.pi * times / 0.4)
    inside = times <= 399 * dt
    off = np.abs(table.u - smooth)[inside].max()
    told = float(table.sentences[0].split("smooth signal by up to ")[1].split(";")[0])
    assert 0.3 * told < off <= 1.01 * told


def test_what_is_left_out_is_told() -> None:
    u = np.zeros(101)
    u[33] = 7.0
    table = waveform(u, 1e-3, controller_rate=100.0, limits=(-1.0, 9.0))
    assert table.u.max() == 0.0
    assert "off the others by up to 7" in table.sentences[0]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            {"limits": (0.0, 120.0)},
            "point 179 at 0.179 s is 120.106698, out of the limits 0 to 120",
        ),
        ({"limits": (30.0, 150.0)}, "point 679 at 0.679 s"),
        ({"limits": (150.0, 0.0)}, "lower one first"),
        ({"limits": None}, "no limits of the drive are known"),
        ({"slew": 300.0}, "from point 0 at 0 s .* 314.157 per second, more than the slew 300"),
        ({"slew": -1.0}, "slew"),
        ({"points": 999}, "1000 points at 1000 Hz, and 999 are allowed"),
        ({"points": 0}, "points"),
        ({"controller_rate": 0.0}, "controller_rate"),
        ({"controller_rate": 1e12}, "more than 10000000"),
        ({"controller_rate": 300.5, "repeat": True}, "300.5 samples .* at 300 or 301 Hz"),
        ({"bits": 0}, "bits"),
        ({"bits": 8, "driver": hyst.Driver.linear(1.0, 0.0, 0, 150)}, "give one of them"),
        ({"driver": hyst.Driver.linear(0.03, 0.0, 0, 4095)}, "point 204 .* limits 0 to 122.85"),
        ({"driver": hyst.Driver.linear(0.03, 500.0, 0, 4095)}, "no code of the driver"),
        ({"history": [1.0]}, "there is no model"),
    ],
)
def test_what_cannot_be_played_is_refused(given: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        waveform(sine(), 1e-3, **(WIDE | given))


def test_a_rate_that_is_proposed_fits() -> None:
    for repeat, most in ((False, 400), (True, 250)):
        with pytest.raises(InputError, match="are allowed") as refusal:
            waveform(sine(), 1e-3, points=most, repeat=repeat, **WIDE)
        rate = float(str(refusal.value).split("rate of ")[1].split(" Hz")[0])
        fits = waveform(sine(), 1e-3, points=most, controller_rate=rate, repeat=repeat, **WIDE)
        assert fits.u.size <= most


@pytest.mark.parametrize(("samples", "rate", "points"), [(766, 136487.0, 99), (31, 791.1, 11)])
def test_rates_that_are_proposed_fit_where_they_are_no_short_decimals(
    samples: int, rate: float, points: int
) -> None:
    u, dt = sine(samples), 0.7e-5 * 9.0
    with pytest.raises(InputError, match="a whole number of them") as refusal:
        waveform(u, dt, controller_rate=rate, repeat=True, **WIDE)
    for each in str(refusal.value).split("as at ")[1].removesuffix(" Hz").split(" or "):
        fits = waveform(u, dt, controller_rate=float(each), repeat=True, **WIDE)
        assert fits.u.size == round(float(each) * samples * dt)
    with pytest.raises(InputError, match="are allowed") as refusal:
        waveform(u, dt, points=points, **WIDE)
    proposed = str(refusal.value).split("rate of ")[1].split(" Hz")[0]
    fits = waveform(u, dt, controller_rate=float(proposed), points=points, **WIDE)
    assert fits.u.size == points


def test_one_point_is_no_matter_of_the_rate() -> None:
    with pytest.raises(InputError, match="1 are allowed; give a shorter signal"):
        waveform(sine(), 1e-3, points=1, **WIDE)


def test_the_way_back_to_the_start_is_among_rates() -> None:
    back = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 3.0, 2.0])  # from 2 to 0 at once
    assert waveform(back, 0.5, repeat=True, limits=(0, 5)).largest_rate == 4.0
    assert waveform(back, 0.5, limits=(0, 5)).largest_rate == 2.0
    # The wanted drive moves by 3, 2 and 1, its codes by 5 (from 5 to 0) and 5 back.
    wave, coarse = np.array([2.4, 3.9, 2.6]), hyst.Driver.linear(5.0, 0.0, 0, 1)
    told = waveform(wave, 0.5, repeat=True, slew=4.0, driver=coarse, limits=(0, 5)).sentences
    assert "codes move by up to 10 per second" in told[-1]


@pytest.mark.parametrize("given", [{"driver": "d.csv"}, {"model": "m.json"}])
def test_texts_are_no_drivers_or_models(given: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="is a str; give"):
        waveform(sine(), 1e-3, **(WIDE | given))


def test_the_end_of_a_wave_that_repeats_is_checked_too() -> None:
    ramp = np.linspace(0.0, 100.0, 101)
    with pytest.raises(
        InputError, match=r"last point 100 to its first 0 at once, .* elsewhere is 1"
    ):
        waveform(ramp, 1e-3, repeat=True, **WIDE)
    with pytest.raises(InputError, match="100000 per second, more than the slew 50000"):
        waveform(ramp, 1e-3, repeat=True, slew=5e4, **WIDE)
    assert waveform(ramp, 1e-3, repeat=True, slew=1.1e5, **WIDE).u.size == 101
    assert "from 100 to 0 at once" in waveform(ramp, 1e-3, **WIDE).sentences[1]
    closed = waveform(np.append(sine(), sine()[0]), 1e-3, repeat=True, **WIDE)
    assert "held twice" in closed.sentences[1]
    assert len(waveform(sine(), 1e-3, repeat=True, **WIDE).sentences) == 1


def test_codes_are_the_nearest_and_keep_the_limits() -> None:
    driver = hyst.Driver.from_table([0, 1000, 4095], [-0.3, 40.1, 150.2])
    table = waveform(sine(), 1e-3, driver=driver, limits=(25.0, 125.0))
    assert table.codes is not None
    assert np.array_equal(table.codes, driver.codes(sine(), (25.0, 125.0)))
    assert table.played.min() >= 25.0
    assert table.played.max() <= 125.0
    assert table.command_error.max_abs <= driver.steps[1]
    bits = waveform(sine(), 1e-3, bits=10, **WIDE)
    nearest = np.ceil(sine() / 150.0 * 1023.0 - 0.5)  # of two the lower one
    assert np.array_equal(bits.codes, nearest)  # type: ignore[arg-type]
    headers, columns = bits.columns("drive", "V")
    assert headers == ["time [s]", "drive [V]", "code"]
    assert columns[0][3] == 0.003
    assert columns[2].dtype == np.int64


def test_codes_that_step_faster_than_the_slew_are_told() -> None:
    table = waveform(np.linspace(0.0, 1.0, 101), 1e-3, slew=12.0, limits=(0, 150), bits=12)
    assert any("its codes move by up to" in each for each in table.sentences)


def test_a_cycle_is_closed_and_its_output_is_the_wanted_one() -> None:
    y_ref = 9.0 + 4.0 * np.sin(2.0 * np.pi * np.arange(500) / 500.0)
    table = waveform(y_ref, 1e-3, model=PLAYS, repeat=True, **WIDE)
    played = PLAYS(np.tile(table.played, 5))
    # Exact inversion: rounding of numbers of about 100.
    assert np.abs(played[-500:] - y_ref).max() < 1e-11
    assert table.error is not None
    assert table.first_error is not None
    assert table.error.max_abs < 1e-11
    # The first pass begins with another memory, which the table says.
    assert np.abs(played[:500] - y_ref).max() == pytest.approx(table.first_error.max_abs)
    assert table.first_error.max_abs > 0.1
    # Held for a sample the output waits while the reference moves on.
    moves = np.abs(np.diff(np.append(y_ref, y_ref[0]))).max()
    assert table.error.held_max_abs == pytest.approx(moves, rel=1e-6)


def test_codes_of_a_cycle_miss_by_half_a_step() -> None:
    y_ref = 9.0 + 4.0 * np.sin(2.0 * np.pi * np.arange(2000) / 2000.0)
    driver = hyst.Driver.linear(150.0 / 4095.0, 0.0, 0, 4095)
    table = waveform(
        y_ref, 1e-4, controller_rate=5000.0, model=PLAYS, repeat=True, driver=driver, **WIDE
    )
    played = PLAYS(np.tile(driver.volts(table.codes), 3))[-1000:]  # type: ignore[arg-type]
    # All plays together take over half a step, and rounding.
    assert np.abs(played - y_ref[::2]).max() <= 0.13 * 0.5 * driver.steps[1] + 1e-11
    assert table.error is not None
    assert table.error.max_abs == pytest.approx(np.abs(played - y_ref[::2]).max())


def test_once_starts_from_what_was_driven_before() -> None:
    y_ref = PLAYS(np.concatenate([[0.0, 100.0, 20.0], np.linspace(20.0, 90.0, 300)]))[3:]
    table = waveform(y_ref, 1e-3, model=PLAYS, history=[0.0, 100.0, 20.0], **WIDE)
    assert np.abs(table.u - np.linspace(20.0, 90.0, 300)).max() < 1e-9
    assert table.error is not None
    assert table.error.max_abs < 1e-11


def test_creep_settles_or_is_refused() -> None:
    y_ref = 9.0 + 4.0 * np.sin(2.0 * np.pi * np.arange(500) / 500.0)
    quick = hyst.Creep([0.05], [0.3], 1e-3) @ PLAYS
    table = waveform(y_ref, 1e-3, model=quick, repeat=True, **WIDE)
    assert table.error is not None
    # A lag of 0.3 s has decayed by exp(-48 / 0.3 / 2) at the most after as many periods.
    assert np.abs(quick(np.tile(table.u, 48))[-500:] - y_ref).max() < 1e-6
    slow = hyst.Creep([0.05], [60.0], 1e-3) @ PLAYS
    with pytest.raises(InputError, match="still changes by"):
        waveform(y_ref, 1e-3, model=slow, repeat=True, **WIDE)
    with pytest.raises(InputError, match="controller"):
        waveform(y_ref, 1e-3, model=quick, controller_rate=500.0, **WIDE)


def test_models_without_a_command_are_refused() -> None:
    flat = hyst.PrandtlIshlinskii(p=[0.5], r=[1.0], p0=0.0)
    with pytest.raises(NotInvertibleError):
        waveform([0.0, 0.1], 1e-3, model=flat, limits=(0, 1))
    verdict = hyst.operators.Verdict("unfit", ("Noise.",))
    unfit = PLAYS.with_description(hyst.ModelDescription(verdict=verdict))
    with pytest.raises(InputError, match="no table is made"):
        waveform([0.0, 0.1], 1e-3, model=unfit, **WIDE)
    with pytest.raises(InputError, match="outside its range"):
        waveform([0.0, 99.0], 1e-3, model=PLAYS, **WIDE)
