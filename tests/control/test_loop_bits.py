"""What a simulated loop tells has the bits of its parts run alone, on every instruction set."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import _engine
from hyst.control import ClosedLoop, TrackingController, simulate_closed_loop

STAGE = hyst.PrandtlIshlinskii(np.linspace(0.1, 0.6, 18), np.linspace(0.5, 9.0, 18), 0.3)
INVERSE = hyst.Affine(0.7) @ STAGE.inverse()
OBSERVER = ([[-60.0, 1.0], [-900.0, 0.0]], [[1.0, 60.0], [0.0, 900.0]], [[0.0, 1.0]], [[0.0, 0.0]])
BLOCK = TrackingController.from_continuous(
    ([4.0, 8.0], [1.0, 0.0]), 1e-3, observer=OBSERVER, inverse=INVERSE
)
r = 18.0 * np.sin(np.arange(3000) * 0.01) + 5.0 * np.sin(np.arange(3000) * 0.07)
noise = 0.1 * np.random.default_rng(2).normal(size=r.size)


def sampled() -> ClosedLoop:
    return simulate_closed_loop(
        r, 1e-3, plant=([50.0], [1.0, 50.0]), controller=BLOCK, hysteresis=STAGE, noise=noise,
        disturbance=0.4,
    )  # fmt: skip


def test_parts_alone_give_the_same() -> None:
    loop = sampled()
    assert BLOCK.run(r, loop.y_measured)[0].tobytes() == loop.u.tobytes()
    assert BLOCK.estimate(r, loop.y_measured).tobytes() == loop.d_hat.tobytes()
    assert BLOCK.applied(r, loop.y_measured).tobytes() == loop.v.tobytes()
    assert STAGE.run(loop.u + 0.4, engine="loop")[0].tobytes() == loop.eta.tobytes()
    assert np.ptp(loop.d_hat) > 1.0


def test_a_continuous_controller_too() -> None:
    loop = simulate_closed_loop(
        r, 1e-3, plant=([50.0], [1.0, 50.0]), controller=([4.0, 8.0], [1.0, 0.0]),
        hysteresis=STAGE, inverse=INVERSE,
    )  # fmt: skip
    assert INVERSE.run(loop.v, engine="loop")[0].tobytes() == loop.u.tobytes()
    assert STAGE.run(loop.u, engine="loop")[0].tobytes() == loop.eta.tobytes()


@pytest.mark.parametrize("name", _engine.instruction_sets())
def test_every_instruction_set_gives_the_same(name: str) -> None:
    expected, before = sampled(), _engine.instruction_set()
    _engine.use_instruction_set(name)
    try:
        loop = sampled()
    finally:
        _engine.use_instruction_set(before)
    assert loop.y.tobytes() == expected.y.tobytes()
    assert loop.d_hat.tobytes() == expected.d_hat.tobytes()
