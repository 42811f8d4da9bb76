"""Sensor noise in the design: its row, its numbers, ties to the quietest gain, bounds with noise.

Frequency responses are computed here from the parts, norms with python-control.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from observer_cases import PLANT, PRINTED_C, REPAIRED_C, WP, WU, random_problem

import control
from hyst.control import (
    DisturbanceObserver,
    LinearSystem,
    ObserverProblem,
    design_disturbance_observer,
    evaluate_gain,
    observer_problem,
)
from hyst.control.disturbance_observer.lower_bound import lower_bound_at_noise
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.control.linear_system import as_linear_system
from hyst.errors import InputError

Array = NDArray[np.float64]
Parts = tuple[Any, Any, Any, Any]

# Two stages whose weight Wp is at its floor of 0.5 at high frequencies: there the norm is flat.
STAGE_200 = (
    ([1579136.7], [1.0, 75.398, 1579136.7]),
    ([20.0], [1.0, 0.0]),
    ([3.9789e-4, 0.02], [3.9789e-5, 1.0]),
    ([0.5, 94.25], [1.0, 0.1]),
)
_W = 2.0 * np.pi * 500.0
STAGE_500 = (
    ([_W**2], [1.0, 0.1 * _W, _W**2]),
    ([0.02, 150.0], [1.0, 0.0]),
    ([2.0, 0.0], [1.0, 31416.0]),
    ([0.5, 188.0], [1.0, 0.1]),
)
REPAIRED = (PLANT, REPAIRED_C, WU, WP)
NOISE_WEIGHT = ([0.3, 20.0], [1.0, 500.0])


def response(system: LinearSystem, w: Array) -> Array:
    """By python-control's own states, without hyst's arithmetic."""
    return np.asarray(control.ss(system.A, system.B, system.C, system.D)(1j * w)).reshape(-1)


def rows(design: DisturbanceObserver, w: Array) -> dict[str, Array]:
    """All gains from the responses of the parts."""
    p = design.problem
    P, C, Wu, Wp, Q = (
        response(each, w) for each in (p.plant, p.controller, p.Wu, p.Wp, p.q_filter(design.gain))
    )
    loop = P * C
    return {
        "Wu T": np.abs(Wu * (loop + Q) / (1.0 + loop)),
        "Wp (1 - Q)": np.abs(Wp * (1.0 - Q)),
        "K S": np.abs((C + Q / P) / (1.0 + loop)),
        "Q/Pn": np.abs(Q / P),
        "C S0": np.abs(C / (1.0 + loop)),
    }


def in_other_units(parts: Parts, time: float, output: float) -> Parts:
    """The same stage with time and output in other units, weights and all."""

    def slowed(num: list[float], den: list[float], gain: float = 1.0) -> tuple[Any, Any]:
        def of(coefficients: list[float]) -> list[float]:
            powers = np.arange(len(coefficients) - 1, -1, -1)
            return [float(c * time**p) for c, p in zip(coefficients, powers, strict=True)]

        return [gain * each for each in of(num)], of(den)

    plant, controller, Wu, Wp = parts
    return slowed(*plant, output), slowed(*controller, 1.0 / output), slowed(*Wu), slowed(*Wp)


@pytest.fixture(scope="module")
def quiet() -> DisturbanceObserver:
    return design_disturbance_observer(*STAGE_200, method="descent")


def test_noise_gains_by_python_control() -> None:
    problem = observer_problem(*REPAIRED, noise=NOISE_WEIGHT)
    design = evaluate_gain(problem, [2.06089, -0.000746559, 518.841])
    c, w = design.certificate, np.geomspace(1e-2, 1e6, 40_000)
    found, Wn = rows(design, w), np.abs(response(problem.Wn or problem.Wu, w))
    stack = np.sqrt(found["Wu T"] ** 2 + found["Wp (1 - Q)"] ** 2)
    for norm, curve in (
        (c.noise_gain, found["K S"]),
        (c.observer_noise_gain, found["Q/Pn"]),
        (c.controller_noise_gain, found["C S0"]),
        (c.noise_norm, Wn * found["K S"]),
        (c.stacked_norm, stack),
        (c.minimized_norm, np.hypot(stack, Wn * found["K S"])),
    ):
        # 40,000 points over 8 decades meet a smooth peak to 1e-6, and never pass it.
        assert norm == pytest.approx(curve.max(), rel=1e-6)
    assert c.minimized_norm == design.gamma
    assert c.noise_gain_frequency == pytest.approx(w[np.argmax(found["K S"])], rel=1e-2)
    o = design.observer
    through = control.ss(o.A, o.B[:, 1:], o.C, o.D[:, 1:])
    assert c.observer_noise_gain == pytest.approx(control.norm(through, "inf"), rel=1e-5)
    assert c.fastest_pole == pytest.approx(np.abs(np.linalg.eigvals(o.A)).max(), rel=1e-9)


@pytest.mark.parametrize("free", [0, 1, 2])
def test_slopes_by_differences(free: int) -> None:
    problem = replace(observer_problem(*REPAIRED), Wn=as_linear_system(NOISE_WEIGHT))
    gain = StackedGain(problem, free)
    x = np.random.default_rng(free).normal(0.0, 0.5, gain.lowest.size)
    for curve in (gain, gain.noise):
        at = curve.at(np.geomspace(1.0, 1e4, 9))  # type: ignore[attr-defined]
        _, slopes = curve.values_and_slopes(x, at)  # type: ignore[attr-defined]
        step = 1e-6
        measured = [
            (curve.values(x + step * e, at) - curve.values(x - step * e, at)) / (2.0 * step)  # type: ignore[attr-defined]
            for e in np.eye(x.size)
        ]
        # central differences: 1e-12 of curvature, 1e-10 of rounding
        np.testing.assert_allclose(slopes, np.array(measured).T, atol=1e-8 * np.abs(slopes).max())


@pytest.mark.parametrize(
    ("parts", "least", "loud", "time"),
    [(STAGE_200, 3.0, 500.0, 1e-3), (STAGE_500, 25.0, 100.0, 1.0)],
    ids=["200 Hz, in ms", "500 Hz"],
)
def test_flat_norms_are_reached_without_noise(
    parts: Parts, least: float, loud: float, time: float
) -> None:
    """Before, the 200 Hz stage made 731 times its sensor's noise, the 500 Hz one 123 times."""
    scaled = in_other_units(parts, time, 10.0)
    best = design_disturbance_observer(*scaled, method="descent", flat=0.0)
    found = design_disturbance_observer(*scaled, method="descent")
    noise = rows(found, np.geomspace(1e-1, 1e8, 40_000) / time)["Q/Pn"].max()
    assert found.gamma <= 1.01 * best.gamma * (1.0 + 1e-9)
    assert 10.0 * best.certificate.observer_noise_gain > loud  # the plant's gain is 10
    assert 10.0 * noise < least
    # 40,000 points over 9 decades meet the peak to 1e-3.
    assert found.certificate.observer_noise_gain == pytest.approx(noise, rel=1e-3)
    assert any(step.startswith("least noise") for step in found.steps)


