"""Laws of the widening as tables, against the formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hyst import InputError
from hyst.models import RateCurve

FASTEST = 2.5e4
RATES = np.concatenate([[0.0], np.geomspace(1e-3, FASTEST, 20001)])


def test_square_root() -> None:
    curve = RateCurve.square_root(0.13, FASTEST)
    # Pieces of equal error, 24 of them: 1 / (2 24^2) of g at the end, two thirds of it lifted.
    miss = np.abs(curve(RATES) - 0.13 * np.sqrt(RATES)).max()
    assert miss < 1e-3 * 0.13 * np.sqrt(FASTEST)
    assert curve(0.0) == 0.0


@pytest.mark.parametrize("rate", [30.0, 1e3, 3e4, 1e6])
@pytest.mark.parametrize("form", ["rational", "exponential"])
def test_saturating(rate: float, form: str) -> None:
    curve = RateCurve.saturating(2e-3, rate, FASTEST, form)
    x = RATES / rate
    law = 2e-3 * rate * (x / (1.0 + x) if form == "rational" else 1.0 - np.exp(-x))
    assert np.abs(curve(RATES) - law).max() < 1.5e-3 * 2e-3 * rate
    assert np.all(np.diff(curve(np.linspace(0.0, 2.0 * FASTEST, 999))) >= 0.0)


@pytest.mark.parametrize("power", [-20, 13])
def test_laws_scale_by_powers_of_two(power: int) -> None:
    factor = 2.0**power
    for one, other in (
        (RateCurve.square_root(0.5, 64.0), RateCurve.square_root(0.5, 64.0 * 4.0**power)),
        (
            RateCurve.saturating(0.5, 8.0, 64.0),
            RateCurve.saturating(0.5, 8.0 * factor, 64.0 * factor),
        ),
    ):
        ratio = other.knees / one.knees
        assert np.all(ratio == ratio[0])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: RateCurve.square_root(-1.0, 1.0), "coefficient is -1.0; thresholds cannot shrink"),
        (lambda: RateCurve.square_root(1.0, 0.0), "fastest is 0.0; give a positive rate"),
        (lambda: RateCurve.saturating(-1.0, 1.0, 1.0), "slope is -1.0; thresholds cannot shrink"),
        (lambda: RateCurve.saturating(1.0, -2.0, 1.0), "rate is -2.0; give a positive rate"),
        (lambda: RateCurve.saturating(1.0, 1.0, np.nan), "fastest"),
        (lambda: RateCurve.saturating(1.0, 1.0, 1.0, "cubic"), "form is 'cubic'"),
    ],
)
def test_laws_that_are_none(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()
