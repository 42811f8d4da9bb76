"""Stable eigenvalues in the internal model: more order, and only where it pays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from observer_cases import PLANT, REPAIRED_C, WP, WU, design_arguments, random_problem

from hyst.control import DisturbanceObserver, InternalModel, design_disturbance_observer
from hyst.control.disturbance_observer.stacked_gain import StackedGain

REPAIRED = (PLANT, REPAIRED_C, WU, WP)


@pytest.fixture(scope="module")
def paper() -> DisturbanceObserver:
    return design_disturbance_observer(*REPAIRED)


@pytest.fixture(scope="module")
def searched() -> DisturbanceObserver:
    return design_disturbance_observer(*REPAIRED, order="auto")


def norms(design: DisturbanceObserver) -> tuple[float, float]:
    """Stacked norm and noise gain from the responses of the parts."""
    p = design.problem
    w = np.geomspace(1e-2, 1e6, 30_000)
    P, C, Wu, Wp, Q = (
        each.response(1j * w)[:, 0, 0]
        for each in (p.plant, p.controller, p.Wu, p.Wp, p.q_filter(design.gain))
    )
    T = (P * C + Q) / (1.0 + P * C)
    stack = np.sqrt(np.abs(Wu * T) ** 2 + np.abs(Wp * (1.0 - Q)) ** 2)
    return float(stack.max()), float(np.abs(Q / P).max())


def test_one_more_order_at_no_more_noise(
    paper: DisturbanceObserver, searched: DisturbanceObserver
) -> None:
    stacked, noise = norms(paper)
    more, more_noise = norms(searched)
    assert stacked <= 0.93
    assert more <= 0.85
    assert more_noise <= noise
    assert (paper.problem.order, searched.problem.order) == (3, 4)
    assert searched.gamma == pytest.approx(more, rel=1e-5)  # the grid meets the peak to this
    eigenvalues = np.linalg.eigvals(searched.internal_model.A_d)
    assert np.sort(eigenvalues)[1] == 0.0
    assert -5000.0 < np.sort(eigenvalues)[0] < -1000.0
    assert searched.certificate.unity_at_zero
    assert any("does not pay, left at 4" in step for step in searched.steps)


def test_as_many_as_asked_for(paper: DisturbanceObserver) -> None:
    found = design_disturbance_observer(*REPAIRED, method="descent", starts=1, order=6)
    assert found.problem.order == found.gain.size == 6
    assert found.gamma < 0.83  # one eigenvalue has 0.841, three 0.816
    # The limit is that of the gain of order 3, to 0.1 %.
    limit = 1.002 * paper.certificate.observer_noise_gain
    assert found.certificate.observer_noise_gain <= limit
    assert paper.lower_bound_at_noise is not None
    assert found.gamma > paper.lower_bound_at_noise


def test_no_random_gain_is_better(searched: DisturbanceObserver) -> None:
    """Over all eigenvalues and poles: none has a lower norm at no more noise."""
    problem = replace(searched.problem, internal_model=InternalModel.integrator())
    gain = StackedGain(problem, 1)
    rng = np.random.default_rng(5)
    eigenvalue = np.linalg.eigvals(searched.internal_model.A_d).min()
    best = gain.parameters_of(searched.certificate.observer_poles, np.array([eigenvalue]))
    limit, noise = searched.gamma**2, 1.001 * searched.certificate.observer_noise_gain**2
    quiet = 0
    for width in (0.02, 0.1, 0.5, 2.0):
        for _ in range(2000):
            x = gain.inside(best + rng.normal(0.0, width, best.size))
            if gain.noise.values(x, gain.noise.grid).max() <= noise:
                quiet += 1
                # A grid of 24 points a decade may miss 1 % of a peak.
                assert gain.values(x, gain.grid).max() > 0.98 * limit
    assert quiet > 100


def test_a_coinciding_pole_cancels(paper: DisturbanceObserver) -> None:
    """With a pole of Q on the eigenvalue the larger observer is the smaller one."""
    gain, more = StackedGain(paper.problem), StackedGain(paper.problem, 1)
    poles, extra = paper.certificate.observer_poles, np.array([-700.0])
    small = gain.parameters_of(poles)
    large = more.parameters_of(np.concatenate([poles, extra]), extra)
    w = np.geomspace(1.0, 1e5, 50)
    np.testing.assert_allclose(
        more.values(large, more.at(w)), gain.values(small, gain.at(w)), rtol=1e-9
    )


@pytest.mark.parametrize("seed", [9])
def test_random_plants_take_order_only_where_it_pays(seed: int) -> None:
    arguments = design_arguments(random_problem(seed))
    base = design_disturbance_observer(*arguments, method="descent", starts=2)
    found = design_disturbance_observer(*arguments, method="descent", starts=2, order="auto")
    gained = found.problem.order - base.problem.order
    assert found.gamma <= base.gamma * 0.95**gained * (1.0 + 1e-9)
    assert found.certificate.observer_noise_gain <= 1.0011 * base.certificate.observer_noise_gain
    assert any("does not pay" in step for step in found.steps) or gained > 0
