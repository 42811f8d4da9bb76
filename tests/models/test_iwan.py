"""Iwan's model: its distribution of sliders, numbers by hand, its inverse, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

import hyst
from hyst import InputError, Iwan, NotInvertibleError
from hyst.models import IwanCurve
from reference.sliders import jenkins, spread_by_a_power

Array = NDArray[np.float64]
EPS = float(np.finfo(np.float64).eps)
JOINTS = {
    "uniform": (2.0, 1.5, 0.0, 0.0),
    "sudden": (2.0, 1.5, 0.5, 2.0),
    "early": (2.0, 1.5, -0.6, 0.25),
}
each_joint = pytest.mark.parametrize("constants", JOINTS.values(), ids=list(JOINTS))


def walk(seed: int, samples: int = 300) -> Array:
    return np.cumsum(np.random.default_rng(seed).standard_normal(samples))


@each_joint
def test_the_curve_is_the_integral_over_the_spread(
    constants: tuple[float, float, float, float],
) -> None:
    """Segalman's eq.: the integral of rho(phi) min(x, phi), with R and S from his constants."""
    force, stiffness, chi, beta = constants
    curve = IwanCurve(*constants)
    limit = curve.phi_max
    factor = stiffness / (1.0 + beta) * (chi + 1.0) / limit ** (chi + 1.0)
    last = stiffness * beta / (1.0 + beta)
    power = 1.0 / (chi + 1.0)
    for x in limit * np.array([0.1, 0.5, 0.9, 1.0, 2.0]):
        # phi = s^(1 / (chi + 1)) takes the pole of chi < 0 out of the integral.
        total = quad(lambda s, x=x: min(x, s**power), 0.0, limit ** (chi + 1.0), limit=200)[0]
        expected = factor * power * total + last * min(x, limit)
        # quad stops at 1.5e-8, at a kink.
        assert float(curve(x)) == pytest.approx(expected, rel=1e-6)
        assert float(hyst.MasingOperator(curve)([x])[0]) == pytest.approx(expected, rel=1e-6)
    assert float(curve(5.0 * limit)) == pytest.approx(force, rel=4.0 * EPS)


@each_joint
def test_it_is_the_limit_of_many_sliders(constants: tuple[float, float, float, float]) -> None:
    """The way of each part is its mean, so that N parts are off by 1 / N^2 of the whole."""
    u = walk(4)
    ours = Iwan(*constants)(u)
    errors = [
        np.abs(jenkins(*spread_by_a_power(n, *constants), u) - ours).max() for n in (100, 2000)
    ]
    # At most some 60 branches of 300 samples add up.
    assert errors[0] <= 60.0 * 2.0 / 100.0**1.5
    assert errors[1] <= errors[0] / 15.0


def test_opensees_has_the_same_joint() -> None:
    opensees = pytest.importorskip("openseespy.opensees")
    constants, u = JOINTS["early"], walk(7, 120)
    stiffness, ways = spread_by_a_power(400, *constants)
    opensees.wipe()
    opensees.model("basic", "-ndm", 1, "-ndf", 1)
    for tag, (k, way) in enumerate(zip(stiffness, ways, strict=True), start=1):
        opensees.uniaxialMaterial("ElasticPP", tag, float(k), float(way))
    opensees.uniaxialMaterial("Parallel", 1000, *range(1, len(ways) + 1))
    opensees.testUniaxialMaterial(1000)
    theirs = []
    for value in u.tolist():
        opensees.setStrain(value)
        theirs.append(opensees.getStress())
    opensees.wipe()
    elements = jenkins(stiffness, ways, u)
    # The elements themselves to rounding of 400 sums, the continuum to what 400 parts leave.
    assert np.abs(np.array(theirs) - elements).max() <= 1e-11
    assert np.abs(np.array(theirs) - Iwan(*constants)(u)).max() <= 60.0 * 2.0 / 400.0**1.5


def test_the_uniform_joint_by_hand() -> None:
    # K_T = 2, F_S = 1: phi_max = 1, f = 2 x - x^2 up to 1; twice that of half the way from a turn.
    joint = Iwan(F_S=1.0, K_T=2.0)
    assert joint.phi_max == 1.0
    # 0.75; back by 1: 0.75 - 1.5; from there by 3: more than 2 phi_max, macro-slip.
    assert joint([0.5, -0.5, 2.5, 1.5]).tolist() == [0.75, -0.75, 1.0, -0.5]


def test_small_loops_lose_as_a_power() -> None:
    """Loss over a cycle of amplitude a goes with a^(chi + 3) (Segalman 2005)."""
    chi = -0.4
    joint = Iwan(2.0, 1.5, chi, 0.3)
    t = np.linspace(0.0, 4.0 * np.pi, 4001)
    losses = []
    for a in (0.01, 0.02):
        u = a * np.sin(t)
        y = joint(u)
        losses.append(np.trapezoid(y[2000:], u[2000:]))
    # Areas by trapezoids of 2000 steps: 1e-5.
    assert losses[1] / losses[0] == pytest.approx(2.0 ** (chi + 3.0), rel=1e-4)


@pytest.mark.parametrize("spring", [0.05, 1.0])
@each_joint
def test_the_inverse_gives_the_way_back(
    constants: tuple[float, float, float, float], spring: float
) -> None:
    joint, u = Iwan(*constants, spring), walk(9)
    # In macro-slip the slope is the spring's: 1.5 / 0.05 = 30 times a rounding of y, over at most
    # some 60 branches of ways up to 60.
    assert np.abs(joint.inverse()(joint(u)) - u).max() <= 40.0 * 60.0 * EPS * 60.0


def test_without_a_spring_macro_slip_has_no_inverse() -> None:
    with pytest.raises(NotInvertibleError, match="flat from 1 on"):
        Iwan(1.0, 2.0).inverse()


REFUSED = {
    (0.0, 1.0, 0.0, 0.0, 0.0): "F_S is 0",
    (1.0, -1.0, 0.0, 0.0, 0.0): "K_T is -1",
    (1.0, 1.0, -1.0, 0.0, 0.0): "chi is -1; the stiffness of all elements is finite",
    (1.0, 1.0, 0.0, -0.1, 0.0): "beta is -0.1; elements have a stiffness of 0 or more",
    (1.0, 1.0, 0.0, 0.0, -2.0): "K_inf is -2; elements have a stiffness of 0 or more",
    (1.0, 1.0, float("inf"), 0.0, 0.0): "chi is inf",
}


@pytest.mark.parametrize("constants", REFUSED)
def test_what_is_no_joint_is_refused(constants: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match=REFUSED[constants]):
        Iwan(*constants)


def test_its_files_and_depth() -> None:
    joint = Iwan(1.0, 2.0, 0.3, 0.2, 0.1, depth=8)
    assert hyst.Iwan.from_dict(joint.to_dict()) == joint
    assert joint.to_dict()["depth"] == 8
    assert joint.with_parameters(joint.parameters().values) == joint
