"""The Preisach model against grids of relays, numbers by hand, and what its inverse promises."""

from __future__ import annotations

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from hyst import InputError, NotInvertibleError, Preisach
from hyst.operators.registry import operator_from_dict
from reference.relays import kp_hysterons, relay_grid

Array = NDArray[np.float64]

EPS = np.finfo(np.float64).eps


def grid(seed: int, cells: int, low: float = -3.0, high: float = 3.0) -> tuple[Array, Array]:
    """Masses and uneven thresholds at random."""
    rng = np.random.default_rng(seed)
    widths = rng.uniform(0.3, 1.0, cells)
    edges = low + (high - low) * np.append(0.0, np.cumsum(widths)) / widths.sum()
    return np.tril(rng.uniform(0.1, 1.0, (cells, cells))), edges


def wandering(seed: int, samples: int = 150, size: float = 4.0) -> Array:
    return np.random.default_rng(seed).uniform(-size, size, samples)


def adversarial(edges: Array) -> Array:
    """Exact thresholds, repeats, steps of single bits, nests deeper than the memory, saturation."""
    rng = np.random.default_rng(5)
    outer = max(abs(edges[0]), abs(edges[-1]))
    nest = outer * np.repeat(0.97 ** np.arange(45), 2) * np.tile([1.0, -0.99], 45)
    bits = np.cumsum(rng.integers(-1, 2, 60)) * EPS * outer + edges[1]
    return np.concatenate(
        [
            rng.choice(edges, 60),
            np.repeat(rng.uniform(edges[0], edges[-1], 20), 3),
            bits,
            nest,
            nest[::-1],
            [2.0 * outer, -2.0 * outer, edges[0], edges[-1]],
            rng.choice(np.concatenate([edges, -edges]), 60),
            rng.normal(size=60),
        ]
    )


def test_numbers_by_hand() -> None:
    # Thresholds -1, 0, 1. Up to u = 1/2 from rest a quarter of the triangle of mass 1 turns, and an
    # eighth of the cell of mass 2, that above alpha + beta = 0: y = 2 (1/4 + 2/8) = 1. From 1 back
    # to 1/2 a quarter of the triangle: y = 4 - 2/4.
    model = Preisach([[1.0, 0.0], [2.0, 1.0]], [-1.0, 0.0, 1.0])
    assert model([0.5, 1.0, 0.5, 0.0, -0.5, 0.5]).tolist() == [1.0, 4.0, 3.5, 2.0, -0.5, 1.5]
    shifted = Preisach([[1.0, 0.0], [2.0, 1.0]], [4.0, 5.0, 6.0], p0=0.5)
    # All relays are down at rest, for all alpha + beta > 0. Up to 5.5 turn the lower triangle, half
    # of the cell and a quarter of the upper triangle: -4 + 2 (1 + 1 + 1/4) + 5.5 / 2.
    assert shifted([0.0, 5.5, 6.0, 5.5, 7.0]).tolist() == [-4.0, 3.25, 7.0, 6.25, 7.5]


@pytest.mark.parametrize("u0", [0.0, 1.7, -9.0])
@pytest.mark.parametrize(("low", "high"), [(-3.0, 3.0), (-1.0, 4.0), (0.5, 3.5), (-4.0, -1.0)])
def test_grids_of_relays_come_to_it(low: float, high: float, u0: float) -> None:
    weights, edges = grid(3, 5, low, high)
    u = wandering(1)
    y = Preisach(weights, edges, 0.3, u0)(u)
    errors = [np.abs(relay_grid(u, weights, edges, 0.3, side, u0) - y).max() for side in (4, 8, 16)]
    # Corners of the staircase are off by half a relay's cell, along rows and columns whose masses
    # add up to twice the sum; what turns counts twice.
    for error, side in zip(errors, (4, 8, 16), strict=True):
        assert error <= 2.0 * weights.sum() / side
    assert errors[2] < 0.5 * errors[0]


