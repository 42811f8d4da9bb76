"""The analytic Jacobian against central differences of the reference implementation.

While no play and no dead-zone changes its branch, the output is a straight line in each single
parameter, so that the difference quotient is exact but for rounding, whatever the step. Samples
from the first one on where a step changes a branch are left out: there the derivative is one-sided.
"""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from hyst import Affine, Operator, Play, PrandtlIshlinskii
from reference.derivatives import jacobian as jacobian_by
from reference.derivatives import off_their_bounds
from reference.examples import EXAMPLES, WITHOUT_STRIBECK_CURVE
from reference.numpy_operators import Trace, flat, has_twin, jumps_behind_rounding, simulate
from reference.random_operators import RANDOM

Array = NDArray[np.float64]

STEP = 1e-5
TWINS = {name: each for name, each in EXAMPLES.items() if has_twin(each.to_dict())}
OTHERS = {
    name: each for name, each in EXAMPLES.items() if name not in TWINS | WITHOUT_STRIBECK_CURVE
}
# Names of the constants in a dictionary, in the order of the parameter vector.
ORDER = {
    "affine": ("gain", "offset"),
    "play": ("r",),
    "stop": ("r",),
    "dead-zone": ("weights", "thresholds"),
    "prandtl-ishlinskii": ("p0", "p", "r"),
}


def places(model: dict[str, Any]) -> list[tuple[int, str, int | None]]:
    """Stage, name and index of every constant, in the order of the parameter vector."""
    found: list[tuple[int, str, int | None]] = []
    for number, stage in enumerate(flat(model)):
        for name in ORDER[stage["kind"]]:
            value = stage.get(name, [])
            indices = range(len(value)) if isinstance(value, list) else (None,)
            found += [(number, name, index) for index in indices]
    return found


def constant(model: dict[str, Any], place: tuple[int, str, int | None]) -> float:
    number, name, index = place
    value = flat(model)[number][name]
    return float(value if index is None else value[index])


def with_constant(
    model: dict[str, Any], place: tuple[int, str, int | None], value: float
) -> dict[str, Any]:
    changed = copy.deepcopy(model)
    number, name, index = place
    stage = flat(changed)[number]
    if index is None:
        stage[name] = value
    else:
        stage[name][index] = value
    return changed


def two_points(
    model: dict[str, Any], place: tuple[int, str, int | None], derivative: str
) -> tuple[float, float] | None:
    """Values on both sides; for a width of 0 two positive ones; none for the linear part's 0."""
    value = constant(model, place)
    if place[1] == "thresholds" and value == 0.0:
        return None
    if place[1] == "r" and value < 2.0 * STEP:
        if derivative == "kernel":
            return None  # a kink that lasts; the kernel may take the side that is not allowed
        # Behind another stage, rounding alone can make the input rise or fall where it rests.
        return (STEP, 2.0 * STEP) if place[0] == 0 else None
    return value - STEP, value + STEP


def same_branches(traces: list[Trace]) -> int:
    """Number of samples before the first one whose branches differ."""
    for k, regimes in enumerate(zip(*(trace.regimes for trace in traces), strict=True)):
        if len(set(regimes)) > 1:
            return k
    return len(traces[0].regimes)


def assert_agrees(operator: Operator, u: Array, derivative: str) -> float | None:
    """Compare all columns; give the share of entries that could be compared, if there are any."""
    model = operator.to_dict()
    jacobian = jacobian_by(operator, u, derivative)
    compared = entries = 0
    for column, place in enumerate(places(model)):
        points = two_points(model, place, derivative)
        if points is None:
            continue
        traces = [simulate(with_constant(model, place, point), u) for point in points]
        # A play without width has one branch; what it would do with hardly any is what counts.
        value = constant(model, place) or (5e-324 if place[1] == "r" else 0.0)
        here = simulate(with_constant(model, place, value), u)
        count = same_branches([*traces, here])
        step = points[1] - points[0]
        quotient = (traces[1].y - traces[0].y) / step
        # Both outputs are off by their rounding, and so is the parameter that was stepped.
        tolerance = 2.0 * (traces[0].rounding + traces[1].rounding) / step
        tolerance += 1e-9 * (1.0 + np.abs(jacobian[:, column]).max())
        np.testing.assert_allclose(
            jacobian[:count, column], quotient[:count], rtol=0.0, atol=tolerance, err_msg=str(place)
        )
        compared += count
        entries += u.size
    return compared / entries if entries else None


