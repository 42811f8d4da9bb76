"""Coleman and Hodgdon's hysteresis against its equation, and where it has no inverse."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import hyst
from hyst import ColemanHodgdon, InputError, NotInvertibleError

Array = NDArray[np.float64]

MODELS = {
    "one piece": ColemanHodgdon(1.0, 2.0, 1.5),
    "saturating": ColemanHodgdon(2.0, [2.0, 0.5, 0.1], [1.6, 0.4, 0.1], [1.0, 2.0]),
    "steeper outside": ColemanHodgdon(0.7, [1.0, 3.0], [0.8, 2.9], [1.2]),
    "wide": ColemanHodgdon(0.4, 2.0, 0.3),
}


def solved(model: ColemanHodgdon, inputs: Array) -> Array:
    """Solve dy/du = alpha s (f - y) + g by Radau at 1e-10, from corner to corner of f."""
    a, b, knots = model.slopes_of_f, model.slopes_of_g, model.knots
    corners = np.concatenate([-knots[::-1], knots])
    f_at = np.concatenate([[0.0], np.cumsum(np.diff(knots, prepend=0.0) * a[:-1])])

    def f(u: float) -> float:
        piece = int(np.searchsorted(knots, abs(u)))
        start = knots[piece - 1] if piece else 0.0
        return float(np.sign(u) * (f_at[piece] + a[piece] * (abs(u) - start)))

    y, u, outputs = 0.0, 0.0, []
    for target in inputs.tolist():
        s = float(np.sign(target - u))
        between = [each for each in corners if min(u, target) < each < max(u, target)]
        for low, high in itertools.pairwise([u, *sorted(between, reverse=s < 0.0), target]):
            g = b[np.searchsorted(knots, abs(0.5 * (low + high)))]
            y = solve_ivp(
                lambda v, z, s=s, g=g: [model.alpha * s * (f(v) - z[0]) + g],
                (low, high),
                [y],
                method="Radau",
                rtol=1e-10,
                atol=1e-13,
            ).y[0, -1]
        u = target
        outputs.append(y)
    return np.array(outputs)


@pytest.mark.parametrize("name", MODELS)
def test_it_solves_its_equation(name: str) -> None:
    inputs = np.random.default_rng(1).uniform(-3.0, 3.0, 7)
    # Radau's own error: 1e-10 of a few units a step, and branches forget.
    assert np.abs(MODELS[name](inputs) - solved(MODELS[name], inputs)).max() < 3e-9


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize(("input_scale", "output_scale"), [(2.0**30, 2.0**-20), (2.0**-40, 8.0)])
def test_other_units_change_no_bit(name: str, input_scale: float, output_scale: float) -> None:
    model, u = MODELS[name], np.random.default_rng(2).uniform(-3.0, 3.0, 200)
    other = model.in_units(input_scale, output_scale)
    np.testing.assert_array_equal(other(input_scale * u), output_scale * model(u))


def slope_after_a_turn(model: ColemanHodgdon, place: float) -> float:
    """Of a branch that came from far above, by a difference."""
    y = model([place + 200.0, place, place + 1e-6])
    return float(y[2] - y[1]) / 1e-6


@pytest.mark.parametrize("name", MODELS)
def test_the_smallest_slope_is_that_after_a_turn_from_far_away(name: str) -> None:
    slope, place = MODELS[name].smallest_slope()
    # At a corner it is the slope on one of its sides. Outputs of 1 and the change of the slope over
    # a step, of 1e-6 times alpha, leave 1e-5.
    sides = [slope_after_a_turn(MODELS[name], place + shift) for shift in (-2e-6, 0.0)]
    assert min(sides) == pytest.approx(slope, abs=1e-5)
    elsewhere = [slope_after_a_turn(MODELS[name], at) for at in np.linspace(-4.0, 4.0, 81)]
    assert min(elsewhere) >= slope - 1e-5


def test_the_inverse_comes_back_over_a_hundred_thousand_samples() -> None:
    model = MODELS["steeper outside"]
    u = np.cumsum(np.random.default_rng(3).normal(scale=0.2, size=100_000))
    # Slopes here are 0.6 at least and 3 at most: some roundings of the largest u.
    assert np.abs(model.inverse()(model(u)) - u).max() <= 2e-14 * np.abs(u).max()


def test_what_falls_after_a_turn_has_no_inverse() -> None:
    with pytest.raises(NotInvertibleError, match=r"2 b - a is -1\.4, not positive"):
        MODELS["wide"].inverse()
    with pytest.raises(NotInvertibleError, match=r"the slope after a turn at -2 is -0\.0398"):
        MODELS["saturating"].inverse()
    y = MODELS["wide"]([40.0, 39.9])
    assert y[1] > y[0]  # the refusal is no caution: the output rises as the input falls


def test_what_starts_too_far_from_f_has_no_inverse() -> None:
    near = ColemanHodgdon(1.0, 2.0, 1.5, y0=0.49)  # (a - b) / alpha is 0.5
    u = np.random.default_rng(4).uniform(-2.0, 2.0, 30)
    np.testing.assert_allclose(near.inverse()(near(u)), u, atol=1e-14)
    with pytest.raises(NotInvertibleError, match="further from f than any drive"):
        ColemanHodgdon(1.0, 2.0, 1.5, y0=0.6).inverse()


@pytest.mark.parametrize(
    ("constants", "message"),
    [
        ((0.0, 1.0, 0.5), "alpha is 0"),
        ((1.0, 1.0, 1.5), r"b is 1\.5 above a = 1: .* as that of friction"),
        ((1.0, -1.0, -1.0), "a goes down to -1"),
        ((1.0, 1.0, -0.5), r"b goes down to -0\.5"),
        ((1.0, [1.0, 2.0], [0.5, 1.0]), "2 a, 2 b and 0 u_s"),
        ((1.0, [1.0, 2.0, 3.0], [0.5, 1.0, 1.0], [2.0, 1.0]), "ascending"),
        ((1.0, [1.0, 2.0], [0.5, 1.0], [0.0]), "positive"),
        ((1.0, [], []), "0 a, 0 b"),
        ((1.0, 1.0, float("nan")), "b"),
    ],
)
def test_constants_outside_the_conditions_are_refused(
    constants: tuple[object, ...], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        ColemanHodgdon(*constants)


def test_friction_and_a_line_are_told_from_it() -> None:
    u = np.tile(np.sin(np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)), 4)
    for model in (hyst.Dahl(8.0, 1.0), hyst.Affine(2.0, 0.3)):
        with pytest.raises(hyst.NotIdentifiableError, match="no loop that lags"):
            hyst.identify(hyst.Record(u, model(u), dt=1e-3), family="coleman-hodgdon", delay=0)


def test_a_saturating_material_is_found_in_pieces() -> None:
    u = np.tile(3.0 * np.sin(np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)), 4)
    truth = ColemanHodgdon(1.5, [2.0, 1.0, 0.2], [1.7, 0.9, 0.15], [1.0, 2.0])
    record = hyst.Record(u, truth(u) + 0.2, dt=1e-3)
    found = hyst.identify(record, family="coleman-hodgdon", pieces=3, delay=0)
    expected = [1.5, 2.0, 1.0, 0.2, 1.7, 0.9, 0.15, 0.2]
    np.testing.assert_allclose(found.parameter_values, expected, rtol=1e-6)
