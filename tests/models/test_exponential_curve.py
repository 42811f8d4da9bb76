"""The exponential loading curve: its formula, elements it stands for, its inverse, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import lambertw

import hyst
from hyst import InputError, MasingOperator
from hyst.models import ExponentialCurve, InverseCurve
from reference.loading_curves import masing
from reference.sliders import jenkins, spread_exponentially

Array = NDArray[np.float64]
EPS = float(np.finfo(np.float64).eps)
CURVES = {
    "stiffens": (1.0, 0.75, 2.0),
    "stiffens from nothing": (1.0, 1.0, 0.5),
    "softens": (0.5, -1.0, 1.5),
    "saturates": (0.0, -1.0, 1.5),
    "nearly a line": (1.0, 1e-6, 0.3),
}
each_curve = pytest.mark.parametrize("constants", CURVES.values(), ids=list(CURVES))


def walk(seed: int, samples: int = 120) -> Array:
    return np.cumsum(np.random.default_rng(seed).standard_normal(samples))


@each_curve
@pytest.mark.parametrize("seed", range(3))
def test_the_operator_is_the_curve_with_masings_rules(
    constants: tuple[float, float, float], seed: int
) -> None:
    c, d, b = constants
    u = walk(seed)
    expected = masing(lambda x: float(c * x + d * b * np.expm1(-x / b)), u)
    # Up to some 30 branches end on end in either way of counting, each rounded a few times.
    size = (c + abs(d)) * float(np.abs(u).max()) * 2.0
    assert np.abs(MasingOperator(ExponentialCurve(*constants))(u) - expected).max() <= (
        100.0 * EPS * size
    )


def test_small_ways_keep_their_digits() -> None:
    # x - (1 - exp(-x)) = x^2 / 2 - x^3 / 6 + ..., where the plain formula has no digit left.
    x = 1e-9
    y = MasingOperator(ExponentialCurve(1.0, 1.0, 1.0))([x])[0]
    assert y == pytest.approx(x**2 / 2.0 - x**3 / 6.0, rel=4.0 * EPS)


def lambert(constants: tuple[float, float, float], w: Array) -> Array:
    """c x + d b (exp(-x / b) - 1) = w by Lambert's function."""
    c, d, b = constants
    at = (w / b + d) / c
    return b * (at + lambertw(-d / c * np.exp(-at)).real)


@pytest.mark.parametrize("constants", [(1.0, 0.75, 2.0), (0.5, -1.0, 1.5), (2.0, -30.0, 0.1)])
def test_the_inverse_is_lamberts_function(constants: tuple[float, float, float]) -> None:
    w = np.geomspace(0.05, 50.0, 200)
    found = InverseCurve(ExponentialCurve(*constants))(w)
    # SciPy's Lambert function ends at 1e-8 relative of its steps; near its branch point less.
    np.testing.assert_allclose(found, lambert(constants, w), rtol=1e-7)
    # And without it: f of what was found is w to rounding, over the slope's share of f.
    np.testing.assert_allclose(ExponentialCurve(*constants)(found), w, rtol=50.0 * EPS)


@pytest.mark.parametrize("seed", range(20))
def test_any_curve_comes_back(seed: int) -> None:
    """Constants and ways over many decades, the worst of them where nothing of a way is left."""
    rng = np.random.default_rng(seed)
    first, last = 10.0 ** rng.uniform(-9.0, 3.0, 2)
    curve = ExponentialCurve(float(last), float(last - first), float(10.0 ** rng.uniform(-3, 3)))
    way = curve.b * 10.0 ** rng.uniform(-9.0, 3.0, 40)
    operator = MasingOperator(curve)
    w = np.array([operator([x])[0] for x in way])
    again = np.array([operator([x])[0] for x in InverseCurve(curve)(w)])
    # A few roundings of a rising function whose x f' is at most f (softening) or a few f.
    np.testing.assert_allclose(again, w, rtol=20.0 * EPS)


def test_saturation_is_that_of_sliders_spread_exponentially() -> None:
    """An infinite spread of Jenkins elements: the sum of N of them comes as 1 / N^2, the mean of
    each part being right, but for the last part, which is infinitely wide: 1 / N."""
    force, way, u = 2.0, 1.5, walk(5, 300)
    ours = MasingOperator(ExponentialCurve(0.0, -force / way, way))(u)
    errors = [
        np.abs(jenkins(*spread_exponentially(n, force, way), u) - ours).max() for n in (100, 1000)
    ]
    assert errors[0] <= 2.0 * force / 100
    assert errors[1] <= 2.0 * force / 1000
    assert errors[1] < 0.2 * errors[0]


def test_saturation_by_hand() -> None:
    # 1 - 1/e at 1; then back by 2: 1 - 1/e - 2 (1 - 1/e).
    y = MasingOperator(ExponentialCurve(0.0, -1.0, 1.0))([1.0, -1.0, 60.0])
    assert y == pytest.approx([0.6321205588285577, -0.6321205588285577, 1.0], rel=4.0 * EPS)


def test_beyond_saturation_there_is_no_way_and_the_sample_is_named() -> None:
    inverse = MasingOperator(ExponentialCurve(0.0, -1.0, 1.0)).inverse()
    assert inverse([0.5])[0] == pytest.approx(np.log(2.0), rel=4.0 * EPS)
    with pytest.raises(InputError, match=r"u\[1\] = 1 the operator overflows"):
        inverse([0.5, 1.0])
    step = inverse.stepper()
    held = step(0.5)
    assert step(1.5) == held
    assert step.fault


REFUSED = {
    (-1.0, -2.0, 1.0): "c is -1; it is the slope far out",
    (1.0, 1.5, 1.0): "d is 1.5, more than c = 1",
    (0.0, 0.0, 1.0): "c and d are 0",
    (1.0, 0.5, 0.0): "b is 0",
    (1.0, 0.5, -2.0): "b is -2",
    (float("nan"), 0.5, 1.0): "c is nan",
}


@pytest.mark.parametrize("constants", REFUSED)
def test_what_is_no_curve_is_refused(constants: tuple[float, float, float]) -> None:
    with pytest.raises(InputError, match=REFUSED[constants]):
        ExponentialCurve(*constants)


@each_curve
def test_other_units_scale_it_to_the_bit(constants: tuple[float, float, float]) -> None:
    operator, u = MasingOperator(ExponentialCurve(*constants)), walk(2)
    scaled = operator.in_units(2.0**30, 2.0**-50)
    assert (scaled(u * 2.0**30) == operator(u) * 2.0**-50).all()


def test_a_power_law_may_start_flat() -> None:
    """f(x) = 2^c3 c2 x^(c3 + 1) / (c3 + 1), from a turn on c2 p^(c3 + 1) / (c3 + 1)."""
    model = hyst.RambergOsgood(0.0, 2.0, 1.0)
    y = model([3.0, 1.0, 3.0, 4.0])
    assert y == pytest.approx([18.0, 14.0, 18.0, 32.0], rel=10.0 * EPS)
    # Slopes of 0 at turns make rounding of y a root of it in u.
    assert np.abs(model.inverse()(y) - [3.0, 1.0, 3.0, 4.0]).max() <= 1e-7
    with pytest.raises(InputError, match="c1 is 0 and c2 is 0"):
        hyst.RambergOsgood(0.0, 0.0, 1.0)
