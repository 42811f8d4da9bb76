"""The rate-dependent Prandtl-Ishlinskii model against the paper's equations and numbers."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hyst
from hyst import InputError, NotInvertibleError, RateDependentPrandtlIshlinskii
from hyst.models import GivenThresholds, RateCurve
from reference.rate_dependent_plays import (
    ACTUATOR,
    DT,
    EXAMPLE,
    output,
    rate,
    reference_signal,
)

EPS = np.finfo(float).eps


def model_of(constants: dict, dt: float = DT) -> RateDependentPrandtlIshlinskii:
    return RateDependentPrandtlIshlinskii(**constants, dt=dt)


@pytest.mark.parametrize("constants", [EXAMPLE, ACTUATOR], ids=["III-F", "IV-C"])
@pytest.mark.parametrize("f", [1.0, 10.0, 60.0, 200.0])
def test_follows_the_papers_equations(constants: dict, f: float) -> None:
    u = reference_signal(f)
    expected = output(
        constants["p"], constants["r"], constants["p0"], u, constants["beta"] * rate(u, DT)
    )
    # Widenings up to 25 and outputs up to 60, a dozen roundings each.
    assert np.abs(model_of(constants)(u) - expected).max() < 100 * EPS * 60


numbers = st.floats(-8.0, 8.0)


@given(
    u=st.lists(numbers, min_size=1, max_size=40).map(np.array),
    gaps=st.lists(st.floats(0.0, 2.0), max_size=4),
    data=st.data(),
)
def test_follows_the_equations_for_any_constants(u: np.ndarray, gaps: list, data) -> None:
    r = np.cumsum(gaps).tolist()
    p = data.draw(st.lists(st.floats(-2.0, 2.0), min_size=len(r), max_size=len(r)))
    p0, beta = data.draw(st.floats(-2.0, 2.0)), data.draw(st.floats(0.0, 5.0))
    dt = data.draw(st.floats(0.1, 10.0))
    model = RateDependentPrandtlIshlinskii(p, r, beta, dt, p0)
    expected = output(p, r, p0, u, beta * rate(u, dt))
    # Widening up to 5 16 / 0.1 = 800 loses 800 eps in each of the bounds, five plays of weight 2.
    assert np.abs(model(u) - expected).max() <= 5 * 2 * 10 * 800 * EPS


def test_general_rate_curves() -> None:
    u = reference_signal(10.0)
    rates, widenings = [0.0, 1000.0, 3000.0, 5000.0], [0.0, 1.0, 2.0, 5.0]
    table = RateDependentPrandtlIshlinskii(
        EXAMPLE["p"], EXAMPLE["r"], RateCurve.table(rates, widenings), DT, 0.5
    )
    x = rate(u, DT)
    beyond = 5.0 + 1.5e-3 * np.maximum(x - 5000.0, 0.0)
    g = np.where(x > 5000.0, beyond, np.interp(x, rates, widenings))
    assert np.abs(table(u) - output(EXAMPLE["p"], EXAMPLE["r"], 0.5, u, g)).max() < 1e-12
    polynomial = RateDependentPrandtlIshlinskii(
        EXAMPLE["p"], EXAMPLE["r"], RateCurve.polynomial([1e-4, 2e-8, 1e-12]), DT, 0.5
    )
    g = 1e-4 * x + 2e-8 * x**2 + 1e-12 * x**3
    assert np.abs(polynomial(u) - output(EXAMPLE["p"], EXAMPLE["r"], 0.5, u, g)).max() < 1e-12


def test_inverse_parameters_of_section_v() -> None:
    # The printed b and s do not follow from the printed a (eqs. 14-15 give these digits).
    inverse = model_of(ACTUATOR).explicit_inverse()
    assert inverse.p0 == pytest.approx(1.40371, abs=5e-6)
    assert inverse.p == pytest.approx([-0.40670, -0.04381, -0.12007], abs=5e-6)
    assert inverse.r == pytest.approx([6.92097, 16.66511, 26.85712], abs=5e-6)
    assert inverse.beta == pytest.approx(6.1067e-4, abs=5e-9)
    assert inverse.dt == DT


@pytest.mark.parametrize("constants", [EXAMPLE, ACTUATOR], ids=["III-F", "IV-C"])
@pytest.mark.parametrize("f", [1.0, 10.0, 60.0, 200.0])
def test_round_trip_with_the_same_thresholds_is_exact(constants: dict, f: float) -> None:
    drive = reference_signal(f)
    model = model_of(constants)
    given_in_time = GivenThresholds(constants["p"], model.thresholds(drive), constants["p0"])
    y = given_in_time(drive)
    assert np.abs(y - model(drive)).max() < 1e-12  # the same operator, bounds rounded otherwise
    back = given_in_time.inverse()(y)
    assert np.abs(back - drive).max() <= 1e-12 * np.ptp(drive)


def test_thresholds_that_drift_apart_still_invert_exactly() -> None:
    # Eq. 11 asks that distances do not shrink; here they grow, each at its own pace.
    u = reference_signal(10.0)
    r = np.array(EXAMPLE["r"]) * (1.0 + np.linspace(0.0, 1.0, u.size)[:, None])
    model = GivenThresholds(EXAMPLE["p"], r, 0.5)
    assert np.abs(model.inverse()(model(u)) - u).max() <= 1e-12 * np.ptp(u)


def test_thresholds_whose_distance_shrinks_are_refused() -> None:
    r = np.array([[1.0, 3.0], [2.0, 4.0], [2.0, 3.5]])
    with pytest.raises(NotInvertibleError, match=r"1 and 2 shrinks from 2 to 1.5 at sample 2"):
        GivenThresholds([1.0, 1.0], r, 0.5).inverse()
    # And rightly: the inverse that eqs. 14-15 would give does not undo the model there.
    u = reference_signal(10.0)
    shrinking = np.array(EXAMPLE["r"]) * (2.0 - np.linspace(0.0, 1.0, u.size)[:, None])
    model = GivenThresholds(EXAMPLE["p"], shrinking, 0.5)
    slopes = 0.5 + np.concatenate([[0.0], np.cumsum(EXAMPLE["p"])])
    s = np.cumsum(slopes[:-1] * np.diff(shrinking, axis=1, prepend=0.0), axis=1)
    formula = GivenThresholds(np.diff(1.0 / slopes), s, 2.0)
    assert np.abs(formula(model(u)) - u).max() > 1e-4


def consistent_errors(f: float) -> tuple[float, float]:
    model, y_ref = model_of(EXAMPLE), reference_signal(f)
    explicit = model(model.explicit_inverse()(y_ref)) - y_ref
    plain = model(model.at_rest().inverse()(y_ref)) - y_ref
    third = y_ref.size // 3
    middle = slice(third, 2 * third)
    return float(np.abs(explicit[middle]).max()), float(np.abs(plain[middle]).max())


@pytest.mark.parametrize(
    ("f", "explicit", "rate_independent"), [(10.0, 1.38, 2.82), (60.0, 13.6, 16.3)]
)
def test_what_the_explicit_inverse_really_leaves(
    f: float, explicit: float, rate_independent: float
) -> None:
    # Computed by an independent prototype, three digits kept.
    found = consistent_errors(f)
    assert found == pytest.approx((explicit, rate_independent), rel=5e-3)


def test_is_not_called_invertible() -> None:
    model = model_of(EXAMPLE)
    assert not model.traits().invertible
    with pytest.raises(NotInvertibleError, match="invert_trajectory"):
        model.inverse()


def test_without_rate_it_is_the_rate_independent_model() -> None:
    model = RateDependentPrandtlIshlinskii(EXAMPLE["p"], EXAMPLE["r"], 0.0, DT, 0.5)
    plain = hyst.PrandtlIshlinskii(EXAMPLE["p"], EXAMPLE["r"], 0.5)
    u = reference_signal(60.0)
    assert np.array_equal(model(u), plain(u))
    assert model.inverse() == plain.inverse()
    assert model.traits().rate_independent


def test_halves_give_the_bits_of_the_whole_and_so_does_the_stepper() -> None:
    model, u = model_of(EXAMPLE), reference_signal(60.0) + 3.0
    whole, end = model.run(u)
    first, state = model.run(u[:77])
    second, last = model.run(u[77:], state)
    assert np.array_equal(np.concatenate([first, second]), whole)
    assert np.array_equal(last, end)
    step = model.stepper()
    assert [step(value) for value in u.tolist()] == whole.tolist()


@pytest.mark.parametrize("curve", [0.002, RateCurve(0.002, [1e-6], [1e-3], [50.0])])
def test_all_engines_give_the_bits_of_the_stepper(curve: float | RateCurve) -> None:
    model = RateDependentPrandtlIshlinskii([0.5, 0.3, 0.2], [0.3, 1.0, 2.0], curve, 1e-3, 0.4)
    u = 5.0 + 0.1 * np.cumsum(np.random.default_rng(0).normal(size=20011))
    step = model.stepper()
    expected = np.array([step(value) for value in u.tolist()])
    for engine in ("auto", "loop", "lanes"):
        y, state = model.run(u, engine=engine)
        assert np.array_equal(y, expected)
        assert np.array_equal(state, step.state)


def test_the_first_sample_has_no_rate() -> None:
    model = RateDependentPrandtlIshlinskii([1.0], [1.0], beta=1.0, dt=0.1, p0=0.5)
    # From rest at 5 the play stands at 4, however far 5 is from 0.
    assert model([5.0])[0] == 0.5 * 5.0 + 4.0


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6))
def test_jacobian_agrees_with_differences(seed: int) -> None:
    random = np.random.default_rng(seed)
    curve = RateCurve(0.3, [0.05], [0.2, -0.1], [0.7, 1.9])
    model = RateDependentPrandtlIshlinskii([0.5, 0.3], [0.4, 1.1], curve, 0.5, 0.7)
    u = np.cumsum(random.normal(size=30))
    jacobian = model.jacobian(u)
    theta = model.parameters().values
    numeric = np.empty_like(jacobian)
    h = 1e-7
    for i in range(theta.size):
        step = h * (np.arange(theta.size) == i)
        numeric[:, i] = (
            model.with_parameters(theta + step)(u) - model.with_parameters(theta - step)(u)
        ) / (2 * h)
    # Rounding eps/h and curvature h; a random signal meets no kink within 1e-7.
    assert np.abs(jacobian - numeric).max() < 1e-5


def test_jacobian_through_stages_before_and_behind() -> None:
    u = np.cumsum(np.random.default_rng(5).normal(size=60))
    plays = RateDependentPrandtlIshlinskii([0.5, 0.3], [0.4, 1.1], 0.2, 0.5, 0.7)
    model = hyst.DeadZone([1.0, 0.4], [0.0, 0.5]) @ plays @ hyst.Affine(1.3, -0.2)
    theta = model.parameters().values
    numeric = np.empty((u.size, theta.size))
    for i in range(theta.size):
        step = 1e-7 * (np.arange(theta.size) == i)
        if i == 2 + 6 + 2:  # the threshold at 0 stays 0: the map jumps there
            numeric[:, i] = model.jacobian(u)[:, i]
            continue
        up, down = model.with_parameters(theta + step), model.with_parameters(theta - step)
        numeric[:, i] = (up(u) - down(u)) / 2e-7
    assert np.abs(model.jacobian(u) - numeric).max() < 1e-5


def test_composition_with_a_dead_zone_map() -> None:
    plays, after = model_of(ACTUATOR), hyst.DeadZone.odd([1.0, 0.2, -0.1], [0.0, 5.0, 20.0])
    model = hyst.ModifiedPrandtlIshlinskii(plays, after)
    u = reference_signal(60.0)
    assert np.array_equal(model(u), after(plays(u)))
    assert model.dt == DT


def test_the_lipschitz_constant_counts_a_widening_that_falls() -> None:
    curve = RateCurve(1.0, (), [-5.0], [30.0])
    model = RateDependentPrandtlIshlinskii([1.0, 0.5], [1.0, 2.0], curve, 1.0, 0.5)
    random, worst = np.random.default_rng(0), 0.0
    for _ in range(1000):
        u = np.cumsum(random.uniform(-40.0, 40.0, 6))
        v = u + random.uniform(-1.0, 1.0, 6) * 10.0 ** random.uniform(-4.0, 1.0)
        worst = max(worst, float(np.abs(model(u) - model(v)).max() / np.abs(u - v).max()))
    # 0.5 + 1.5 (1 + 2 4) by the slope of -4 beyond the knee; 5 by that of 1 before it.
    assert model.lipschitz_constant() == 14.0
    assert 12.0 < worst <= 14.0


def test_serialisation_is_exact(tmp_path) -> None:
    curve = RateCurve(0.1, [0.2, 0.3], [0.4, -0.1], [1.0 / 3.0, 2.0])
    for model in (
        model_of(ACTUATOR),
        RateDependentPrandtlIshlinskii([0.5], [1.0], curve, 0.1, 0.3, z0=[0.7]),
    ):
        path = tmp_path / "model.json"
        model.save(path)
        assert hyst.load(path) == model
        assert hash(hyst.load(path)) == hash(model)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"beta": -1e-4}, "beta is -0.0001"),
        ({"dt": 0.0}, "dt is 0.0"),
        ({"dt": -1.0}, "dt is -1.0"),
        ({"r": [3.0, 2.0]}, "ascending"),
        ({"r": [3.0]}, "one p for each r"),
        ({"p0": float("nan")}, "p0"),
        ({"z0": [0.0, 5.0]}, "z0.0. and z0.1. differ by 5"),
        ({"z0": [0.0]}, "z0 has 1 entries"),
    ],
)
def test_bad_constants_are_refused(change: dict, message: str) -> None:
    good = {"p": [0.5, 0.5], "r": [1.0, 2.0], "beta": 0.1, "dt": 0.1, "p0": 1.0}
    with pytest.raises(InputError, match=message):
        RateDependentPrandtlIshlinskii(**(good | change))


def test_bad_rate_curves_are_refused() -> None:
    with pytest.raises(InputError, match="must not fall"):
        RateCurve.table([0.0, 1.0, 2.0], [0.0, 2.0, 1.0])
    with pytest.raises(InputError, match=r"\(0, 0\)"):
        RateCurve.table([0.0, 1.0], [1.0, 2.0])
    with pytest.raises(InputError, match=r"powers\[0\] is -1"):
        RateCurve.polynomial([1.0, -1.0])
    with pytest.raises(InputError, match="at least one"):
        RateCurve.polynomial([])


def test_weights_without_explicit_inverse() -> None:
    with pytest.raises(NotInvertibleError, match="p0 is 0"):
        RateDependentPrandtlIshlinskii([1.0], [1.0], 0.1, 0.1, 0.0).explicit_inverse()
    with pytest.raises(NotInvertibleError, match=r"p\[1\] is -0.5"):
        RateDependentPrandtlIshlinskii([-1.0], [1.0], 0.1, 0.1, 0.5).explicit_inverse()


def test_where_the_sample_equation_loses_its_slope() -> None:
    # beta/dt = 7 in the example: 0.5 + (1 - 7) 0.9777.
    assert model_of(EXAMPLE).sample_equation_slope() == pytest.approx(0.5 - 6.0 * 0.9777)
    assert model_of(EXAMPLE, dt=1e-3).sample_equation_slope() == pytest.approx(0.5 + 0.3 * 0.9777)


def test_sample_times_must_agree() -> None:
    with pytest.raises(InputError, match=r"0.0001 s and 0.001 s"):
        model_of(EXAMPLE) @ model_of(ACTUATOR, dt=1e-3)
    assert (hyst.Affine(2.0) @ model_of(EXAMPLE)).dt == DT
    assert hyst.Affine(2.0).dt is None
    with pytest.raises(InputError, match=r"the record has dt = 0.001 s, the model 0.0001 s"):
        model_of(EXAMPLE).require_sample_time(1e-3)