@pytest.mark.parametrize("spacing", ["even", "uneven"])
@pytest.mark.parametrize("seed", range(3))
def test_ridges_are_krasnoselskii_pokrovskii_hysterons(seed: int, spacing: str) -> None:
    weights, edges = grid(seed, 6, -2.0, 3.5)
    if spacing == "even":
        edges = np.linspace(-2.0, 3.5, 7)
    u = np.concatenate([wandering(seed, 400), adversarial(edges)])
    y = Preisach.krasnoselskii_pokrovskii(weights, edges, 0.2)(u)
    # Twenty-one terms and a branch from corner to corner are rounded, at sizes up to the sum; nests
    # of 90 reversals round once a reversal.
    bound = 100.0 * EPS * (weights.sum() + 0.2 * np.abs(u).max())
    deep = Preisach(weights, edges, 0.2, density="ridges", depth=200)(u)
    assert np.abs(deep - kp_hysterons(u, weights, edges, 0.2)).max() <= bound
    assert np.abs(y[:400] - deep[:400]).max() == 0.0


@pytest.mark.parametrize("density", ["even", "ridges"])
def test_saturation_is_the_sum(density: str) -> None:
    weights, edges = grid(1, 7)
    model = Preisach(weights, edges, density=density)  # type: ignore[arg-type]
    y = model([100.0, -100.0, 1.0, 100.0])
    # Rounded sums of 28 terms.
    wanted = weights.sum() * np.array([1.0, -1.0, 1.0])
    assert np.abs(y[[0, 1, 3]] - wanted).max() <= 28 * EPS * weights.sum()


def test_the_start_is_where_an_input_has_left_the_demagnetised_state() -> None:
    weights, edges = grid(2, 6, -2.0, 3.0)
    for u0 in (1.3, -0.4, -5.0, 5.0):
        started = Preisach(weights, edges, 0.1, u0)
        led = Preisach(weights, edges, 0.1)
        u = wandering(4)
        assert started(u).tobytes() == led(np.append(u0, u))[1:].tobytes()
    # Ever smaller loops lead there too, off by one step of 1/400 of the range for every relay.
    decay = 3.0 * np.linspace(1.0, 0.0, 800) * np.tile([1.0, -1.0], 400)
    u = np.append(decay, wandering(6))
    after = Preisach(weights, edges, 0.1, depth=2000)(u)[800:]
    fresh = Preisach(weights, edges, 0.1)(u[800:])
    assert np.abs(after - fresh).max() <= 4.0 * weights.sum() / 400.0


@pytest.mark.parametrize("density", ["even", "ridges"])
@pytest.mark.parametrize("seed", range(4))
def test_branches_rise_to_the_bit(seed: int, density: str) -> None:
    weights, edges = grid(seed, 9, -1.0, 2.0)
    # Some cells empty, some a millionth: pieces that are flat, or nearly.
    weights = weights * np.random.default_rng(seed).choice([0.0, 1e-6, 1.0], weights.shape)
    model = Preisach(weights, edges, 0.0, 0.0, density)  # type: ignore[arg-type]
    state = model.run(wandering(seed, 40, 2.0))[1]
    near = (edges[:, None] + EPS * np.arange(-4, 5)).ravel()
    up = np.sort(np.concatenate([np.linspace(-3.0, 3.0, 2000), near]))
    low, lowest = model.run([-1.3], state)
    assert (np.diff(np.append(low, model.run(up, lowest)[0]))[up > -1.3] >= 0.0).all()
    high, highest = model.run([1.9], state)
    assert (np.diff(np.append(high, model.run(up[::-1], highest)[0]))[up[::-1] < 1.9] <= 0.0).all()


@pytest.mark.parametrize("density", ["even", "ridges"])
@pytest.mark.parametrize("cells", [1, 4, 13])
def test_the_inverse_finds_inputs(cells: int, density: str) -> None:
    weights, edges = grid(cells, cells, -2.0, 2.5)
    model = Preisach(weights, edges, 0.5, 0.0, density, 200)  # type: ignore[arg-type]
    u = np.concatenate([wandering(cells, 300), adversarial(edges)])
    y = model(u)
    # An output's rounding, once a reversal of 90 nested ones, over the least slope p0.
    bound = 100.0 * EPS * np.abs(y).max() / 0.5
    assert np.abs(model.inverse()(y) - u).max() <= bound
    wanted = np.concatenate([y, wandering(2, 300, 1.5 * np.abs(y).max())])
    # A step from input to output, rounded at the steepest: 2 w / h for a cell's triangle.
    steepest = model.lipschitz_constant() * np.abs(model.inverse()(wanted)).max()
    assert np.abs(model(model.inverse()(wanted)) - wanted).max() <= 4.0 * EPS * steepest


