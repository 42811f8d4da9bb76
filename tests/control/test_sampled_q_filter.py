"""The Q-filter of a sampled plant: by hand, by brute force, and in the loop it is for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from observer_cases import OMEGA, PLANT, REPAIRED_C, WP, WU, random_problem

from hyst.control import (
    LinearSystem,
    SampledQFilterObserver,
    TrackingController,
    closed_loop_poles,
    compare_blocks,
    design_sampled_q_filter,
    simulate_closed_loop,
)
from hyst.control.q_filters import table_of_blocks
from hyst.errors import InputError

Array = np.ndarray[Any, np.dtype[Any]]

# Relative degree 3: its fast sampling zeros tend to -3.73 and -0.27.
THIRD = ([OMEGA**3], np.polymul([1.0, 1.6 * OMEGA, OMEGA**2], [1.0, OMEGA]))


@pytest.fixture(scope="module")
def late() -> SampledQFilterObserver:
    return design_sampled_q_filter(PLANT, REPAIRED_C, WU, WP, 1e-4, delay=1.5e-4)


@pytest.fixture(scope="module")
def third() -> SampledQFilterObserver:
    return design_sampled_q_filter(THIRD, ([2.0], [1.0, 0.0]), WU, WP, 1e-4)


def polynomial_response(system: tuple[Any, Any], s: Array) -> Array:
    return np.polyval(system[0], s) / np.polyval(system[1], s)


def stack(design: SampledQFilterObserver, w: Array) -> Array:
    """[a K S; Wp E] from responses, aliases summed one by one to 300 times the sample rate."""
    problem, dt = design.problem, design.filter.dt
    z = np.exp(1j * w * dt)
    Pd = problem.plant.system.response(z)[:, 0, 0]
    of_v, of_y = np.moveaxis(design.observer.response(z)[:, 0], 1, 0)
    s = 2.0 / dt * (z - 1.0) / (z + 1.0)
    C = 4.0 + 8.0 / s  # the trapezoidal rule
    K = (C + of_y) / (1.0 + of_v)
    N, S, S0 = K / (1.0 + K * Pd), 1.0 / (1.0 + K * Pd), 1.0 / (1.0 + C * Pd)
    at = w[:, None] + 2.0 * np.pi / dt * np.arange(-300, 301)
    hold = np.abs((1.0 - np.exp(-1j * at * dt)) / (1j * at))
    size = np.abs(polynomial_response(PLANT, 1j * at) * polynomial_response(WU, 1j * at))
    a = (size * hold).sum(axis=1) / dt
    Wp = np.abs(polynomial_response(WP, 1j * w))
    return np.asarray(np.hypot(a * np.abs(N), Wp * np.abs(S / S0)))


@pytest.mark.parametrize("name", ["late", "third"])
def test_the_observer_is_the_filter_and_the_inverse(
    name: str, request: pytest.FixtureRequest
) -> None:
    design = request.getfixturevalue(name)
    w = np.geomspace(1.0, np.pi / 1e-4, 200)
    z = np.exp(1j * w * 1e-4)
    Pd = design.problem.plant.system.response(z)[:, 0, 0]
    observer = design.observer.response(z)[:, 0]
    # From the state space of the plant; Pd is as small as 1e-6 near half the sample rate.
    np.testing.assert_allclose(observer[:, 1] * Pd, -observer[:, 0], rtol=1e-6)
    np.testing.assert_allclose(observer[:, 0], -design.filter.response(z), rtol=1e-9)
    assert design.filter.response(np.ones(1, complex))[0] == pytest.approx(1.0, abs=1e-9)
    assert np.abs(design.observer.poles()).max() < 1.0
    assert design.filter.relative_degree == design.problem.relative_degree
    assert np.abs(closed_loop_poles(design.problem.plant.system, design.block)).max() < 1.0


@pytest.mark.parametrize("seed", [1, 2, 3, 4, 5, 6])
def test_slow_poles_keep_their_digits_where_sampling_is_fast(seed: int) -> None:
    """At 20 samples for the fastest pole, slow ones crowd at z = 1, up to seven of them."""
    p = random_problem(seed)
    dt = 0.05 / float(np.abs(p.plant.poles()).max())
    design = design_sampled_q_filter(p.plant, p.controller, p.Wu, p.Wp, dt)
    z = np.exp(1j * np.geomspace(1e-5, np.pi, 300))
    Pd = design.problem.plant.system.response(z)[:, 0, 0]
    observer = design.observer.response(z)[:, 0]
    # Coefficients in powers of z instead of z - 1 leave 1e-4 to 1e-1 here, and unstable loops.
    np.testing.assert_allclose(observer[:, 1] * Pd, -observer[:, 0], atol=1e-8)
    assert np.abs(design.observer.poles()).max() < 1.0
    assert np.abs(closed_loop_poles(p.plant, design.block)).max() < 1.0
    assert np.isfinite(design.gamma)


def test_zeros_outside_the_circle_are_kept(third: SampledQFilterObserver) -> None:
    kept = np.sort(third.problem.kept_zeros.real)
    # Known limits of the sampling zeros of 1/s^3 (Euler-Frobenius: z^2 + 4 z + 1), dt -> 0.
    np.testing.assert_allclose(kept, [-2.0 - np.sqrt(3.0), -2.0 + np.sqrt(3.0)], rtol=0.1)
    np.testing.assert_allclose(np.abs(third.filter.response(kept + 0j)), 0.0, atol=1e-9)
    assert "kept zeros" in third.summary()
    assert third.name == "sampled 1/(tau s + 1)^4"


def test_norm_is_that_of_the_loop(late: SampledQFilterObserver) -> None:
    w = np.unique(np.concatenate([np.geomspace(1.0, np.pi / 1e-4, 4000)]))
    seen = stack(late, w).max()
    # Aliases past 300 sample rates add below 1e-4; spacing of w 2.6e-3, smooth peaks.
    assert seen == pytest.approx(late.gamma, rel=2e-4)
    assert late.feasible
    assert "the sampled loop is stable for every plant within Wu" in late.message


def test_no_other_time_constant_is_better(late: SampledQFilterObserver) -> None:
    problem, dt = late.problem, late.filter.dt
    w = np.geomspace(1.0, np.pi / dt, 600)
    z = np.exp(1j * w * dt)
    Pd = problem.plant.system.response(z)[:, 0, 0]
    at = w[:, None] + 2.0 * np.pi / dt * np.arange(-60, 61)
    hold = np.abs((1.0 - np.exp(-1j * at * dt)) / (1j * at))
    size = np.abs(polynomial_response(PLANT, 1j * at) * polynomial_response(WU, 1j * at))
    a, Wp = (size * hold).sum(axis=1) / dt, np.abs(polynomial_response(WP, 1j * w))
    s = 2.0 / dt * (z - 1.0) / (z + 1.0)
    C = 4.0 + 8.0 / s
    S0 = 1.0 / (1.0 + C * Pd)
    kept = late.problem.kept_zeros
    least = np.inf
    for tau in np.geomspace(2e-5, 1.0, 1500):
        p = np.exp(-dt / tau)
        b = np.prod(z[:, None] - kept, axis=1) / np.prod(1.0 - kept)
        power = 3 - late.problem.relative_degree - kept.size
        Q = ((1.0 - p) / (z - p)) ** 3 * b * z ** float(power)
        N, E = (C + Q / Pd) * S0, 1.0 - Q
        least = min(least, float(np.hypot(a * np.abs(N), Wp * np.abs(E)).max()))
    # A tie of 2e-4 goes to the slower filter; spacing of w 1.7 %, peaks flat to 1e-3.
    assert late.gamma <= least * 1.002


def test_a_pure_delay_by_hand() -> None:
    """Pd = 2 z^-2 and no controller: Q = [(1 - p)/(z - p)]^2, K S = Q/Pd, E = 1 - Q."""
    A = np.array([[0.0, 1.0], [0.0, 0.0]])
    plant = LinearSystem(A, [[0.0], [1.0]], [[2.0, 0.0]], [[0.0]], 0.01)
    found = design_sampled_q_filter(plant, 0.0, 0.5, 0.4)
    p = np.exp(-0.01 / found.tau)  # type: ignore[operator]
    z = np.exp(1j * np.geomspace(1e-3, np.pi / 0.01, 20_000) * 0.01)
    Q = ((1.0 - p) / (z - p)) ** 2
    np.testing.assert_allclose(found.filter.response(z), Q, rtol=1e-9)
    assert found.certificate.uncertainty_norm == pytest.approx(0.5, rel=1e-4)  # at w -> 0
    assert found.certificate.noise_gain == pytest.approx(0.5, rel=1e-4)  # 1/|Pd(1)|
    assert found.certificate.performance_norm == pytest.approx(
        0.4 * np.abs(1.0 - Q).max(), rel=1e-4
    )


def test_it_takes_a_constant_disturbance_off_a_late_plant(late: SampledQFilterObserver) -> None:
    t = np.arange(15_000) * 1e-4
    d = np.where(t > 0.3, 2.0, 0.0)
    block = TrackingController.from_continuous(REPAIRED_C, 1e-4, observer=late)
    loop = simulate_closed_loop(
        np.zeros(t.size), 1e-4, plant=PLANT, controller=block, disturbance=d, delay=1.5e-4
    )
    assert np.abs(loop.y[3000:4000]).max() > 0.3
    assert abs(loop.y[-1]) < 1e-3  # the controller's own slow pole, 1.6 1/s, is still there
    assert loop.d_hat[-1] == pytest.approx(2.0, abs=1e-5)


def test_noise_is_bounded_where_it_is_asked() -> None:
    free = design_sampled_q_filter(PLANT, REPAIRED_C, WU, WP, 1e-4, order=5)
    w = np.geomspace(1.0, np.pi / 1e-4, 4000)
    z = np.exp(1j * w * 1e-4)

    def most(design: SampledQFilterObserver) -> float:
        Pd = design.problem.plant.system.response(z)[:, 0, 0]
        return float(np.abs(design.filter.response(z) / Pd).max())

    assert most(free) > 1.05
    bounded = design_sampled_q_filter(PLANT, REPAIRED_C, WU, WP, 1e-4, order=5, most_noise=1.02)
    assert most(bounded) <= 1.02 * (1.0 + 1e-3)  # other grids of frequencies
    assert bounded.gamma >= free.gamma * (1.0 - 1e-4)


def test_blocks_beside_one_another(late: SampledQFilterObserver) -> None:
    rows = compare_blocks(PLANT, REPAIRED_C, WU, WP, 1e-4, {"mine": late}, delay=1.5e-4)
    assert [name for name, _ in rows] == ["no observer", "1/(tau s + 1)^3", "mine"]
    certificates = dict(rows)
    assert certificates["mine"].stacked_norm == pytest.approx(late.gamma, rel=1e-12)
    assert certificates["1/(tau s + 1)^3"].stacked_norm <= late.gamma * (1.0 + 1e-12)
    # Without observer nothing of a disturbance is taken off: E = 1, Wp largest at 0.
    assert certificates["no observer"].performance_norm == pytest.approx(
        64.0 * np.pi / 0.2, rel=1e-3
    )
    assert len(table_of_blocks(rows).splitlines()) == 4
    # At whole delays and fast sampling the continuous design is the better one.
    fast = compare_blocks(PLANT, REPAIRED_C, WU, WP, 1e-4)
    again = design_sampled_q_filter(PLANT, REPAIRED_C, WU, WP, 1e-4)
    assert fast[1][1].stacked_norm < again.gamma
    with pytest.raises(InputError, match="there are no rows"):
        table_of_blocks(())


UNIT = ([100.0], [1.0, 100.0])
BAD: list[tuple[dict[str, Any], str]] = [
    ({"dt": None}, "the plant is continuous; give dt"),
    ({"dt": -1.0}, "dt is -1"),
    ({"delay": -1.0}, "delay is -1"),
    ({"order": 0}, "order is 0"),
    ({"order": 13}, "order is 13"),
    ({"most_noise": 0.5}, r"no filter of 2 lags keeps \|Q/Pd\| below 0.5; at 0 it is 1/\|Pd"),
    ({"most_noise": -1.0}, "most_noise is -1"),
    ({"plant": ([1.0], [1.0, -1.0])}, "the plant is unstable"),
    ({"plant": ([1.0], [1.0, 0.0])}, "the plant is not stable, pole at z = 1"),
    ({"plant": ([1.0, 0.0], [1.0, 20.0, 200.0])}, "the plant has a zero at z = 1"),
    ({"plant": 0.0}, "the plant's gain is zero"),
    ({"controller": ([1e5], [1.0, 0.0])}, "does not stabilize the plant at dt = 0.001 s"),
    ({"Wu": ([1.0], [1.0, -3.0])}, "Wu is not stable"),
]


@pytest.mark.parametrize(("change", "message"), BAD)
def test_problems_without_a_solution(change: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {
        "plant": UNIT, "controller": ([1.0], [1.0, 0.0]), "Wu": 0.1, "Wp": 0.5, "dt": 1e-3
    }  # fmt: skip
    with pytest.raises(InputError, match=message):
        design_sampled_q_filter(**(given | change))


def test_noise_in_units_that_differ_by_many_decades() -> None:
    """A plant of gain 5e-9: the drive is 2e8 times that of a plant of gain 1, and no warning."""
    lag, shape = 0.12342440270630625, [2.57016846, 0.53704661, 1.0]
    Wu, Wp = ([0.486, 5.77e-3], [0.0103, 1.0]), ([0.0331, 0.254], [1.0, 2.54e-4])
    rms = [
        design_sampled_q_filter(
            ([gain], shape), ([0.0204 / gain], [1.0, 0.0]), Wu, Wp, dt=0.08043054, delay=lag
        ).certificate.noise_rms
        for gain in (5.02857e-9, 1.0)
    ]
    # Rounding, magnified by the conditioning of the Lyapunov equation.
    assert rms[0] * 5.02857e-9 == pytest.approx(rms[1], rel=1e-8)