def test_no_random_gain_is_quieter(quiet: DisturbanceObserver) -> None:
    gain = StackedGain(quiet.problem)
    best = gain.parameters_of(quiet.certificate.observer_poles)
    limit, noise = quiet.gamma**2, quiet.certificate.observer_noise_gain**2
    rng = np.random.default_rng(3)
    passed = 0
    for width in (0.02, 0.1, 0.5, 2.0):
        for _ in range(2000):
            x = gain.inside(best + rng.normal(0.0, width, best.size))
            if gain.values(x, gain.grid).max() <= limit:  # a grid passes more than the norm does
                passed += 1
                # A grid of 24 points a decade may miss 1 % of a peak.
                assert gain.noise.values(x, gain.noise.grid).max() > 0.98 * noise
    assert passed > 100


def test_ties_do_not_cost_what_is_told() -> None:
    """Below 1 stays below 1, and above it only what is the same in all digits is given up."""
    printed = (PLANT, PRINTED_C, WU, WP)
    best = design_disturbance_observer(*printed, method="descent", starts=2, flat=0.0)
    found = design_disturbance_observer(*printed, method="descent", starts=2)
    assert 1.0 < best.gamma <= found.gamma <= 1.0001 * best.gamma * (1.0 + 1e-9)
    assert found.certificate.observer_noise_gain < 0.95 * best.certificate.observer_noise_gain
    # Weights that the best gain meets by 0.5 %: a quieter one may not lose that.
    share = 0.995 / best.gamma
    tight = ([share * each for each in WU[0]], WU[1]), ([share * each for each in WP[0]], WP[1])
    assert design_disturbance_observer(
        PLANT, PRINTED_C, *tight, method="descent", starts=2
    ).feasible


