"""A first-order lag: against the solved equation, its inverse, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.integrate

import hyst

DT = 1e-3


def drive(samples: int = 400, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=samples).cumsum() / 5.0


@pytest.mark.parametrize("tau", [0.42e-3, 3.7e-3])
@pytest.mark.parametrize("hold", ["first", "zero"])
def test_it_solves_the_equation_between_samples(tau: float, hold: str) -> None:
    u, t = drive(60), np.arange(60) * DT
    y, expected = u[0], [u[0]]
    for k in range(1, u.size):

        def between(time: float, at: int = k) -> float:
            share = (time - t[at - 1]) / DT if hold == "first" else 1.0
            return float(u[at - 1] + share * (u[at] - u[at - 1]))

        found = scipy.integrate.solve_ivp(
            lambda time, y, between=between: (between(time) - y) / tau,
            (t[k - 1], t[k]), [y], method="Radau", rtol=1e-12, atol=1e-13,
        )  # fmt: skip
        y = float(found.y[0, -1])
        expected.append(y)
    # The tolerance asked of the solver, which a stable equation does not add up.
    np.testing.assert_allclose(hyst.Lag(tau, DT, hold)(u), expected, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("samples", [1e-3, 0.42, 1.0, 30.0, 1e4, 1e6])
def test_a_ramp_comes_late_by_the_time_constant(samples: float) -> None:
    """From rest the ramp t is answered by ``t - tau (1 - exp(-t / tau))``, with all its digits."""
    tau, t = samples * DT, np.arange(2000) * DT
    expected = t + tau * np.expm1(-t / tau)
    expected[0] = 0.0
    if samples > 1e3:  # tau (x^2 / 2 - x^3 / 6 + ..), without the difference of two equals
        x = t / tau
        expected = tau * sum((-x) ** n / math.factorial(n) for n in range(2, 16))
    # What carries over keeps each step: roundings of what is reached, and those of the closed form.
    np.testing.assert_allclose(
        hyst.Lag(tau, DT)(t)[1:], expected[1:], rtol=3e-13, atol=1e-15 * expected[-1]
    )


@pytest.mark.parametrize("hold", ["first", "zero"])
def test_short_lags_tend_to_the_signal_itself(hold: str) -> None:
    u = drive()
    for samples in (1e-2, 1e-4, 1e-6):
        # y is behind u by tau du/dt at most, of which the largest step counts.
        apart = np.abs(hyst.Lag(samples * DT, DT, hold)(u) - u).max()
        assert apart <= samples * np.abs(np.diff(u)).max() * (1.0 + 1e-9)
    # A held signal is reached within its sample, but for rounding; a line stays behind.
    assert (apart > 1e-8) == (hold == "first")


@pytest.mark.parametrize("hold", ["first", "zero"])
@pytest.mark.parametrize("samples", [1e-3, 0.42, 3.0, 1e3, 1e6])
def test_a_command_of_the_inverse_reaches_what_was_wanted(samples: float, hold: str) -> None:
    lag, wanted = hyst.Lag(samples * DT, DT, hold), drive(5000, seed=1)
    # The inverse takes the step that the lag will take: roundings do not add up.
    assert np.abs(lag(lag.inverse()(wanted)) - wanted).max() <= 4e-16 * np.abs(wanted).max()


@pytest.mark.parametrize("samples", [0.05, 0.42, 3.0])
def test_the_inverse_gives_back_what_was_given(samples: float) -> None:
    lag, u = hyst.Lag(samples * DT, DT), drive(5000, seed=2)
    back = lag.inverse()
    # Some roundings of y, each made larger by no more than the inverse makes a signal.
    bound = 4.0 * 2.2e-16 * np.abs(u).max() * back.lipschitz_constant()
    assert np.abs(back(lag(u)) - u).max() <= bound
    assert bound < 1e-12 * np.ptp(u)


@pytest.mark.parametrize("hold", ["first", "zero"])
@pytest.mark.parametrize("samples", [0.3, 1.0, 1.01, 7.0])
def test_the_inverse_makes_signals_larger_by_what_it_says(samples: float, hold: str) -> None:
    """The worst input has the signs of the impulse response, read backwards."""
    inverse = hyst.Lag(samples * DT, DT, hold).inverse()
    impulse = np.zeros(400)
    impulse[1] = 1.0
    response = inverse(impulse)[1:]
    worst = np.concatenate([[0.0], np.sign(response[::-1])])
    reached = inverse(worst)[-1]
    # At rest before the first sample: the start at 0 costs nothing here.
    assert reached == pytest.approx(inverse.lipschitz_constant(), rel=1e-6)


def test_at_another_sample_time_the_time_constant_stays() -> None:
    lag = hyst.Lag(4.2e-3, DT)
    slower = lag.at_sample_time(4e-3)
    assert (slower.time_constant, slower.dt) == (4.2e-3, 4e-3)
    knots = drive(200, seed=3)
    line = np.interp(np.arange(199 * 4 + 1) / 4.0, np.arange(200), knots)
    # A line between samples is the same input at both; roundings of some thousand samples.
    np.testing.assert_allclose(lag(line)[::4], slower(knots), rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("samples", [1e-3, 0.42, 20.0, 1e6])
@pytest.mark.parametrize("hold", ["first", "zero"])
def test_the_derivative_by_the_time_constant(samples: float, hold: str) -> None:
    tau, u = samples * DT, drive(300, seed=4)
    step = 1e-4 * tau
    higher, lower = hyst.Lag(tau + step, DT, hold)(u), hyst.Lag(tau - step, DT, hold)(u)
    expected = (higher - lower) / (2.0 * step)
    found = hyst.Lag(tau, DT, hold).jacobian(u)[:, 0]
    # The difference is off by the square of the step, and by rounding over the step.
    bound = 1e-6 * np.abs(expected).max() + 1e-15 * np.abs(u).max() / step
    assert np.abs(found - expected).max() <= bound


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((0.0, DT), r"time_constant is 0\.0; give seconds, above 0"),
        ((-1.0, DT), r"time_constant is -1\.0"),
        ((float("nan"), DT), "time_constant is nan"),
        ((float("inf"), DT), "time_constant is inf"),
        ((1e-10, DT), r"1e-07 samples of 0\.001 s; give one of 1e-06"),
        ((1e13, DT), r"1e\+16 samples"),
        ((1.0, 0.0), "dt is 0"),
        ((1.0, DT, "second"), "hold is 'second'; give 'first'"),
    ],
)
def test_bad_constants_are_named(arguments: tuple, why: str) -> None:
    with pytest.raises(hyst.InputError, match=why):
        hyst.Lag(*arguments)


def test_records_and_stages_of_another_sample_time_are_refused() -> None:
    with pytest.raises(hyst.InputError, match="sample time"):
        hyst.Lag(1.0, DT).require_sample_time(2.0 * DT)
    with pytest.raises(hyst.InputError, match="sample times of"):
        hyst.Lag(1.0, DT) @ hyst.Delay(1.0, 2.0 * DT)


@pytest.mark.parametrize("inverse", [False, True])
@pytest.mark.parametrize("hold", ["first", "zero"])
def test_long_records_have_the_bits_of_single_steps(hold: str, inverse: bool) -> None:
    """Whole records take a faster way, in blocks of 128 samples."""
    lag, u = hyst.Lag(1.7e-3, DT, hold), drive(1000, seed=5)
    model = lag.inverse() if inverse else lag
    step = model.stepper()
    stepped = [step(value) for value in u.tolist()]
    y, state = model.run(u)
    assert y.tolist() == stepped
    assert state.tobytes() == step.state.tobytes()


@pytest.mark.parametrize("inverse", [False, True])
def test_what_overflows_in_a_long_record_is_named(inverse: bool) -> None:
    lag, u = hyst.Lag(1.7e-3, DT), np.full(400, -1e308)
    u[300] = 1.7e308
    with pytest.raises(hyst.InputError, match=r"u\[300\] = 1\.7e\+308 .* overflows"):
        (lag.inverse() if inverse else lag)(u)
