"""Observers designed in discrete time: claims recomputed from the matrices of the whole loop."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.signal
from observer_cases import OMEGA, PLANT, REPAIRED_C, TWO_MODES, WP, WU
from sampled_observer_cases import (
    left_of_disturbance,
    sampled_random_problem,
    some_parameters,
    whole_loop,
)

import control
import hyst
from hyst.control import (
    DisturbanceObserver,
    InternalModel,
    TrackingController,
    design_disturbance_observer,
    evaluate_gain,
    observer_problem,
)
from hyst.control.disturbance_observer.discrete.coordinates import held_gain
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.stacked_gain import SampledStackedGain
from hyst.control.sampled.folding import folded_uncertainty
from hyst.errors import InputError, SolverError

Array = np.ndarray

# The counterexample of a stage of 200 Hz at 10 kHz: plant, controller, weights, and a plant that is
# within Wu and that the sampled continuous design does not survive.
STAGE = ([1579136.7], [1.0, 75.398, 1579136.7])
STAGE_C, STAGE_WU = ([20.0], [1.0, 0.0]), ([3.9789e-4, 0.02], [3.9789e-5, 1.0])
STAGE_WP = ([0.5, 94.25], [1.0, 0.1])
BREAKER = (
    [684.87174470367, -5944449.494735953, 20911620624.60466],
    [3.9789e-05, 1.5405468231714823, 13688.695436678998, 3446618.6941461405, 21334034507.860294],
)


@pytest.mark.parametrize("seed", range(10))
def test_poles_and_stack_are_those_of_the_whole_loop(seed: int) -> None:
    p = sampled_random_problem(seed)
    stack = SampledStackedGain(p, freed=seed % 3)
    parameters = some_parameters(stack, seed)
    gain = stack.gain_of(parameters)
    A, _, _ = whole_loop(p, gain)
    s = np.concatenate([stack.poles(parameters), np.full(stack.at_zero, -1.0)])
    alone = whole_loop(p, np.zeros(p.order))[0][: p.plant.order + p.controller.order]
    alone = alone[:, : len(alone)]
    poles = np.concatenate([(1.0 + s) / (1.0 - s), np.linalg.eigvals(alone)])
    # Poles of a delay are multiple, so polynomials are compared, away from all poles.
    for z in 1.5 * np.exp(1j * np.linspace(0.1, 3.0, 5)):
        theirs = np.prod(np.linalg.eigvals(z * np.eye(len(A)) - scipy.linalg.matrix_balance(A)[0]))
        assert abs(np.prod(z - poles) / theirs - 1.0) < 1e-6  # of rounding in L
    w = np.geomspace(1e-3, 0.99, 60) * math.pi / p.dt
    E, N = left_of_disturbance(p, gain, w)
    a = folded_uncertainty(p.sampled, p.Wu, w)
    expected = np.abs(a * N) ** 2 + np.abs(p.Wp.response(1j * w)[:, 0, 0] * E) ** 2
    values = stack.values(parameters, stack.at(np.tan(0.5 * w * p.dt)))
    # The weights are interpolated in the search, not in the certificate.
    np.testing.assert_allclose(values, expected, rtol=1e-3)
    assert np.median(np.abs(values / expected - 1.0)) < 1e-5


def test_a_gain_gets_the_states_that_hold_its_digits() -> None:
    # Six poles, two zeros and 2.6 samples of delay at a fast rate: in the states of the transfer
    # function L leaves E four digits.
    p = sampled_random_problem(7)
    stack = SampledStackedGain(p, freed=2)
    x = some_parameters(stack, 1)
    w = np.geomspace(1e-3, 0.99, 40) * math.pi / p.dt
    solved, at = stack.solved(x), stack.at(np.tan(0.5 * w * p.dt))
    E = at.model * (at.powers[:, -solved.k.size :] @ solved.k) / (at.powers @ solved.x)
    other, gain = held_gain(stack, x, p)
    z = np.exp(1j * w * p.dt)
    plain = 1.0 - p.q_filter(stack.gain_of(x)).response(z)[:, 0, 0]
    held = 1.0 - other.q_filter(gain).response(z)[:, 0, 0]
    assert np.abs(held - E).max() < 1e-5  # ten poles within a few percent of z = 1
    assert np.abs(plain - E).max() > np.abs(held - E).max()
    np.testing.assert_allclose(
        other.plant.response(z)[:, 0, 0], p.plant.response(z)[:, 0, 0], rtol=1e-6, atol=1e-9
    )


def test_a_gain_that_doubles_cannot_hold_is_refused() -> None:
    p = sampled_random_problem(7)
    stack = SampledStackedGain(p, freed=2)
    # All ten poles within 0.4 % of z = 1, and the plant's up to z = -1 in effect.
    x = stack.inside(stack.parameters_of(-np.geomspace(1e-3, 2e-3, stack.order).astype(complex)))
    with pytest.raises(SolverError, match="order 11 with poles so near z = 1 cannot be held"):
        held_gain(stack, x, p)


@pytest.mark.parametrize("free", [0, 1, 2])
def test_slopes_are_those_of_the_values(free: int) -> None:
    p = sampled_random_problem(2)
    stack = SampledStackedGain(p, free, freed=1)
    x = some_parameters(stack, free)
    for curve in (stack, stack.noise):
        value, slopes = curve.values_and_slopes(x, stack.grid)
        np.testing.assert_allclose(value, curve.values(x, stack.grid), rtol=1e-12)
        for i, shift in enumerate(1e-5 * np.eye(x.size)):
            above, below = (curve.values(x + each, stack.grid) for each in (shift, -shift))
            # Differences of 1e-5 are good to 1e-10 of the curvature and 1e-11 of rounding.
            np.testing.assert_allclose(
                slopes[:, i], (above - below) / 2e-5, rtol=1e-4, atol=1e-5 * float(value.max())
            )


def test_free_eigenvalues_belong_to_the_internal_model() -> None:
    p = sampled_random_problem(4)
    stack = SampledStackedGain(p, free=3)
    x = some_parameters(stack, 1)
    extended = replace(p, internal_model=stack.internal_model(x))
    w = np.geomspace(1e-2, 0.9, 40) * math.pi / p.dt
    E, N = left_of_disturbance(extended, stack.gain_of(x), w)
    a = folded_uncertainty(p.sampled, p.Wu, w)
    expected = np.abs(a * N) ** 2 + np.abs(p.Wp.response(1j * w)[:, 0, 0] * E) ** 2
    values = stack.values(x, stack.at(np.tan(0.5 * w * p.dt)))
    np.testing.assert_allclose(values, expected, rtol=1e-3)  # interpolated weights
    assert np.linalg.eigvals(extended.internal_model.A_d).real.max() <= 1e-9


@pytest.fixture(scope="module")
def late() -> DisturbanceObserver:
    """The paper's example at 10 kHz, half a sample late."""
    return design_disturbance_observer(
        PLANT, REPAIRED_C, WU, WP, dt=1e-4, delay=5e-5, perturbed_plant=TWO_MODES
    )


