"""Blocks and plants within Wu at random: SAFE is true, and what is refused can be broken."""

from __future__ import annotations

import numpy as np
import pytest
from observer_cases import random_problem

from hyst.control import (
    LinearSystem,
    TrackingController,
    design_sampled_q_filter,
    sampled_certificate,
    stress,
)


def times(factor: float, weight: LinearSystem) -> LinearSystem:
    return LinearSystem(weight.A, weight.B, factor * weight.C, factor * weight.D)


@pytest.mark.parametrize("seed", range(9))
def test_random_blocks_against_random_plants(seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    p = random_problem(seed)
    dt = rng.uniform(0.05, 0.6) / float(np.abs(p.plant.poles()).max())
    delay = dt * [0.0, 0.5, 1.0, 1.7][seed % 4]
    Wu = times(rng.uniform(0.05, 1.0), p.Wu)
    design = design_sampled_q_filter(p.plant, p.controller, Wu, p.Wp, dt, delay=delay)
    block = TrackingController.from_continuous(p.controller, dt, observer=design)
    found = sampled_certificate(block, p.plant, Wu, p.Wp, delay=delay)
    assert found.nominal_stable

    def holds(weight: LinearSystem) -> bool:
        return stress(block, p.plant, weight, 60, delay=delay, seed=seed).holds

    assert holds(Wu) or not found.robustly_stable
    # A hundredth below the border none of the plants breaks the block, two above it one does.
    assert holds(times(0.99 / found.uncertainty_norm, Wu))
    assert not holds(times(1.02 / found.uncertainty_norm, Wu))
