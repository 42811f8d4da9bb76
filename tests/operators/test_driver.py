"""Drivers: volts of codes and codes of volts against hand calculation and looking at every code."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import hyst
from hyst import Driver
from hyst.errors import InputError
from hyst.operators import ModelDescription


def random_driver(seed: int, *, falls: bool = False) -> Driver:
    """A table with pieces of few codes and of hundreds, and slopes a factor of ten apart."""
    rng = np.random.default_rng(seed)
    codes = np.cumsum(rng.integers(1, 400, 8)) - 900
    volts = np.cumsum(np.diff(codes, prepend=codes[0] - 1) * rng.uniform(0.005, 0.05, 8)) - 3.0
    return Driver.from_table(codes, -volts if falls else volts)


def exact_volts(driver: Driver, code: int) -> Fraction:
    """The straight line between the points in fractions."""
    codes = driver.table_codes
    volts = [Fraction(each) for each in driver.table_volts]
    i = max(k for k in range(len(codes) - 1) if codes[k] <= code)
    return volts[i] + (volts[i + 1] - volts[i]) * Fraction(code - codes[i], codes[i + 1] - codes[i])


def test_a_table_is_a_line_between_its_points() -> None:
    driver = Driver.from_table([0, 2, 6], [0.0, 1.0, 5.0])
    assert driver.volts([0, 1, 2, 3, 6]).tolist() == [0.0, 0.5, 1.0, 2.0, 5.0]
    assert driver.code_range == (0, 6)
    assert driver.volt_range == (0.0, 5.0)
    assert driver.steps == (0.5, 1.0)


def test_scale_and_offset() -> None:
    driver = Driver.linear(-0.5, 1.0, -2, 4)
    assert driver.volts([-2, 0, 4]).tolist() == [2.0, 1.0, -1.0]
    assert driver.codes([2.0, 0.9, -1.0]).tolist() == [-2, 0, 4]
    assert driver.volt_range == (-1.0, 2.0)


def test_rows_may_come_with_falling_codes() -> None:
    assert Driver.from_table([6, 2, 0], [5.0, 1.0, 0.0]) == Driver.from_table(
        [0, 2, 6], [0.0, 1.0, 5.0]
    )


@pytest.mark.parametrize("scale", [0.25, -0.25])
def test_a_tie_goes_to_the_lower_code_and_nothing_leaves_the_table(scale: float) -> None:
    driver = Driver.linear(scale, 0.0, -4, 4)
    halves = scale * np.array([-3.5, -0.5, 0.5, 2.5])
    assert driver.codes(halves).tolist() == [-4, -1, 0, 2]
    assert driver.codes(scale * np.array([-4.2, 4.2, 1e300])).tolist() == [-4, 4, 4]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("falls", [False, True])
def test_volts_and_nearest_codes_are_those_of_looking_at_every_code(seed: int, falls: bool) -> None:
    driver = random_driver(seed, falls=falls)
    low, high = driver.code_range
    every = np.arange(low, high + 1)
    volts = driver.volts(every)
    exact = np.array([float(exact_volts(driver, int(code))) for code in every])
    # A slope, a product and a sum are rounded.
    assert np.abs(volts - exact).max() <= 4.0 * np.spacing(np.abs(exact).max())
    assert driver.codes(volts).tolist() == every.tolist()
    rng = np.random.default_rng(seed + 100)
    wanted = np.concatenate(
        [rng.uniform(volts.min() - 1.0, volts.max() + 1.0, 400), 0.5 * (volts[1:] + volts[:-1])]
    )
    # argmin takes the first of equals, which is the lower code.
    nearest = every[np.abs(volts[None, :] - wanted[:, None]).argmin(axis=1)]
    assert driver.codes(wanted).tolist() == nearest.tolist()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("falls", [False, True])
def test_codes_within_limits_give_volts_within_limits(seed: int, falls: bool) -> None:
    driver = random_driver(seed, falls=falls)
    low, high = driver.volt_range
    every = np.arange(driver.code_range[0], driver.code_range[1] + 1)
    volts = driver.volts(every)
    for share in (0.011, 0.2, 0.37):
        limits = low + share * (high - low), high - share * (high - low)
        inside = every[(volts >= limits[0]) & (volts <= limits[1])]
        assert driver.codes_within(*limits) == (inside.min(), inside.max())
        given = driver.quantized(np.linspace(low, high, 977), limits)
        assert given.min() >= limits[0]
        assert given.max() <= limits[1]
    with pytest.raises(InputError, match="no code of the driver"):
        driver.codes_within(high + 1.0, high + 2.0)
    middle = driver.volts(every[7])
    with pytest.raises(InputError, match="no code of the driver"):
        driver.codes_within(
            float(middle) + 0.3 * driver.steps[0], float(middle) + 0.4 * driver.steps[0]
        )
    # A limit that is a code's own volts is within.
    assert 7 + every[0] in driver.codes_within(float(middle), float(middle))


def test_rounding_is_off_by_half_a_step_at_most() -> None:
    driver = random_driver(5)
    wanted = np.linspace(*driver.volt_range, 5001)
    off = np.abs(driver.quantized(wanted) - wanted)
    # A rounding of the volts themselves comes on top.
    assert off.max() <= 0.5 * driver.steps[1] + 1e-14
    assert off.max() > 0.49 * driver.steps[1]


@pytest.mark.parametrize("exponent", [-40, -3, 7, 60])
def test_another_unit_changes_no_code(exponent: int) -> None:
    driver, wanted = random_driver(2), np.linspace(-9.0, 40.0, 3001)
    scaled = Driver(driver.table_codes, tuple(math.ldexp(v, exponent) for v in driver.table_volts))
    codes = driver.codes(wanted)
    assert np.array_equal(scaled.codes(np.ldexp(wanted, exponent)), codes)
    assert np.array_equal(scaled.volts(codes), np.ldexp(driver.volts(codes), exponent))


def test_all_codes_of_32_bits() -> None:
    driver = Driver.linear(2.0**-22, 0.0, -(2**31), 2**31 - 1)
    assert driver.volts([-(2**31), 0, 2**31 - 1]).tolist() == [-512.0, 0.0, 512.0 - 2.0**-22]
    assert driver.codes([-256.0, 1e9, -1e9]).tolist() == [-(2**30), 2**31 - 1, -(2**31)]


@pytest.mark.parametrize(
    ("codes", "volts", "said"),
    [
        ([0, 1, 2, 3], [0.0, 1.0, 0.5, 2.0], "row 3 .* volt 0.5 after 1"),
        ([0, 1, 2], [0.0, 1.0, 1.0], "row 3 .* volt 1 again, as in row 2"),
        ([0, 1, 1], [0.0, 1.0, 2.0], "row 3 .* code 1 again"),
        ([0, 5, 3], [0.0, 1.0, 2.0], "row 3 .* code 3 after 5"),
        ([0, 1.5], [0.0, 1.0], "row 2 .* code 1.5; codes are whole"),
        ([0, math.nan], [0.0, 1.0], "row 2 .* code nan"),
        ([0, 1, 2], [0.0, math.nan, 1.0], "row 2 .* volt nan; give finite"),
        ([0, 1], [0.0, math.inf], "row 2 .* volt inf"),
        ([0, 2**31], [0.0, 1.0], "row 2 .* code 2147483648; codes are of 32 bits"),
        ([-(2**31) - 1, 0], [0.0, 1.0], "row 1 .* 32 bits"),
        ([0], [0.0], "has 1 rows"),
        ([0, 1], [0.0], "two lists of the same length"),
        ([0, 1], [1e9, 1e9 + 4e-7], "after row 1 .* double precision does not resolve"),
        (["a", "b"], [0.0, 1.0], "give real numbers"),
    ],
)
def test_what_is_no_table_is_refused_by_its_first_bad_row(
    codes: list[Any], volts: list[float], said: str
) -> None:
    with pytest.raises(InputError, match=said):
        Driver.from_table(codes, volts)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((0.0, 0.0, 0, 1), "volts_per_code is 0"),
        ((1.0, 0.0, 1, 1), "lower code first"),
        ((1.0, math.nan, 0, 1), "offset"),
        ((1.0, 0.0, 0, 2**31), "high_code"),
        ((1.0, 0.0, 0, 1.5), "high_code"),
    ],
)
def test_what_is_no_scale_is_refused(given: tuple[Any, ...], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Driver.linear(*given)


@pytest.mark.parametrize(
    ("codes", "said"),
    [
        ([0, 1.5], "index 1 is 1.5"),
        ([0, 9], "index 1 is 9"),
        ([[0], [-1]], r"index \(1, 0\) is -1"),
    ],
)
def test_codes_that_a_driver_does_not_take_are_refused(codes: list[Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Driver.linear(1.0, 0.0, 0, 8).volts(codes)


def test_single_precision_is_refused_where_it_does_not_resolve_a_step() -> None:
    driver = Driver.linear(2.0**-20, 100.0, 0, 2**20)
    with pytest.raises(InputError, match="single precision does not resolve"):
        driver.require_resolved(single=True)
    Driver.linear(2.0**-12, 0.0, 0, 2**16).require_resolved(single=True)


@pytest.mark.parametrize(
    ("volts", "said"),
    [
        ([-1.7e308, 1.7e308], "row 1 .* moderate size"),
        ([0.0, 1e-310], "does not resolve"),  # fewer digits than steps of 1e-313 need
    ],
)
def test_volts_that_numbers_do_not_take_are_refused(volts: list[float], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Driver.from_table([0, 1000], volts)
    large = Driver.from_table([0, 10], [0.0, 1e300])
    with pytest.raises(InputError, match="beyond single precision; export in double"):
        large.require_resolved(single=True)
    small = Driver.from_table([0, 10], [0.0, 1e-44])
    with pytest.raises(InputError, match="single precision does not resolve"):
        small.require_resolved(single=True)


@pytest.mark.parametrize("limits", [3, (1, 2, 3), (math.nan, 3), ("a", "b"), ([1], 3)])
def test_limits_that_are_no_two_numbers_are_refused(limits: Any) -> None:
    with pytest.raises(InputError, match=r"give the lowest and the highest volts|a limit"):
        Driver.linear(1.0, 0.0, 0, 8).codes([1.0], limits)


def test_limits_may_be_infinite() -> None:
    driver = Driver.linear(1.0, 0.0, 0, 8)
    assert driver.codes([-9.0, 9.0], (-math.inf, math.inf)).tolist() == [0, 8]


def test_a_file_of_a_model_keeps_the_driver_and_is_read_by_its_own_version(tmp_path: Any) -> None:
    model = hyst.PrandtlIshlinskii(p=[0.5], r=[0.1], p0=1.0)
    driver = random_driver(3, falls=True)
    model.save(tmp_path / "model.json", ModelDescription(driver=driver))
    found = hyst.load(tmp_path / "model.json").description
    assert found.driver == driver
    assert found.of_inverse().driver == driver
    assert '"version": 5' in (tmp_path / "model.json").read_text()
    model.save(tmp_path / "plain.json")
    assert '"version": 3' in (tmp_path / "plain.json").read_text()
    told = (tmp_path / "model.json").read_text()
    (tmp_path / "older.json").write_text(told.replace('"version": 5', '"version": 4'))
    with pytest.raises(InputError, match="unknown entry 'driver'"):
        hyst.load(tmp_path / "older.json")
    (tmp_path / "bad.json").write_text(told.replace('"unit": "V"', '"units": "V"'))
    with pytest.raises(InputError, match="'codes', 'volts' and 'unit'"):
        hyst.load(tmp_path / "bad.json")
