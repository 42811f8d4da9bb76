"""Dahl's friction where a step from sample to sample would lose it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hyst import Affine, Dahl, InputError, LinearDynamics, NotInvertibleError
from hyst.export.c.block import block_of, stepper_of


@pytest.mark.parametrize("samples", [10, 100_000])
def test_slow_motion_keeps_its_force_in_single_precision(samples: int) -> None:
    # By hand: 1 - exp(-1/2). At 100,000 samples a way is 84 units of single's last place of 1.
    step = stepper_of(block_of(Dahl(1.0, 1.0), "single"), "single")
    forces = [step(float(u)) for u in np.linspace(0.0, 0.5, samples)]
    # Constant, power and sum round once each: three of 6e-8, of a force below 1/2.
    assert forces[-1] == pytest.approx(1.0 - math.exp(-0.5), abs=1e-7)


def test_a_position_beyond_every_number_leaves_the_memory() -> None:
    # Of n = 50 a force of (1 - 1e-15) Fc is a way of 1e15^49 / 49.
    inverse = Dahl(1.0, 1.0, 50.0).inverse()
    disturbed, quiet = inverse.stepper(), inverse.stepper()
    disturbed(0.1)
    quiet(0.1)
    assert disturbed(1.0 - 1e-15) == quiet(0.1)
    assert disturbed.fault
    for force in (0.05, -0.1, 0.2):
        assert disturbed(force) == quiet(force)


def test_a_rest_hands_on_what_the_signal_before_it_depends_on() -> None:
    # y[0] = D u[0] = 0 rests where friction begins; dF/dD = sigma u[0] whichever way it goes.
    dynamics = LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], 1e-3)
    chain = Dahl(2.0, 3.0) @ dynamics
    parameters = chain.parameters()
    column = next(i for i, name in enumerate(parameters.names) if name.endswith(".D"))
    assert parameters.values[column] == 0.0
    assert chain.jacobian([0.7, -0.4])[0, column] == pytest.approx(1.4, rel=1e-15)


def test_forces_and_positions_survive_a_million_samples() -> None:
    friction = Dahl(1.0, 1.0, 2.0)
    u = np.cumsum(np.random.default_rng(1).normal(scale=0.01, size=1_000_000))
    # Each turn rounds position and force once; a turn wears old errors down. 1e-14 is 45 roundings
    # of 1, where half a million turns that added up would make 700.
    assert np.abs(friction.inverse()(friction(u)) - u).max() <= 1e-14 * np.abs(u).max()


def test_refusals_say_what_to_give() -> None:
    with pytest.raises(InputError, match=r"z0 is 1\.5; .* give -1 to 1"):
        Dahl(1.0, 1.0, z0=1.5)
    with pytest.raises(NotInvertibleError, match=r"n is 0\.5: .* many positions have one force"):
        (Affine(2.0) @ Dahl(1.0, 1.0, 0.5)).inverse()
