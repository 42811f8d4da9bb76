"""Maxwell-slip, generalized Maxwell-slip and LuGre friction against independent solutions."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from hyst import (
    Affine,
    Dahl,
    GeneralizedMaxwellSlip,
    InputError,
    LuGre,
    MaxwellSlip,
    NotInvertibleError,
    Operator,
    Record,
    fit,
)

Array = NDArray[np.float64]
DT = 1e-2


def stick_slip_drive(seed: int, samples: int = 400) -> Array:
    """Slow and fast strokes, rests and turns."""
    rng = np.random.default_rng(seed)
    u = np.cumsum(rng.normal(size=samples) * np.repeat([1e-3, 1e-2, 5e-2, 2e-3], samples // 4))
    u[100:110] = u[100]
    return np.asarray(u)


def springs_that_slide(k: Array, f: Array, k0: float, u: Array) -> Array:
    """The NumPy loop: every force steps as a spring's and is cut at its limit."""
    force, y = np.clip(k * u[0], -f, f), [k0 * u[0]]
    y[0] += force.sum()
    for step, here in zip(np.diff(u), u[1:], strict=True):
        force = np.clip(force + k * step, -f, f)
        y.append(k0 * here + force.sum())
    return np.array(y)


@pytest.mark.parametrize("seed", range(4))
def test_maxwell_slip_is_springs_that_slide(seed: int) -> None:
    rng = np.random.default_rng(seed)
    k, r = rng.uniform(0.1, 3.0, 6), np.sort(rng.uniform(0.01, 0.3, 6))
    u = stick_slip_drive(seed)
    y = MaxwellSlip(k, k * r, 0.5)(u)
    # Sums of some 400 steps with a rounding each of forces below 3 r = 1.
    assert np.abs(y - springs_that_slide(k, k * r, 0.5, u)).max() < 1e-12


def test_maxwell_slip_is_a_parallel_of_elastic_plastic_springs_of_opensees() -> None:
    ops = pytest.importorskip("openseespy.opensees")
    k, r = np.array([3.0, 1.0, 2.0, 0.5]), np.array([0.2, 0.3, 0.8, 1.5])
    t = np.linspace(0.0, 1.0, 2000)
    u = 2.0 * np.sin(6.0 * np.pi * t) + 1.2 * np.sin(34.0 * np.pi * t)
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    for tag, (modulus, limit) in enumerate(zip(k.tolist(), r.tolist(), strict=True), start=1):
        ops.uniaxialMaterial("ElasticPP", tag, modulus, limit)
    ops.uniaxialMaterial("Elastic", 5, 0.25)
    ops.uniaxialMaterial("Parallel", 9, 1, 2, 3, 4, 5)
    ops.testUniaxialMaterial(9)
    stress = []
    for strain in u.tolist():
        ops.setStrain(strain)
        stress.append(ops.getStress())
    ops.wipe()
    # Both round a few times a sample, forces of 4.1 at most.
    assert np.abs(MaxwellSlip(k, k * r, 0.25)(u) - stress).max() < 1e-12


@pytest.mark.parametrize("engine", ["loop", "lanes", "memory-curve"])
def test_maxwell_slip_has_the_bits_of_its_plays_in_every_engine(engine: str) -> None:
    friction = MaxwellSlip([1.0, 0.3, 0.7], [0.05, 0.07, 0.3], 0.2, z0=[0.01, 0.02, -0.03])
    u = np.sin(np.linspace(0.0, 60.0, 20_000)) * np.linspace(1.0, 0.1, 20_000)
    y, state = friction.run(u, engine=engine)
    expected, memory = friction.as_plays().run(u, engine=engine)
    assert y.tobytes() == expected.tobytes()
    assert state.tobytes() == memory.tobytes()


