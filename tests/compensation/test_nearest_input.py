"""Commands of a model whose output turns."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import Affine, Butterfly, InputError, NotInvertibleError, PrandtlIshlinskii
from hyst.compensation import invert_trajectory
from hyst.compensation.suited_methods import methods_for

SWITCHING = PrandtlIshlinskii([0.6, 0.6], [0.3, 0.5])
STRAIN = Butterfly(SWITCHING, [[0.0, 0.0, 1.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.0]])
HISTORY = [1.0, -1.0, 1.0, 0.0]
RIGHT = (0.0, 1.5)


def on_the_right_wing() -> np.ndarray:
    """Minor loops on inputs above 0, where after HISTORY the strain only rises with the input."""
    t = np.arange(300) / 100.0
    return 0.5 + 0.4 * np.sin(2.0 * np.pi * t) * np.exp(-0.3 * t)


@pytest.mark.parametrize(("scale", "gain"), [(1.0, 1.0), (2.0**20, -(2.0**-30)), (0.3, 7.0)])
def test_on_one_wing_the_command_comes_back(scale: float, gain: float) -> None:
    model = Affine(gain, 3.0 * gain) @ STRAIN.in_units(scale, 1.0)
    u, history = scale * on_the_right_wing(), scale * np.array(HISTORY)
    whole = model(np.concatenate([history, u]))[history.size :]
    done = invert_trajectory(
        model, whole, "trajectory", input_range=(0.0, 1.5 * scale), history=history
    )
    # The slope is 0.2 at least over inputs up to 1: it amplifies roundings of the output tenfold.
    np.testing.assert_allclose(done.u, u, rtol=0.0, atol=1e-13 * scale)
    assert done.max_abs <= 1e-14 * abs(gain)
    assert (done.clipped, done.notes) == (0, ())


def test_a_command_that_must_change_the_wing_says_so() -> None:
    """Up to an input of 0.6 the right wing reaches 0.43; beyond that only the left one, at -0.8."""
    y_ref = np.linspace(0.25, 1.0, 50)
    done = invert_trajectory(STRAIN, y_ref, "trajectory", input_range=(-1.5, 0.6), history=HISTORY)
    assert done.max_abs < 1e-12  # rounding of an output around 1, amplified by slopes near a turn
    assert (np.diff(done.u) < -0.5).sum() == 1
    assert len(done.notes) == 1
    assert "does not reach the reference at 1 sample," in done.notes[0]
    after = STRAIN.run(HISTORY)[1]
    np.testing.assert_array_equal(STRAIN.run(done.u, after)[0], done.y_predicted)


def test_out_of_reach_is_refused_or_followed_as_closely_as_possible() -> None:
    y_ref = np.array([0.5, 5.0, 0.5])
    with pytest.raises(
        InputError, match=r"y_ref\[1\] is 5, .* reaches .* with an input of 0 to 1.5"
    ):
        invert_trajectory(STRAIN, y_ref, "trajectory", input_range=RIGHT, history=HISTORY)
    done = invert_trajectory(
        STRAIN, y_ref, "trajectory", input_range=RIGHT, history=HISTORY, outside="clip"
    )
    assert done.clipped == 1
    assert done.u[1] == 1.5
    assert done.predicted_error[2] == pytest.approx(0.0, abs=1e-12)


def test_what_is_missing_is_said() -> None:
    with pytest.raises(InputError, match="give the lowest and the highest input allowed"):
        invert_trajectory(STRAIN, [0.1], "trajectory")
    with pytest.raises(InputError, match="knows no rate limit"):
        invert_trajectory(STRAIN, [0.1], "trajectory", input_range=RIGHT, rate_limit=1.0)
    with pytest.raises(NotInvertibleError, match="not monotone"):
        invert_trajectory(STRAIN, [0.1], input_range=RIGHT)
    with pytest.raises(InputError, match="input_range"):
        invert_trajectory(STRAIN, [0.1], "trajectory", input_range=(1.0, 0.0))


def test_the_method_is_offered_for_butterflies_alone() -> None:
    assert methods_for(Affine(2.0) @ STRAIN) == ("trajectory",)
    assert methods_for(SWITCHING) == ()
    lag = hyst.LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], 0.01)
    assert "trajectory" not in methods_for(lag @ STRAIN)
