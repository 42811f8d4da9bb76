"""A delay by parts of a sample: against interpolation, its inverse, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import hyst

DT = 1e-3


def drive(samples: int = 400, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=samples).cumsum() / 5.0


@pytest.mark.parametrize("samples", [0.0, 0.3, 0.5, 1.0, 2.75, 7.0, 390.5, 1000.25])
def test_it_is_the_line_between_samples_read_late(samples: float) -> None:
    u = drive()
    expected = np.interp(np.arange(u.size) - samples, np.arange(u.size), u)  # holds the first
    # Two roundings of the interpolation.
    np.testing.assert_allclose(hyst.Delay(samples, DT)(u), expected, rtol=0.0, atol=1e-14)


def test_whole_samples_are_the_samples_themselves() -> None:
    u = drive()
    assert hyst.Delay(5, DT)(u).tolist() == [u[0]] * 5 + u[:-5].tolist()


@pytest.mark.parametrize("samples", [0.0, 0.1, 0.42, 0.49])
@pytest.mark.parametrize("scale", [1.0, 1e-9, -3e7])
def test_less_than_half_a_sample_is_inverted(samples: float, scale: float) -> None:
    delay, u = hyst.Delay(samples, DT), scale * drive(3000)
    inverse = delay.inverse()
    # Roundings, made larger by no more than the inverse makes a signal.
    bound = 4.0 * 2.2e-16 * np.abs(u).max() * inverse.lipschitz_constant()
    assert np.abs(delay(inverse(u)) - u).max() <= bound
    assert np.abs(inverse(delay(u)) - u).max() <= bound


@pytest.mark.parametrize("samples", [0.51, 0.75, 1.0, 1.25, 30.0])
def test_longer_delays_ask_for_preview(samples: float) -> None:
    with pytest.raises(hyst.NotInvertibleError, match=r"ask for inverse\(preview=N\)"):
        hyst.Delay(samples, DT).inverse()


@pytest.mark.parametrize("f", [0.5, 0.6])
def test_what_is_refused_would_not_have_settled(f: float) -> None:
    """A disturbance of one sample: at half a sample it stays for ever, beyond it grows."""
    command = np.zeros(100)
    command[0] = 1.0
    for k in range(1, command.size):
        command[k] = -f / (1.0 - f) * command[k - 1]
    assert abs(command[-1]) >= 1.0


def test_at_another_sample_time_it_keeps_its_time() -> None:
    delay = hyst.Delay(2.5, DT)
    assert delay.at_sample_time(2e-3) == hyst.Delay(1.25, 2e-3)
    assert delay.at_sample_time(DT) is delay
    counted = hyst.Delay(2.5)
    assert counted.dt is None
    assert counted.at_sample_time(2e-3) is counted


def test_a_fit_may_move_it_within_its_whole_sample() -> None:
    parameters = hyst.Delay(2.25, DT).parameters()
    assert parameters.lower.tolist() == [2.0]
    assert 2.999 < parameters.upper[0] < 3.0
    u = drive()
    late = np.concatenate([u[:1], u[:1], u[:1], u])[: u.size]
    before = np.concatenate([u[:1], u[:1], u])[: u.size]
    # The derivative of the line: what is one sample older less what is newer.
    assert hyst.Delay(2.25, DT).jacobian(u)[:, 0].tolist() == (late - before).tolist()


def test_the_longest_delay_steps_as_fast_as_a_short_one_and_carries_on() -> None:
    delay, u = hyst.Delay(100_000, DT), drive(250_000)
    whole, _ = delay.run(u)
    first, state = delay.run(u[:123_456])
    rest, _ = delay.run(u[123_456:], state)
    assert np.concatenate([first, rest]).tolist() == whole.tolist()
    assert whole[100_000:].tolist() == u[:150_000].tolist()


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((-0.5, DT), r"samples is -0\.5; give by how many samples"),
        ((float("nan"), DT), "samples is nan"),
        ((float("inf"), DT), "samples is inf"),
        ((100_001, DT), "samples is 100001; a delay is of at most 100000 samples"),
        ((1.0, -1.0), "dt is -1"),
    ],
)
def test_bad_constants_are_named(arguments: tuple, why: str) -> None:
    with pytest.raises(hyst.InputError, match=why):
        hyst.Delay(*arguments)


def test_half_a_sample_has_no_stable_inverse_operator() -> None:
    with pytest.raises(hyst.InputError, match="stable below half a sample"):
        hyst.Delay(0.25, DT).inverse().at_sample_time(DT / 2.0)