def test_maxwell_slip_with_a_spring_is_inverted_exactly() -> None:
    friction = MaxwellSlip([1.0, 2.0], [0.05, 0.2], 0.25)
    u = stick_slip_drive(7)
    # Slopes between 1/4 and 3.25 amplify a rounding of forces below 1 by four at most.
    assert np.abs(friction.inverse()(friction(u)) - u).max() < 1e-14


def along(model: LuGre, u: Array) -> Array:
    """Radau in time, at a relative tolerance of 1e-10, the velocity constant between samples."""
    z, y = 0.0, [0.0]
    for step in np.diff(u):
        v = float(step) / model.dt
        g = model.Fc + (model.Fs - model.Fc) * np.exp(-((v / model.vs) ** 2))

        def rate(_: float, z: Array, v: float = v, g: float = g) -> Array:
            return np.asarray(v - model.sigma0 * abs(v) * z / g)

        solved = solve_ivp(rate, (0.0, model.dt), [z], "Radau", rtol=1e-10, atol=1e-14)
        z = float(solved.y[0, -1])
        dz = float(rate(0.0, np.array([z]))[0])
        viscous = model.sigma2 * v + model.Fv * np.tanh(v / model.vv)
        y.append(model.sigma0 * z + model.sigma1 * dz + viscous)
    return np.array(y)


@pytest.mark.parametrize(
    "model",
    [
        LuGre(50.0, 0.0, 0.0, 1.0, 1.0, 1.0, DT),
        LuGre(50.0, 0.5, 0.3, 1.0, 1.6, 0.5, DT, Fv=0.6, vv=0.3),
        LuGre(400.0, 2.0, 0.0, 0.7, 2.0, 0.2, DT),
    ],
    ids=["Dahl's", "all terms", "steep"],
)
def test_lugre_against_radau(model: LuGre) -> None:
    u = stick_slip_drive(3, 120)
    expected = along(model, u)
    # The solver's relative tolerance, over 120 samples that forget by the way they go.
    assert np.abs(model(u) - expected).max() < 1e-8 * np.abs(expected).max()


def elements(model: GeneralizedMaxwellSlip, u: Array, parts: int) -> Array:
    """Every sample cut into so many Euler steps, element by element."""
    force, slides, y = np.zeros(model.k.size), np.zeros(model.k.size), [0.0]
    for step in np.diff(u):
        v, way = np.sign(step), abs(float(step)) / parts
        speed = abs(float(step)) / model.dt
        s = model.Fc + (model.Fs - model.Fc) * np.exp(-((speed / model.vs) ** model.delta))
        for _ in range(parts if v else 0):
            slides[(slides != v) | (slides == 0.0)] = 0.0
            slides[(slides == 0.0) & (v * force >= model.alpha * s)] = v
            toward = model.C * (model.alpha * v - force / s) * model.dt / parts
            force = np.where(slides == v, force + toward, force + model.k * v * way)
        if not v:
            slides[:] = 0.0
        y.append(float(force.sum()) + model.sigma2 * float(step) / model.dt)
    return np.array(y)


def test_generalized_maxwell_slip_against_small_steps() -> None:
    model = GeneralizedMaxwellSlip(
        [40.0, 20.0, 10.0], [0.2, 0.3, 0.5], 20.0, 1.0, 1.5, 0.5, DT, delta=1.5, sigma2=0.1
    )
    u = stick_slip_drive(5, 200)
    y = model(u)
    coarse, fine = (float(np.abs(elements(model, u, n) - y).max()) for n in (50, 400))
    # Euler's error is of first order: an eighth of the step, an eighth of the error, but for the
    # step within which an element begins to slide, of up to k times 5e-2 times 2 over 400.
    assert fine < 1e-2
    assert fine < 0.3 * coarse


def test_generalized_maxwell_slip_without_a_curve_is_maxwell_slip() -> None:
    k, alpha = [40.0, 20.0, 10.0], [0.2, 0.3, 0.5]
    u = stick_slip_drive(2) - stick_slip_drive(2)[0]
    for C in (0.0, 3.0):
        model = GeneralizedMaxwellSlip(k, alpha, C, 2.0, 2.0, 1.0, DT)
        plain = MaxwellSlip(k, 2.0 * np.array(alpha))
        # Forces below 2 with a rounding in each of 400 steps; exact in 1.5 at a sliding end.
        assert np.abs(model(u) - plain(u)).max() < 1e-12