def test_certified_norm_is_that_of_a_fine_grid(late: DisturbanceObserver) -> None:
    p = late.problem
    assert isinstance(p, SampledObserverProblem)
    w = np.concatenate([np.geomspace(1e-1, 31000.0, 4000), np.linspace(100.0, 31415.9, 4000)])
    E, N = left_of_disturbance(p, late.gain, w)
    # Aliases by hand: |P Wu H| at w + 2 pi k / dt, one after the other.
    a = np.zeros(w.size)
    for k in range(-300, 301):
        s = 1j * (w + 2.0 * math.pi * k / 1e-4)
        P, U = (np.polyval(n, s) / np.polyval(d, s) for n, d in (PLANT, WU))
        a += np.abs(P * U * (1.0 - np.exp(-s * 1e-4)) / s) / 1e-4
    stack = np.hypot(
        a * np.abs(N), np.abs(np.polyval(WP[0], 1j * w) / np.polyval(WP[1], 1j * w) * E)
    )
    assert stack.max() <= late.gamma * (1.0 + 1e-6)
    assert stack.max() >= late.gamma * (1.0 - 1e-4)  # 8000 frequencies meet the peak closely
    c = late.certificate
    assert c.uncertainty_norm == pytest.approx(float((a * np.abs(N)).max()), rel=1e-4)


