from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst.errors import InputError
from hyst.signals import reversals

# Few distinct values, so that plateaus, ties and swings of exactly the dead band are common.
COARSE = st.lists(st.integers(-4, 4).map(float), min_size=1, max_size=40)
FINE = st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=40)
DEAD_BANDS = st.sampled_from([0.0, 0.5, 1.0, 2.0, 3.0])


def by_definition(u: list[float], dead_band: float) -> list[int]:
    """The docstring's two conditions, checked sample by sample."""

    def is_maximum(signal: list[float], k: int) -> bool:
        came_up = left = False
        for i in range(k - 1, -1, -1):
            if signal[i] >= signal[k]:
                break
            came_up = came_up or signal[k] - signal[i] > dead_band
        for j in range(k + 1, len(signal)):
            if signal[j] > signal[k]:
                break
            left = left or signal[k] - signal[j] > dead_band
        return came_up and left

    mirrored = [-value for value in u]
    return [k for k in range(len(u)) if is_maximum(u, k) or is_maximum(mirrored, k)]


@given(u=COARSE, dead_band=DEAD_BANDS)
def test_the_definition_holds_with_ties_and_plateaus(u: list[float], dead_band: float) -> None:
    assert reversals(u, dead_band).tolist() == by_definition(u, dead_band)


@given(u=FINE, dead_band=st.floats(0.0, 1e6))
def test_the_definition_holds_for_any_values(u: list[float], dead_band: float) -> None:
    assert reversals(u, dead_band).tolist() == by_definition(u, dead_band)


@given(u=FINE, dead_band=st.floats(0.0, 1e6))
def test_maxima_and_minima_alternate_with_swings_above_the_dead_band(
    u: list[float], dead_band: float
) -> None:
    swings = np.diff(np.array(u)[reversals(u, dead_band)])
    assert (np.abs(swings) > dead_band).all()
    assert (np.sign(swings[1:]) == -np.sign(swings[:-1])).all()


@given(u=COARSE, dead_band=DEAD_BANDS, data=st.data())
def test_repeating_samples_moves_indices_and_nothing_else(
    u: list[float], dead_band: float, data: st.DataObject
) -> None:
    counts = data.draw(st.lists(st.integers(1, 4), min_size=len(u), max_size=len(u)))
    first_of_each = np.concatenate(([0], np.cumsum(counts)))
    stretched = reversals(np.repeat(u, counts), dead_band)
    assert stretched.tolist() == first_of_each[reversals(u, dead_band)].tolist()


@given(u=COARSE, dead_band=DEAD_BANDS)
def test_the_mirrored_signal_turns_at_the_same_samples(u: list[float], dead_band: float) -> None:
    assert reversals(-np.array(u), dead_band).tolist() == reversals(u, dead_band).tolist()


@given(
    seed=st.integers(0, 2**32 - 1),
    cycles=st.integers(1, 6),
    dead_band=st.floats(1e-3, 0.9),
    noise=st.floats(0.0, 0.499),
)
def test_noise_below_half_the_dead_band_leaves_the_count_on_a_sine(
    seed: int, cycles: int, dead_band: float, noise: float
) -> None:
    # Swings of the noise stay below 2 * 0.499 D < D; those of the sine above 2 - D > D.
    sine = np.sin(2.0 * np.pi * np.linspace(0.0, cycles, 200 * cycles + 1))
    disturbed = sine + dead_band * np.random.default_rng(seed).uniform(-noise, noise, sine.size)
    assert reversals(disturbed, dead_band).size == 2 * cycles


def test_a_long_noisy_sine_keeps_its_reversals_near_the_crests() -> None:
    time = np.arange(200_000) * 1e-3
    disturbed = np.sin(time) + np.random.default_rng(3).uniform(-0.02, 0.02, time.size)
    found = time[reversals(disturbed, dead_band=0.05)]
    crests = np.pi * (np.arange(found.size) + 0.5)
    assert found.size == 64  # crests at pi (k + 1/2) below 200
    # 1 - cos(x) = 0.04 at x = 0.28: further from a crest noise cannot lift a sample above it.
    assert np.abs(found - crests).max() < 0.29


@pytest.mark.parametrize(
    ("u", "dead_band", "expected"),
    [
        ([5.0], 0.0, []),
        ([5.0, 5.0, 5.0], 0.0, []),
        ([0.0, 1.0, 2.0], 0.0, []),
        ([0.0, 1.0, 0.0], 0.0, [1]),
        ([0.0, 1.0, 1.0, 1.0, 0.0], 0.0, [1]),  # a plateau counts by its first index
        ([0.0, 0.0, 1.0, 1.0], 0.0, []),  # plateaus at the ends are no turns
        ([0.0, 3.0, 2.0, 3.0, 0.0], 1.0, [1]),  # a dip of exactly the dead band is no swing
        ([0.0, 3.0, 1.9, 3.0, 0.0], 1.0, [1, 2, 3]),
        ([0.0, 0.5, -2.0, 0.0], 1.0, [2]),  # the rise before index 1 is within the dead band
        ([0.0, 2.0, 0.0], 2.0, []),  # not more than the dead band
        ([1.7e308, -1.7e308, 1.7e308], 1e308, [1]),  # the swing itself overflows a double
        ([0.0, 5e-324, 0.0], 0.0, [1]),  # the smallest positive double
    ],
)
def test_small_cases_worked_by_hand(u: list[float], dead_band: float, expected: list[int]) -> None:
    assert reversals(u, dead_band).tolist() == expected


def test_indices_can_index() -> None:
    for dead_band in (0.0, 0.5):
        assert reversals([0.0, 1.0, 0.0], dead_band).dtype == np.intp
        assert reversals([0.0], dead_band).dtype == np.intp


@pytest.mark.parametrize("dead_band", [-1e-9, np.nan, np.inf])
def test_an_impossible_dead_band_is_refused(dead_band: float) -> None:
    with pytest.raises(InputError, match=f"dead_band is {dead_band}"):
        reversals([0.0, 1.0], dead_band)


def test_a_gap_in_the_signal_is_refused() -> None:
    with pytest.raises(InputError, match="u is nan at index 1"):
        reversals([0.0, np.nan, 1.0])