def test_lugre_without_rate_is_dahls() -> None:
    u = stick_slip_drive(4)
    u -= u[0]
    # Each sample rounds once; ways wear old roundings down.
    assert np.abs(LuGre(30.0, 0.0, 0.0, 1.5, 1.5, 1.0, DT)(u) - Dahl(30.0, 1.5)(u)).max() < 1e-13


@pytest.mark.parametrize(
    "model",
    [
        LuGre(50.0, 0.5, 0.3, 1.0, 1.6, 0.5, DT),
        GeneralizedMaxwellSlip([40.0, 20.0], [0.5, 0.5], 20.0, 1.0, 1.5, 0.5, DT),
    ],
    ids=["lugre", "generalized"],
)
def test_time_and_speed_scale_together(model: Operator) -> None:
    """The same path at another sample time is another motion, unless it is made at half speed."""
    u = stick_slip_drive(6)
    slow = model.at_sample_time(2.0 * DT)
    assert np.abs(slow(u) - model(u)).max() > 1e-2
    between = np.interp(np.arange(2 * u.size - 1) / 2.0, np.arange(u.size), u)
    # Two samples at the same velocity are one of twice the length: rounding of forces below 3.
    assert np.abs(model(between)[::2] - slow(u)).max() < 1e-12
    with pytest.raises(InputError, match=r"dt = 0\.02 s, the model 0\.01 s"):
        model.require_sample_time(2.0 * DT)


def test_dissipation_is_what_the_passivity_margin_says() -> None:
    """The work of a fast stroke against bristles that a slow one has loaded."""

    def work(sigma1: float, sigma2: float) -> float:
        model = LuGre(10.0, sigma1, sigma2, 1.0, 2.0, 1.0, 1e-6)
        u = np.concatenate([np.linspace(0.0, 5.0, 200), 5.0 + np.linspace(0.0, 0.05, 200)[1:]])
        y = np.empty(u.size)
        y[:200], state = model.at_sample_time(1.0).run(u[:200])
        y[200:], _ = model.run(u[200:], state)
        return float(np.sum(y[200:] * np.diff(u[199:])))

    # The bristles hold w^2 / (2 sigma0) = 0.2; more than that cannot be taken from what is passive.
    active = LuGre(10.0, 1.0, 0.5, 1.0, 2.0, 1.0, DT)
    assert active.passivity_margin() == pytest.approx(-0.5)
    assert work(1.0, 0.5) < -0.2
    assert LuGre(10.0, 1.0, 1.0, 1.0, 2.0, 1.0, DT).passivity_margin() == 0.0
    assert work(1.0, 1.0) > -0.2


REFUSALS = [
    (lambda: MaxwellSlip([1.0], [1.0, 2.0]), "k has 1 entries but f has 2"),
    (lambda: MaxwellSlip([1.0, -1.0], [1.0, 2.0]), "k[1] is -1.0"),
    (lambda: MaxwellSlip([1.0], [0.0]), "f[0] is 0.0"),
    (lambda: MaxwellSlip([1.0], [1.0], k0=-1.0), "k0 is -1.0"),
    (lambda: MaxwellSlip([1.0, 2.0], [1.0, 1.0]), "f[1] / k[1] = 0.5 is smaller than"),
    (lambda: MaxwellSlip([1.0], [1.0], z0=[0.0, 0.0]), "z0 has 2 entries"),
    (lambda: LuGre(1.0, 0.0, 0.0, 2.0, 1.0, 1.0, DT), "Fs is 1, below Fc = 2"),
    (lambda: LuGre(-1.0, 0.0, 0.0, 1.0, 1.0, 1.0, DT), "sigma0 is -1.0"),
    (lambda: LuGre(1.0, 0.0, -1.0, 1.0, 1.0, 1.0, DT), "sigma2 is -1.0"),
    (lambda: LuGre(1.0, 0.0, 0.0, 1.0, 1.0, 0.0, DT), "vs is 0.0"),
    (lambda: LuGre(1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0), "dt is 0.0"),
    (lambda: LuGre(1.0, 0.0, 0.0, 1.0, 1.0, 1.0, DT, Fv=-1.0), "Fv is -1.0"),
    (lambda: GeneralizedMaxwellSlip([], [], 0.0, 1.0, 1.0, 1.0, DT), "k has no entry"),
    (lambda: GeneralizedMaxwellSlip([1.0], [1.0], 0.0, 1.0, 0.5, 1.0, DT), "Fs is 0.5, below"),
    (lambda: GeneralizedMaxwellSlip([1.0], [1.0], -1.0, 1.0, 1.0, 1.0, DT), "C is -1.0"),
]


