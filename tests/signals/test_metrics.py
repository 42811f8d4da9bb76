from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst.errors import InputError
from hyst.signals import Metrics, error_metrics

Y = [0.0, 4.0, 0.0, 4.0]  # mean 2, deviations all 2
Y_MODEL = [1.0, 4.0, 0.0, 7.0]  # errors 1, 0, 0, 3


def test_a_case_worked_by_hand() -> None:
    metrics = error_metrics(Y, Y_MODEL)
    assert metrics.rms == pytest.approx(math.sqrt(10.0 / 4.0), rel=1e-15)
    assert metrics.max_abs == 3.0
    assert metrics.rms_percent == pytest.approx(25.0 * math.sqrt(2.5), rel=1e-15)
    assert metrics.max_percent == 75.0
    # ||e|| = sqrt 10, ||y - mean|| = sqrt 16
    assert metrics.nrmse_fit_percent == pytest.approx(100.0 * (1.0 - math.sqrt(0.625)), rel=1e-14)
    assert (metrics.bias, metrics.samples, metrics.output_range) == (1.0, 4, 4.0)


@pytest.mark.parametrize("exponent", [-1000, -40, 40, 1000])
def test_a_unit_smaller_by_a_power_of_two_changes_no_percentage(exponent: int) -> None:
    unit = math.ldexp(1.0, exponent)
    scaled = error_metrics(unit * np.array(Y), unit * np.array(Y_MODEL))
    plain = error_metrics(Y, Y_MODEL)
    assert scaled.rms == unit * plain.rms
    assert scaled.nrmse_fit_percent == plain.nrmse_fit_percent


def test_a_free_offset_takes_the_mean_error_out_and_reports_it() -> None:
    metrics = error_metrics(Y, Y_MODEL, free_offset=True)  # errors 0, -1, -1, 2
    assert metrics.rms == pytest.approx(math.sqrt(6.0 / 4.0), rel=1e-15)
    assert metrics.max_abs == 2.0
    assert metrics.bias == 1.0
    assert metrics.nrmse_fit_percent == pytest.approx(100.0 * (1.0 - math.sqrt(0.375)), rel=1e-14)


def test_the_range_of_the_percentages_can_be_given() -> None:
    metrics = error_metrics(Y, Y_MODEL, output_range=30.0)
    assert (metrics.max_abs, metrics.max_percent, metrics.output_range) == (3.0, 10.0, 30.0)


def test_a_perfect_model_and_the_mean_are_the_ends_of_the_fit_scale() -> None:
    assert error_metrics(Y, Y).nrmse_fit_percent == 100.0
    assert error_metrics(Y, [2.0] * 4).nrmse_fit_percent == 0.0


def test_the_dictionary_survives_json() -> None:
    metrics = error_metrics(Y, Y_MODEL)
    assert Metrics(**json.loads(json.dumps(metrics.to_dict()))) == metrics
    assert list(metrics.to_dict()) == [
        "rms",
        "max_abs",
        "rms_percent",
        "max_percent",
        "nrmse_fit_percent",
        "bias",
        "samples",
        "output_range",
    ]


@given(
    errors=st.lists(st.integers(-50, 50), min_size=4, max_size=4),
    scale=st.integers(-30, 30),
    offset=st.integers(-100, 100),
)
def test_percentages_do_not_depend_on_the_unit(errors: list[int], scale: int, offset: int) -> None:
    model = np.array(Y) + np.array(errors)
    here = error_metrics(Y, model)
    # Small integers times a power of two: nothing rounds before the mean and the root.
    there = error_metrics(2.0**scale * (np.array(Y) + offset), 2.0**scale * (model + offset))
    assert there.rms_percent == pytest.approx(here.rms_percent, rel=1e-12, abs=1e-12)
    assert there.nrmse_fit_percent == pytest.approx(here.nrmse_fit_percent, rel=1e-12, abs=1e-9)
    assert there.rms == pytest.approx(2.0**scale * here.rms, rel=1e-12)


@pytest.mark.parametrize(
    ("y", "y_model", "output_range", "message"),
    [
        ([1.0, 1.0], [1.0, 2.0], None, "y is 1.0 throughout"),
        ([1.0, 2.0], [1.0], None, "y and y_model have 2 and 1 samples"),
        ([1.0, 2.0], [1.0, math.nan], None, "y_model is nan at index 1"),
        ([math.inf, 2.0], [1.0, 2.0], None, "y is inf at index 0"),
        ([1.0, 2.0], [1.0, 2.0], 0.0, "output_range is 0.0"),
        ([1.0, 2.0], [1.0, 2.0], math.nan, "output_range is nan"),
    ],
)
def test_what_cannot_be_compared_is_refused(
    y: list[float], y_model: list[float], output_range: float | None, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        error_metrics(y, y_model, output_range=output_range)
