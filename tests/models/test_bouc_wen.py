"""Bouc-Wen's model against solutions that know nothing of it, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from hyst import Affine, BoucWen, InputError, NotInvertibleError
from hyst.export.c.block import block_of, stepper_of

Array = NDArray[np.float64]


def drive(seed: int, samples: int = 25, size: float = 1.5) -> Array:
    """Give inputs at random, nearly all of them turns."""
    return size * np.random.default_rng(seed).normal(size=samples)


def integrated(model: BoucWen, u: Array) -> Array:
    """Integrate the printed equation from sample to sample by Radau's method, and add k u."""
    z, last, found = model.z0, model.u0, []
    for each in u.tolist():
        s = 1.0 if each > last else -1.0

        def slope(way: float, at: Array, s: float = s) -> Array:
            sign = np.sign(at)
            held = model.beta * s * sign + model.gamma + model.phi * (s + sign)
            return np.asarray(s * (model.A - np.abs(at) ** model.n * held))

        way, scale = abs(each - last), model.limits()[1]
        solved = solve_ivp(slope, (0.0, way), [z], method="Radau", rtol=1e-10, atol=1e-12 * scale)
        z, last = float(solved.y[0, -1]), each
        found.append(model.k * each + model.h * z)
    return np.array(found)


@pytest.mark.parametrize(
    ("n", "gamma", "phi", "h"),
    [
        (0.5, 0.3, 0.0, 1.0),
        (1.0, 0.3, 0.0, -1.0),
        (1.0, -0.6, 0.1, 1.0),
        (1.5, 1.0, 0.3, -1.0),
        (2.0, -0.3, 0.0, -1.0),
        (3.0, 0.5, -0.2, 1.0),
    ],
)
def test_it_is_the_solution_of_its_equation(n: float, gamma: float, phi: float, h: float) -> None:
    model = BoucWen(4.0, 0.9, 1.0, gamma, n, h, phi, z0=0.1, u0=0.2)
    u = drive(int(10 * n))
    # Radau keeps to 1e-10 of z at each turn, and the model forgets what it left.
    assert np.abs(model(u) - integrated(model, u)).max() <= 1e-10 * np.ptp(u)


def test_it_is_opensees_bouc_wen_of_fine_steps() -> None:
    ops = pytest.importorskip("openseespy.opensees")
    t = np.linspace(0.0, 1.0, 200)
    u = 1.5 * np.sin(6.0 * np.pi * t) + 0.8 * np.sin(22.0 * np.pi * t)

    def stress(substeps: int) -> Array:
        """Force of alpha = 0.3, ko = 2: 0.6 u + 1.4 z with A = 1, n = 1.5, beta .7, gamma .2."""
        fine = np.interp(np.arange(u.size * substeps - substeps + 1) / substeps, range(u.size), u)
        ops.wipe()
        ops.model("basic", "-ndm", 1, "-ndf", 1)
        ops.uniaxialMaterial("BoucWen", 1, 0.3, 2.0, 1.5, 0.2, 0.7, 1.0, 0.0, 0.0, 0.0)
        ops.testUniaxialMaterial(1)
        forces = []
        for strain in fine.tolist():
            ops.setStrain(strain)
            forces.append(ops.getStress())
        ops.wipe()
        return np.array(forces)[::substeps]

    # z of OpenSees times 1.4 is this one's, so its A is 1.4 and the rest over 1.4^1.5.
    shrunk = 1.4 / 1.4**1.5
    force = BoucWen(0.6, 1.4, 0.7 * shrunk, 0.2 * shrunk, 1.5)(u)
    coarse, fine = stress(50), stress(100)
    # Backward Euler: twice the steps is half the error, so what is left of 2 fine - coarse is of
    # second order; 100 sub-steps leave some 3e-4 of the range themselves.
    assert np.abs(fine - force).max() <= 2e-3
    assert np.abs(2.0 * fine - coarse - force).max() <= 2e-5


@pytest.mark.parametrize("n", [0.5, 1.0, 1.7, 6.0])
@pytest.mark.parametrize(("k", "h"), [(1.4, -1.0), (0.05, 1.0), (50.0, 1.0)])
def test_the_inverse_gives_the_input_back(n: float, k: float, h: float) -> None:
    model = BoucWen(k, 0.6, 0.8, 0.3, n, h, phi=0.05, z0=0.1, u0=-0.3)
    u = drive(7, 4000, 2.0)
    error = np.abs(model.inverse()(model(u)) - u).max()
    # y is rounded at its size; where its slope is least, k or more, that is an error of u.
    slope = model.slopes()[0]
    assert error <= 20.0 * np.finfo(float).eps * np.abs(model(u)).max() / slope


