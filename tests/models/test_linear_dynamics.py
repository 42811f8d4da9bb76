"""Linear dynamics against scipy.signal, python-control and the numbers printed in the paper."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

import hyst
from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics, SecondOrderSections
from hyst.operators import operator_from_dict

# S0 eqs. 48 and 49; the sample time that makes the one the other is 0.01 s, not the printed one.
CONTINUOUS = [3.391e10], [1.0, 3759.0, 2.063e7, 7.514e10]
PRINTED = [0.256, 0.02439, 0.1349], [1.0, -0.5746, 0.4949, -9.137e-17]

RNG = np.random.default_rng(7)


def random_system(order: int, relative_degree: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(order)
    half = 0.9 * np.exp(1j * rng.uniform(0.2, 2.9, order // 2)) * rng.uniform(0.5, 1, order // 2)
    poles = np.concatenate([half, half.conj(), [0.6] * (order % 2)])
    num = np.concatenate([np.zeros(relative_degree), rng.normal(size=order + 1 - relative_degree)])
    return num, np.atleast_1d(np.poly(poles)).real


@pytest.mark.parametrize("order", [0, 1, 2, 3, 5, 8, 12, 13, 20])
@pytest.mark.parametrize("delay", [0, 4])
def test_a_record_is_what_lfilter_gives(order: int, delay: int) -> None:
    num, den = random_system(order, min(order, 1))
    u = RNG.normal(size=3000)
    expected = scipy.signal.lfilter(np.concatenate([np.zeros(delay), num]), den, u)
    y = LinearDynamics.from_transfer_function(num, den, 0.01, delay)(u)
    # Two realizations round differently, the more the higher the order.
    assert np.abs(y - expected).max() <= 1e-10 * np.abs(expected).max()


@pytest.mark.parametrize("order", [1, 2, 7, 13])
@pytest.mark.parametrize("delay", [0, 3])
def test_halves_steps_and_whole_are_the_same_bits(order: int, delay: int) -> None:
    G = LinearDynamics.from_transfer_function(*random_system(order, 0), 1.0, delay)
    u = RNG.normal(size=500)
    whole = G(u)
    first, state = G.run(u[:211])
    second, _ = G.run(u[211:], state)
    step = G.stepper()
    assert np.array_equal(np.concatenate([first, second]), whole)
    assert np.array_equal([step(each) for each in u.tolist()], whole)


def test_zero_order_hold_gives_the_printed_discrete_system() -> None:
    G = LinearDynamics.from_continuous(*CONTINUOUS, dt=0.01)
    printed = LinearDynamics.from_transfer_function(*PRINTED, dt=0.01)
    f = np.linspace(0.0, 50.0, 50)
    # The paper prints four digits of each coefficient.
    assert np.abs(G.frequency_response(f) / printed.frequency_response(f) - 1.0).max() < 1e-3
    assert G.dc_gain() == pytest.approx(3.391 / 7.514, rel=1e-12)
    assert np.abs(G.zeros()) == pytest.approx([0.726, 0.726], abs=5e-4)  # seeds' notes


def test_zero_order_hold_agrees_with_scipy() -> None:
    num, den, dt = [2.0, 30.0], [1.0, 4.0, 900.0], 0.02
    expected_num, expected_den, _ = scipy.signal.cont2discrete((num, den), dt)
    G = LinearDynamics.from_continuous(num, den, dt)
    expected = scipy.signal.lfilter(expected_num.ravel(), expected_den, np.ones(200))
    assert G(np.ones(200)) == pytest.approx(expected, rel=1e-10, abs=1e-12)


def test_zeros_poles_and_gain_come_back() -> None:
    zeros, poles = [1.6, -0.3, 0.2 + 0.4j, 0.2 - 0.4j], [0.5, 0.9, 0.1, -0.7, 0.3j, -0.3j]
    G = LinearDynamics.from_zeros_poles_gain(zeros, poles, 2.5, dt=1.0)
    assert G.relative_degree() == 2
    assert G.impulse_response(3)[2] == pytest.approx(2.5, rel=1e-12)
    assert np.sort_complex(G.zeros()) == pytest.approx(np.sort_complex(zeros), abs=1e-9)
    assert np.sort_complex(G.poles()) == pytest.approx(np.sort_complex(poles), abs=1e-9)
    sections = SecondOrderSections.from_linear(G)
    u = RNG.normal(size=400)
    assert sections(u) == pytest.approx(G(u), abs=1e-11 * np.abs(G(u)).max())


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_python_control_both_ways(delay: int) -> None:
    control = pytest.importorskip("control")
    G = LinearDynamics.from_transfer_function([1.0, 0.3], [1.0, -1.2, 0.5], 0.1, delay)
    there = G.to_control()
    u = RNG.normal(size=100)
    _, expected = control.forced_response(there, np.arange(100) * 0.1, u)
    assert G(u) == pytest.approx(expected, abs=1e-12)
    assert LinearDynamics.from_control(there)(u) == pytest.approx(expected, abs=1e-12)
    continuous = control.tf([5.0], [1.0, 2.0, 5.0])
    sampled = control.sample_system(continuous, 0.05)
    f = np.linspace(0.1, 9.9, 20)
    ours = LinearDynamics.from_control(continuous, dt=0.05).frequency_response(f)
    assert ours == pytest.approx(sampled(np.exp(2j * np.pi * f * 0.05)), rel=1e-10)


@pytest.mark.parametrize(
    "model",
    [
        LinearDynamics.from_transfer_function([1.0, 0.3, 0.2], [1.0, -1.2, 0.5], 0.1, delay=2),
        SecondOrderSections([[1.0, 0.3, 0.2, -1.2, 0.5], [0.0, 1.0, 0.0, 0.4, 0.0]], 0.1),
        LinearDynamics.from_transfer_function([0.0, 1.0], [1.0, -0.9], 0.1, delay=1)
        @ hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.5], 1.0),
        hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.5], 1.0)
        @ LinearDynamics.from_transfer_function([1.0], [1.0, -0.9], 0.1),
    ],
    ids=["state space", "sections", "after plays", "before plays"],
)
def test_jacobian_is_the_difference_quotient(model: hyst.Operator) -> None:
    u, theta, step = RNG.normal(size=150), model.parameters().values, 1e-6
    jacobian = model.jacobian(u)
    for i in range(theta.size):
        shift = step * np.eye(theta.size)[i]
        up, down = model.with_parameters(theta + shift), model.with_parameters(theta - shift)
        quotient = (up(u) - down(u)) / (2.0 * step)
        # Second differences: h^2 of the third derivative, and rounding / h.
        assert jacobian[:, i] == pytest.approx(quotient, abs=1e-6 * max(1, np.abs(quotient).max()))


def test_a_model_file_keeps_every_bit(tmp_path: object) -> None:
    G = LinearDynamics.from_continuous(*CONTINUOUS, dt=0.01, delay=2)
    model = G @ hyst.PrandtlIshlinskii([0.5], [0.1], 1.0)
    path = f"{tmp_path}/model.json"
    model.save(path)
    assert hyst.load(path) == model
    assert operator_from_dict(G.to_dict()).delay == 2


def test_the_causal_inverse_cancels() -> None:
    G = LinearDynamics.from_transfer_function([2.0, 0.5], [1.0, -0.8], 0.1)
    u = RNG.normal(size=300)
    assert G.inverse()(G(u)) == pytest.approx(u, abs=1e-12)


@pytest.mark.parametrize(
    ("num", "den", "delay", "says"),
    [
        ([1.0], [1.0, -0.5], 0, "answers 1 samples late"),
        ([1.0, 0.2], [1.0, -0.5], 2, "answers 2 samples late"),
        ([1.0, -1.6], [1.0, -0.5], 0, "zero 1.6"),
        ([1.0, 1.0], [1.0, -0.5], 0, "zero -1"),
    ],
)
def test_what_has_no_causal_inverse_points_to_the_noncausal_one(
    num: list[float], den: list[float], delay: int, says: str
) -> None:
    G = LinearDynamics.from_transfer_function(num, den, 0.1, delay)
    with pytest.raises(NotInvertibleError, match=f"{says}.*StableInverse"):
        G.inverse()
    assert not G.is_invertible()


def test_lipschitz_constant_is_the_sum_of_the_impulse_response() -> None:
    lag = LinearDynamics.from_transfer_function([1.0, 0.0], [1.0, -0.5], 1.0)
    assert lag.lipschitz_constant() == pytest.approx(2.0, rel=1e-6)
    integrator = LinearDynamics.from_transfer_function([1.0], [1.0, -1.0], 1.0)
    assert integrator.lipschitz_constant() == np.inf
    assert not integrator.is_stable()


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: LinearDynamics([[1.0, 0.0]], [1.0], [1.0], 0.0, 0.1), "shapes"),
        (lambda: LinearDynamics([[np.nan]], [1.0], [1.0], 0.0, 0.1), "finite"),
        (lambda: LinearDynamics([[0.5]], [1.0], [1.0], 0.0, 0.0), "dt is 0.0"),
        (lambda: LinearDynamics([[0.5]], [1.0], [1.0], 0.0, 0.1, delay=-1), "whole number"),
        (
            lambda: LinearDynamics([[0.5]], [1.0], [1.0], 0.0, 0.1, delay=1000001),
            "delay is 1000001; give a whole number from 0 to 1000000",
        ),
        (lambda: LinearDynamics(np.eye(65), np.ones(65), np.ones(65), 0.0, 0.1), "at most 64"),
        (lambda: LinearDynamics.from_transfer_function([1, 0, 0], [1, 0], 1.0), "future"),
        (lambda: LinearDynamics.from_zeros_poles_gain([], [0.3j], 1.0, 1.0), "conjugate"),
        (lambda: LinearDynamics.from_control(3.0), "python-control"),
    ],
)
def test_what_is_no_system_is_refused(make: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("samples", [0, -1, 2.5, np.nan, "3", None])
def test_an_impulse_response_has_at_least_one_sample(samples: object) -> None:
    lag = LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], dt=1e-3)
    with pytest.raises(InputError, match="samples"):
        lag.impulse_response(samples)  # type: ignore[arg-type]
    assert lag.impulse_response(3).tolist() == [0.0, 0.5, 0.25]


def test_an_impulse_response_that_overflows_says_where() -> None:
    # 2^k is beyond the doubles from k = 1024 on, and so is the state that sample 1024 leaves.
    with pytest.raises(InputError, match=r"u\[1024\] = 0 the operator overflows"):
        LinearDynamics([[2.0]], [1.0], [1.0], 0.0, 1.0).impulse_response(2000)
