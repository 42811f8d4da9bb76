"""Any composition is fitted from its own constants: what lmfit gives for formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares
from simulated_records import drive

import hyst
from hyst import InputError, NotIdentifiableError, SolverError
from hyst.models import MemoryElement, MemoryFunction, PolynomialCurve
from hyst.operators import Affine, Operator

DT = 1e-3
U = drive(800)
DYNAMICS = hyst.LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], dt=DT)
PLAYS = hyst.PrandtlIshlinskii([0.4, 0.2], [0.1, 0.3], p0=1.0)

# Kinds that no family makes, each with a start some way from the truth.
PAIRS: dict[str, tuple[Operator, Operator]] = {
    "plays behind dynamics": (
        PLAYS @ DYNAMICS,
        hyst.PrandtlIshlinskii([0.3, 0.3], [0.12, 0.25], p0=0.9) @ DYNAMICS,
    ),
    "a stop and a line": (Affine(2.0, 0.3) @ hyst.Stop(0.3), Affine(1.5, 0.0) @ hyst.Stop(0.4)),
    "a play between lines": (Affine(1.5, 0.2) @ hyst.Play(0.25), Affine(1.2) @ hyst.Play(0.15)),
    "rate-dependent plays": (
        hyst.RateDependentPrandtlIshlinskii([0.4], [0.2], 2e-3, DT, p0=1.0),
        hyst.RateDependentPrandtlIshlinskii([0.3], [0.25], 1e-3, DT, p0=0.8),
    ),
    "a polynomial curve": (
        hyst.MasingOperator(PolynomialCurve([1.0, 0.0, 0.3])),
        hyst.MasingOperator(PolynomialCurve([0.8, 0.0, 0.2])),
    ),
    "a map and dynamics": (
        DYNAMICS @ hyst.DeadZone([1.0, 0.4], [0.0, 0.2]),
        DYNAMICS @ hyst.DeadZone([0.8, 0.5], [0.0, 0.3]),
    ),
}
HELD = {"plays behind dynamics": "prandtl_ishlinskii", "a map and dynamics": "dead_zone"}


def record(model: Operator, noise: float = 0.0, seed: int = 0) -> hyst.Record:
    rng = np.random.default_rng(seed)
    return hyst.Record(U, model(U) + noise * rng.normal(size=U.size), DT)


@pytest.mark.parametrize("name", PAIRS)
def test_constants_come_back(name: str) -> None:
    true, guess = PAIRS[name]
    free = [HELD[name]] if name in HELD else None
    found = hyst.fit(guess, record(true), free=free, start=0)
    assert type(found.model) is type(guess)
    # The iteration ends when the residual is rounding of the range.
    np.testing.assert_allclose(found.model.parameters().values, true.parameters().values, atol=1e-8)


def test_it_agrees_with_another_optimiser() -> None:
    """SciPy's trust-region method with its own differences ends at the same minimum."""
    true = Affine(1.0, 0.2) @ PLAYS
    guess = Affine(1.0, 0.0) @ hyst.PrandtlIshlinskii([0.3, 0.3], [0.12, 0.25], p0=0.9)
    given = record(true, noise=0.02)
    free = ["prandtl_ishlinskii", "affine.offset"]
    found = hyst.fit(guess, given, free=free, start=0)
    places = [0, 1, 2, 3, 4, 6]

    def residual(theta: np.ndarray) -> np.ndarray:
        constants = guess.parameters().values.copy()
        constants[places] = theta
        return guess.with_parameters(constants)(U) - given.y

    expected = least_squares(residual, guess.parameters().values[places], x_scale=0.1)
    cost = float(np.sum(residual(found.parameter_values) ** 2))
    assert cost == pytest.approx(2.0 * expected.cost, rel=1e-3)
    # Within a small part of a standard error, where the cost is flat.
    apart = np.abs(found.parameter_values - expected.x) / found.standard_errors
    assert apart.max() < 0.1


def test_standard_errors_agree_with_scatter() -> None:
    true = Affine(2.0, 0.3) @ hyst.Stop(0.3)
    fits = [hyst.fit(true, record(true, 0.05, seed), start=0) for seed in range(60)]
    values = np.array([each.parameter_values for each in fits])
    stated = np.array([each.standard_errors for each in fits])
    ratio = values.std(axis=0, ddof=1) / np.sqrt(np.mean(stated**2, axis=0))
    # 60 draws know a standard deviation to 9 %.
    assert (ratio < 1.3).all()
    assert (ratio > 0.7).all()


def test_constants_that_are_not_free_stay_bit_for_bit() -> None:
    true, guess = PAIRS["a stop and a line"]
    found = hyst.fit(guess, record(true), free=["affine"], start=0)
    assert found.parameter_names == ("affine.gain", "affine.offset")
    assert found.model.parameters().values[0] == 0.4


def test_bounds_are_kept_and_told() -> None:
    true, guess = PAIRS["a stop and a line"]
    found = hyst.fit(guess, record(true), bounds={"stop.r": (0.35, 1.0)}, start=0)
    assert found.model.parameters().values[0] == 0.35
    assert np.isnan(found.standard_errors[0])
    assert np.isfinite(found.standard_errors[1:]).all()


def test_what_cannot_be_told_apart_is_named() -> None:
    true = Affine(2.0) @ hyst.PrandtlIshlinskii([0.4], [0.3], p0=1.0)
    found = hyst.fit(true, record(true, noise=0.01), start=0)
    names = dict(zip(found.parameter_names, found.standard_errors, strict=True))
    assert np.isnan(names["affine.gain"])
    assert np.isfinite(names["prandtl_ishlinskii.r[1]"])
    assert any("do not tell apart" in each for each in found.undetermined)