@pytest.mark.parametrize("density", ["even", "ridges"])
def test_relays_alone_are_inverted_within_saturation(density: str) -> None:
    weights, edges = grid(7, 8, -2.0, 2.5)
    model = Preisach(weights, edges, 0.0, 0.0, density, 200)  # type: ignore[arg-type]
    u = np.concatenate([wandering(8, 300, 2.0), np.clip(adversarial(edges), -2.0, 2.5)])
    y = model(u)
    inverse = model.inverse()
    assert np.abs(model(inverse(y)) - y).max() <= 100.0 * EPS * np.abs(y).max()
    # After a reversal the output moves by the square of the way: half its digits are the input's.
    found = inverse(y)
    assert np.abs(found - u).max() <= 1e-6
    total = weights.sum()
    full = inverse([0.5 * total, float(y.max()), -0.25 * total])
    assert edges[0] <= full.min() <= full.max() <= edges[-1]


def test_saturation_as_the_model_rounds_it_is_within_reach() -> None:
    """Thresholds off centre: saturation comes along a branch, whose sums round otherwise."""
    rng = np.random.default_rng(0)
    for _ in range(300):
        cells = int(rng.integers(1, 8))
        edges = np.sort(rng.standard_normal(cells + 1))
        weights = np.tril(rng.random((cells, cells)))
        model = Preisach(weights, edges, 0.0, float(edges[-1]))
        u = np.clip(2.0 * rng.standard_normal(60), edges[0], edges[-1])
        inverse, y = model.inverse(), model(u)
        assert np.abs(model(inverse(y)) - y).max() <= 100.0 * EPS * weights.sum()
        with pytest.raises(InputError, match=r"u\[1\]"):
            inverse([0.0, weights.sum() * (1.0 + 1e-13)])


def test_what_no_input_reaches_is_named() -> None:
    inverse = Preisach([[1.0, 0.0], [2.0, 1.0]], [-1.0, 0.0, 1.0]).inverse()
    assert inverse([4.0, -4.0]).tolist() == [1.0, -1.0]
    with pytest.raises(InputError, match=r"u\[1\] = 4\.5 .* outputs that its model can give"):
        inverse([3.0, 4.5, 1.0])
    step, quiet = inverse.stepper(), inverse.stepper()
    held = step(3.0)
    assert step(-4.0001) == held == quiet(3.0)
    assert step.fault
    assert [step(y) for y in (2.0, -3.0)] == [quiet(y) for y in (2.0, -3.0)]


def test_an_inverse_that_does_not_exist_is_refused() -> None:
    weights, edges = np.array([[1.0, 0.0], [2.0, 0.0]]), [-1.0, 0.0, 1.0]
    with pytest.raises(
        NotInvertibleError, match=r"weights\[1, 1\] is 0 and p0 0: .* between 0 and 1 the output"
    ):
        Preisach(weights, edges).inverse()
    assert not Preisach(weights, edges).traits().invertible
    assert Preisach(weights, edges, p0=1e-6).traits().invertible
    # Mass below the rounding of the output moves nothing.
    with pytest.raises(NotInvertibleError, match=r"weights\[0, 0\] is 1e-18"):
        Preisach([[1e-18, 0.0], [2.0, 1.0]], edges).inverse()


@pytest.mark.parametrize("name", ["forward", "inverse"])
def test_units_scale_bits(name: str) -> None:
    weights, edges = grid(4, 6)
    model = Preisach(weights, edges, 0.3, 0.7)
    u = wandering(3, 300)
    other = model.in_units(2.0**7, 2.0**-9)
    if name == "forward":
        assert (other(2.0**7 * u) == 2.0**-9 * model(u)).all()
    else:
        y = model(u)
        assert (other.inverse()(2.0**-9 * y) == 2.0**7 * model.inverse()(y)).all()
    factors = model.parameter_scales(2.0**7, 2.0**-9)
    scaled = model.parameters().values * factors
    assert (scaled == other.parameters().values).all()


