"""Loops whose drive meets its limits: nothing winds up, and they come back as if they never had."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from closed_loop_cases import CONTROLLER, HYSTERESIS, INVERSE, OBSERVER, PLANT

import hyst
from hyst.control import (
    ClosedLoop,
    TrackingController,
    reference_feedforward,
    simulate_closed_loop,
)

DT = 1e-4
LIMITS = (-35.0, 35.0)
CLIPPING = hyst.DeadZone([1.0, -1.0, -1.0], [0.0, 35.0, -35.0])  # an amplifier that saturates
BACK = 2.5  # s, when the reference is within reach again
T = np.arange(round(4.5 / DT)) * DT
# A reference of 45 asks for a drive of 46; with 35 the stage makes 25.
FAR = np.where(T < 0.5, 0.0, np.where(T < BACK, 45.0, 10.0))
REACHED = float(HYSTERESIS([0.0, 35.0])[-1])
NEAR = np.minimum(FAR, REACHED)
FAST_PI, INTEGRAL = ([1.0, 200.0], [1.0, 0.0]), ([60.0], [1.0, 0.0])
PID = ([2e-4 + 1e-3, 0.5 + 60.0 * 2e-4, 60.0], [2e-4, 1.0, 0.0])
SCALED = hyst.Affine(0.7) @ INVERSE


def block(controller: Any, **more: Any) -> TrackingController:
    arguments: dict[str, Any] = {"inverse": INVERSE, "limits": LIMITS} | more
    return TrackingController.from_continuous(controller, DT, **arguments)


def loop(controller: TrackingController, r: np.ndarray = FAR, **more: Any) -> ClosedLoop:
    around: dict[str, Any] = {"plant": PLANT, "hysteresis": HYSTERESIS} | more
    done = simulate_closed_loop(r, DT, controller=controller, **around)
    assert done.diverged_at is None
    return done


def recovery(done: ClosedLoop, error: float = 0.5) -> float:
    """Seconds after the return of the reference from which on the error stays below."""
    far = np.flatnonzero(np.abs(done.e[round(BACK / DT) :]) > error)
    return float((far[-1] + 1) * DT) if far.size else 0.0


@pytest.mark.parametrize("method", ["tustin", "zoh"])
@pytest.mark.parametrize("inverse", [INVERSE, SCALED])
@pytest.mark.parametrize("controller", [FAST_PI, INTEGRAL, PID])
def test_comes_back_within_a_fifth_of_a_second(controller: Any, inverse: Any, method: Any) -> None:
    for observer in (None, OBSERVER):
        kind: dict[str, Any] = {"observer": observer, "inverse": inverse, "method": method}
        limited = loop(block(controller, **kind))
        assert np.abs(limited.u).max() == 35.0
        assert recovery(limited) < 0.2
        if inverse is SCALED and observer is None:
            continue  # what is left of the hysteresis makes the way back depend on the way there
        # Nor is it slower than a loop never asked for more than it can; 2 ms for the drive.
        never = loop(block(controller, limits=None, **kind), NEAR)
        assert recovery(limited) < recovery(never) + 2e-3


def test_windup_that_is_gone() -> None:
    wound = loop(
        block(CONTROLLER, observer=OBSERVER, limits=None), hysteresis=HYSTERESIS @ CLIPPING
    )
    assert np.abs(wound.d_hat).max() > 1e5
    assert recovery(wound) > 1.9
    limited = loop(block(CONTROLLER, observer=OBSERVER))
    assert np.abs(limited.d_hat).max() < 10.0
    assert np.abs(limited.v).max() <= REACHED


def test_a_slow_loop_comes_back_as_if_it_had_never_been_limited() -> None:
    """C = 4 + 8/s makes a pole near -8/5 1/s, which takes a second to bring 3 down to 0.5."""
    for inverse in (INVERSE, SCALED):
        limited = loop(block(CONTROLLER, observer=OBSERVER, inverse=inverse))
        never = loop(block(CONTROLLER, observer=OBSERVER, inverse=inverse, limits=None), NEAR)
        assert 1.0 < recovery(never) < 1.2
        assert recovery(limited) < recovery(never) + 0.05
        # The limited one held its end for good, the other one crept there with that pole: e^-3.2
        # of what it had left, over 1 + 4.
        later = round((BACK + 0.2) / DT)
        assert np.abs(limited.y - never.y)[later:].max() < 0.1


@pytest.mark.parametrize("inverse", [INVERSE, SCALED])
@pytest.mark.parametrize("order", [0, 1, 2])
def test_the_same_slow_loop_with_feedforward_is_back_at_once(order: int, inverse: Any) -> None:
    """What is conditioned is the whole way of the reference, or C would rest at what is left."""
    F = reference_feedforward(PLANT, DT, order=order)
    made: dict[str, Any] = {"observer": OBSERVER, "inverse": inverse, "feedforward": F}
    limited = loop(block(CONTROLLER, **made))
    never = loop(block(CONTROLLER, limits=None, **made), NEAR)
    assert np.abs(limited.u).max() == 35.0
    assert recovery(never) < 0.05
    assert recovery(limited) < 0.05


@pytest.mark.parametrize("rate", [2e3, 2e4, 2e5])
@pytest.mark.parametrize("inverse", [INVERSE, SCALED])
def test_rates_are_met_and_nothing_winds_up(rate: float, inverse: Any) -> None:
    for controller in (FAST_PI, INTEGRAL):
        limited = loop(block(controller, observer=OBSERVER, inverse=inverse, rate=rate))
        assert np.abs(np.diff(limited.u)).max() <= rate * DT * (1.0 + 1e-9)
        assert recovery(limited) < 0.2


def test_the_same_behind_an_amplifier_that_clips_itself() -> None:
    limited = block(CONTROLLER, observer=OBSERVER)
    own, other = loop(limited), loop(limited, hysteresis=HYSTERESIS @ CLIPPING)
    assert np.array_equal(own.y, other.y)
    assert np.array_equal(own.u, other.u)


def test_what_is_told_is_what_was_applied() -> None:
    limited = block(CONTROLLER, observer=OBSERVER)
    done = loop(limited, noise=0.05)
    assert np.array_equal(limited.run(done.r, done.y_measured)[0], done.u)
    assert np.array_equal(limited.estimate(done.r, done.y_measured), done.d_hat)
    held = np.abs(done.u) == 35.0
    assert held.sum() > 1e4
    # v belongs to the drive: what the hysteresis makes of it, with the rounding of two inverses.
    assert np.abs(done.v - done.eta).max() < 1e-9


@pytest.mark.parametrize("controller", [CONTROLLER, FAST_PI, INTEGRAL, PID])
@pytest.mark.parametrize("seed", range(3))
def test_references_far_beyond_the_limits(controller: Any, seed: int) -> None:
    """Ten times what can be reached, at random, with noise: bounded, and back within 0.2 s."""
    rng = np.random.default_rng(seed)
    r = np.repeat(rng.normal(0.0, 300.0, 45), 1000)
    r[round(BACK / DT) :] = 10.0
    for more in ({}, {"rate": 5e3}, {"inverse": SCALED}):
        limited = block(controller, observer=OBSERVER, **more)
        done = loop(limited, r, noise=0.05, seed=seed)
        assert np.abs(done.u).max() <= 35.0
        x = limited.run(done.r, done.y_measured)[1][: limited.order]
        still = limited.run(np.full(5, 10.0), np.full(5, 10.0))[1][: limited.order]
        assert np.isfinite(x).all()
        assert np.isfinite(still).all()
        smooth = np.abs(
            np.convolve(done.e[round((BACK + 0.2) / DT) :], np.full(200, 5e-3), "valid")
        )
        if controller is not CONTROLLER:
            assert smooth.max() < 0.5
        else:  # from whatever error, 40 at most, its own pole brings it below 0.5 in the 2 s left
            assert smooth[-1] < 0.5


@pytest.mark.parametrize("seed", range(16))
def test_loops_at_random_come_back_as_if_they_had_never_been_limited(seed: int) -> None:
    rng = np.random.default_rng(seed)
    omega, zeta = 2.0 * np.pi * 10.0 ** rng.uniform(1.5, 2.8), 10.0 ** rng.uniform(-1.5, 0.0)
    plant = ([omega**2], [1.0, 2.0 * zeta * omega, omega**2])
    # An integrator alone is stable below 2 zeta omega, and so it is with a notch at the resonance.
    gain = rng.uniform(0.1, 0.4) * 2.0 * zeta * omega
    well = [1.0, 2.0 * omega, omega**2]
    notch = ([gain * each for each in plant[1]], [*well, 0.0])
    controller = ([gain], [1.0, 0.0]) if seed % 2 else notch
    high = float(rng.uniform(15.0, 30.0))
    limits = (-float(rng.uniform(0.5, 1.0)) * high, high)
    top = float(HYSTERESIS([0.0, high])[-1])
    assert float(HYSTERESIS([0.0, high, limits[0]])[-1]) < 0.4 * top
    r = np.where(T < BACK, top * rng.uniform(1.2, 10.0), 0.5 * top)
    factor = 1.0 if seed % 3 else float(rng.uniform(0.8, 1.1))
    kind: dict[str, Any] = {"inverse": hyst.Affine(factor) @ INVERSE}
    limited = loop(block(controller, limits=limits, **kind), r, plant=plant)
    never = loop(block(controller, limits=None, **kind), np.minimum(r, top), plant=plant)
    assert limited.u.max() == high
    error = 0.03 * top
    # 10 ms for what inexact inverses leave of the way there.
    assert recovery(limited, error) < 1.2 * recovery(never, error) + 0.01
    assert recovery(never, error) < 1.5


def test_a_drive_that_may_not_be_negative() -> None:
    """As of an amplifier from 0 to 35: what the plays hold at a drive of 0 is as far as it goes."""
    remanent = float(HYSTERESIS([0.0, 35.0, 0.0])[-1])
    assert remanent > 10.5
    limited = loop(block(FAST_PI, observer=OBSERVER, limits=(0.0, 35.0)))
    assert limited.u.min() == 0.0
    # The plant's own modes have settled after 2 s.
    assert limited.y[-1] == pytest.approx(remanent, abs=1e-9)
    within_reach = np.where(FAR == 10.0, remanent + 1.0, FAR)
    assert recovery(loop(block(FAST_PI, observer=OBSERVER, limits=(0.0, 35.0)), within_reach)) < 0.2


def test_a_loop_that_has_settled_starts_from_the_drive_it_rests_with() -> None:
    """A rate counts from that drive: nothing moves while the reference rests."""
    stage = hyst.PrandtlIshlinskii([0.5], [1.0], 1.0)
    block = TrackingController.from_continuous(
        ([0.2, 60.0], [1.0, 0.0]), 1e-3, inverse=stage.inverse(), limits=(-1.0, 20.0), rate=50.0
    )
    plant = ([400.0], [1.0, 30.0, 400.0])
    loop = simulate_closed_loop(
        np.full(200, 12.0), 1e-3, plant=plant, controller=block, hysteresis=stage, start="settled"
    )
    # By hand: 12 = u + 0.5 (u - 1), so u = 25 / 3.
    np.testing.assert_allclose(loop.u, 25.0 / 3.0, rtol=1e-9)
    np.testing.assert_allclose(loop.y, 12.0, rtol=1e-9)
    with pytest.raises(hyst.InputError, match="beyond the limits of the drive"):
        simulate_closed_loop(
            np.full(9, 40.0), 1e-3, plant=plant, controller=block, hysteresis=stage, start="settled"
        )


@pytest.mark.parametrize("more", [{"limits": (-3.0, 3.0)}, {"rate": 300.0}])
def test_a_loop_goes_on_where_no_drive_belongs_to_v(more: dict[str, Any]) -> None:
    """Dahl's friction never gives more than 1; a reference of 2 for 0.1 s, and one within reach."""
    friction = hyst.Dahl(5.0, 1.0)
    limited = TrackingController.from_continuous(
        ([0.2, 100.0], [1.0, 0.0]), 1e-4, inverse=friction.inverse(), **more
    )
    r = np.where(np.arange(3000) < 1000, 2.0, 0.3)
    plant = ([1000.0], [1.0, 1000.0])
    done = simulate_closed_loop(r, 1e-4, plant=plant, controller=limited, hysteresis=friction)
    assert done.r.size == r.size
    # 0.2 s, of which the loop of 100 1/s needs a tenth: e^-20 of 2.
    assert abs(done.e[-1]) < 1e-8
    assert np.abs(done.v - friction(done.u)).max() < 1e-12
    # Records and steps are the same, and the fault tells.
    assert np.array_equal(limited.run(done.r, done.y)[0], done.u)
    step = limited.stepper()
    assert np.array_equal([step(a, b) for a, b in zip(done.r, done.y, strict=True)], done.u)
    assert (step.fault, step.limited) == (True, True)
