"""Bouc-Wen's model that degrades and pinches, against solutions that know nothing of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from hyst import BoucWen, DegradingBoucWen, InputError, NotInvertibleError, fit
from hyst.signals import Record

Array = NDArray[np.float64]

WORN = DegradingBoucWen(0.2, 1.0, 0.6, 0.3, delta_nu=0.02, delta_eta=0.05)
PINCHED = replace(WORN, zeta=0.9, p=0.5, q=0.2, psi=0.3, delta_psi=0.01, lam=0.2)


def drive(seed: int, samples: int = 25, size: float = 1.5) -> Array:
    """Give inputs at random, nearly all of them turns."""
    return size * np.random.default_rng(seed).normal(size=samples)


def integrated(of: DegradingBoucWen, u: Array) -> tuple[Array, float]:
    """Integrate the printed equations by Radau's method, and stop where z passes 0."""
    z, energy, last, found = 0.0, 0.0, 0.0, []
    total = of.beta + of.gamma

    def slope(_: float, at: Array, s: float) -> Array:
        share, e = float(at[0]), float(at[1])
        nu, eta = 1.0 + of.delta_nu * e, 1.0 + of.delta_eta * e
        held = of.beta * s * np.sign(share) + of.gamma
        deep = of.zeta * (1.0 - np.exp(-of.p * e))
        wide = (of.psi + of.delta_psi * e) * (of.lam + deep)
        place = of.q * (of.A / (nu * total)) ** (1.0 / of.n)
        h = 1.0 - deep * np.exp(-(((share * s - place) / wide) ** 2))
        return s * np.array([h * (of.A - nu * abs(share) ** of.n * held) / eta, share])

    def passes(_: float, at: Array, __: float) -> float:
        return float(at[0])

    passes.terminal = True  # type: ignore[attr-defined]
    for each in u.tolist():
        way, s = abs(each - last), 1.0 if each > last else -1.0
        while way > 0.0:
            passes.direction = s  # type: ignore[attr-defined]
            part = solve_ivp(
                slope, (0.0, way), [z, energy], "Radau", args=(s,), rtol=1e-11, atol=1e-13,
                events=passes if z * s < 0.0 else None,
            )  # fmt: skip
            z, energy = part.y[:, -1].tolist()
            way -= float(part.t[-1])
            if part.status == 1:
                z = 0.0
        last = each
        found.append(of.k * each + z)
    return np.array(found), energy


@pytest.mark.parametrize(
    ("model", "gamma", "n"),
    [
        (WORN, 0.3, 1.0),
        (WORN, -0.2, 1.4),
        (WORN, 0.6, 3.0),
        (PINCHED, -0.2, 1.0),
        (PINCHED, 0.3, 1.4),
        (PINCHED, 0.3, 2.0),
    ],
)
def test_it_is_the_solution_of_its_equations(
    model: DegradingBoucWen, gamma: float, n: float
) -> None:
    of = replace(model, n=n, gamma=gamma)
    u = drive(int(10 * n), 14, 2.5)
    expected, energy = integrated(of, u)
    assert energy > 2.0  # so that it has degraded and pinched
    # Radau keeps to 1e-11 of z and the energy at each turn, and sub-steps leave some 1e-12.
    assert np.abs(of(u) - expected).max() <= 1e-10 * np.ptp(expected)


def test_without_wear_and_pinch_it_is_bouc_wens() -> None:
    u = drive(3, 400)
    for n in (1.0, 1.5, 2.0):
        new = DegradingBoucWen(0.2, 1.0, 0.6, 0.3, n)
        # Sub-steps leave 1e-10 of z where Bouc-Wen's own way is closed form.
        assert np.abs(new(u) - BoucWen(0.2, 1.0, 0.6, 0.3, n)(u)).max() <= 1e-9


def opensees(material: tuple[object, ...], u: Array, substeps: int) -> Array:
    ops = pytest.importorskip("openseespy.opensees")
    fine = np.interp(np.arange(u.size * substeps - substeps + 1) / substeps, range(u.size), u)
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.uniaxialMaterial(*material)
    ops.testUniaxialMaterial(1)
    forces = []
    for strain in fine.tolist():
        ops.setStrain(strain)
        forces.append(ops.getStress())
    ops.wipe()
    return np.array(forces)[::substeps]


def cycles() -> Array:
    t = np.linspace(0.0, 1.0, 160)
    return np.asarray(2.0 * np.sin(6.0 * np.pi * t) + 0.6 * np.sin(22.0 * np.pi * t))


def test_it_degrades_as_opensees_bouc_wen_of_fine_steps() -> None:
    """Its z is without a unit, its energy that of the force (1 - alpha) ko z."""
    # alpha ko = 0.3, (1 - alpha) ko = 0.7; z here is 0.7 z there, n = 1, delta_A = 0.
    material = ("BoucWen", 1, 0.3, 1.0, 1.0, 0.2, 0.7, 1.0, 0.0, 0.05, 0.1)
    model = DegradingBoucWen(0.3, 0.7, 0.7, 0.2, 1.0, delta_nu=0.05, delta_eta=0.1)
    u = cycles()
    force = model(u)
    coarse, fine = opensees(material, u, 60), opensees(material, u, 120)
    # Backward Euler: halved steps halve the error, so 2 fine - coarse is of second order.
    assert np.abs(2.0 * fine - coarse - force).max() <= 2e-4 * np.ptp(force)
    # The test can tell: without the loss of stiffness it is off by a hundred times that.
    assert np.abs(fine - replace(model, delta_eta=0.0)(u)).max() >= 2e-2 * np.ptp(force)