def test_memory_too_deep_is_told_and_loops_still_close() -> None:
    weights, edges = grid(9, 6)
    nest = 2.5 * np.repeat(0.9 ** np.arange(20), 2) * np.tile([1.0, -0.97], 20)
    back = nest[::-1][1:]
    shallow, deep = Preisach(weights, edges, depth=10), Preisach(weights, edges, depth=50)
    y, state = shallow.run(np.append(nest, back))
    exact, full = deep.run(np.append(nest, back))
    assert shallow.overflowed(state)
    assert not deep.overflowed(full)
    # The first ten reversals have room, and what comes back to them finds them.
    assert y[:10].tobytes() == exact[:10].tobytes()
    assert np.abs(y[-9:] - exact[-9:]).max() <= 40.0 * EPS * weights.sum()


def test_what_is_no_model_is_refused() -> None:
    weights, edges = [[1.0, 0.0], [2.0, 1.0]], [-1.0, 0.0, 1.0]
    refused = {
        r"weights\[1, 0\] is -2; a negative density": ([[1.0, 0.0], [-2.0, 1.0]], edges),
        r"weights\[0, 1\] is 3; .* above the diagonal": ([[1.0, 3.0], [2.0, 1.0]], edges),
        r"thresholds\[2\] = -0.5 is not above thresholds\[1\] = 0": (weights, [-1.0, 0.0, -0.5]),
        r"thresholds\[1\] = -1 is not above": (weights, [-1.0, -1.0, 0.5]),
        r"weights has shape \(2, 2\); 2 thresholds are the edges of 1 x 1": (weights, [0.0, 1.0]),
        r"weights has shape \(2,\)": ([1.0, 2.0], edges),
        r"thresholds has 1 entries": (weights, [1.0]),
        r"weights\[\(1, 0\)\] is nan": ([[1.0, 0.0], [np.nan, 1.0]], edges),
        r"thresholds\[1\] is inf": (weights, [0.0, np.inf, 1.0]),
        r"the sum of weights overflows": ([[1e308, 0.0], [1e308, 1.0]], edges),
        r"further apart than a number": (weights, [-1.5e308, 0.0, 1.5e308]),
    }
    for message, (masses, thresholds) in refused.items():
        with pytest.raises(InputError, match=message):
            Preisach(masses, thresholds)
    for message, rest in {
        r"p0 is -0.1; .* 0 or more": {"p0": -0.1},
        r"density is 'round'": {"density": "round"},
        r"depth is 0": {"depth": 0},
        r"u0 is nan": {"u0": np.nan},
    }.items():
        with pytest.raises(InputError, match=message):
            Preisach(weights, edges, **rest)  # type: ignore[arg-type]


def test_files_hold_the_triangle_and_matrices_are_taken() -> None:
    model = Preisach([[1.0, 0.0], [2.0, 1.0]], [-1.0, 0.0, 1.0], density="ridges", depth=7)
    data = json.loads(json.dumps(model.to_dict()))
    assert data["weights"] == [[1.0], [2.0, 1.0]]
    assert operator_from_dict(data) == model
    data["weights"] = [[1.0, 0.0], [2.0, 1.0]]
    assert operator_from_dict(data) == model
    assert model.parameters().names == ("p0", "w[1,1]", "w[2,1]", "w[2,2]")


def test_the_derivative_by_a_mass_is_what_is_up_less_what_is_down() -> None:
    weights, edges = grid(6, 5)
    model = Preisach(weights, edges, 0.2)
    u = wandering(7)
    jacobian = model.jacobian(u)
    assert (np.abs(jacobian[:, 1:]) <= 1.0 + 8.0 * EPS).all()
    # The output is linear in p0 and the masses, so that they give it back: 16 rounded terms.
    bound = 32.0 * EPS * (weights.sum() + 0.8)
    assert np.abs(jacobian @ model.parameters().values - model(u)).max() <= bound