@pytest.mark.parametrize(("make", "words"), REFUSALS, ids=[words for _, words in REFUSALS])
def test_constants_that_are_none_of_friction_are_refused(make: object, words: str) -> None:
    with pytest.raises(InputError, match=re.escape(words)):
        make()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("model", "words"),
    [
        (MaxwellSlip([1.0, 2.0], [0.5, 1.5]), "k0 is 0: .* stays at 2"),
        (LuGre(1.0, 0.0, 0.0, 1.0, 2.0, 1.0, DT), "Fs is 2 and Fc 1: .* two velocities"),
        (LuGre(1.0, 0.0, 0.0, 1.0, 1.0, 1.0, DT), r"sigma2 and Fv are 0: .*hyst\.Dahl"),
        (LuGre(1.0, 0.0, 0.5, 1.0, 1.0, 1.0, DT), r"sigma2 is 0\.5 and Fv 0: .* velocity only"),
        (
            GeneralizedMaxwellSlip([1.0], [1.0], 0.0, 3.0, 3.0, 1.0, DT),
            r"Fc is 3: .*hyst\.MaxwellSlip",
        ),
    ],
    ids=["maxwell-slip", "stribeck", "sliding", "viscous", "generalized"],
)
def test_there_is_no_inverse_and_the_reason_is_told(model: Operator, words: str) -> None:
    with pytest.raises(NotInvertibleError, match=words):
        (Affine(2.0) @ model).inverse()


def test_constants_of_generalized_maxwell_slip_come_back_from_a_fit() -> None:
    true = GeneralizedMaxwellSlip([40.0, 15.0], [0.4, 0.6], 20.0, 1.0, 1.5, 0.5, DT, sigma2=0.1)
    u = np.concatenate([stick_slip_drive(1), stick_slip_drive(8)])
    guess = GeneralizedMaxwellSlip([35.0, 17.0], [0.4, 0.6], 15.0, 1.1, 1.4, 0.6, DT, sigma2=0.15)
    free = ["k[1]", "k[2]", "C", "Fc", "Fs", "vs", "sigma2"]
    found = fit(guess, Record(u, true(u), DT), free=free, delay=0)
    values = found.model.parameters().values
    # From 8 to 50 % off. The cost bends where elements break away within another sample, so that a
    # fit stops a little before its end.
    np.testing.assert_allclose(values, true.parameters().values, rtol=5e-3)


def test_every_element_slides_where_the_way_says() -> None:
    friction = MaxwellSlip([2.0, 1.0, 4.0], [0.2, 0.2, 2.0])
    for (k, f), before in zip(
        zip(friction.k, friction.f, strict=True), (0.0, 0.1, 0.2), strict=True
    ):
        below, above = friction([0.0, 0.999 * f / k]), friction([0.0, 1.001 * f / k])
        assert above[1] > below[1]
        assert before < f / k
    assert all(a <= b for a, b in itertools.pairwise(friction.f / friction.k))