def test_half_a_sample_late_still_reaches_the_continuous_norm(late: DisturbanceObserver) -> None:
    c = late.certificate
    assert late.gamma < 0.9239  # the continuous observer of the paper, without any delay
    assert late.feasible
    assert c.nominal_stable
    assert c.perturbed_stable
    assert c.robustly_stable
    assert c.unity_at_zero
    assert c.proper
    assert late.lower_bound < late.gamma
    # A pole of Q at half of Nyquist is at |s| = 1 of the w-plane: no real part below 0.
    assert c.observer_poles.real.min() > -1e-6


def test_q_is_what_the_block_estimates_of_a_step(late: DisturbanceObserver) -> None:
    block = TrackingController.from_continuous(REPAIRED_C, 1e-4, observer=late)
    step, x, y_all = block.stepper(), np.zeros(late.plant.order), []
    A, B, C = late.plant.A, late.plant.B[:, 0], late.plant.C[0]
    for _ in range(4000):
        y = float(C @ x)
        y_all.append(y)
        x = A @ x + B * (step(0.0, y) + 1.0)
    d_hat = block.estimate(np.zeros(4000), np.array(y_all))
    c = late.certificate
    num = np.concatenate([np.zeros(c.Q_relative_degree), c.Q_numerator])
    expected = scipy.signal.lfilter(num, c.Q_denominator, np.ones(4000))
    np.testing.assert_allclose(d_hat, expected, atol=1e-6)  # poles near 1 cost digits of Q
    # A constant is rejected: what is left is the slow pole of C, 2/s, after 0.4 s.
    assert abs(y_all[-1]) < 5e-3 * np.abs(y_all).max()


def test_q_as_a_transfer_function_is_sampled(late: DisturbanceObserver) -> None:
    z = np.exp(1j * np.array([0.01, 0.3, 2.0]))
    p = late.problem
    assert late.Q.dt == 1e-4
    np.testing.assert_allclose(late.Q(z), p.q_filter(late.gain).response(z)[:, 0, 0], rtol=1e-5)


def test_jensen_leaves_nothing_to_gain_on_average(late: DisturbanceObserver) -> None:
    # E is 1 at infinity and has its zeros inside or on the circle: the mean of log|E| is 0.
    p = late.problem
    assert isinstance(p, SampledObserverProblem)
    angle = (np.arange(40_000) + 0.5) * math.pi / 40_000
    E, _ = left_of_disturbance(p, late.gain, angle / p.dt)
    assert float(np.mean(np.log(np.abs(E)))) == pytest.approx(0.0, abs=2e-4)  # a kink at w = 0


@pytest.mark.parametrize("delay", [4e-5, 1.4e-4])
def test_fractional_delay_is_that_of_a_finer_simulation(delay: float) -> None:
    dt, parts = 1e-4, 5
    p = observer_problem(PLANT, REPAIRED_C, WU, WP, dt=dt, delay=delay)
    gain = SampledStackedGain(p)  # type: ignore[arg-type]
    L = gain.gain_of(some_parameters(gain, 3))
    found = evaluate_gain(p, L)
    block = TrackingController.from_continuous(REPAIRED_C, dt, observer=found)
    # The plant in steps of a fifth of dt, on which both delays fall; v acts so much later.
    w = OMEGA
    A = np.array([[0.0, 1.0], [-(w**2), -1.6 * w]])
    both = scipy.linalg.expm(
        np.block([[A, np.array([[0.0], [w**2]])], [np.zeros((1, 3))]]) * dt / parts
    )
    step, x, y_fine, v_late = block.stepper(), np.zeros(2), [], []
    late = round(delay / dt * parts)
    held = np.zeros(parts * 300 + 2 * parts)
    for k in range(300):
        y_fine.append(x[0])
        v_late.append(step(0.0, x[0]))
        held[parts * k + late : parts * (k + 1) + late] = v_late[-1]
        for i in range(parts):
            x = both[:2, :2] @ x + both[:2, 2] * (held[parts * k + i] + 1.0)
    # The same from the design's own sampled plant; the disturbance is late there, too.
    step, x_d, y_d = block.stepper(), np.zeros(p.plant.order), []
    for _ in range(300):
        y_d.append(float(p.plant.C[0] @ x_d))
        x_d = p.plant.A @ x_d + p.plant.B[:, 0] * step(0.0, y_d[-1])
    assert np.abs(y_d).max() == 0.0
    outputs = _with_disturbance(p, block, A, w, 300)
    np.testing.assert_allclose(outputs, y_fine, rtol=1e-9, atol=1e-9)


