"""Margins of loops against hand calculations, python-control, poles and simulations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from feedback_cases import PI, STAGE_DT, Fraction, mode, product, values

import hyst
from hyst.control import (
    TrackingController,
    closed_loop_poles,
    design_disturbance_observer,
    hinf_norm,
    loop_margins,
)
from hyst.control.feedback.loop_plant import loop_plant
from hyst.errors import InputError

STAGE = mode(500.0, 0.05)
LAG: Fraction = ([2.0], [0.1, 1.0])
CASES: dict[str, tuple[Fraction, Fraction]] = {
    "stage, PI": (STAGE, PI),
    "two modes, PI": (product(mode(300.0, 0.02), mode(800.0, 0.04)), ([0.01, 30.0], [1.0, 0.0])),
    "lag, PI": (LAG, ([1.5, 20.0], [1.0, 0.0])),
    "three lags, gain": (([1.0], np.poly([-1.0] * 3).tolist()), ([3.0], [1.0])),
    "non-minimum phase": (([-0.5, 1.0], [1.0, 2.0, 1.0]), ([0.3], [1.0, 0.0])),
    "gain of the other sign": (([-2.0], [1.0, 1.0]), ([-0.4, -0.6], [1.0, 0.0])),
}


def test_a_loop_by_hand() -> None:
    # L = 1 / (s (s + 1)^2) turns by 180 degrees at 1 rad/s, where |L| = 1/2. |L| = 1 where
    # w (w^2 + 1) = 1, w = 0.6823278; its phase there is -90 - 2 atan w degrees.
    found = loop_margins(([1.0], [1.0, 2.0, 1.0]), ([1.0], [1.0, 0.0]))
    w = 0.6823278038280193
    margin = 90.0 - 2.0 * math.degrees(math.atan(w))
    assert found.stable
    assert found.gain_margin == pytest.approx(2.0, rel=1e-12)
    assert found.gain_reduction == 0.0
    assert found.crossovers == pytest.approx([w], rel=1e-12)
    assert found.phase_margin == pytest.approx(margin, rel=1e-12)
    assert found.delay_margin == pytest.approx(math.radians(margin) / w, rel=1e-12)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("dt", [None, 2e-5])
def test_agree_with_python_control(case: str, dt: float | None) -> None:
    control = pytest.importorskip("control")
    plant, controller = CASES[case]
    loop = control.tf(*plant) * control.tf(*controller)
    top = 1e3 * np.abs(np.roots(plant[1])).max()
    if dt is not None:
        dt *= 1.0 if np.abs(np.roots(plant[1])).max() > 100.0 else 1e3
        static = len(controller[1]) == 1  # python-control cannot sample what has no state
        loop = control.c2d(control.tf(*plant), dt, "zoh") * (
            control.tf(*controller, dt)
            if static
            else control.c2d(control.tf(*controller), dt, "tustin")
        )
        top = math.pi / dt
    # Its method of roots is inaccurate for sampled loops, as it warns; it interpolates responses.
    w = np.geomspace(1e-7 * top, 0.9999 * top, 4_000)
    gains, phases, distances, _, crossed, closest = control.stability_margins(
        control.frequency_response(loop, w), returnall=True
    )
    found = loop_margins(plant, controller, dt)
    within = found.crossovers[(found.crossovers > w[0]) & (found.crossovers < w[-1])]
    # Between points that are 0.4 % apart it fits splines.
    assert within == pytest.approx(np.sort(crossed), rel=1e-3)
    assert found.phase_margin == pytest.approx(np.abs(phases).min(initial=math.inf), rel=1e-3)
    above = gains[gains > 1.0].min(initial=math.inf)
    if above < 1e4:  # beyond it is at z = -1, where python-control does not look
        assert found.gain_margin == pytest.approx(above, rel=1e-3)
    if dt is not None and found.modulus_frequency > 0.99 * top:
        # At z = -1, which python-control takes for no minimum.
        assert found.modulus_margin < distances.min(initial=1.0)
    else:
        assert found.modulus_margin == pytest.approx(distances.min(initial=1.0), rel=1e-3)
    if distances.size and found.modulus_frequency < 0.99 * top:
        near = closest[int(np.argmin(distances))]
        assert found.modulus_frequency == pytest.approx(near, rel=2e-2)  # flat there


@pytest.mark.parametrize("case", CASES)
def test_modulus_margin_is_the_norm_of_the_sensitivity(case: str) -> None:
    plant, controller = CASES[case]
    found = loop_margins(plant, controller)
    above, below = np.polymul(plant[1], controller[1]), np.polymul(plant[0], controller[0])
    norm, at = hinf_norm((above, np.polyadd(above, below)))
    if not found.stable:
        assert math.isinf(norm)
        return
    # The maximum between the points of a grid is looked for to a ten-thousandth of its spacing.
    assert found.peak_sensitivity == pytest.approx(norm, rel=1e-6)
    if math.isfinite(at):
        assert found.modulus_frequency == pytest.approx(at, rel=1e-2)


@pytest.mark.parametrize("late", [0.3, 1.0, 2.4])
def test_margins_are_where_the_sampled_loop_gets_unstable(late: float) -> None:
    """Poles of the loop as it is simulated, gain and delay a little below and above the margin."""
    delay = late * STAGE_DT
    # 1.2 times PI: its delay margin is then within the 100 samples of delay that poles are told of.
    faster = ([1.2 * each for each in PI[0]], PI[1])
    found = loop_margins(STAGE, faster, STAGE_DT, delay)

    def radius(gain: float, more: float) -> float:
        controller = ([gain * each for each in faster[0]], PI[1])
        block = TrackingController.from_continuous(controller, STAGE_DT)
        poles = closed_loop_poles(STAGE, block, delay=delay + more)
        return float(np.abs(poles).max())

    assert found.stable
    assert radius(0.999 * found.gain_margin, 0.0) < 1.0 < radius(1.001 * found.gain_margin, 0.0)
    # A dead time in a hold is not quite exp(-jw delay), less so the slower the crossover: here
    # the crossover is at 0.018 rad a sample.
    margin = found.delay_margin
    assert radius(1.0, 0.99 * margin) < 1.0 < radius(1.0, 1.01 * margin)


@pytest.mark.parametrize("delay", [1e-5, 1.3e-4, 5e-4])
@pytest.mark.parametrize("gain", [0.3, 0.9, 1.6, 3.0])
def test_stability_with_dead_time_in_continuous_time(delay: float, gain: float) -> None:
    """Nyquist's criterion against the poles of the loop with a Pade approximation of order 8."""
    controller = ([gain * each for each in PI[0]], PI[1])
    # Pade, by the ratios of its coefficients: c_j = c_(j-1) (n + 1 - j) / ((2 n + 1 - j) j).
    n, c = 8, [1.0]
    for j in range(1, n + 1):
        c.append(c[-1] * (n + 1 - j) / ((2 * n + 1 - j) * j))
    rising = np.array([c[j] * delay**j for j in range(n, -1, -1)])
    pade = (rising * (-1.0) ** np.arange(n, -1, -1), rising)
    open_num = np.polymul(np.polymul(STAGE[0], controller[0]), pade[0])
    open_den = np.polymul(np.polymul(STAGE[1], controller[1]), pade[1])
    worst = np.roots(np.polyadd(open_num, open_den)).real.max()
    assert abs(worst) > 1.0, "the case is on the border"
    found = loop_margins(STAGE, controller, delay=delay)
    assert found.stable == bool(worst < 0.0)
    # And every margin is on the curve itself.
    s = 1j * found.crossovers
    loop = values(STAGE, s) * values(controller, s) * np.exp(-s * delay)
    assert np.abs(loop) == pytest.approx(np.ones(s.size), rel=1e-9)
    assert found.phase_margins == pytest.approx(np.degrees(np.angle(-loop)), abs=1e-6)


