"""A chain with a stage of every kind, built in the engine and written as plain Python."""

from __future__ import annotations

import numpy as np
import pytest
from equations import Pair, direction_dead_zone, play, prandtl_ishlinskii, stop, two_sided_dead_zone

from hyst.operators.stage import Stage


@pytest.fixture
def pair() -> Pair:
    made = Pair()
    made.add(Stage("affine", (1.1, -0.3)), lambda u: 1.1 * u + -0.3)
    weights, thresholds = [0.9, 0.2, -0.1], [0.0, 0.7, -1.3]
    made.add(Stage("dead_zone", (*weights, *thresholds)), two_sided_dead_zone(weights, thresholds))
    p, r = [0.3, 0.2, 0.1], [0.1, 0.9, 2.3]
    made.add(Stage("pi", (0.4, *p, *r)), prandtl_ishlinskii(0.4, p, r))
    made.add(Stage("play", (0.05,)), play(0.05))
    made.add(Stage("stop", (2.2,)), stop(2.2))
    made.add(
        Stage("direction_dead_zone", (1.7, 0.3, 0.0, 0.4)),
        direction_dead_zone([1.7, 0.3], [0.0, 0.4]),
    )
    return made


@pytest.fixture
def noise() -> np.ndarray:
    """Reversals at every other sample, and a plateau."""
    u = 4.0 * np.random.default_rng(1).standard_normal(3000)
    u[1000:1010] = u[1000]
    return u