def _with_disturbance(p: Any, block: Any, A: Array, w: float, samples: int) -> list[float]:
    """The loop on the design's plant, with what a disturbance of 1 since t = 0 adds to y."""
    n, dt = len(A), p.dt
    both = scipy.linalg.expm(
        np.block([[A, np.array([[0.0], [w**2]])], [np.zeros((1, n + 1))]]) * dt
    )
    step, x, extra, outputs = block.stepper(), np.zeros(p.plant.order), np.zeros(n), []
    for _ in range(samples):
        y = float(p.plant.C[0] @ x + extra[0])
        outputs.append(y)
        x = p.plant.A @ x + p.plant.B[:, 0] * step(0.0, y)
        extra = both[:n, :n] @ extra + both[:n, n]
    return outputs


@pytest.mark.parametrize(("samples", "states"), [(0.0, 0), (0.5, 1), (1.0, 1), (2.0, 2), (3.7, 4)])
def test_order_grows_with_the_delay(samples: float, states: int) -> None:
    p = observer_problem(PLANT, ([1.0], [1.0, 0.0]), WU, WP, dt=1e-4, delay=samples * 1e-4)
    assert p.order == 3 + states
    assert p.observer(np.zeros(p.order)).order == 3 + states
    # The delay is a phase of the plant: held, then late; checked where nothing has folded.
    z = np.exp(1j * 2e-3)
    held = observer_problem(PLANT, ([1.0], [1.0, 0.0]), WU, WP, dt=1e-4).plant
    ratio = p.plant.response([z])[0, 0, 0] / held.response([z])[0, 0, 0]
    assert ratio == pytest.approx(np.exp(-1j * 2e-3 * samples), abs=1e-6)


def test_fast_sampling_approaches_the_continuous_design() -> None:
    slow, fast = (
        design_disturbance_observer(PLANT, REPAIRED_C, WU, WP, dt=dt) for dt in (1e-4, 1e-5)
    )
    # 0.9239 is the norm in continuous time; half a sample of hold costs in proportion to dt.
    assert 0.9239 < fast.gamma < 0.9239 + 2e-3
    assert (slow.gamma - 0.9239) / (fast.gamma - 0.9239) == pytest.approx(10.0, rel=0.3)


def test_stage_that_broke_the_sampled_continuous_design() -> None:
    arguments = STAGE, STAGE_C, STAGE_WU, STAGE_WP
    found = design_disturbance_observer(*arguments, dt=1e-4, perturbed_plant=BREAKER, starts=1)
    c = found.certificate
    assert c.robustly_stable
    assert c.uncertainty_norm < 0.25
    assert c.perturbed_stable
    # Without a price on noise, as the paper has it, its poles lie far above half the rate.
    continuous = design_disturbance_observer(*arguments, flat=0.0, starts=2)
    block = TrackingController.from_continuous(STAGE_C, 1e-4, observer=continuous)
    assert np.abs(hyst.control.closed_loop_poles(BREAKER, block)).max() > 1.0


def test_plants_within_the_folded_bound_stay_stable() -> None:
    found = design_disturbance_observer(STAGE, STAGE_C, STAGE_WU, STAGE_WP, dt=1e-4, starts=1)
    block = TrackingController.from_continuous(STAGE_C, 1e-4, observer=found)
    rng = np.random.default_rng(3)
    for _ in range(40):
        # Delta = Wu times an all pass of any frequency: |Delta| is |Wu| everywhere.
        f, zeta = 10.0 ** rng.uniform(1.0, 5.5), 10.0 ** rng.uniform(-2.5, 0.0)
        passed = ([1.0, -2.0 * zeta * f, f * f], [1.0, 2.0 * zeta * f, f * f])
        sign = rng.choice([-1.0, 1.0])
        Delta = sign * control.tf(*STAGE_WU) * control.tf(*passed)
        assert (
            np.abs(hyst.control.closed_loop_poles(control.tf(*STAGE) * (1 + Delta), block)).max()
            < 1
        )