def test_all_crossings_are_told_and_the_worst_counts() -> None:
    # A mode of damping 0.01 under an integrator of 60 1/s crosses 1 three times.
    plant = mode(500.0, 0.01)
    found = loop_margins(plant, ([60.0], [1.0, 0.0]))
    assert found.crossovers.size == 1
    found = loop_margins(plant, ([70.0], [1.0, 0.0]))
    assert found.crossovers.size == 3
    assert not found.stable
    assert found.gain_margin == math.inf
    assert found.gain_reduction == pytest.approx(2.0 * 0.01 * 1000.0 * math.pi / 70.0, rel=1e-9)
    assert found.phase_margin == pytest.approx(np.abs(found.phase_margins).min())


def test_a_conditionally_stable_loop_has_two_gain_margins() -> None:
    # L = k (s + 1)^2 / s^3 is stable for k > 1/2 (Routh: 2 k k > k).
    plant: Fraction = ([1.0, 2.0, 1.0], [1.0, 0.0, 0.0])
    found = loop_margins(([1.0], [1.0, 1e-9]), product(plant, ([2.0], [1.0])))
    assert found.stable
    assert found.gain_reduction == pytest.approx(0.25, rel=1e-6)
    assert found.gain_margin == math.inf


def test_bandwidth_and_rejection_of_a_first_order_loop() -> None:
    # L = 5 / s: T = 5 / (s + 5), S = s / (s + 5), both 0.707 at 5 rad/s.
    found = loop_margins(1.0, ([5.0], [1.0, 0.0]))
    assert found.bandwidth == pytest.approx(5.0, rel=1e-9)
    assert found.rejection == pytest.approx(5.0, rel=1e-9)
    assert found.modulus_margin == pytest.approx(1.0, abs=1e-6)  # reached at infinity


def test_a_slow_integrator_before_a_fast_plant_with_dead_time() -> None:
    """L is 1/s far below pole and dead time, so |L| = 1 at 1 rad/s and |S| = 0.707 at 1 rad/s."""
    found = loop_margins(([1.0], [1e-4, 1.0]), ([1.0], [1.0, 0.0]), delay=5e-5)
    # Pole and dead time turn by 1.5e-4 rad there, and change |S| as much.
    assert found.crossovers == pytest.approx([1.0], rel=1e-7)
    assert found.phase_margin == pytest.approx(90.0 - math.degrees(1.5e-4), rel=1e-8)
    assert found.delay_margin == pytest.approx(0.5 * math.pi - 1.5e-4, rel=1e-8)
    assert found.rejection == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize("late", [0.4, 3.0, 40.3])