def test_what_several_directions_share_is_named_once() -> None:
    true = Affine(2.0) @ Affine(0.5, 0.1) @ hyst.PrandtlIshlinskii([0.4], [0.3], p0=1.0)
    found = hyst.fit(true, record(true, noise=0.01), start=0)
    assert len(found.undetermined) == 1
    unsure = np.flatnonzero(np.isnan(found.standard_errors))
    assert all(found.undetermined[0].count(found.parameter_names[i]) == 1 for i in unsure)


def test_all_that_has_no_standard_error_for_want_of_others_is_named() -> None:
    """The gain is known but for a factor of all weights, also of the smallest."""
    plays = hyst.PrandtlIshlinskii([0.2, 0.03, 0.02], [0.1, 0.3, 0.6], p0=1.0)
    found = hyst.fit(Affine(2.0) @ plays, record(Affine(2.0) @ plays, noise=0.01), start=0)
    unsure = np.flatnonzero(np.isnan(found.standard_errors))
    assert unsure.size == 5
    assert len(found.undetermined) == 1
    for i in unsure:
        assert found.parameter_names[i] in found.undetermined[0]


def test_several_records_delay_and_validation() -> None:
    true, guess = PAIRS["a play between lines"]
    other = drive(500, seed=3)
    late = [
        hyst.Record(u, np.concatenate([np.full(2, true(u)[0]), true(u)])[: u.size], DT)
        for u in (U, other)
    ]
    found = hyst.fit(guess, late[:1], delay=2, validation=late[1], start=0)
    assert found.metrics["validation"].rms < 1e-8
    np.testing.assert_allclose(found.predict(other)[2:], late[1].y[2:], atol=1e-8)


def test_a_memory_element_keeps_what_is_no_parameter() -> None:
    function = MemoryFunction.polynomial([1.0, 0.5, 0.3])
    true = MemoryElement(function, DT)
    guess = true.with_parameters([0.8, 0.3, 0.4])
    found = hyst.fit(guess, record(true), start=0)
    assert found.model == true.with_parameters(found.model.parameters().values)
    np.testing.assert_allclose(found.model.parameters().values, [1.0, 0.5, 0.3], atol=1e-7)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"free": []}, "no constant is free"),
        ({"free": 5}, "free is of type int"),
        ({"bounds": [("stop.r", (0.0, 1.0))]}, "bounds is of type list"),
        ({"free": ["stop.q"]}, "no constant 'stop.q'; it has stop.r, affine.gain, affine.offset"),
        ({"bounds": {"stop.r": (0.5, 1.0)}}, "stop.r is 0.4 in the model, outside its bounds 0.5"),
        ({"bounds": {"stop.r": (1.0, 0.5)}}, "give the lower one first"),
        ({"bounds": {"stop.r": 1.0}}, "give two numbers"),
        ({"bounds": {"gain": (0.0, 1.0)}}, "no constant 'gain'"),
        ({"delay": "auto"}, "delay is 'auto'"),
        ({"start": -1}, "start is -1"),
    ],
)
def test_what_cannot_be_used_is_refused(options: dict[str, Any], said: str) -> None:
    true, guess = PAIRS["a stop and a line"]
    with pytest.raises(InputError, match=said):
        hyst.fit(guess, record(true), **options)


def test_something_else_than_an_operator() -> None:
    with pytest.raises(InputError, match="of type str; give an operator"):
        hyst.fit("pi", record(PLAYS))  # type: ignore[arg-type]


def test_another_sample_time_is_refused() -> None:
    true, guess = PAIRS["plays behind dynamics"]
    with pytest.raises(InputError, match=r"the model 0\.001 s"):
        hyst.fit(guess, hyst.Record(U, true(U), 2e-3))
    slow = hyst.LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], dt=2e-3)
    with pytest.raises(InputError, match=r"sample times of 0\.001 s and 0\.002 s"):
        slow @ DYNAMICS


def test_too_few_samples_and_constant_signals() -> None:
    true, guess = PAIRS["a stop and a line"]
    short = hyst.Record(U[:3], true(U)[:3], DT)
    with pytest.raises(NotIdentifiableError, match="3 samples can be used but 3 constants"):
        hyst.fit(guess, short, start=0)
    with pytest.raises(NotIdentifiableError, match="constant"):
        hyst.fit(guess, hyst.Record(np.ones(50), U[:50], DT))


def test_not_converged_raises_unless_allowed() -> None:
    true, guess = PAIRS["plays behind dynamics"]
    given = record(true, noise=0.01)
    options = {"free": ["prandtl_ishlinskii"], "max_iterations": 1, "start": 0}
    with pytest.raises(SolverError, match=r"the fit of the model .*did not converge"):
        hyst.fit(guess, given, **options)
    found = hyst.fit(guess, given, allow_unconverged=True, **options)
    assert found.status == "iteration limit"


def test_an_input_that_never_turns_will_do_for_dynamics() -> None:
    """A step response is a record, too."""
    u = np.concatenate([np.zeros(10), np.ones(200)])
    guess = hyst.LinearDynamics(DYNAMICS.A * 0.9, DYNAMICS.B, DYNAMICS.C * 1.2, DYNAMICS.D, DT)
    free = ["linear_dynamics.A", "linear_dynamics.C", "linear_dynamics.D"]
    with pytest.raises(InputError, match=r"linear_dynamics\.A"):
        hyst.fit(guess, hyst.Record(u, DYNAMICS(u), DT), free=free)
    names = ["A", "C", "D"]
    found = hyst.fit(guess, hyst.Record(u, DYNAMICS(u), DT), free=names, start=0)
    np.testing.assert_allclose(found.model(u), DYNAMICS(u), atol=1e-9)