def test_delay_is_worth_knowing() -> None:
    w = 2.0 * math.pi * 500.0
    plant = ([w * w], [1.0, 0.06 * w, w * w])
    weights = ([4e-4, 0.02], [4e-5, 1.0]), STAGE_WP
    aware = design_disturbance_observer(
        plant, ([60.0], [1.0, 0.0]), *weights, dt=1e-4, delay=1.5e-4
    )
    assert aware.gamma < 0.6  # the continuous design, sampled, has 0.794
    assert aware.certificate.uncertainty_norm < 0.41  # 0.532


def test_sampled_plants_of_every_kind_are_the_same() -> None:
    held = control.c2d(control.ss(*control.ssdata(control.tf2ss(control.tf(*PLANT)))), 1e-4)
    A, B, C, D = (np.asarray(each) for each in (held.A, held.B, held.C, held.D))
    given: list[tuple[Any, dict[str, Any]]] = [
        (held, {}),
        (hyst.control.LinearSystem(A, B, C, D, 1e-4), {}),
        (hyst.LinearDynamics(A, B, C, D, dt=1e-4), {}),
        (PLANT, {"dt": 1e-4}),
    ]
    z = np.exp(1j * np.array([0.001, 0.1, 3.0]))
    for plant, options in given:
        p = observer_problem(plant, REPAIRED_C, WU, WP, **options)
        expected = (C @ np.linalg.solve(z[:, None, None] * np.eye(2) - A, B))[:, 0, 0]
        np.testing.assert_allclose(p.plant.response(z)[:, 0, 0], expected, rtol=1e-9)
    late = hyst.LinearDynamics(A, B, C, D, dt=1e-4, delay=2)
    assert observer_problem(late, ([1.0], [1.0, 0.0]), WU, WP).order == 5


def test_sampled_plant_with_a_zero_outside_is_taken() -> None:
    # A fir of three taps, one zero at z = -2.2 and one at 1.5: no observer inverts it.
    plant = control.tf([0.2, 0.14, -0.66], [1.0, -1.1, 0.3, 0.0], 1e-3)
    weights = 0.2, ([0.2, 20.0], [1.0, 0.02])
    found = design_disturbance_observer(-plant, ([20.0], [1.0, 0.0]), *weights, starts=2)
    assert found.certificate.nominal_stable
    assert found.certificate.robustly_stable
    assert found.lower_bound <= found.gamma


def test_design_survives_json_and_says_what_it_is(late: DisturbanceObserver) -> None:
    given = json.loads(json.dumps(late.to_dict()))
    assert given["dt"] == 1e-4
    assert given["delay"] == 5e-5
    assert given["certificate"]["uncertainty_norm"] == late.certificate.uncertainty_norm
    assert "every plant within Wu" in late.message
    assert "every 0.0001 s, 5e-05 s of delay" in late.summary()
    assert late.observer.dt == 1e-4
    assert late.internal_model == InternalModel.integrator() or late.internal_model.order == 1


def test_given_gain_is_certified() -> None:
    p = observer_problem(PLANT, REPAIRED_C, WU, WP, dt=1e-4)
    stack = SampledStackedGain(p)  # type: ignore[arg-type]
    L = stack.gain_of(some_parameters(stack, 3))
    found = evaluate_gain(p, L)
    E, _ = left_of_disturbance(p, L, np.array([found.certificate.performance_frequency]))  # type: ignore[arg-type]
    Wp = np.polyval(WP[0], 1j * found.certificate.performance_frequency) / np.polyval(
        WP[1], 1j * found.certificate.performance_frequency
    )
    assert found.certificate.performance_norm == pytest.approx(abs(Wp * E[0]), rel=1e-6)
    with pytest.raises(InputError, match="the gain has 2 numbers; give 3 finite ones"):
        evaluate_gain(p, [1.0, 2.0])
