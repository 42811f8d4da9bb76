"""Commands that follow a wanted output: exactness, limits, memory, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hyst.compensation import invert_trajectory
from hyst.errors import InputError, NotInvertibleError
from hyst.models import (
    GeneralizedPrandtlIshlinskii,
    ModifiedPrandtlIshlinskii,
    PrandtlIshlinskii,
)
from hyst.operators import Affine, DeadZone, Operator, Play

PI = PrandtlIshlinskii(p=[0.5, 0.3, -0.2], r=[0.4, 1.0, 2.0], p0=1.0)
MAP = DeadZone([0.8, 0.4, -0.3], [0.0, 1.5, -1.0])
MODELS: dict[str, Operator] = {
    "line": Affine(-2.0, 1.0),
    "pi": PI,
    "gpi": GeneralizedPrandtlIshlinskii(MAP, PI),
    "mpi with offset": Affine(1.0, -3.0) @ ModifiedPrandtlIshlinskii(PI, MAP),
    "falling": Affine(-1.0, 0.5) @ PI,
}


def wandering(seed: int, samples: int = 300) -> np.ndarray:
    """A signal with nested reversals at many levels."""
    rng = np.random.default_rng(seed)
    return np.cumsum(rng.normal(size=samples)) * 0.5


def nearest_in_reach(
    model: Operator, state: np.ndarray, wanted: float, low: float, high: float
) -> float:
    """The input in [low, high] whose output is nearest, by bisection, without any inverse."""

    def output(u: float) -> float:
        return float(model.run([u], state)[0][0])

    sign = 1.0 if output(high) > output(low) else -1.0
    if sign * output(low) >= sign * wanted:
        return low
    if sign * output(high) <= sign * wanted:
        return high
    for _ in range(80):
        middle = 0.5 * (low + high)
        if sign * output(middle) < sign * wanted:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("seed", range(3))
def test_without_limits_the_prediction_is_the_reference(name: str, seed: int) -> None:
    y_ref = wandering(seed)
    done = invert_trajectory(MODELS[name], y_ref)
    # Rounding through a dozen additions per sample; 1e-12 of the range is the project's bound.
    assert np.abs(done.y_predicted - y_ref).max() <= 1e-12 * np.ptp(y_ref)
    assert np.array_equal(done.y_predicted, MODELS[name](done.u))
    assert done.clipped == 0
    assert done.method == "exact"


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("seed", range(4))
def test_clipping_is_the_best_that_can_be_done_at_every_sample(name: str, seed: int) -> None:
    model, low, high = MODELS[name], -0.7, 1.6
    y_ref = model(wandering(seed, 120) * 1.5)
    done = invert_trajectory(model, y_ref, input_range=(low, high), outside="clip")
    state = model.initial_state()
    outputs = []
    held = 0
    for wanted in y_ref:
        u = nearest_in_reach(model, state, float(wanted), low, high)
        y, state = model.run([u], state)
        outputs.append(y[0])
        held += u in (low, high)
    assert 0 < done.clipped < y_ref.size
    assert done.clipped == held
    assert done.u.min() >= low
    assert done.u.max() <= high
    # Bisection ends within 1e-15 of the input; slopes are below 3 and memory does not amplify.
    np.testing.assert_allclose(done.y_predicted, outputs, atol=1e-12)


def test_tracking_is_exact_again_once_the_reference_is_back_in_reach() -> None:
    t = np.linspace(0.0, 4.0 * np.pi, 800)
    y_ref = 4.0 * np.sin(t)
    low, high = -1.8, 1.8
    done = invert_trajectory(PI, y_ref, input_range=(low, high), outside="clip")
    free = (done.u > low) & (done.u < high)
    assert 0.2 < free.mean() < 0.9
    assert np.abs(done.predicted_error[free]).max() < 1e-12
    # Saturating the plain inverse's command instead loses the memory: that is what must not happen.
    naive = PI(np.clip(PI.inverse()(y_ref), low, high)) - y_ref
    assert np.abs(naive[free]).max() > 0.01


def test_numbers_by_hand() -> None:
    model = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    # Rising from 0: slope 1 to u = 1, then 1.5, so y(5) = 7. Falling: slope 1 for 2, then 1.5.
    done = invert_trajectory(
        model, [0.0, 4.0, 9.0, 5.5, 3.5], input_range=(0.0, 5.0), outside="clip"
    )
    np.testing.assert_allclose(done.u, [0.0, 3.0, 5.0, 3.5, 2.0], atol=1e-14)
    np.testing.assert_allclose(done.predicted_error, [0.0, 0.0, -2.0, 0.0, 0.0], atol=1e-14)
    assert done.clipped == 1
    assert done.max_abs == pytest.approx(2.0, abs=1e-14)
    assert done.rms == pytest.approx(math.sqrt(4.0 / 5.0), abs=1e-14)
    assert done.percent_of_range(done.max_abs) == pytest.approx(100.0 * 2.0 / 9.0, abs=1e-12)


def test_a_constant_reference_has_no_percentages() -> None:
    assert invert_trajectory(PI, [1.0, 1.0]).percent_of_range(0.1) is None


@pytest.mark.parametrize("name", MODELS)
def test_the_history_sets_the_memory(name: str) -> None:
    model = MODELS[name]
    history, wanted_u = [0.0, 3.0, -1.0, 0.2], wandering(7)
    y_ref = model(np.concatenate([history, wanted_u]))[len(history) :]
    done = invert_trajectory(model, y_ref, history=history)
    np.testing.assert_allclose(done.u, wanted_u, atol=1e-12 * np.ptp(wanted_u))
    np.testing.assert_allclose(done.y_predicted, y_ref, atol=1e-12 * np.ptp(y_ref))


def test_history_holds_for_clipping_too() -> None:
    history = np.array([0.0, 3.0, -1.0])
    y_ref = 3.0 * np.sin(np.linspace(0.0, 20.0, 200))
    done = invert_trajectory(PI, y_ref, input_range=(-1.5, 1.5), outside="clip", history=history)
    whole = PI(np.concatenate([history, done.u]))[history.size :]
    free = np.abs(done.u) < 1.5
    assert done.clipped > 0
    assert np.abs(whole[free] - y_ref[free]).max() < 1e-12


@given(scale=st.floats(1e-6, 1e6), top=st.floats(0.3, 20.0))
@settings(max_examples=50, deadline=None)
def test_touching_the_end_of_the_range_is_not_outside(scale: float, top: float) -> None:
    model = Affine(scale) @ PI
    u = np.array([0.0, top, 0.1 * top, top, 0.5 * top])
    done = invert_trajectory(model, model(u), input_range=(0.0, top))
    assert done.clipped == 0
    assert done.u.max() <= top
    assert done.max_abs <= 1e-12 * np.ptp(model(u))


def test_refusal_names_sample_value_command_and_what_is_in_reach() -> None:
    model = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    with pytest.raises(InputError) as caught:
        invert_trajectory(model, [0.0, 4.0, 8.5, 10.0], input_range=(0.0, 5.0))
    message = str(caught.value)
    # By hand: 8.5 = 1.5 u - 0.5 at u = 6, 10 at u = 7, and u = 5 gives 7.
    for part in ("y_ref[2] = 8.5", "needs the input 6,", "0 to 5", "0 to 7)", "reach are 0 to 7,"):
        assert part in message


@pytest.mark.parametrize(
    ("reference", "part"),
    [
        ([0.0, math.nan], "index 1"),
        ([0.0, 1.0, -math.inf], "index 2"),
        ([], "empty"),
        ([[0.0, 1.0]], "one-dimensional"),
        (["a"], "real numbers"),
    ],
)
def test_unusable_references(reference: list[object], part: str) -> None:
    with pytest.raises(InputError, match="y_ref") as caught:
        invert_trajectory(PI, reference)  # type: ignore[arg-type]
    assert part in str(caught.value)


@pytest.mark.parametrize(
    "input_range", [(1.0, 1.0), (2.0, 1.0), (0.0, math.nan), (0.0, math.inf), (0.0, 1.0, 2.0)]
)
def test_unusable_ranges(input_range: tuple[float, float]) -> None:
    with pytest.raises(InputError, match="input_range"):
        invert_trajectory(PI, [0.0, 1.0], input_range=input_range)


def test_unknown_method_lists_those_there_are() -> None:
    with pytest.raises(InputError, match=r"'oracle'.*exact"):
        invert_trajectory(PI, [0.0], method="oracle")


def test_unknown_way_out_lists_both() -> None:
    with pytest.raises(InputError, match=r"'ignore'.*'refuse'.*'clip'"):
        invert_trajectory(PI, [0.0], outside="ignore")  # type: ignore[arg-type]


def test_a_history_that_is_not_finite_is_refused() -> None:
    with pytest.raises(InputError, match=r"history is nan at index 1"):
        invert_trajectory(PI, [0.0], history=[0.0, math.nan])


def test_no_inverse_no_command() -> None:
    with pytest.raises(NotInvertibleError, match="p0"):
        invert_trajectory(Play(1.0), [0.0, 1.0])
