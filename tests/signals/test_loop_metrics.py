from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.io import loadmat

from hyst.errors import InputError
from hyst.signals import hysteresis_percent, loop_area

STEPS = 16  # samples a unit of input: every corner of the loops below falls on a sample


def play(u: NDArray[np.float64], r: float) -> NDArray[np.float64]:
    """A play operator starting at rest, written out sample by sample."""
    y, z = np.empty_like(u), 0.0
    for k, value in enumerate(u):
        z = max(value - r, min(value + r, z))
        y[k] = z
    return y


def triangle(amplitude: int, cycles: int) -> NDArray[np.float64]:
    """Run 0 -> A -> -A -> 0 so many times."""
    top = amplitude * STEPS
    wave = np.concatenate((np.arange(top), np.arange(top, -top, -1), np.arange(-top, 0)))
    return np.tile(wave, cycles) / STEPS


@given(amplitude=st.integers(1, 4), notches=st.integers(1, 4 * STEPS - 1), cycles=st.integers(1, 3))
def test_the_loop_of_a_play_has_the_area_4_r_a_minus_r(
    amplitude: int, notches: int, cycles: int
) -> None:
    r = notches / STEPS
    u = triangle(amplitude, 1 + cycles)
    steady = slice(4 * amplitude * STEPS, None)  # the first cycle starts from rest
    area = loop_area(u[steady], play(u, r)[steady], cycles)
    # The polygon is the loop, so only rounding of sums of about 1e3 terms is left.
    assert area == pytest.approx(max(0.0, 4.0 * r * (amplitude - r)), rel=1e-12, abs=1e-12)


def test_the_area_of_a_sampled_sine_loop_converges() -> None:
    u = np.sin(2.0 * np.pi * np.linspace(0.0, 2.0, 20_001))
    area = loop_area(u[10_000:-1], play(u, 0.3)[10_000:-1])
    # Corners of the loop are missed by at most one step, 6e-4, on sides of length 1.
    assert area == pytest.approx(0.84, abs=1e-6)


def test_the_sign_tells_lag_from_work() -> None:
    u = triangle(2, 2)
    y = play(u, 0.5)
    lag, friction = u[-8 * STEPS :], (u - y)[-8 * STEPS :]
    assert loop_area(lag, y[-8 * STEPS :]) == pytest.approx(3.0, rel=1e-12)
    # A dry friction element, force u - y over displacement u, takes up 4 r (A - r) a cycle.
    assert loop_area(lag, friction) == pytest.approx(-3.0, rel=1e-12)


def test_the_area_ignores_offsets_and_the_starting_sample() -> None:
    u = triangle(2, 2)
    y = play(u, 0.5)[-8 * STEPS :]
    u = u[-8 * STEPS :]
    # Sums of 1e2 products of size 1e8 would lose 1e-6 if the origin were not taken out.
    assert loop_area(np.roll(u, 37) + 1e4, np.roll(y, 37) - 1e4) == pytest.approx(3.0, rel=1e-9)


def test_an_ellipse_has_the_area_pi_a_b() -> None:
    angle = 2.0 * np.pi * np.arange(1000) / 1000
    # A regular polygon of n corners has the area (n / 2) sin(2 pi / n) of the circle's radius^2.
    polygon = 500.0 * np.sin(2.0 * np.pi / 1000)
    area = loop_area(3.0 * np.cos(angle), 2.0 * np.sin(angle))
    assert area == pytest.approx(6.0 * polygon, rel=1e-13)
    assert area == pytest.approx(6.0 * np.pi, rel=1e-5)


@pytest.mark.parametrize("cycles", [1, 2, 4])
@pytest.mark.parametrize(("amplitude", "r"), [(2, 0.25), (2, 0.5), (2, 1.0), (2, 1.5), (3, 0.75)])
def test_the_loop_of_a_play_is_2_r_wide(amplitude: int, r: float, cycles: int) -> None:
    u = np.append(triangle(amplitude, cycles), 0.0)
    # Up to r = A / 2 the opening is 2 r; above, the two flat sides face each other.
    opening = min(2.0 * r, 2.0 * (amplitude - r))
    expected = 100.0 * opening / (2.0 * (amplitude - r))
    assert hysteresis_percent(u, play(u, r)) == pytest.approx(expected, rel=1e-12)


def test_the_start_from_rest_does_not_count() -> None:
    # From rest along y = u, then around a loop between y = 0.5 u and y = 0.5 u + 1.
    u = [0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0]
    y = [-4.0, -1.0, 2.0, 1.5, 0.0, 0.5, 2.0]
    # 1 between rising and falling at u = 1, of a range from -4 to 2.
    assert hysteresis_percent(u, y) == pytest.approx(100.0 / 6.0, rel=1e-12)
    # With a single reversal there is nothing else to compare with: 4 at u = 0.
    assert hysteresis_percent(u[:5], y[:5]) == pytest.approx(400.0 / 6.0, rel=1e-12)


def test_a_single_valued_curve_has_no_hysteresis() -> None:
    u = triangle(2, 2)
    assert hysteresis_percent(u, u**3) == pytest.approx(0.0, abs=1e-12)


def test_branches_sampled_at_different_inputs_are_compared_in_between() -> None:
    # Rising along y = u in one stride, falling along the corner (1, 3): opening 2 at u = 1.
    assert hysteresis_percent([4.0, 0.0, 4.0, 1.0, 0.0], [4.0, 0.0, 4.0, 3.0, 0.0]) == 50.0


def test_noise_on_the_input_changes_the_width_by_no_more_than_itself() -> None:
    u = triangle(2, 4)
    rng = np.random.default_rng(11)
    disturbed = u + rng.uniform(-0.02, 0.02, u.size)
    # The loop is 1 wide of 3; input noise of 0.02 on sides of slope 1 moves each side by 0.02,
    # and a sample can be one step of 1 / 16 from where its neighbour was taken to be.
    found = hysteresis_percent(disturbed, play(u, 0.5), dead_band=0.1)
    assert found == pytest.approx(100.0 / 3.0, abs=100.0 * 2.0 * (0.02 + 1.0 / STEPS) / 3.0)


@pytest.mark.parametrize(
    ("u", "y", "message"),
    [
        ([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], "u has no reversal"),
        ([1.0, 1.0, 1.0], [0.0, 1.0, 2.0], "u has no reversal"),
        ([0.0, 1.0, 0.0], [2.0, 2.0, 2.0], "y is 2.0 throughout"),
        ([0.0, 1.0], [2.0, 2.0, 2.0], "u and y have 2 and 3 samples"),
        ([0.0, np.nan], [2.0, 2.0], "u is nan at index 1"),
    ],
)
def test_what_is_no_loop_is_refused(u: list[float], y: list[float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        hysteresis_percent(u, y)


def test_an_area_of_no_cycles_is_refused() -> None:
    with pytest.raises(InputError, match="cycles is 0"):
        loop_area([0.0, 1.0], [0.0, 1.0], cycles=0)


def test_measured_magnetic_loops_enclose_more_the_further_they_reach(measured_data: Path) -> None:
    folder = measured_data / "magnetic-bh"
    h = loadmat(folder / "H_MnZn_HP_ferrite.mat")["HmeasT"]
    b = loadmat(folder / "B_MnZn_HP_ferrite.mat")["BmeasT"]
    losses = [loop_area(h[:, k], b[:, k]) for k in range(h.shape[1])]
    assert losses[0] > 0.0  # B lags H
    assert losses == sorted(losses)
