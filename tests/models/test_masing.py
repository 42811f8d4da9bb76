"""Operators from loading curves: plays, polynomials, tables, their inverses and derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import InputError, NotInvertibleError, PrandtlIshlinskii
from hyst.models import (
    InverseCurve,
    MasingOperator,
    PiecewiseLinear,
    PolynomialCurve,
    PowerLaw,
)
from reference.loading_curves import masing
from reference.random_operators import signals

CURVES = {
    "power law": PowerLaw(0.5, 0.3, 1.3),
    "softening power law": PowerLaw(0.5, 0.3, -0.4),
    "plays": PiecewiseLinear([0.5, -0.2, 0.7], [0.5, 1.5, 4.0], p0=0.3),
    "table": PiecewiseLinear.from_points([1.0, 2.0, 3.5], [0.5, 2.0, 3.0]),
    "polynomial": PolynomialCurve([1.0, -0.5, 0.2]),
}
each_curve = pytest.mark.parametrize("curve", CURVES.values(), ids=list(CURVES))


@st.composite
def banks(draw: st.DrawFn) -> PrandtlIshlinskii:
    """Plays whose loading curve never falls; thresholds may repeat or be 0."""
    slopes = np.array(draw(st.lists(st.floats(0.0, 3.0), min_size=1, max_size=8)))
    n = slopes.size - 1
    r = sorted(draw(st.lists(st.integers(0, 20), min_size=n, max_size=n)))
    return PrandtlIshlinskii(np.diff(slopes), np.array(r) / 4.0, slopes[0])


@given(bank=banks(), u=signals())
def test_plays_are_the_piecewise_linear_case(bank: PrandtlIshlinskii, u: np.ndarray) -> None:
    operator = MasingOperator(PiecewiseLinear(bank.p, bank.r, bank.p0))
    assert np.abs(operator(u) - bank(u)).max() <= 1e-12 * max(np.ptp(u), 1.0)


def test_many_plays_on_a_long_record() -> None:
    rng = np.random.default_rng(0)
    bank = PrandtlIshlinskii(rng.random(200), np.sort(rng.random(200)) * 3.0, 0.2)
    operator = MasingOperator(PiecewiseLinear(bank.p, bank.r, bank.p0))
    t = np.linspace(0.0, 1.0, 20_000)
    u = 3.0 * np.sin(40.0 * t) * np.cos(7.0 * t) + 0.2 * rng.normal(size=t.size)
    assert np.abs(operator(u) - bank(u)).max() <= 1e-12 * np.ptp(bank(u))
    inverse = operator.inverse()
    assert isinstance(inverse.curve, PiecewiseLinear)
    # S1 eqs. 7-8 against the inverse function: the same operator.
    assert np.abs(inverse(bank(u)) - u).max() <= 1e-12 * np.ptp(u)
    y = bank(u)
    assert np.abs(inverse(y) - bank.inverse()(y)).max() <= 1e-12 * np.ptp(u)


def test_the_jacobian_of_plays_is_that_of_the_bank() -> None:
    bank = PrandtlIshlinskii([0.5, -0.2, 0.7], [0.5, 1.5, 4.0], p0=0.3)
    operator = MasingOperator(CURVES["plays"])
    u = 5.0 * np.random.default_rng(2).normal(size=300)
    # Both are sums of the same numbers, up to 20 of them, in another order.
    np.testing.assert_allclose(operator.jacobian(u), bank.jacobian(u), atol=1e-12)


@each_curve
def test_it_follows_masings_rules(curve) -> None:
    u = 3.0 * np.random.default_rng(3).normal(size=200)
    expected = masing(lambda x: float(curve(x)), u)
    tolerance = 1e-7 if curve is CURVES["softening power law"] else 1e-12
    assert np.abs(MasingOperator(curve)(u) - expected).max() <= tolerance * np.ptp(expected)


@each_curve
@pytest.mark.parametrize("memory", ["masing", "last-reversal"])
@pytest.mark.parametrize("band", [0.0, 0.3])
def test_the_inverse_curve_makes_the_inverse_operator(curve, memory: str, band: float) -> None:
    if band and memory == "masing":
        return
    operator = MasingOperator(curve, memory=memory, dead_band=band)
    u = np.cumsum(np.random.default_rng(4).normal(size=500)) / 5.0
    assert np.abs(operator.inverse()(operator(u)) - u).max() <= 1e-12 * np.ptp(u)
    assert operator.inverse().inverse()(u) == pytest.approx(operator(u), abs=1e-12 * np.ptp(u))


@each_curve
def test_curves_and_their_inverse_functions(curve) -> None:
    x = np.concatenate([-np.geomspace(1e-6, 50.0, 60), [0.0], np.geomspace(1e-6, 50.0, 60)])
    np.testing.assert_allclose(curve.inverse()(curve(x)), x, rtol=1e-12)
    np.testing.assert_allclose(MasingOperator(curve)(x[60:]), curve(x[60:]), rtol=1e-12)
    assert curve.inverse().inverse()(x) == pytest.approx(curve(x), rel=1e-12)


@each_curve
@pytest.mark.parametrize("way", ["forward", "inverse"])
def test_jacobian_against_differences(curve, way: str) -> None:
    operator = MasingOperator(curve)
    operator = operator.inverse() if way == "inverse" else operator
    u = 2.0 * np.sin(np.linspace(0.1, 20.0, 150)) * np.linspace(1.0, 0.4, 150) + 0.013
    theta = operator.parameters().values
    jacobian = operator.jacobian(u)
    assert jacobian.shape == (150, theta.size)
    for j in range(theta.size):
        step = np.zeros(theta.size)
        step[j] = 1e-7
        quotient = (
            operator.with_parameters(theta + step)(u) - operator.with_parameters(theta - step)(u)
        ) / 2e-7
        # Rounding over the step is 1e-8; a knot passed within the step changes one sample.
        wrong = np.abs(jacobian[:, j] - quotient) > 1e-6 * (1.0 + np.abs(quotient))
        assert wrong.sum() <= 1


@each_curve
def test_lipschitz_constants_hold(curve) -> None:
    for operator in (MasingOperator(curve), MasingOperator(curve).inverse()):
        bound = operator.lipschitz_constant()
        rng = np.random.default_rng(5)
        u, shift = 3.0 * rng.normal(size=400), 0.1 * rng.uniform(-1.0, 1.0, 400)
        moved = np.abs(operator(u + shift) - operator(u)).max()
        assert moved <= bound * np.abs(shift).max() * (1.0 + 1e-12)
    # By hand: 1/c1 and down to 0 again; sum of the absolute weights; unbounded.
    assert MasingOperator(PowerLaw(0.5, 0.3, 1.3)).inverse().lipschitz_constant() == 4.0
    plays = MasingOperator(PiecewiseLinear([0.5, -0.2], [1.0, 2.0], p0=0.3))
    assert plays.lipschitz_constant() == pytest.approx(1.0, abs=1e-15)
    assert MasingOperator(PowerLaw(0.5, 0.3, 1.3)).lipschitz_constant() == float("inf")


def test_a_table_of_a_power_law_comes_near_it() -> None:
    law = PowerLaw(0.5, 0.3, 1.3)
    x = np.linspace(0.0, 3.0, 1001)[1:]
    u = 2.5 * np.sin(np.linspace(0.0, 20.0, 500))
    # Chords of an arc: at most f'' h^2 / 8 off, with f'' <= 2 and h = 0.003, on each half.
    difference = MasingOperator(PiecewiseLinear.from_points(x, law(x)))(u) - MasingOperator(law)(u)
    assert np.abs(difference).max() < 2.0 * 2.0 * 0.003**2 / 8.0 * 10.0


@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda: PowerLaw(-1.0, 1.0, 1.0), "c1 is -1"),
        (lambda: PowerLaw(1.0, -1.0, 1.0), "c2 is -1"),
        (lambda: PowerLaw(0.0, 0.0, 1.0), "never move"),
        (lambda: PowerLaw(1.0, 1.0, -1.0), "above -1"),
        (lambda: PiecewiseLinear([-1.0], [1.0], p0=0.5), r"p\[1\] is -0.5"),
        (lambda: PiecewiseLinear([1.0], [1.0, 2.0]), "one p for each r"),
        (lambda: PiecewiseLinear.from_points([1.0, 1.0], [1.0, 2.0]), r"x\[1\] is 1"),
        (lambda: PiecewiseLinear.from_points([1.0, 2.0], [2.0, 1.0]), "never falls"),
        (lambda: PiecewiseLinear.from_points([], []), "one or more"),
        (lambda: PolynomialCurve([]), "at least one"),
        (lambda: PolynomialCurve([0.0, 1.0]), "slope of the polynomial is 0 at 0"),
        (lambda: PolynomialCurve([1.0, -2.0, 1.0]), "at 0.666667"),
        (lambda: PolynomialCurve([1.0, -0.1]), "falls far out"),
        (lambda: PolynomialCurve([1.0, float("nan")]), r"coefficients\[1\] is nan"),
        (lambda: MasingOperator(PrandtlIshlinskii([1.0], [1.0])), "loading curve"),
        (lambda: InverseCurve(2.0), "loading curve"),
    ],
)
def test_refused_curves(make, part: str) -> None:
    with pytest.raises(InputError, match=part):
        make()


def test_flat_pieces_have_no_inverse() -> None:
    with pytest.raises(NotInvertibleError, match="flat from 2 on"):
        PiecewiseLinear([-1.0, 1.0], [2.0, 3.0], p0=1.0).inverse()
