"""Designed controllers: what they promise, by other means, and how near the best they come."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from feedback_cases import Fraction, mode, product, values

import hyst
from hyst.control import (
    ControllerDesign,
    TrackingController,
    design_controller,
    discretize,
    simulate_closed_loop,
)
from hyst.control.feedback.gain_bounds import (
    gain_for_gain_margin,
    gain_for_phase,
    gain_for_sensitivity,
    gain_for_uncertainty,
)
from hyst.control.sampled.folding import folded_uncertainty
from hyst.control.sampled.plant import sampled_plant
from hyst.errors import InputError, SolverError

DT = 1e-4


def peak_and_radius(
    plant: Fraction, design: ControllerDesign, dt: float, delay: float
) -> tuple[float, float]:
    """Ms on 20,000 frequencies, and the largest |z| of the loop put together by hand."""
    P, C = sampled_plant(plant, dt, delay).system, design.sampled
    assert C is not None
    n, m = P.order, C.order
    A = np.zeros((n + m, n + m))
    A[:n, :n], A[:n, n:] = P.A - P.B @ C.D @ P.C, P.B @ C.C
    A[n:, :n], A[n:, n:] = -C.B @ P.C, C.A
    radius = float(np.abs(np.linalg.eigvals(A)).max())
    z = np.exp(1j * np.geomspace(1e-4, 1.0, 20_000) * math.pi)
    loop = P.response(z)[:, 0, 0] * C.response(z)[:, 0, 0]
    return float(1.0 / np.abs(1.0 + loop).min()), radius


@pytest.mark.parametrize(
    ("kind", "hertz", "damping", "late"),
    [
        ("i", 100.0, 0.01, 0.0),
        ("i", 2000.0, 0.3, 2.0),
        ("pi", 500.0, 0.05, 1.0),
        ("pi", 2000.0, 0.05, 1.5),
        ("pid", 500.0, 0.01, 1.5),
        ("pid", 2000.0, 0.3, 1.0),
    ],
)
def test_keeps_its_promise_wherever_the_resonance_is(
    kind: str, hertz: float, damping: float, late: float
) -> None:
    """Ms at 11 resonances within the mismatch, of which the search looked at five."""
    delay = late * DT
    design = design_controller(mode(hertz, damping), kind, dt=DT, delay=delay)  # type: ignore[arg-type]
    worst = 0.0
    for factor in np.linspace(0.95, 1.05, 11):
        peak, radius = peak_and_radius(mode(factor * hertz, damping), design, DT, delay)
        assert radius < 1.0
        worst = max(worst, peak)
    # Between the five resonances it may be a little more than at them.
    assert worst < 1.52
    assert design.worst.peak_sensitivity <= 1.5
    # 20,000 frequencies are 5e-4 apart, on a maximum that is flat.
    assert peak_and_radius(mode(hertz, damping), design, DT, delay)[0] == pytest.approx(
        design.margins.peak_sensitivity, rel=1e-4
    )


@pytest.mark.parametrize("notch", [True, False])
def test_more_gain_would_break_the_promise(notch: bool) -> None:
    design = design_controller(mode(500.0, 0.05), "pi", dt=DT, notch=notch)
    assert design.margins.stable
    plants = [mode(500.0 * factor, 0.05) for factor in (0.95, 0.975, 1.0, 1.025, 1.05)]

    def worst(gain: float) -> float:
        C = design.sampled
        assert C is not None
        more = hyst.control.LinearSystem(C.A, C.B, gain * C.C, gain * C.D, C.dt)
        changed = ControllerDesign(**{**vars(design), "sampled": more})
        return max(peak_and_radius(plant, changed, DT, 0.0)[0] for plant in plants)

    # What the grid of frequencies misses costs at most some steps of half a percent.
    assert worst(1.0) <= 1.5 < worst(1.02)


@pytest.mark.parametrize(("order", "peak"), [(2, 1.4), (3, 2.0), (4, 1.4)])
def test_pi_for_equal_lags_is_the_best_there_is(order: int, peak: float) -> None:
    """Largest ki by brute force, as Astrom, Panagopoulos and Hagglund pose it."""
    plant: Fraction = ([1.0], np.poly([-1.0] * order).tolist())
    w = np.geomspace(1e-2, 1e2, 1500)
    P = values(plant, 1j * w)
    best = 0.0
    for kp in np.linspace(0.05, 8.0, 160):
        low, high = 0.0, 6.0
        for _ in range(20):
            ki = 0.5 * (low + high)
            loop = P * (kp + ki / (1j * w))
            closed = np.polyadd(np.polymul([1.0, 0.0], plant[1]), [kp, ki])
            good = np.roots(closed).real.max() < 0.0 and np.abs(1.0 + loop).min() >= 1.0 / peak
            low, high = (ki, high) if good else (low, ki)
        best = max(best, low)
    design = design_controller(plant, "pi", peak_sensitivity=peak, noise_gain=1e3)
    # 160 values of kp: flat at the best one. The design may lose a percent to its own grids.
    assert 0.985 * best < design.ki < 1.01 * best


def test_notch_allows_several_times_the_gain() -> None:
    plant = mode(500.0, 0.01)
    with_it, without = (
        design_controller(plant, "i", dt=DT, notch=each) for each in ("auto", False)
    )
    # Without: ki < 2 d w (1 - 1 / Ms), a third of it for Ms = 1.5, were there no hold.
    assert without.ki == pytest.approx(2.0 * 0.01 * 1000.0 * math.pi / 3.0, rel=0.1)
    assert with_it.ki > 10.0 * without.ki
    assert with_it.notches[0].frequency == pytest.approx(1000.0 * math.pi, rel=0.06)
    assert not without.notches


def test_two_resonances_get_what_they_need() -> None:
    plant = product(mode(300.0, 0.02), mode(800.0, 0.01))
    design = design_controller(plant, "pi", dt=5e-5, notch=True)
    assert len(design.notches) == 2
    for first in (0.95, 1.0, 1.05):
        moved = product(mode(first * 300.0, 0.02), mode(first * 800.0, 0.01))
        peak, radius = peak_and_radius(moved, design, 5e-5, 0.0)
        assert radius < 1.0
        assert peak < 1.5 + 1e-6
    assert "800 Hz" in design.summary() or "notch 2" in design.summary()


def test_further_demands_are_kept() -> None:
    plant = mode(300.0, 0.02)
    free = design_controller(plant, "pi", dt=DT)
    held = design_controller(plant, "pi", dt=DT, phase_margin=70.0, gain_margin=6.0)
    quiet = design_controller(plant, "pi", dt=DT, noise_gain=1.2)
    assert held.margins.phase_margin >= 70.0 - 1e-3
    assert held.margins.gain_margin >= 6.0 - 1e-3
    assert held.worst.phase_margin >= 70.0 - 1e-3
    assert abs(held.ki) < abs(free.ki)
    z = np.exp(1j * np.geomspace(1.0, math.pi / DT, 4000) * DT)
    for design, bound in ((free, 2.0), (quiet, 1.2)):
        assert design.sampled is not None
        C = design.sampled.response(z)[:, 0, 0]
        P = sampled_plant(plant, DT).system.response(z)[:, 0, 0]
        assert np.abs(C / (1.0 + P * C)).max() < bound * 1.002


def test_uncertainty_is_allowed_for() -> None:
    plant, Wu = mode(90.0, 0.8), ([-10.0, -9600.0, 0.0], [1.0, 960.0, 5.76e6])
    free, robust = (
        design_controller(plant, "pi", dt=DT, Wu=each, noise_gain=10.0) for each in (None, Wu)
    )
    assert abs(robust.ki) < abs(free.ki)

    def norm(design: ControllerDesign) -> float:
        block = TrackingController.from_continuous(design, DT)
        return hyst.control.sampled_certificate(block, plant, Wu).uncertainty_norm

    # Its grid of frequencies is not that of the certificate.
    assert norm(robust) < 1.0 + 2e-3
    assert norm(free) > 1.0


@pytest.mark.parametrize(("kind", "late"), [("pid", 0.0), ("i", 1.0)])
def test_noise_and_uncertainty_are_bounded_between_the_frequencies_of_the_search(
    kind: str, late: float
) -> None:
    """On 40,000 frequencies; the search alone left 2.007 and 1.0005."""
    slow, fast = mode(300.0, 0.02), mode(900.0, 0.02)
    above = np.polyadd(np.polymul(slow[0], fast[1]), 0.3 * np.polymul(fast[0], slow[1]))
    plant: Fraction = (above.tolist(), np.polymul(slow[1], fast[1]).tolist())
    Wu = None if kind == "pid" else ([1.0 / 500.0, 0.2], [1.0 / 50_000.0, 1.0])
    design = design_controller(plant, kind, dt=DT, delay=late * DT, Wu=Wu)  # type: ignore[arg-type]
    met, C = sampled_plant(plant, DT, late * DT), design.sampled
    assert C is not None
    w = np.linspace(1e-4, 1.0 - 1e-9, 40_000) * math.pi / DT
    z = np.exp(1j * w * DT)
    of_controller = C.response(z)[:, 0, 0]
    noise = np.abs(of_controller / (1.0 + met.system.response(z)[:, 0, 0] * of_controller))
    assert noise.max() * 1.3 <= 2.0  # P(0) is 1.3
    assert Wu is None or (folded_uncertainty(met, Wu, w) * noise).max() < 1.0


@pytest.mark.parametrize("scale", [-3.0, 1e-6])
def test_gain_and_units_of_the_plant_go_into_the_gain_alone(scale: float) -> None:
    one = design_controller(mode(500.0, 0.05), "i", dt=DT)
    other = design_controller(mode(500.0, 0.05, scale), "i", dt=DT)
    assert len(other.notches) == len(one.notches)
    assert other.ki * scale == pytest.approx(one.ki, rel=1e-6)
    assert other.worst.modulus_margin == pytest.approx(one.worst.modulus_margin, rel=1e-6)


def test_units_of_time_change_nothing_else() -> None:
    slow = design_controller(mode(0.5, 0.05), "pi", dt=1e3 * DT, delay=1e3 * DT)
    fast = design_controller(mode(500.0, 0.05), "pi", dt=DT, delay=DT)
    assert (slow.kind, len(slow.notches)) == (fast.kind, len(fast.notches))
    assert 1e3 * slow.ki == pytest.approx(fast.ki, rel=1e-6)


def test_plants_that_are_sampled_already() -> None:
    num, den = mode(300.0, 0.02)
    dynamics = hyst.LinearDynamics.from_continuous(num, den, DT, delay=1)
    of_samples = design_controller(dynamics, "pi")
    of_plant = design_controller((num, den), "pi", dt=DT, delay=DT)
    assert of_samples.sampled is not None
    assert of_samples.sampled.dt == DT
    # They differ in what a resonance elsewhere is: the poles of the samples move, not the zeros.
    assert of_samples.ki == pytest.approx(of_plant.ki, rel=0.05)
    assert peak_and_radius((num, den), of_samples, DT, DT)[0] < 1.5 + 1e-6


def test_a_loop_with_it_settles_and_python_control_has_the_same() -> None:
    control = pytest.importorskip("control")
    plant = mode(500.0, 0.05, 2.0)
    design = design_controller(plant, "pi", dt=DT, delay=DT)
    block = TrackingController.from_continuous(design, DT)
    loop = simulate_closed_loop(np.ones(600), DT, plant=plant, controller=block, delay=DT)
    assert np.abs(loop.e[-100:]).max() < 1e-3
    late = control.tf([1.0], [1.0, 0.0], DT)
    P = control.c2d(control.tf(*plant), DT, "zoh") * late
    closed = control.feedback(P * control.tf(design.to_control()), 1)
    t = np.arange(600) * DT
    y = control.forced_response(control.ss(closed), t, np.ones(600)).outputs
    # Transfer functions of order 6 near z = 1 lose digits; ours are states.
    assert np.abs(y - loop.y).max() < 1e-4


def test_continuous_loops_with_dead_time() -> None:
    design = design_controller(([2.0], [1.0, 1.0]), delay=0.5)
    assert design.sampled is None
    assert design.controller is design.continuous
    assert design.margins.stable
    w = np.geomspace(1e-3, 1e3, 200_000)
    s = 1j * w
    C = design.continuous.response(s)[:, 0, 0]
    loop = 2.0 / (s + 1.0) * np.exp(-0.5 * s) * C
    assert 1.0 / np.abs(1.0 + loop).min() == pytest.approx(
        design.margins.peak_sensitivity, rel=1e-6
    )


def test_the_continuous_controller_is_the_one_whose_sampling_is_meant() -> None:
    design = design_controller(mode(2000.0, 0.05), "pi", dt=DT, notch=True)
    assert design.sampled is not None
    again = discretize(design.continuous, DT)
    z = np.exp(1j * np.geomspace(10.0, 3e4, 50) * DT)
    assert again.response(z) == pytest.approx(design.sampled.response(z), rel=1e-12)
    # The notch acts where it is said to, warped though the rule is there.
    near = np.linspace(0.9, 1.1, 2001) * design.notches[0].frequency
    C = np.abs(again.response(np.exp(1j * near * DT))[:, 0, 0])
    assert near[int(np.argmin(C))] == pytest.approx(design.notches[0].frequency, rel=2e-3)


def random_loops() -> np.ndarray:
    random = np.random.default_rng(3)
    w = np.geomspace(0.05, 50.0, 400)
    loops = []
    for _ in range(20):
        poles = -random.uniform(0.3, 3.0, 3)
        late = random.uniform(0.0, 1.0)
        loops.append(
            np.exp(-1j * w * late) / (1j * w) / np.prod([1j * w - p for p in poles], axis=0)
        )
    return np.array(loops)


@pytest.mark.parametrize("bound", ["sensitivity", "uncertainty", "phase", "gain"])
def test_gain_bounds_are_the_first_gain_that_breaks_them(bound: str) -> None:
    """Against a scan over gains 0.1 % apart."""
    loops = random_loops()
    of_uncertainty = 0.3 * np.abs(loops) + 0.01
    gains = {
        "sensitivity": gain_for_sensitivity(loops, 1.5),
        "uncertainty": gain_for_uncertainty(loops, of_uncertainty),
        "phase": gain_for_phase(loops, 50.0),
        "gain": gain_for_gain_margin(loops, 3.0),
    }[bound]
    for loop, deviation, found in zip(loops, of_uncertainty, gains, strict=True):
        for k in found * np.array([0.1, 0.5, 0.9, 0.999, 1.001]):
            held = {
                "sensitivity": np.abs(1.0 + k * loop).min() >= 1.0 / 1.5,
                "uncertainty": (k * deviation < np.abs(1.0 + k * loop)).all(),
                "phase": not (
                    (np.abs(k * loop) >= 1.0) & (np.abs(np.angle(-loop, deg=True)) < 50.0)
                ).any(),
                # On straight lines between the points the curve is to cross right of -1/3.
                "gain": _crossings(k * loop).min(initial=0.0) >= -1.0 / 3.0,
            }[bound]
            assert held == (k <= found)


def _crossings(loop: np.ndarray) -> np.ndarray:
    real = []
    for a, b in itertools.pairwise(loop):
        if (a.imag > 0.0) != (b.imag > 0.0):
            real.append(a.real - a.imag * (b.real - a.real) / (b.imag - a.imag))
    return np.array(real)


STAGE = mode(500.0, 0.05)


@pytest.mark.parametrize(
    ("plant", "options", "said"),
    [
        (([1.0], [1.0, -1.0]), {}, "the plant is unstable"),
        (([1.0, 0.0], [1.0, 2.0, 1.0]), {}, "zero at the origin"),
        (([1.0], [1.0, 1.0, 0.0]), {}, "pole at the origin"),
        (STAGE, {"dt": 1e-3}, "sample at 1313 Hz or faster"),  # 500 * 1.05 / 0.4
        (STAGE, {"kind": "p"}, "kind is 'p'"),
        (STAGE, {"notch": 2}, "notch is 2"),
        (STAGE, {"peak_sensitivity": 1.0}, "peak_sensitivity is 1"),
        (STAGE, {"noise_gain": 1.0}, "noise_gain is 1"),
        (STAGE, {"gain_margin": 0.5}, "gain_margin is 0.5"),
        (STAGE, {"phase_margin": 95.0}, "phase_margin is 95"),
        (STAGE, {"mismatch": 0.5}, "mismatch is 0.5"),
        (STAGE, {"delay": -1.0}, "delay is -1"),
    ],
)
def test_refusals(plant: Fraction, options: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        design_controller(plant, **options)  # type: ignore[arg-type]


def test_a_rate_that_is_named_does() -> None:
    assert design_controller(STAGE, "i", dt=1.0 / 1313.0).margins.stable


@pytest.mark.parametrize("dt", [None, 0.01])
def test_uncertainty_of_the_sign_leaves_no_gain(dt: float | None) -> None:
    with pytest.raises(InputError, match=r"Wu is 1\.5 at low frequencies"):
        design_controller(([1.0], [1.0, 1.0]), dt=dt, Wu=1.5)


def test_a_plant_that_bears_any_gain_is_refused() -> None:
    with pytest.raises(SolverError, match="any gain"):
        design_controller(3.0)
