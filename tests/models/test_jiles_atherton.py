"""Jiles and Atherton's hysteresis against solutions of its published equations over the field."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import hyst
from hyst import InputError, JilesAtherton, NotInvertibleError
from hyst.models.jiles_atherton import VARIANTS

Array = NDArray[np.float64]

# Ms a k c alpha: soft, hard, near a jump (alpha Ms / (3 a) = 0.9), steel as in SI units.
CONSTANTS = {
    "soft": (2.0, 1.0, 0.3, 0.4, 0.8),
    "hard": (1.0, 1.0, 3.0, 0.1, 1.0),
    "steep": (1.0, 1.0, 1.0, 0.5, 2.7),
    "steel": (1.6e6, 1000.0, 700.0, 0.2, 1.4e-3),
}
each_variant = pytest.mark.parametrize("variant", VARIANTS)
each_magnet = pytest.mark.parametrize("name", CONSTANTS)


def magnet(name: str, variant: str, **more: object) -> JilesAtherton:
    return JilesAtherton(*CONSTANTS[name], variant=variant, **more)


def drive(name: str, count: int, seed: int) -> Array:
    _, a, k, *_ = CONSTANTS[name]
    return (2.0 * a + 3.0 * k) * np.random.default_rng(seed).uniform(-1.0, 1.0, count)


def langevin(x: float) -> tuple[float, float]:
    """L and its slope."""
    if abs(x) < 0.02:
        return (
            x / 3.0 - x**3 / 45.0 + 2.0 * x**5 / 945.0,
            1.0 / 3.0 - x**2 / 15.0 + 2.0 * x**4 / 189.0,
        )
    return 1.0 / np.tanh(x) - 1.0 / x, 1.0 / x**2 - 1.0 / np.sinh(x) ** 2


def towards(model: JilesAtherton, field: float, m: float) -> tuple[float, float]:
    """What pulls the pinned part, Man - Mirr or Man - M, and dMan/dHe."""
    value, slope = langevin((field + model.alpha * m) / model.a)
    man, c = model.Ms * value, model.c
    pinned = m if model.variant == "jiles-atherton-1986" else (m - c * man) / (1.0 - c)
    return man - pinned, model.Ms / model.a * slope


def susceptibility(model: JilesAtherton, field: float, m: float, s: float) -> float:
    """Give dM/dH as published, delta_M included."""
    pull, slope = towards(model, field, m)
    k, c, alpha = model.k, model.c, model.alpha
    moves = s * pull > 0.0
    if model.variant == "effective-field":
        chi = (1.0 - c) * (pull / (s * k) if moves else 0.0) + c * slope
        return chi / (1.0 - alpha * chi)
    pinned = pull / (s * k - alpha * pull) if moves else 0.0
    if model.variant == "jiles-thoelke-devine-1992":
        return ((1.0 - c) * pinned + c * slope) / (1.0 - alpha * c * slope)
    return (pinned + c * slope) / (1.0 + c - alpha * c * slope)


def solved(model: JilesAtherton, fields: Array) -> Array:
    """Solve dM/dH implicitly, Radau at 1e-10, in two parts where the pinned part begins to move."""

    def met(field: float, m: Array) -> float:
        return towards(model, field, float(m[0]))[0]

    met.terminal = True
    h, m, outputs = 0.0, 0.0, []
    for target in fields.tolist():
        s = float(np.sign(target - h))
        while h != target:
            rests = s * met(h, np.array([m])) < 0.0
            part = solve_ivp(
                lambda field, y, s=s: [susceptibility(model, field, float(y[0]), s)],
                (h, target),
                [m],
                method="Radau",
                rtol=1e-10,
                atol=1e-13 * model.Ms,
                events=met if rests else None,
            )
            h, m = float(part.t[-1]), float(part.y[0, -1])
            if rests and h != target:
                # Past the kink, which the solver's root finding knows to rounding.
                step = 1e-12 * (target - h)
                m, h = m + step * susceptibility(model, h, m, s), h + step
        outputs.append(m)
    return np.array(outputs)


@each_magnet
@each_variant
def test_it_solves_its_equation(name: str, variant: str) -> None:
    model, fields = magnet(name, variant), drive(name, 4, 1)
    # Sub-steps leave 1e-10 of Ms, Radau and the place of its kink some times that.
    assert np.abs(model(fields) - solved(model, fields)).max() < 2e-9 * model.Ms


def test_variants_disagree_for_the_same_constants() -> None:
    fields = drive("steep", 40, 2)
    one, two, three = (magnet("steep", variant)(fields) for variant in VARIANTS)
    assert np.abs(one - two).max() > 0.01
    assert np.abs(one - three).max() > 0.01
    assert np.abs(two - three).max() > 0.01


def test_without_coupling_two_variants_are_one() -> None:
    fields = drive("soft", 40, 3)
    one, two = (
        dataclasses.replace(magnet("soft", variant), alpha=0.0)(fields) for variant in VARIANTS[:2]
    )
    # The widths of their sub-steps differ: 1e-10 of Ms each.
    np.testing.assert_allclose(one, two, atol=1e-9)


@each_magnet
@each_variant
def test_the_inverse_comes_back(name: str, variant: str) -> None:
    model = magnet(name, variant)
    fields = np.cumsum(drive(name, 2000, 4)) / 40.0
    back = model.inverse()(model(fields))
    np.testing.assert_allclose(model(back), model(fields), atol=1e-13 * model.Ms)
    # Reversible slopes far out are some 1e-3 of Ms / a: rounding of M over them.
    np.testing.assert_allclose(back, fields, atol=1e-10 * model.a)


@each_variant
def test_flux_density_has_an_inverse_even_without_a_reversible_part(variant: str) -> None:
    model = dataclasses.replace(magnet("steel", variant), c=0.0, output="B")
    fields = drive("steel", 500, 5)
    assert model([0.0, 100.0])[1] == pytest.approx(
        4e-7 * np.pi * (100.0 + dataclasses.replace(model, output="M")([100.0])[0]), rel=1e-13
    )
    # B of 2 T rounds by 4e-16, over mu0 where M rests: 4e-10 A/m, of 1000.
    np.testing.assert_allclose(model.inverse()(model(fields)), fields, atol=5e-9)
    with pytest.raises(NotInvertibleError, match=r"c is 0: .* many fields have one M"):
        dataclasses.replace(model, output="M").inverse()


def test_a_magnetisation_beyond_saturation_is_refused_by_its_sample() -> None:
    inverse = magnet("soft", VARIANTS[0]).inverse()
    with pytest.raises(InputError, match=r"u\[2\] = 2 the operator"):
        inverse([0.5, 1.9, 2.0, 0.1])
    step = inverse.stepper()
    step(0.5)
    held = step(1.9)
    assert step(-2.5) == held
    assert step.fault
    assert step(1.9) == held


@each_variant
def test_no_susceptibility_is_negative_after_a_turn(variant: str) -> None:
    model = magnet("hard", variant)
    fields = np.concatenate([np.linspace(0.0, 9.0, 50), np.linspace(8.9, -9.0, 400)])
    change = np.diff(model(fields)) * np.sign(np.diff(fields))
    assert change.min() > 0.0


@each_variant
@pytest.mark.parametrize(("input_scale", "output_scale"), [(2.0**40, 2.0**-30), (2.0**-100, 4.0)])
def test_other_units_change_no_bit(variant: str, input_scale: float, output_scale: float) -> None:
    for output in ("M", "B"):
        model = magnet("soft", variant, output=output, mu0=0.5)
        other, fields = model.in_units(input_scale, output_scale), drive("soft", 100, 6)
        np.testing.assert_array_equal(other(input_scale * fields), output_scale * model(fields))


def test_it_saturates_far_out_and_comes_back_from_there() -> None:
    model = magnet("soft", VARIANTS[0])
    far = model([1e9])[0]
    # 1 - L(x) = 1/x, x = 1e9.
    assert model.Ms - far == pytest.approx(2e-9, rel=1e-6)
    loop = np.concatenate([model([0.0, 1e9, -1e9, 1.0]), model([0.0, 1e4, -1e4, 1.0])])
    assert loop[3] == pytest.approx(loop[7], abs=1e-9)  # both are of the loop from saturation


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"c": 1.0}, "c is 1; it is the reversible share"),
        ({"c": -0.1}, r"c is -0\.1"),
        ({"k": 0.0}, "k is 0"),
        ({"k": 1e4}, r"k / a is \d+; .* give 1/1000 to 1000"),
        ({"k": 1e-5}, r"k / a is .*e-05; .* give 1/1000 to 1000"),
        ({"a": -1.0}, "a is -1"),
        ({"Ms": float("inf")}, "Ms is inf"),
        ({"alpha": 1.5}, r"alpha Ms / \(3 a\) is 1; from 1 on the magnetisation jumps"),
        ({"variant": "jiles"}, "variant is 'jiles'; choose one of effective-field"),
        ({"output": "H"}, "output is 'H'; choose one of M, B"),
        ({"mu0": 0.0}, "mu0 is 0"),
    ],
)
def test_constants_that_are_no_magnet_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        dataclasses.replace(magnet("soft", VARIANTS[0]), **change)


def _loops(share: float = 1.0) -> Array:
    return share * np.tile(np.sin(np.linspace(0.0, 2.0 * np.pi, 150, endpoint=False)), 4)


@pytest.mark.parametrize("other", [hyst.Affine(2.0, 0.3), hyst.Dahl(8.0, 1.0)])
def test_records_that_are_no_magnet_are_refused(other: hyst.Operator) -> None:
    record = hyst.Record(_loops(), other(_loops()), dt=1e-3)
    with pytest.raises(hyst.NotIdentifiableError, match="no loop around a curve that saturates"):
        hyst.identify(record, family="jiles-atherton", delay=0)


@each_variant
def test_each_variant_is_found_from_its_own_loops(variant: str) -> None:
    truth = JilesAtherton(1.5, 0.2, 0.15, 0.25, 0.2, variant)
    u = np.concatenate([_loops(), _loops(0.4)[:300]])
    found = hyst.identify(
        hyst.Record(u, truth(u), dt=1e-3), family="jiles-atherton", variant=variant, delay=0
    )
    np.testing.assert_allclose(found.parameter_values[:5], truth.parameters().values, rtol=1e-6)


def test_loops_far_from_saturation_are_told_so() -> None:
    truth = JilesAtherton(1.5, 1.5, 0.3, 0.2, 1.2)
    record = hyst.Record(_loops(), truth(_loops()), dt=1e-3)
    found = hyst.identify(record, family="jiles-atherton", delay=0, allow_unconverged=True)
    assert any("% of the saturation only" in each for each in found.undetermined)