@pytest.mark.parametrize(("parts", "limit"), [(REPAIRED, 600.0), (STAGE_200, 31416.0)])
def test_poles_keep_the_limit(parts: Parts, limit: float) -> None:
    found = design_disturbance_observer(*parts, method="descent", starts=1, fastest_pole=limit)
    # A pole of multiplicity three is known to the cube root of rounding, 1e-5.
    assert np.abs(np.linalg.eigvals(found.observer.A)).max() <= limit * (1.0 + 2e-5)
    assert found.feasible


def test_a_row_of_noise_is_kept() -> None:
    allowed = 0.3
    found = design_disturbance_observer(
        *STAGE_500, noise=0.05, jitter=allowed, method="descent", starts=1
    )
    gains = rows(found, np.geomspace(1e-1, 1e7, 40_000))
    assert 0.05 * gains["K S"].max() < allowed
    assert found.feasible
    assert found.certificate.noise_norm == pytest.approx(gains["K S"].max() / 6.0, rel=1e-4)
    assert f"at most {0.05 * found.certificate.noise_gain:.4g}" in found.summary()
    # By hand: no Q with Q(0) = 1 makes less than 1/Pn(0) = 1 of slow noise.
    with_too_little = design_disturbance_observer(
        *STAGE_500, noise=0.05, jitter=0.04, method="descent", starts=1, flat=0.0
    )
    assert not with_too_little.feasible
    assert "Wn K S is 1." in with_too_little.message


def test_the_drive_jitters_no_more_than_allowed() -> None:
    """Random noise through K S, stepped exactly with python-control."""
    found = design_disturbance_observer(
        *STAGE_200, noise=0.01, jitter=0.03, method="descent", starts=1
    )
    p, o = found.problem, found.observer
    names = {"plant": (["v"], ["x"]), "C": (["e"], ["u"]), "observer": (["v", "y"], ["d"])}
    systems = {"plant": p.plant, "C": p.controller, "observer": o}
    parts = [
        control.ss(s.A, s.B, s.C, s.D, inputs=names[k][0], outputs=names[k][1])
        for k, s in systems.items()
    ]
    parts.append(control.summing_junction(inputs=["x", "n"], output="y"))
    parts.append(control.summing_junction(inputs=["-y"], output="e"))
    parts.append(control.summing_junction(inputs=["u", "-d"], output="v"))
    loop = control.interconnect(parts, inputs=["n"], outputs=["v"])
    t = np.arange(20_000) * 5e-5
    noise = 0.01 * np.random.default_rng(0).normal(size=t.size)
    drive = control.forced_response(loop, t, noise).outputs
    assert 0.001 < drive.std() < 0.03


def test_default_weight_is_ten_times_what_cannot_be_avoided() -> None:
    problem = observer_problem(*REPAIRED, noise=0.2)
    w = np.geomspace(1e-2, 1e5, 40_000)
    P, C = response(problem.plant, w), response(problem.controller, w)
    alone = np.abs(C / (1.0 + P * C)).max()  # 6.31, above 1/Pn(0) = 1
    assert problem.Wn is not None
    assert problem.Wn.D[0, 0] == pytest.approx(1.0 / (10.0 * alone), rel=1e-6)
    soft = observer_problem(*STAGE_200, noise=3.0)
    assert soft.Wn is not None
    # an integrator of bandwidth 20 rad/s: |C S0| stays at 1/Pn(0) = 1 up to it
    assert soft.Wn.D[0, 0] == pytest.approx(0.1, rel=1e-3)


def random_with_noise(seed: int) -> ObserverProblem:
    return replace(random_problem(seed), Wn=as_linear_system(0.2))