def test_response_of_a_late_plant_is_that_of_all_its_states(late: float) -> None:
    """Whole samples are turns of the plant without them, which takes no state for each."""
    met = loop_plant(STAGE, STAGE_DT, late * STAGE_DT)
    w = np.geomspace(1.0, 0.99 * math.pi / STAGE_DT, 200)
    assert met.sampled is not None
    states = met.sampled.system.response(np.exp(1j * w * STAGE_DT))[:, 0, 0]
    # 1e-12: an exponential of the matrix and 40 products.
    assert met.response(w) == pytest.approx(states, rel=1e-12)


def test_ninety_samples_of_delay_leave_a_slow_loop_its_margins() -> None:
    """The integrator turns by 90 degrees, and y is of the drive of the sample before."""
    found = loop_margins(1.0, ([1.0], [1.0, 0.0]), 1e-4, 90e-4)
    # 91 samples turn by 90 degrees at w, where |L| is dt / 2 / tan(w dt / 2), 1/w to 3e-5.
    assert found.gain_margin == pytest.approx(0.5 * math.pi / 91e-4, rel=1e-4)


@pytest.mark.parametrize("dt", [None, 1e-3])
def test_a_static_gain_of_minus_one_makes_a_loop_that_integrates(dt: float | None) -> None:
    """L = -1 / (s + 1) leaves 1 + L = s / (s + 1): on the border, without rejection at rest."""
    found = loop_margins(([1.0], [1.0, 1.0]), -1.0, dt)
    assert found.bandwidth == 0.0
    assert found.rejection == 0.0
    assert found.peak_sensitivity > 100.0
    assert found.gain_reduction == pytest.approx(1.0, rel=1e-9)


def test_identified_dynamics_bring_their_time_and_their_delay() -> None:
    dynamics = hyst.LinearDynamics.from_continuous(*STAGE, STAGE_DT, delay=1.4)
    own = loop_margins(dynamics, PI)
    asked = loop_margins(STAGE, PI, STAGE_DT, 1.4 * STAGE_DT)
    assert own.dt == STAGE_DT
    assert own.gain_margin == pytest.approx(asked.gain_margin, rel=1e-6)
    assert own.modulus_margin == pytest.approx(asked.modulus_margin, rel=1e-6)


def test_a_block_counts_with_its_observer() -> None:
    Wu, Wp = ([2.0, 0.0], [1.0, 3e4]), ([0.05, 10.0], [1.0, 0.1])
    lag: Fraction = ([300.0], [1.0, 300.0])
    controller: Fraction = ([0.1, 30.0], [1.0, 0.0])
    design = design_disturbance_observer(lag, controller, Wu, Wp, method="descent")
    alone = TrackingController.from_continuous(controller, 1e-3)
    watched = TrackingController.from_continuous(controller, 1e-3, observer=design)
    assert loop_margins(lag, alone).gain_margin == pytest.approx(
        loop_margins(lag, controller, 1e-3).gain_margin, rel=1e-9
    )
    found = loop_margins(lag, watched)
    # What the sensitivity is at its worst, from the block's own matrices at one frequency.
    z = np.exp(1j * found.modulus_frequency * 1e-3)
    K = -(watched.C @ np.linalg.solve(z * np.eye(watched.order) - watched.A, watched.B[:, 1]))
    K -= watched.D[1]
    pole = math.exp(-0.3)
    assert abs(1.0 + K * (1.0 - pole) / (z - pole)) == pytest.approx(found.modulus_margin, rel=1e-9)
    assert found.rejection > loop_margins(lag, alone).rejection


def test_told_in_words() -> None:
    text = loop_margins(STAGE, PI, STAGE_DT).summary()
    assert "loop is stable: yes, sampled at 0.0001 s" in text
    assert "gain margin: 2.061 (6.28 dB)" in text  # as python-control says, above


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"plant": ([1.0], [1.0, -1.0])}, "unstable"),
        ({"delay": -1.0}, "delay is -1"),
        ({"controller": hyst.Play(1.0)}, "the controller is"),
        ({"plant": hyst.LinearDynamics([], [], [], 1.0, 1e-3), "dt": 1e-4}, "dt"),
    ],
)
def test_refusals(given: dict[str, object], said: str) -> None:
    arguments = {"plant": STAGE, "controller": PI, **given}
    with pytest.raises(InputError, match=said):
        loop_margins(**arguments)  # type: ignore[arg-type]


def test_a_sampled_controller_needs_the_sample_time_of_its_loop() -> None:
    block = hyst.control.discretize(PI, STAGE_DT)
    with pytest.raises(InputError, match="give dt"):
        loop_margins(STAGE, block)
    assert loop_margins(STAGE, block, STAGE_DT).gain_margin == pytest.approx(
        loop_margins(STAGE, PI, STAGE_DT).gain_margin, rel=1e-12
    )
