"""Feedforward beside feedback, loops that start where they rest, and parts of a loop compared."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from feedback_cases import PI, STAGE_DT, Fraction, mode
from numpy.typing import NDArray

import hyst
from hyst.control import (
    TrackingController,
    closed_loop_poles,
    compare_loops,
    design_controller,
    design_disturbance_observer,
    reference_feedforward,
    simulate_closed_loop,
)
from hyst.errors import InputError

Array = NDArray[np.float64]

DT = STAGE_DT
STAGE = mode(500.0, 0.05)
HYSTERESIS = hyst.PrandtlIshlinskii([0.1, 0.08, 0.05, 0.05], [1.0, 2.0, 4.0, 8.0], 0.5)
INVERSE = HYSTERESIS.inverse()


def sine(hertz: float, seconds: float = 1.0) -> Array:
    return np.asarray(10.0 * np.sin(2.0 * np.pi * hertz * np.arange(round(seconds / DT)) * DT))


def share(reference: Array, delay: float = 0.0, **options: Any) -> float:
    """Rms tracking error over the amplitude, after 0.3 s."""
    given = {"inverse": INVERSE, "feedforward": None, "noise": 0.0, "controller": PI, **options}
    block = TrackingController.from_continuous(
        given["controller"], DT, inverse=given["inverse"], feedforward=given["feedforward"]
    )
    loop = simulate_closed_loop(
        reference, DT, plant=STAGE, controller=block, hysteresis=HYSTERESIS, delay=delay,
        noise=given["noise"], settle=0.3,
    )  # fmt: skip
    return loop.rms_error / 10.0


def test_a_stage_of_500_hz_follows_10_hz() -> None:
    # |S| at 10 Hz is 0.386 of the PI 0.02 + 150/s, over the root of 2: the 27 % of the audit.
    assert share(sine(10.0)) == pytest.approx(0.273, abs=0.002)
    assert share(sine(10.0), feedforward=True) < 0.002
    assert share(sine(10.0), feedforward=True, delay=DT) < 0.005
    assert share(sine(10.0), feedforward=True, noise=0.01) < 0.005
    # With 0.8 of the inverse the error that feedback must take off is a fifth of the reference.
    assert share(sine(10.0), feedforward=True, inverse=hyst.Affine(0.8) @ INVERSE) < 0.2 * 0.4


@pytest.mark.parametrize("late", [0.0, 1.0, 1.5])
def test_orders_of_the_feedforward_track_ever_better(late: float) -> None:
    errors = [
        share(sine(20.0), late * DT, feedforward=reference_feedforward(STAGE, DT, late * DT, order))
        for order in (0, 1, 2)
    ]
    assert errors[1] < 0.3 * errors[0]
    assert errors[2] < 0.1 * errors[1]
    static = share(sine(20.0), late * DT, feedforward=True)
    assert static == pytest.approx(errors[0], rel=1e-6)


def test_taylor_coefficients_of_a_plant_that_is_known() -> None:
    # A lag behind a hold: P(z) = (1 - a) / (z - a), so 1 / P(z) = (z - a) / (1 - a), and in
    # d = 1 - 1/z: z = 1 / (1 - d) = 1 + d + d^2 + ..., hence 1 + (d + d^2 + ...) / (1 - a).
    a = np.exp(-0.5)
    F = reference_feedforward(([50.0], [1.0, 50.0]), 0.01, order=2)
    c = 1.0 / (1.0 - a)
    taps = np.array([1.0 + c + c, -c - 2.0 * c, c])
    impulse = [F.D[0, 0], (F.C @ F.B)[0, 0], (F.C @ F.A @ F.B)[0, 0]]
    assert impulse == pytest.approx(taps, rel=1e-9)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_polynomials_are_followed_without_feedback(order: int) -> None:
    """A feedforward of order n undoes the plant for references that grow as t^n."""
    t = np.arange(3000) * 1e-3
    plant = ([40.0 * 300.0], [1.0, 40.0, 300.0])
    F = reference_feedforward(plant, 1e-3, 2.3e-3, order)
    block = TrackingController.from_continuous(0.0, 1e-3, feedforward=F)
    loop = simulate_closed_loop(t**order, 1e-3, plant=plant, controller=block, delay=2.3e-3)
    # What is left after 3 s, 20 of the slowest time constants, is rounding.
    assert np.abs(loop.e[-100:]).max() < 1e-7 * max(1.0, t[-1] ** order)


def test_static_feedforward_knows_the_gain() -> None:
    plant: Fraction = ([8.0 * 1e4], [1.0, 200.0, 1e4])
    reference = np.full(400, 3.0)
    design = design_controller(plant, "i", dt=1e-3)
    # The gain is asked of the plant, of the design of C, and is 1 where nobody knows.
    for given in ({"controller": 0.0, "plant": plant}, {"controller": design}):
        block = TrackingController.from_continuous(dt=1e-3, feedforward=True, **given)  # type: ignore[arg-type]
        assert block.run([3.0], [3.0])[0][0] == pytest.approx(3.0 / 8.0, rel=1e-9)
        loop = simulate_closed_loop(reference, 1e-3, plant=plant, controller=block)
        assert loop.y[-1] == pytest.approx(3.0, rel=1e-3)
    blind = TrackingController.from_continuous(0.0, 1e-3, feedforward=True)
    assert blind.run([3.0], [0.0])[0][0] == 3.0


def test_feedforward_changes_no_pole_and_stands_beside_c_and_observer() -> None:
    Wu, Wp = ([2.0, 0.0], [1.0, 3e4]), ([0.05, 10.0], [1.0, 0.1])
    lag: Fraction = ([300.0], [1.0, 300.0])
    controller: Fraction = ([0.1, 30.0], [1.0, 0.0])
    design = design_disturbance_observer(lag, controller, Wu, Wp, method="descent")
    F = ([0.02, 1.0], [0.001, 1.0])
    plain, fed = (
        TrackingController.from_continuous(controller, 1e-3, observer=design, feedforward=each)
        for each in (None, F)
    )
    slow = np.sort_complex(closed_loop_poles(lag, plain))
    both = np.sort_complex(closed_loop_poles(lag, fed))
    own = (1.0 - 0.5) / (1.0 + 0.5)  # of F by the trapezoidal rule: (1 - p dt/2) / (1 + p dt/2)
    assert np.abs(both - own).min() < 1e-9
    for pole in slow:
        assert np.abs(both - pole).min() < 1e-6
    # v with feedforward is that without, plus what F makes of the reference, and what the observer
    # makes of the difference: with y at 0 and no observer, exactly F y_ref.
    r, y = np.cos(np.arange(50) * 0.3), np.zeros(50)
    without = TrackingController.from_continuous(controller, 1e-3).run(r, y)[0]
    with_it = TrackingController.from_continuous(controller, 1e-3, feedforward=F).run(r, y)[0]
    alone = hyst.control.discretized_dynamics(F, 1e-3)(r)
    assert with_it - without == pytest.approx(alone, abs=1e-12)


@pytest.mark.parametrize(
    ("feedforward", "said"),
    [
        (([1.0], [1.0, -1.0]), "the feedforward is not stable"),
        (([1.0, 0.0, 0.0], [1.0, 1.0]), "the feedforward is improper"),
        ("static", "the feedforward"),
        ((np.eye(1), np.ones((1, 2)), np.ones((1, 1)), np.ones((1, 2))), "has 2 inputs"),
    ],
)
def test_feedforwards_that_cannot_be(feedforward: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        TrackingController.from_continuous(PI, DT, feedforward=feedforward)


def test_no_static_feedforward_where_there_is_no_static_gain() -> None:
    with pytest.raises(InputError, match="static gain is inf"):
        TrackingController.from_continuous(PI, DT, feedforward=True, plant=([1.0], [1.0, 0.0]))
    with pytest.raises(InputError, match="static gain is 0"):
        reference_feedforward(([1.0, 0.0], [1.0, 1.0]), DT)


@pytest.mark.parametrize("factor", [1.0, 0.8])
@pytest.mark.parametrize("feedforward", [None, True])
@pytest.mark.parametrize("controller", [PI, 0.1, 0.0])
def test_a_settled_start_is_where_the_loop_comes_to_rest(
    controller: Any, feedforward: Any, factor: float
) -> None:
    inverse = hyst.Affine(factor) @ INVERSE if factor != 1.0 else INVERSE
    plant = mode(500.0, 0.05, 0.8)
    block = TrackingController.from_continuous(
        controller, DT, inverse=inverse, feedforward=feedforward, plant=plant
    )
    given = {"plant": plant, "controller": block, "hysteresis": HYSTERESIS, "delay": 1.3 * DT}
    loop = simulate_closed_loop(np.full(500, 40.0), DT, start="settled", **given)
    assert np.ptp(loop.y) < 1e-10
    assert np.ptp(loop.u) < 1e-10
    # By a ramp from rest that is slow and does not overshoot, it comes there too.
    slow = 40.0 * np.minimum(np.arange(30_000) / 20_000.0, 1.0)
    if controller is not PI:
        assert loop.y[0] == pytest.approx(simulate_closed_loop(slow, DT, **given).y[-1], rel=1e-6)
    else:
        assert loop.y[0] == pytest.approx(40.0, rel=1e-12)


@pytest.mark.parametrize("leak", [10.0, 0.1, 1e-3, 1e-5])
@pytest.mark.parametrize("gain", [1e-6, 1.0, 1e6])
def test_a_settled_start_of_a_slow_leak_is_no_integrator_s(gain: float, leak: float) -> None:
    """L(0) = 1000 / leak, so y rests at r L / (1 + L) exactly, with an exact inverse."""
    block = TrackingController.from_continuous(
        ([0.1 / gain, 1000.0 / gain], [1.0, leak]), DT, inverse=INVERSE
    )
    loop = simulate_closed_loop(
        np.full(100, 40.0 * gain), DT, plant=mode(90.0, 0.8, gain), controller=block,
        hysteresis=HYSTERESIS, start="settled",
    )  # fmt: skip
    at_rest = 40.0 * gain / (1.0 + leak / 1000.0)
    # Rounding of A, 1e-16 of leak DT, is what is left of the static gain.
    assert loop.y[0] == pytest.approx(at_rest, rel=1e-10)
    assert loop.y[-1] == pytest.approx(at_rest, rel=1e-8)


def test_a_settled_loop_goes_on_as_one_that_has_settled() -> None:
    """Half a second of rest before the motion, by the long way, and at once."""
    block = TrackingController.from_continuous(PI, DT, inverse=INVERSE, feedforward=True)
    given = {"plant": STAGE, "controller": block, "hysteresis": HYSTERESIS}
    motion = 40.0 + sine(10.0, 0.3)
    rising = 20.0 * (1.0 - np.cos(np.pi * np.minimum(np.arange(20_000) / 10_000.0, 1.0)))
    long = simulate_closed_loop(np.concatenate([rising, motion]), DT, **given)
    short = simulate_closed_loop(motion, DT, start="settled", noise=np.zeros(motion.size), **given)
    assert short.y == pytest.approx(long.y[-motion.size :], abs=1e-6)
    # The long way overshoots a little, which the plays remember until the motion passes it.
    assert short.u == pytest.approx(long.u[-motion.size :], abs=1e-3)
    assert short.eta == pytest.approx(long.eta[-motion.size :], abs=1e-6)
    assert not short.noise.any()


def test_starts_that_cannot_be() -> None:
    block = TrackingController.from_continuous(PI, DT, inverse=INVERSE)
    r = np.full(10, 5.0)
    with pytest.raises(InputError, match="give a TrackingController"):
        simulate_closed_loop(r, DT, plant=STAGE, controller=PI, start="settled")
    with pytest.raises(InputError, match="start is 'soon'"):
        simulate_closed_loop(r, DT, plant=STAGE, controller=block, start="soon")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="static gain is inf"):
        simulate_closed_loop(r, DT, plant=([1.0], [1.0, 0.0]), controller=block, start="settled")


def test_parts_of_a_loop_are_compared_and_marked() -> None:
    found = compare_loops(
        sine(10.0), DT, plant=STAGE, controller=PI, hysteresis=HYSTERESIS, noise=0.01, settle=0.3
    )
    series, both = found["inverse + feedback"], found["inverse + feedback + feedforward"]
    assert series.rms == pytest.approx(2.73, abs=0.02)
    assert both.rms < 0.05
    assert found["inverse alone"].rms < 0.05
    assert {row.mark for row in found.rows} == {"proven"}
    assert 0.0 < both.noise_jitter < both.jitter
    assert found["inverse alone"].noise_jitter == 0.0
    with pytest.raises(InputError, match="there is no loop 'observer'"):
        found["observer"]


def test_a_loop_that_is_not_safe_is_marked_in_the_table() -> None:
    """S1's controller without an inverse: slopes of the plays go up to five times that at 0."""
    p = [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7]
    steep = hyst.PrandtlIshlinskii(p, np.arange(4.0, 41.0, 4.0), 0.1)
    t = np.arange(30_000) * DT
    r = 18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t)
    found = compare_loops(
        r, DT, plant=mode(90.0, 0.8), controller=([4.0, 8.0], [1.0, 0.0]), hysteresis=steep,
        Wu=([-1.0, -960.0, 0.0], [1.0, 960.0, 5.76e6]), settle=1.0,
    )  # fmt: skip
    line, both = found["feedback alone"], found["inverse + feedback"]
    assert both.mark == "proven"
    assert line.mark == "NOT SAFE"
    row = next(text for text in found.summary().splitlines() if text.startswith("feedback alone"))
    assert "NOT SAFE: at a slope of" in row


