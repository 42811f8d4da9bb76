"""A wanted output through points that are moved."""

import numpy as np
import pytest

import hyst
from hyst.studio.work.reference import MOST_SAMPLES, Reference

SINE = Reference(middle=50.0, amplitude=20.0, frequency=2.0)


def test_unmoved_points_of_a_sine_make_a_sine() -> None:
    time, y = SINE.sampled(None)
    # A periodic cubic through 12 points a period is at most 1e-3 of the amplitude off.
    np.testing.assert_allclose(y, 50.0 + 20.0 * np.sin(4.0 * np.pi * time), atol=0.03)
    assert time[-1] == pytest.approx(1.5)


def test_a_triangle_is_straight_between_its_points() -> None:
    time, y = SINE.shaped("triangle").sampled(None)
    phase = np.mod(2.0 * time, 1.0)
    wanted = 50.0 + 20.0 * np.interp(phase, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    np.testing.assert_allclose(y, wanted, atol=1e-9)


def test_steps_hold_two_levels() -> None:
    assert sorted(set(SINE.shaped("steps").sampled(None)[1].round(9))) == [30.0, 70.0]


def test_a_point_goes_where_it_is_moved_and_no_further_than_the_amplitude() -> None:
    moved = SINE.shaped("triangle").moved(3, 60.0)
    assert moved.at_points()[1][3] == pytest.approx(60.0)
    assert moved.sampled(None)[1].max() < 70.0
    assert SINE.moved(3, 1e9).at_points()[1][3] == pytest.approx(70.0)


def test_periods_repeat() -> None:
    _, y = SINE.moved(0, 41.0).sampled(None)
    np.testing.assert_allclose(y[:600], y[600:1200], atol=1e-9)


def test_sample_times_of_models_are_kept_or_refused_with_a_frequency_that_will_do() -> None:
    time, _ = SINE.sampled(1e-3)
    assert time[1] == 1e-3
    with pytest.raises(hyst.InputError, match=r"choose at most 4.17 Hz"):
        SINE.with_number("frequency", 5.0).sampled(0.01)
    with pytest.raises(hyst.InputError, match=rf"the page takes {MOST_SAMPLES}; choose at least"):
        SINE.sampled(1e-6)
