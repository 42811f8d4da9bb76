"""A play as wide as a power of the rate of its input."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import InputError, NotInvertibleError, RateShift


def plain_loop(c: float, m: float, dt: float, u: np.ndarray) -> np.ndarray:
    """The equation, sample by sample, in NumPy."""
    z, last, result = 0.0, u[0], []
    for each in u:
        width = c * (abs(each - last) / dt) ** m
        z = min(max(z, each - width), each + width)
        last = each
        result.append(z)
    return np.array(result)


@pytest.mark.parametrize("m", [0.08, 0.5, 1.0, 1.7])
def test_it_is_the_play_of_its_equation(m: float) -> None:
    u = np.random.default_rng(1).normal(size=300).cumsum()
    # The core's own power is exact to 4 + 2 |m log2 x| roundings; so is no libm's to the bit.
    np.testing.assert_allclose(
        RateShift(0.3, m, 0.01)(u), plain_loop(0.3, m, 0.01, u), rtol=1e-13, atol=1e-13
    )


def test_relays_behind_it_switch_later_by_the_shift() -> None:
    """A triangle of 2 input units per second, c 2^m = 0.2 sqrt(2): the loop is so much wider."""
    u = np.concatenate([np.linspace(-1.0, 1.0, 1001), np.linspace(1.0, -1.0, 1001)[1:]])
    z = RateShift(0.2, 0.5, 1e-3)(u)
    up, down = u[:1001][z[:1001] >= 0.0][0], u[1001:][z[1001:] <= 0.0][0]
    # Samples are 0.002 apart, so that a crossing is found to as much.
    assert up == pytest.approx(0.2 * np.sqrt(2.0), abs=0.0021)
    assert down == pytest.approx(-0.2 * np.sqrt(2.0), abs=0.0021)
    assert RateShift(0.2, 0.5, 1e-3).shift_at(-2.0) == pytest.approx(0.2 * np.sqrt(2.0), rel=1e-15)


def test_half_the_sample_time_shifts_as_much_at_the_same_rate() -> None:
    shift = RateShift(0.2, 0.5, 0.5)
    coarse = shift(np.arange(0.0, 5.0, 0.5))
    fine = shift.at_sample_time(0.25)(np.arange(0.0, 4.75, 0.25))
    # Both rise at a rate of 1; the same operations but for the sample time, a power of two.
    np.testing.assert_array_equal(coarse[1:], fine[2::2])


def test_units_scale_the_shift() -> None:
    u = np.random.default_rng(2).normal(size=50).cumsum()
    model = RateShift(0.3, 0.5, 0.1, z0=0.25)
    # 4^(1 - m) = 2: powers of two, so only the power function rounds.
    np.testing.assert_allclose(model.in_units(4.0, 4.0)(4.0 * u), 4.0 * model(u), rtol=1e-14)
    with pytest.raises(InputError, match="other units"):
        model.in_units(4.0, 2.0)


def test_in_front_of_a_model_it_keeps_the_unit_of_the_input() -> None:
    plays = hyst.PrandtlIshlinskii([0.5], [0.5], 1.0)
    model = plays @ RateShift(0.3, 0.5, 0.1)
    u = np.random.default_rng(3).normal(size=50).cumsum()
    # As above.
    np.testing.assert_allclose(model.in_units(4.0, 8.0)(4.0 * u), 8.0 * model(u), rtol=1e-13)


def test_without_a_shift_it_is_its_own_inverse() -> None:
    u = np.array([0.0, 3.0, -1.0])
    np.testing.assert_array_equal(RateShift(0.0, 0.5, 0.1)(u), u)
    np.testing.assert_array_equal(RateShift(0.0, 0.5, 0.1).inverse()(u), u)
    assert RateShift(0.0, 0.5, 0.1).is_invertible()


def test_with_a_shift_there_is_no_inverse() -> None:
    with pytest.raises(NotInvertibleError, match=r"c is 0\.3"):
        RateShift(0.3, 0.5, 0.1).inverse()


@pytest.mark.parametrize(
    ("constants", "message"),
    [((-0.1, 0.5, 0.1), "c is -0.1"), ((0.1, 0.0, 0.1), "m is 0"), ((0.1, 0.5, 0.0), "0")],
)
def test_constants_that_are_none_are_refused(
    constants: tuple[float, float, float], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        RateShift(*constants)
