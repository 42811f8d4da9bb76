"""Closed loops against closed forms, and against the numbers the repaired example is known by."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from closed_loop_cases import (
    CONTROLLER,
    HYSTERESIS,
    INVERSE,
    MODES,
    OBSERVER,
    PLANT,
    PRINTED_CONTROLLER,
    mode,
    reference,
)

import hyst
from hyst.control import (
    ClosedLoop,
    closed_loop_poles,
    design_disturbance_observer,
    simulate_closed_loop,
)
from hyst.errors import SolverError

SLOW_PLANT = ([50.0], [1.0, 50.0])


def example(dt: float = 2e-5, seconds: float = 3.0, **given: object) -> ClosedLoop:
    """Three seconds, of which the first settles: two whole periods are measured."""
    arguments = {
        "plant": PLANT,
        "controller": CONTROLLER,
        "hysteresis": HYSTERESIS,
        "settle": 1.0,
    } | given
    return simulate_closed_loop(reference(seconds, dt), dt, **arguments)  # type: ignore[arg-type]


# The numbers of a prototype that was written apart from this code, to the digits they are known to.
@pytest.mark.parametrize(
    ("share", "observer", "rms"),
    [(1.0, None, 4.64), (0.7, None, 11.64), (0.7, OBSERVER, 4.76), (None, None, 6.01)],
    ids=["exact", "0.7", "0.7 and observer", "no inverse"],
)
def test_repaired_example(share: float | None, observer: object, rms: float) -> None:
    inverse = None if share is None else hyst.Affine(share) @ INVERSE
    loop = example(inverse=inverse, observer=observer)
    # Half of the last digit known, and what a sample more or less in the window may move.
    assert loop.rms_error == pytest.approx(rms, abs=0.006)
    assert loop.max_error > loop.rms_error


def test_observer_recovers_what_the_inexact_inverse_adds() -> None:
    inexact = hyst.Affine(0.7) @ INVERSE
    exact, alone, observed = (
        example(inverse=inverse, observer=observer).rms_error
        for inverse, observer in ((INVERSE, None), (inexact, None), (inexact, OBSERVER))
    )
    assert (alone - observed) / (alone - exact) >= 0.95


def test_printed_controller_diverges_at_the_rate_of_its_pole() -> None:
    loop = example(controller=PRINTED_CONTROLLER, inverse=INVERSE)
    assert loop.diverged_at is not None
    assert 0.05 < loop.diverged_at < 0.1
    assert loop.rms_error == math.inf
    assert "diverges" in loop.summary()
    for signal in (loop.r, loop.y, loop.v, loop.u, loop.eta, loop.d_hat, loop.e, loop.t):
        assert signal.size == round(loop.diverged_at / loop.dt)
        assert np.isfinite(signal).all()
    # The amplitude grows like exp(275 t), here from half to half of what was recorded.
    pole = closed_loop_poles(PLANT, PRINTED_CONTROLLER)[0]
    assert pole.real == pytest.approx(275.0, abs=1.0)
    start = round(0.04 / loop.dt)
    middle = (start + loop.y.size) // 2
    early, late = (np.abs(each).max() for each in (loop.y[start:middle], loop.y[middle:]))
    rate = math.log(late / early) / ((loop.y.size - middle) * loop.dt)
    # A peak may lie up to half a period of its 1822 rad/s before the end of a half.
    assert rate == pytest.approx(pole.real, rel=0.15)


@pytest.mark.parametrize("observer", [None, OBSERVER], ids=["alone", "observer"])
def test_exact_inverse_leaves_a_linear_loop_whose_error_is_known(observer: object) -> None:
    expected = 0.0
    for amplitude, frequency in ((18.0, 1.0), (28.0, 3.0)):
        s = 2j * np.pi * frequency
        P = np.polyval(PLANT[0], s) / np.polyval(PLANT[1], s)
        C = np.polyval(CONTROLLER[0], s) / np.polyval(CONTROLLER[1], s)
        of_v, of_y = 0.0, 0.0
        if observer is not None:
            A, B, row, _ = OBSERVER
            of_v, of_y = (row @ np.linalg.solve(s * np.eye(3) - A, B))[0]
        # v = C (r - y) - of_v v - of_y y, y = P v
        y = P * C / (1.0 + of_v + of_y * P + P * C)
        expected += 0.5 * abs(amplitude * (1.0 - y)) ** 2
    coarse, fine = (
        example(dt, 10.0, inverse=INVERSE, observer=observer, settle=9.0).rms_error
        for dt in (1e-4, 5e-5)
    )
    # Richardson's extrapolation of a first-order method leaves errors of second order: dt^2 times
    # the square of the fastest frequency that matters, 566 rad/s, is 8e-4 of the error of 4e-3.
    assert 2.0 * fine - coarse == pytest.approx(math.sqrt(expected), rel=3e-5)
    assert abs(fine - math.sqrt(expected)) < 0.01


def test_converges_with_first_order_in_dt() -> None:
    inexact = hyst.Affine(0.7) @ INVERSE
    steps = (4e-5, 2e-5, 1e-5, 5e-6)
    outputs = [
        example(dt, 0.5, inverse=inexact, observer=OBSERVER, settle=0.0).y[:: round(4e-5 / dt)]
        for dt in steps
    ]
    changes = [np.abs(a - b).max() for a, b in itertools.pairwise(outputs)]
    ratios = np.array(changes[:-1]) / np.array(changes[1:])
    # Held between samples, the output of the hysteresis is half a sample late: halving dt halves
    # the error. Contacts of plays fall on samples, which moves the ratio a little.
    assert np.all((ratios > 1.7) & (ratios < 2.3))


def test_agrees_with_a_loop_in_python_over_an_independent_realization() -> None:
    control = pytest.importorskip("control")
    dt, samples = 2e-5, 1500
    blocks = {
        "P": (control.ss(control.tf(*PLANT)), ["w"], ["y"]),
        "C": (control.ss(control.tf(*CONTROLLER)), ["e"], ["c"]),
        "O": (control.ss(*OBSERVER), ["v", "ym"], ["d"]),
    }
    systems = [
        control.ss(each.A, each.B, each.C, each.D, name=name, inputs=into, outputs=out)
        for name, (each, into, out) in blocks.items()
    ]
    systems += [
        control.summing_junction(["y", "n"], "ym"),
        control.summing_junction(["r", "-ym"], "e"),
        control.summing_junction(["c", "-d"], "v"),
    ]
    joint = control.interconnect(systems, inputs=["r", "n", "w"], outputs=["v", "y", "d"])
    sampled = control.c2d(joint, dt, "zoh")
    rng = np.random.default_rng(3)
    r, noise, d = 30.0 * reference(samples * dt, dt), *rng.normal(0.0, 0.3, (2, samples))
    loop = simulate_closed_loop(
        r,
        dt,
        plant=PLANT,
        controller=CONTROLLER,
        hysteresis=HYSTERESIS,
        inverse=INVERSE,
        observer=OBSERVER,
        noise=noise,
        disturbance=d,
    )
    x, z, memory = np.zeros(sampled.nstates), np.zeros(10), np.zeros(10)
    signals = []
    for k in range(samples):
        v, y, d_hat = sampled.C @ x + sampled.D @ [r[k], noise[k], 0.0]
        z = np.maximum(v - INVERSE.r, np.minimum(v + INVERSE.r, z))
        u = INVERSE.p0 * v + INVERSE.p @ z
        memory = np.maximum(u + d[k] - HYSTERESIS.r, np.minimum(u + d[k] + HYSTERESIS.r, memory))
        eta = HYSTERESIS.p0 * (u + d[k]) + HYSTERESIS.p @ memory
        x = sampled.A @ x + sampled.B @ [r[k], noise[k], eta]
        signals.append((v, u, eta, y, d_hat))
    for name, expected in zip(("v", "u", "eta", "y", "d_hat"), np.array(signals).T, strict=True):
        # Two realizations of one system differ by rounding, amplified by the condition of the
        # companion form, whose entries span twelve orders of magnitude.
        scale = max(1.0, np.abs(expected).max())
        assert np.abs(getattr(loop, name) - expected).max() < 1e-7 * scale, name


def test_constant_disturbance_is_estimated_and_rejected() -> None:
    for place in ("hysteresis", "plant"):
        loop = simulate_closed_loop(
            np.zeros(60_000),
            1e-4,
            plant=PLANT,
            controller=2.0,
            observer=OBSERVER,
            disturbance=3.0,
            disturbance_at=place,
            settle=5.0,
        )
        # Q(0) = 1. The observer's slowest mode, 155 1/s, has died out long before; what is left is
        # rounding, amplified by the observer's gain of 17113.
        assert np.abs(loop.d_hat[-100:] - 3.0).max() < 1e-8
        assert loop.max_error < 1e-8
        assert (loop.disturbance == 3.0).all()


def test_noise_is_white_reproducible_and_reaches_the_controller_alone() -> None:
    given = {"plant": SLOW_PLANT, "controller": 4.0}
    r = np.zeros(20_000)
    first, same, other = (
        simulate_closed_loop(r, 1e-4, noise=0.5, seed=seed, **given) for seed in (1, 1, 2)
    )
    assert np.array_equal(first.y, same.y)
    assert not np.array_equal(first.y, other.y)
    # Standard error of a standard deviation of 20,000 samples: 0.5 %.
    assert first.noise.std() == pytest.approx(0.5, rel=0.02)
    assert np.array_equal(first.y_measured, first.y + first.noise)
    as_samples = simulate_closed_loop(r, 1e-4, noise=first.noise, **given)
    assert np.array_equal(as_samples.y, first.y)
    # v = 4 (r - y - noise)
    assert np.abs(first.v + 4.0 * first.y_measured).max() < 1e-14


def test_algebraic_loop_is_solved_through_the_hysteresis() -> None:
    stage = hyst.PrandtlIshlinskii([0.5, 0.25], [0.5, 2.0], p0=1.0)
    r = 5.0 * np.sin(np.arange(4000) * 0.01)
    loop = simulate_closed_loop(r, 1e-3, plant=2.0, controller=3.0, hysteresis=stage)
    # Everything of one instant: v = 3 (r - 2 eta), eta the hysteresis of all v so far.
    assert np.abs(loop.v - 3.0 * (r - 2.0 * loop.eta)).max() < 1e-12
    assert np.abs(stage(loop.v) - loop.eta).max() < 1e-12
    assert np.array_equal(loop.y, 2.0 * loop.eta)


def test_algebraic_loop_with_a_delay_takes_the_sample_before() -> None:
    r = np.ones(50)
    late = simulate_closed_loop(r, 1.0, plant=0.5, controller=1.0, algebraic_loop="delay")
    # y_k = (1 - y_{k-1}) / 2, y_{-1} = 0
    assert late.y[:4].tolist() == [0.5, 0.25, 0.375, 0.3125]
    solved = simulate_closed_loop(r, 1.0, plant=0.5, controller=1.0)
    assert np.abs(solved.y - 1.0 / 3.0).max() < 1e-15
    # A gain of 3 round the loop: the delayed one grows threefold a sample, the solved one is at
    # rest.
    diverging = simulate_closed_loop(
        np.ones(90), 1.0, plant=3.0, controller=1.0, algebraic_loop="delay"
    )
    assert diverging.diverged_at is not None
    assert abs(diverging.y[-1] / diverging.y[-2] + 3.0) < 1e-3
    assert simulate_closed_loop(np.ones(90), 1.0, plant=3.0, controller=1.0).diverged_at is None


def test_an_algebraic_loop_that_feeds_itself_up_is_refused() -> None:
    # v = -2 (r - v): what comes back is larger than what went in.
    with pytest.raises(SolverError, match="algebraic loop"):
        simulate_closed_loop(np.ones(5), 1.0, plant=1.0, controller=-2.0)


def test_poles_of_the_loop() -> None:
    # (s + 50) + 4 * 50
    assert closed_loop_poles(SLOW_PLANT, 4.0) == pytest.approx([-250.0], rel=1e-12)
    # With the separation of S1 eq. 33 where plant and nominal plant agree: those of the loop and
    # those of the observer, det(sI - A) of which is Q's denominator, S1 eq. 47.
    nominal = (PLANT[0][:1] / 2400.0**2, [1.0, 1.6 * 2.0 * np.pi * 90.0, (2.0 * np.pi * 90.0) ** 2])
    poles = closed_loop_poles(nominal, CONTROLLER, OBSERVER)
    alone = closed_loop_poles(nominal, CONTROLLER)
    observer = np.linalg.eigvals(OBSERVER[0])
    expected = np.concatenate([alone, observer])
    for pole in poles:
        assert np.abs(expected - pole).min() < 1e-6 * abs(pole)
    assert np.poly(observer) == pytest.approx([1.0, 6.390e4, 1.978e7, 5.472e9], rel=1e-3)


def test_designed_observer_recovers_as_much() -> None:
    (above, below), (damping, frequency) = mode(*MODES[0]), MODES[1]
    design = design_disturbance_observer(
        (above, below),
        CONTROLLER,
        ([-1.0, -2.0 * damping * frequency, 0.0], [1.0, 2.0 * damping * frequency, frequency**2]),
        ([0.5, 64.0 * np.pi], [1.0, 0.2]),
        method="descent",
        starts=1,
    )
    inexact = hyst.Affine(0.7) @ INVERSE
    exact, alone, observed = (
        example(inverse=inverse, observer=observer).rms_error
        for inverse, observer in ((INVERSE, None), (inexact, None), (inexact, design))
    )
    assert (alone - observed) / (alone - exact) >= 0.95