def test_slow_motion_keeps_z_in_single_precision() -> None:
    # By hand: z = 1 - exp(-1/2) for n = 1 and A = beta + gamma = 1, over 100,000 samples.
    step = stepper_of(block_of(BoucWen(0.0, 1.0, 0.5, 0.5), "single"), "single")
    z = [step(float(u)) for u in np.linspace(0.0, 0.5, 100_000)]
    # Way, logarithm, power and sum round once each: four of 6e-8, of a z below 1/2.
    assert z[-1] == pytest.approx(1.0 - np.exp(-0.5), abs=1.3e-7)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_z_rests_at_its_limit_however_long_the_way(precision: str) -> None:
    # By hand: z = 1 - exp(-u) for n = 1 and A = beta + gamma = 1, also where z rounds to 1.
    model = BoucWen(0.0, 1.0, 0.5, 0.5)
    u = np.linspace(0.5, 60.0, 1191)
    step = stepper_of(block_of(model, precision), precision)
    # Way, exponential and difference round once each, of numbers up to 1.
    rounding = 4.0 * float(np.finfo(np.float32 if precision == "single" else np.float64).eps)
    assert np.array([step(float(each)) for each in u]) == pytest.approx(-np.expm1(-u), abs=rounding)


def test_an_asymmetric_loop_ends_at_its_two_limits() -> None:
    # (A / (beta + gamma +- 2 phi))^(1/n) with 8 / (1 + 1) and 8 / (1 - 1/2), n = 2: 2 and -4.
    model = BoucWen(0.0, 8.0, 0.75, 0.5, 2.0, phi=0.375)
    z = model([100.0, -100.0])
    assert z == pytest.approx([2.0, -4.0], rel=1e-15)


@pytest.mark.parametrize(
    ("constants", "sentence"),
    [
        ({"n": 0.0}, r"n is 0\.0; give .* above 0"),
        ({"n": -1.0}, r"n is -1\.0; give .* above 0"),
        ({"n": 0.05}, r"n is 0\.05; .* give 0\.1 to 100"),
        ({"beta": 0.0}, r"beta is 0\.0; give"),
        ({"gamma": 0.6}, r"gamma is 0\.6 where beta is 0\.5; .* -beta < gamma <= beta"),
        ({"gamma": -0.5}, r"gamma is -0\.5 where beta is 0\.5; .* -beta < gamma <= beta"),
        ({"phi": 0.4}, r"phi is 0\.4 where beta \+ gamma is 0\.7; .* give a smaller phi"),
        ({"gamma": -0.4999}, r"is 9999; unloading .* at most 1000"),
        ({"h": 0.5}, r"h is 0\.5; .* give 1 or -1"),
        ({"k": -1.0}, r"k is -1\.0; give .* 0 or more"),
        ({"z0": 9.0}, r"z0 is 9; .* give -1\.42857 to 1\.42857"),
    ],
)
def test_what_is_not_admissible_is_refused(constants: dict[str, float], sentence: str) -> None:
    usual = {"k": 1.0, "A": 1.0, "beta": 0.5, "gamma": 0.2}
    with pytest.raises(InputError, match=sentence):
        BoucWen(**{**usual, **constants})


def test_an_output_that_falls_in_places_has_no_inverse() -> None:
    # k - A (1 + 0.3 / 0.7), the slope right after a turn far out; k, at the limit.
    with pytest.raises(NotInvertibleError, match=r"smallest slope dy/du is -0\.428571, k - A"):
        BoucWen(1.0, 1.0, 0.5, 0.2, h=-1.0).inverse()
    with pytest.raises(NotInvertibleError, match=r"smallest slope dy/du is 0, k, at the limit"):
        (Affine(2.0) @ BoucWen(0.0, 1.0, 0.5, 0.2)).inverse()
    piezo = BoucWen(1.43, 1.0, 0.5, 0.2, h=-1.0)
    y = piezo(drive(3, 500, 30.0))
    assert np.isfinite(piezo.inverse()(y)).all()  # 1.43 is just above 1.428571


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_units_in_which_beta_has_no_number_are_refused(scale: float) -> None:
    # 1e-9 to the power -49 is 1e441.
    with pytest.raises(InputError, match=r"n is 50: .* give an output of moderate size"):
        BoucWen(0.5, 1.0, 0.5, 0.3, 50.0).in_units(scale, scale)
