"""Commands as codes: what rounding costs, and that it does not add up."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.compensation import in_codes, invert_trajectory
from hyst.errors import InputError

PLAYS = hyst.PrandtlIshlinskii(p=[0.3, -0.1, 0.4], r=[0.1, 0.3, 0.7], p0=1.0)


def long_drive(samples: int = 100_000) -> np.ndarray:
    """Strokes that never repeat, between -1 and 1."""
    k = np.arange(samples)
    return 0.6 * np.sin(k / 61.0) + 0.4 * np.sin(k / 47.3)


def test_plays_miss_by_half_a_step_times_their_weights_and_no_more_later() -> None:
    driver = hyst.Driver.linear(2.0 / 255.0, -1.0, 0, 255)
    u = long_drive()
    error = np.abs(PLAYS(driver.quantized(u)) - PLAYS(u))
    # A play takes over at most the largest difference of two drives so far.
    bound = (1.0 + 0.3 + 0.1 + 0.4) * 0.5 * driver.steps[1]
    assert error.max() <= bound * (1.0 + 1e-9)
    assert error[:20_000].max() > 0.5 * bound
    assert error[-20_000:].max() <= 1.05 * error[:20_000].max()


CELLS = np.tril(np.random.default_rng(0).uniform(0.0, 1.0, (12, 12)))
OTHERS = {
    "preisach": hyst.Preisach(CELLS, np.linspace(-1.0, 1.0, 13)),
    "ramberg-osgood": hyst.RambergOsgood(c1=1.0, c2=0.5, c3=3.0),
    "dahl": hyst.Dahl(sigma=4.0, Fc=0.5),
    "creep": hyst.Creep([0.1], [0.5], 0.01) @ PLAYS,
}


@pytest.mark.parametrize("model", OTHERS.values(), ids=OTHERS)
def test_errors_of_other_memories_do_not_grow(model: hyst.Operator) -> None:
    driver = hyst.Driver.linear(2.0 / 255.0, -1.0, 0, 255)
    u = long_drive(50_000)
    error = np.abs(model(driver.quantized(u)) - model(u))
    assert error[:10_000].max() > 0.0
    # The drive never repeats, so later samples may meet a slightly worse place: by tenths, while
    # what adds up over five times the samples would be five times as large.
    assert error[-10_000:].max() <= 1.25 * error[:10_000].max()


def test_codes_of_a_command_and_their_output() -> None:
    driver = hyst.Driver.from_table([0, 1000, 4095], [-1.1, -0.6, 1.2])
    y_ref = PLAYS(0.9 * long_drive(4000))
    done = invert_trajectory(PLAYS, y_ref)
    coded = in_codes(PLAYS, done, driver)
    assert np.array_equal(coded.codes, driver.codes(done.u))
    assert np.abs(coded.u - done.u).max() == coded.off <= 0.5 * driver.steps[1] * (1.0 + 1e-9)
    # Rounding of two inversions apart, the predicted output is that of the codes' volts.
    assert np.abs(coded.y_predicted - PLAYS(driver.volts(coded.codes))).max() < 1e-12
    assert 0.0 < coded.max_abs <= 1.8 * 0.5 * driver.steps[1]
    assert "as codes" in coded.told("V", "um")


def test_history_is_that_of_the_command() -> None:
    driver = hyst.Driver.linear(0.001, 0.0, -2000, 2000)
    y_ref = np.linspace(0.5, -0.5, 300)
    done = invert_trajectory(PLAYS, y_ref, history=[0.0, 1.4])
    coded = in_codes(PLAYS, done, driver, history=[0.0, 1.4])
    whole = PLAYS(np.concatenate([[0.0, 1.4], coded.u]))[2:]
    assert np.abs(coded.y_predicted - whole).max() < 1e-12
    assert np.abs(coded.predicted_error).max() <= 1.8 * 0.0005


def test_limits_hold_for_the_volts_of_codes() -> None:
    driver = hyst.Driver.linear(0.1, 0.0, -20, 20)
    done = invert_trajectory(PLAYS, PLAYS(np.linspace(-0.57, 0.57, 50)))
    coded = in_codes(PLAYS, done, driver, limits=(-0.57, 0.57))
    assert coded.u.min() == pytest.approx(-0.5)
    assert coded.u.max() == pytest.approx(0.5)


def test_a_driver_comes_from_the_description_or_is_asked_for() -> None:
    done = invert_trajectory(PLAYS, [0.0, 0.2])
    with pytest.raises(InputError, match="no driver"):
        in_codes(PLAYS, done)
    driver = hyst.Driver.linear(0.1, 0.0, 0, 20)
    known = PLAYS.with_description(hyst.ModelDescription(driver=driver))
    assert in_codes(known, done).driver == driver