@pytest.mark.parametrize("q", [0.0, 0.2])
def test_it_pinches_as_opensees_bwbn_of_fine_steps(q: float) -> None:
    """Lengths there are in z without a unit, 0.7 of it here; its energy is that of the force."""
    material = ("BWBN", 1, 0.3, 1.0, 1.0, 0.2, 0.7, 1.0, q, 0.6, 1.0, 0.3, 0.02, 0.5, 1e-12, 200)
    model = DegradingBoucWen(
        0.3, 0.7, 0.7, 0.2, 1.0, zeta=0.6, p=1.0, q=q, psi=0.21, delta_psi=0.014, lam=0.5
    )
    u = cycles()
    force = model(u)
    coarse, fine = opensees(material, u, 60), opensees(material, u, 120)
    # As above; without the pinch it is off by a hundred times that.
    assert np.abs(2.0 * fine - coarse - force).max() <= 2e-4 * np.ptp(force)
    assert np.abs(fine - replace(model, zeta=0.0)(u)).max() >= 2e-2 * np.ptp(force)


@pytest.mark.parametrize("wear", [0.02, 0.1])
@pytest.mark.parametrize("model", [WORN, PINCHED], ids=["degrading", "pinched"])
def test_the_inverse_gives_the_input_back(model: DegradingBoucWen, wear: float) -> None:
    of = replace(model, delta_nu=wear / 20.0, delta_eta=wear, k=0.3)
    u = drive(7, 3000, 2.0)
    y = of(u)
    # y is rounded at its size, and where its slope is least that is an error of u; energies of
    # both ways add up their roundings.
    allowed = 200.0 * np.finfo(float).eps * np.abs(y).max() / of.least_slope()
    assert np.abs(of.inverse()(y) - u).max() <= allowed


def test_the_slope_keeps_to_its_bound() -> None:
    """Pushed on at its limit while strength is lost, z falls, and never faster than is said."""
    for zeta in (0.0, 0.5, 0.9):
        of = replace(PINCHED, k=0.0, delta_nu=0.5, zeta=zeta, p=2.0)
        u = np.concatenate([np.linspace(0.0, 3.0, 300), np.linspace(3.0, -40.0, 4000)[1:]])
        least = float((np.diff(of(u)) / np.diff(u)).min())
        assert least >= of.least_slope()
        with pytest.raises(NotInvertibleError, match="strength is lost faster than k makes up"):
            of.inverse()
        assert least < -0.05  # it does fall


def test_samples_in_between_change_no_bit() -> None:
    u = drive(11, 60)
    ways = [np.linspace(a, b, 33)[1:] for a, b in zip([0.0, *u[:-1]], u, strict=True)]
    for way, end in zip(ways, u, strict=True):
        way[-1] = end
    assert (PINCHED(np.concatenate(ways))[31::32] == PINCHED(u)).all()


def test_a_fit_finds_what_has_worn() -> None:
    true = replace(WORN, delta_nu=0.03, delta_eta=0.08)
    t = np.linspace(0.0, 1.0, 600)
    u = (1.0 + t) * np.sin(2.0 * np.pi * 6.0 * t)
    noise = 0.003 * np.random.default_rng(5).normal(size=u.size)
    record = Record(u, integrated_fast(true, u) + noise, dt=1e-3)
    free = ["k", "A", "beta", "gamma", "delta_nu", "delta_eta"]
    found = fit(replace(true, A=0.8, beta=0.9, delta_nu=0.01, delta_eta=0.02), record, free=free)
    assert found.parameter_names == tuple(free)
    values, sure = found.parameter_values, found.standard_errors
    truth = np.array([getattr(true, name) for name in free])
    # Six normal errors: beyond four of their size once in 2600 records.
    assert (np.abs(values - truth) <= 4.0 * sure).all()
    assert (sure[-2:] < 0.1 * truth[-2:]).all()


def integrated_fast(of: DegradingBoucWen, u: Array) -> Array:
    """The classical method of fourth order in 40 steps a sample, for records of many samples."""
    z, e, last, found = 0.0, 0.0, float(u[0]), []

    def slope(z: float, e: float, s: float) -> tuple[float, float]:
        held = of.beta * s * np.sign(z) + of.gamma
        z_slope = (of.A - (1.0 + of.delta_nu * e) * abs(z) ** of.n * held) / (1 + of.delta_eta * e)
        return s * z_slope, s * z

    for each in u.tolist():
        s, step = (1.0 if each > last else -1.0), abs(each - last) / 40
        for _ in range(40):
            a = slope(z, e, s)
            b = slope(z + step / 2 * a[0], e + step / 2 * a[1], s)
            c = slope(z + step / 2 * b[0], e + step / 2 * b[1], s)
            d = slope(z + step * c[0], e + step * c[1], s)
            z += step / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
            e += step / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
        last = each
        found.append(of.k * each + z)
    return np.array(found)


@pytest.mark.parametrize(
    ("constants", "sentence"),
    [
        ({"n": 0.5}, r"n is 0\.5; .* no less than 1"),
        ({"n": 30.0}, r"n is 30\.0; give"),
        ({"zeta": 1.0}, r"zeta is 1; .* 0 to less than 1"),
        ({"delta_nu": -0.1}, r"delta_nu is -0\.1; give .* 0 or more"),
        ({"gamma": 0.7}, r"gamma is 0\.7 where beta is 0\.6; .* -beta < gamma <= beta"),
        ({"zeta": 0.5, "psi": 1e-4}, r"psi lam is .* of the limit of z, 1\.11111; so narrow"),
        ({"A": float("nan")}, "A is nan"),
    ],
)
def test_what_is_not_admissible_is_refused(constants: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        replace(WORN, **constants)