def random_walk(seed: int, samples: int = 60) -> Array:
    """A signal off every lattice, that starts anywhere and turns at random."""
    generator = np.random.default_rng(seed)
    return generator.uniform(-4.0, 4.0) + np.cumsum(generator.standard_normal(samples))


@pytest.mark.parametrize("operator", TWINS.values(), ids=list(TWINS))
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("derivative", ["auto", "kernel"])
def test_examples(operator: Operator, seed: int, derivative: str) -> None:
    if derivative == "kernel" and not any(
        two_points(operator.to_dict(), place, derivative) for place in places(operator.to_dict())
    ):
        return  # a play or stop without width alone
    share = assert_agrees(operator, random_walk(seed), derivative)
    # A step of 1e-5 changes the branch of few of 60 samples about 1 apart.
    assert share is not None
    assert share > 0.95


@pytest.mark.parametrize("kind", sorted({each.kind for each in TWINS.values()} | {"inverse"}))
@given(
    data=st.data(), seed=st.integers(0, 2**32 - 1), derivative=st.sampled_from(["auto", "kernel"])
)
def test_random_operators(kind: str, data: st.DataObject, seed: int, derivative: str) -> None:
    operator = data.draw(RANDOM[kind])
    assume(not jumps_behind_rounding(operator.to_dict()))
    share = assert_agrees(operator, random_walk(seed, samples=25), derivative)
    assert share is None or share > 0.0, "nothing was compared"


@pytest.mark.parametrize("operator", OTHERS.values(), ids=list(OTHERS))
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("derivative", ["auto", "kernel"])
def test_other_kinds_against_their_own_differences(
    operator: Operator, seed: int, derivative: str
) -> None:
    """Curves and dynamics: their outputs are held to their equations by tests of their own."""
    u = random_walk(seed)
    jacobian, parameters = jacobian_by(operator, u, derivative), operator.parameters()
    smooth_entries = 0
    can_move = parameters.lower < parameters.upper
    columns = np.flatnonzero(can_move & (off_their_bounds(operator) | (derivative == "auto")))
    for column, value in zip(columns, parameters.values[columns], strict=True):

        def quotient(step: float, column: int = column, value: float = value) -> Array:
            points = np.clip([value - step, value + step], parameters.lower[column], None)
            outputs = [
                operator.with_parameters(
                    np.concatenate(
                        [parameters.values[:column], [point], parameters.values[column + 1 :]]
                    )
                )(u)
                for point in points
            ]
            return np.asarray((outputs[1] - outputs[0]) / (points[1] - points[0]))

        near, far = quotient(1e-6), quotient(3e-6)
        # Differences of second order agree to 1e-6 of their size where nothing turns in between.
        scale = 1.0 + np.abs(far).max()
        smooth = np.abs(near - far) <= 1e-6 * scale
        smooth_entries += int(smooth.sum())
        assert np.abs(jacobian[:, column] - near)[smooth].max(initial=0.0) <= 1e-5 * scale
    assert smooth_entries >= 0.8 * u.size * columns.size


def test_by_hand() -> None:
    # y = gain z + offset with z = u - r rising to 3, then resting at 3 - r while u falls to 2.
    operator = Affine(2.0, 1.0) @ Play(1.0)
    assert operator.jacobian([0.0, 3.0, 2.0]).tolist() == [
        [0.0, 0.0, 1.0],
        [-2.0, 2.0, 1.0],
        [-2.0, 2.0, 1.0],
    ]


@pytest.mark.parametrize("bank", [Play(0.0), PrandtlIshlinskii([1.0], [0.0])])
def test_a_play_without_width_passes_derivatives_from_the_first_sample(bank: Operator) -> None:
    # It is the identity: with u = 0 in rest its input's derivatives are still its own.
    operator = bank @ Affine(1.0, 0.0)
    assert operator.jacobian([0.0, 0.0])[:, :2].tolist() == [[0.0, 1.0], [0.0, 1.0]]
