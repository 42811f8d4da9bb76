"""Creep: against filters and closed forms, its inverse beside hysteresis, and what is refused."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import scipy.signal

import hyst
from hyst import _single

DECADES = hyst.Creep([0.02, 0.02, 0.02, 0.02], [0.01, 0.1, 1.0, 10.0], dt=1e-3)
PLAYS = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], p0=1.0)


def drive(samples: int = 20_000, seed: int = 0) -> np.ndarray:
    steps = np.random.default_rng(seed).normal(size=samples)
    return np.asarray(scipy.signal.lfilter([1.0], [1.0, -0.999], steps) / 20.0)


@pytest.mark.parametrize("rest", [0.0, -1.5])
def test_it_is_a_sum_of_sampled_filters(rest: float) -> None:
    u, expected = drive(), drive()
    for weight, tau in zip(DECADES.weights, DECADES.time_constants, strict=True):
        keep = np.exp(-DECADES.dt / tau)
        lag, _ = scipy.signal.lfilter([0.0, 1.0 - keep], [1.0, -keep], u, zi=[rest])
        expected = expected + weight * lag
    found = hyst.Creep(DECADES.weights, DECADES.time_constants, DECADES.dt, rest)(u)
    # The filter rounds otherwise, and each of its 10^4 samples of memory adds a rounding.
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11 * np.ptp(expected))


def test_a_step_creeps_by_the_closed_form() -> None:
    after = np.arange(5000) * DECADES.dt
    expected = 1.0 + sum(0.02 * (1.0 - np.exp(-after / tau)) for tau in (0.01, 0.1, 1.0, 10.0))
    np.testing.assert_allclose(DECADES(np.ones(5000)), expected, rtol=1e-13)


def test_decades_of_time_constants_creep_evenly_over_the_logarithm_of_time() -> None:
    """Within 2 % of what one decade creeps, as the docstring says; away from both ends."""
    times = 10.0 ** np.arange(-4.0, 5.0)
    t = np.geomspace(1e-1, 1e2, 400)
    crept = (1.0 - np.exp(-t[:, None] / times)).sum(axis=1)
    line = np.log10(t)
    assert np.abs(crept - line - np.mean(crept - line)).max() < 0.02


def test_what_does_not_move_creeps_to_rest_and_rest_stays() -> None:
    at_rest = hyst.Creep([0.2, 0.1], [0.01, 3.0], 1e-3, rest=2.5)
    assert set(at_rest(np.full(1000, 2.5)).tolist()) == {float(at_rest([2.5])[0])}


@pytest.mark.parametrize("scale", [1.0, 1e-9, 3e7])
def test_hysteresis_and_creep_are_inverted_from_the_first_sample_on(scale: float) -> None:
    model = hyst.Creep(DECADES.weights, DECADES.time_constants, 1e-3, 0.3 * scale) @ hyst.Affine(
        scale, 0.1 * scale
    )
    model = model @ PLAYS
    wanted = scale * drive(seed=1)
    reached = model(model.inverse()(wanted))
    # Ten roundings of each of the two ways.
    assert np.abs(reached - wanted).max() <= 1e-14 * np.ptp(wanted)


@pytest.mark.parametrize("order", list(itertools.permutations(range(3))))
def test_it_composes_in_any_order(order: tuple[int, ...]) -> None:
    parts = (DECADES, PLAYS, hyst.DeadZone.odd([1.0, 0.2], [0.0, 0.5]))
    a, b, c = (parts[i] for i in order)
    model, u = a @ b @ c, drive(seed=2)
    np.testing.assert_allclose(model.inverse()(model(u)), u, rtol=0.0, atol=1e-12 * np.ptp(u))


def test_at_another_sample_time_it_creeps_the_same_in_seconds() -> None:
    slower = DECADES.at_sample_time(4e-3)
    assert slower.dt == 4e-3
    u = np.repeat(drive(2000, seed=3), 4)
    # A held input is the same input at both.
    np.testing.assert_allclose(DECADES(u)[::4], slower(u[::4]), rtol=1e-12)


def test_single_precision_creeps_as_far() -> None:
    """A lag of 10^5 samples: its single steps are below the digits of what it has reached."""
    slow = hyst.Creep([0.5], [10.0], dt=1e-4)
    gain = float(np.float32(slow.gains()[0]))
    stage = ("creep", "", {}, {"weight": [0.5], "gain": [gain]}, {"inverse": 0})
    step = _single.Stepper([stage], [0.0, 0.0])
    for _ in range(1_500_000):
        reached = step(1.0)
    # A rounding of the output; without what is carried over the lag would stop at 1.4985.
    assert abs(reached - float(slow(np.ones(1_500_000))[-1])) < 2e-7


@pytest.mark.parametrize(
    ("weights", "times", "why"),
    [
        ([-0.6, -0.5], [0.1, 1.0], r"sum up to -1\.1: .* the sum must be above -1"),
        ([5.0], [1e-4], r"grow by a factor of 4.9997"),
    ],
)
def test_a_command_that_would_grow_is_refused(
    weights: list[float], times: list[float], why: str
) -> None:
    with pytest.raises(hyst.NotInvertibleError, match=why):
        hyst.Creep(weights, times, dt=1e-3).inverse()


def test_what_is_refused_would_have_grown() -> None:
    """The bound is no caution: just beyond it the command grows, just within it does not."""
    for weight, grows in ((1.1, True), (0.9, False)):
        fast = hyst.Creep([weight], [1e-6], dt=1e-3)  # answers within a sample: u_k + w u_{k-1}
        assert fast.is_invertible() is not grows
        u = np.zeros(200)
        u[0] = 1.0
        for k in range(1, u.size):
            u[k] = -weight * u[k - 1]
        assert bool(np.abs(u[-1]) > 1.0) is grows
        np.testing.assert_allclose(fast(u), [1.0] + [0.0] * 199, atol=1e-6 * np.abs(u).max())


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (([0.1], [1.0, 2.0], 1e-3), "1 weights and 2 time constants"),
        (([0.1], [0.0], 1e-3), r"time_constants\[0\] is 0\.0; give a time above 0"),
        (([0.1], [-2.0], 1e-3), r"time_constants\[0\] is -2\.0"),
        (([0.1], [1e14], 1e-3), "1e\\+17 samples"),
        (([0.1], [1.0], 0.0), "dt"),
        (([float("nan")], [1.0], 1e-3), r"weights\[0\]"),
        (([0.1], [1.0], 1e-3, float("inf")), "rest"),
    ],
)
def test_bad_constants_are_named(arguments: tuple, why: str) -> None:
    with pytest.raises(hyst.InputError, match=why):
        hyst.Creep(*arguments)


def test_a_record_of_another_sample_time_is_refused() -> None:
    with pytest.raises(hyst.InputError, match="sample time"):
        DECADES.require_sample_time(2e-3)


@pytest.mark.parametrize("lags", [0, 1, 2, 3, 4, 7, 10, 11, 13])
@pytest.mark.parametrize("inverse", [False, True])
def test_long_records_have_the_bits_of_single_steps(lags: int, inverse: bool) -> None:
    """Whole records take a faster way, in blocks of 128 samples."""
    creep = hyst.Creep(np.full(lags, 0.1 / max(lags, 1)), np.geomspace(2e-3, 1e4, lags), 1e-3, 0.3)
    model, u = (creep.inverse() if inverse else creep), drive(1000, seed=lags)
    step = model.stepper()
    stepped = [step(value) for value in u.tolist()]
    y, state = model.run(u)
    assert y.tolist() == stepped
    assert state.tobytes() == step.state.tobytes()
    first, middle = model.run(u[:333])
    second, end = model.run(u[333:], middle)
    assert np.concatenate([first, second]).tobytes() == y.tobytes()
    assert end.tobytes() == state.tobytes()


@pytest.mark.parametrize("inverse", [False, True])
def test_what_overflows_in_a_long_record_is_named(inverse: bool) -> None:
    creep = hyst.Creep([0.5, 0.25], [0.1, 1.0], 1e-3, rest=-1e308)
    u = np.full(400, -1e308)
    u[300] = 1.7e308
    with pytest.raises(hyst.InputError, match=r"u\[300\] = 1\.7e\+308 .* overflows"):
        (creep.inverse() if inverse else creep)(u)