@pytest.mark.parametrize("seed", [9])
def test_random_plants_with_noise(seed: int) -> None:
    p = random_with_noise(seed)
    found = design_disturbance_observer(
        p.plant, p.controller, p.Wu, p.Wp, p.internal_model, noise=p.Wn, method="descent", starts=2
    )
    poles = np.concatenate([p.plant.poles(), found.certificate.observer_poles])
    w = np.geomspace(1e-3 * np.abs(poles).min(), 1e2 * np.abs(poles).max(), 5000)
    gains = [each.response(1j * w)[:, 0, 0] for each in (p.plant, p.controller, p.Wu, p.Wp)]
    P, C, Wu, Wp = gains
    Q = p.q_filter(found.gain).response(1j * w)[:, 0, 0]
    K_S = (C + Q / P) / (1.0 + P * C)
    parts = np.abs([Wu * P * K_S, Wp * (1.0 - Q), 0.2 * K_S])
    stack = np.linalg.norm(parts, axis=0)
    # Q/P of order 9 at 100 times the fastest pole keeps five digits.
    assert stack.max() <= found.gamma * (1.0 + 1e-5)
    assert stack.max() >= 0.98 * found.gamma  # 5000 points over all decades see most of a peak
    assert found.lower_bound <= found.certificate.stacked_norm
    assert found.lower_bound_at_noise is not None
    assert found.lower_bound_at_noise <= found.certificate.stacked_norm


def test_bound_at_noise_is_below_all_that_is_as_quiet() -> None:
    base = design_disturbance_observer(*REPAIRED, method="descent")
    bound = base.lower_bound_at_noise
    assert bound is not None
    assert base.lower_bound + 0.1 < bound < base.gamma
    assert f"nor below {bound:.4g} at the 1.38 of this one" in base.summary()
    # More order, by poles and zeros that cancel in the plant.
    num, den = np.array(PLANT[0]), np.array(PLANT[1])
    for fake in (300.0, 2000.0):
        num, den = np.polymul(num, [1.0, fake]), np.polymul(den, [1.0, fake])
    larger = ((num, den), REPAIRED_C, WU, WP)
    found = design_disturbance_observer(*larger, method="descent", starts=1, flat=0.0)
    at_noise = lower_bound_at_noise(
        StackedGain(base.problem), found.gamma, found.certificate.observer_noise_gain
    )
    assert at_noise < found.certificate.stacked_norm < base.gamma


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"noise": -0.1}, r"noise is -0\.1; give the standard deviation"),
        ({"noise": ([1.0], [1.0, -2.0])}, r"the noise weight is not stable, pole at 2 1/s"),
        ({"noise": ([1.0, 0.0], [3.0])}, r"the noise weight is improper"),
        ({"jitter": 0.1}, r"jitter is what the noise may make in the drive; give noise"),
        ({"noise": 0.1, "jitter": 0.0}, r"jitter is 0\.0; give the standard deviation that noise"),
        ({"fastest_pole": 0.0}, r"fastest_pole is 0\.0; give a limit of the poles"),
        ({"flat": -1.0}, r"flat is -1\.0"),
        ({"method": "slpmm", "noise": 0.1}, r"'slpmm' knows no noise"),
        ({"method": "slpmm", "fastest_pole": 1.0}, r"'slpmm' knows no fastest_pole"),
        ({"order": 2}, r"order is 2; give a whole number from 3 to 9, or 'auto'"),
        ({"order": 40}, r"order is 40; give a whole number from 3 to 9"),
        ({"order": "more"}, r"order is 'more'; give a whole number"),
    ],
)
def test_options_that_cannot_be_met(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        design_disturbance_observer(*REPAIRED, **options)


def test_states_of_a_loud_design_are_told() -> None:
    """What the audit found: poles of 40 kHz and 731 times the noise, now in the answer."""
    loud = design_disturbance_observer(*STAGE_200, method="descent", starts=1, flat=0.0)
    assert loud.certificate.fastest_pole > 2e5
    assert f"fastest {loud.certificate.fastest_pole:.4g} rad/s" in loud.summary()
    assert f"Q/Pn {loud.certificate.observer_noise_gain:.4g}" in loud.summary()