def test_no_row_with_a_plant_that_integrates_is_proven() -> None:
    """Feedforward alone leaves it where any disturbance carries it."""
    found = compare_loops(
        sine(10.0, 0.02), DT, plant=([1.0], [1e-3, 1.0, 0.0]), controller=([1.0], [1.0]),
        hysteresis=HYSTERESIS, feedforward=0.5,
    )  # fmt: skip
    assert found["inverse alone"].mark != "proven"


@pytest.mark.parametrize(
    ("given", "said"),
    [({"hysteresis": None}, "hysteresis is NoneType"), ({"inverse": 2.0}, "inverse is float")],
)
def test_what_is_compared_needs_operators(given: dict[str, Any], said: str) -> None:
    whole: dict[str, Any] = {"plant": STAGE, "controller": PI, "hysteresis": HYSTERESIS} | given
    with pytest.raises(InputError, match=said):
        compare_loops(sine(10.0, 0.02), DT, **whole)


def test_without_feedforward_there_is_nothing_to_compare() -> None:
    with pytest.raises(InputError, match="feedforward is left out"):
        compare_loops(
            sine(10.0), DT, plant=STAGE, controller=PI, hysteresis=HYSTERESIS, feedforward=None
        )


def test_a_reference_that_the_hysteresis_cannot_give_diverges_and_is_no_error() -> None:
    """Dahl's force stays below Fc: for an output beyond there is no drive."""
    found = compare_loops(
        sine(10.0)[:2000], DT, plant=STAGE, controller=PI, hysteresis=hyst.Dahl(1.0, 5.0)
    )
    assert found["inverse + feedback"].mark == "NOT SAFE"
    assert np.isinf(found["inverse + feedback"].rms)
    assert np.isfinite(found["feedback alone"].rms)
