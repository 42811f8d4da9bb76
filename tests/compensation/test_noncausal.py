"""Looking ahead through linear dynamics, then the exact inverse of the hysteresis."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.compensation import invert_trajectory
from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics

PI = hyst.PrandtlIshlinskii([0.3, 0.2], [0.5, 2.0], 1.0)
MIXED = LinearDynamics.from_zeros_poles_gain([1.6, 0.2], [0.5, 0.3, 0.8], -0.14, 1e-3, delay=3)


def rest_to_rest(samples: int = 2000) -> np.ndarray:
    window = np.sin(np.pi * np.linspace(0.0, 1.0, samples - 800)) ** 2
    wave = 4.0 * window * np.sin(np.linspace(0.0, 30.0, samples - 800))
    return np.concatenate([np.zeros(400), wave, np.zeros(400)])


@pytest.mark.parametrize(
    "model",
    [MIXED @ PI, PI @ MIXED, hyst.Affine(-2.0, 0.0) @ MIXED @ PI, MIXED],
    ids=["after", "before", "between", "alone"],
)
def test_a_trajectory_from_rest_to_rest_is_followed(model: hyst.Operator) -> None:
    done = invert_trajectory(model, rest_to_rest(), "noncausal")
    # Truncation of the series at 1e-12, and the gains of inverse and model.
    assert done.max_abs < 1e-8
    assert model(done.u) == pytest.approx(done.y_predicted)


def test_exact_inversion_points_to_it() -> None:
    with pytest.raises(NotInvertibleError, match="StableInverse"):
        invert_trajectory(MIXED @ PI, rest_to_rest())


def test_the_range_is_kept_or_the_sample_is_named() -> None:
    model = MIXED @ PI
    with pytest.raises(InputError, match=r"outside its range -1 to 1"):
        invert_trajectory(model, rest_to_rest(), "noncausal", input_range=(-1.0, 1.0))
    done = invert_trajectory(
        model, rest_to_rest(), "noncausal", input_range=(-1.0, 1.0), outside="clip"
    )
    assert np.abs(done.u).max() <= 1.0
    assert done.clipped > 0


def test_models_without_dynamics_are_refused() -> None:
    with pytest.raises(InputError, match="0 stages of linear dynamics"):
        invert_trajectory(PI, rest_to_rest(), "noncausal")


def test_the_error_table_splits_the_edges_from_the_interior() -> None:
    # Begins and ends on its way, where the method takes it to rest.
    y_ref = 3.0 * np.cos(np.linspace(0.0, 30.0, 2000))
    done = hyst.compensation.invert_trajectory(MIXED @ PI, y_ref, "noncausal")
    whole, inside, edges = hyst.compensation.error_parts(done)
    assert whole.max_abs == edges.max_abs == np.abs(done.predicted_error).max() > 1e-3
    # What the dynamics held at the start has decayed to 1e-9 of a signal of size 3, and a margin.
    assert inside.max_abs < 1e-8
    first, beyond = done.interior
    assert inside.name == f"samples {first} to {beyond - 1}"
    # The means of both squares, weighted by their samples, are that of the whole.
    count = beyond - first
    both = count * inside.rms**2 + (2000 - count) * edges.rms**2
    assert both == pytest.approx(2000 * whole.rms**2, rel=1e-12)
    rows = [row[0] for row in hyst.report.compensation_table(done, "um").rows]
    assert rows == [
        "inversion, rms",
        "inversion, max",
        *(f"inversion, {each}, {part.name}" for part in (inside, edges) for each in ("rms", "max")),
    ]


def test_without_edges_the_table_is_of_all_samples() -> None:
    done = hyst.compensation.invert_trajectory(hyst.Affine(2.0), [1.0, 2.0])
    assert done.interior is None
    assert [part.name for part in hyst.compensation.error_parts(done)] == [""]
    assert [row[0] for row in hyst.report.compensation_table(done, "").rows] == [
        "inversion, rms",
        "inversion, max",
    ]


def low_pass(frequency: float, damping: float) -> LinearDynamics:
    w = 2.0 * np.pi * frequency
    return LinearDynamics.from_continuous([w * w], [1.0, 2.0 * damping * w, w * w], 1e-3)


BOTH = MIXED @ PI @ low_pass(60.0, 0.5)


@pytest.mark.parametrize("behind", [MIXED, hyst.Affine(-2.0, 0.1) @ MIXED], ids=["", "and a map"])
def test_dynamics_on_both_sides_are_followed_from_rest_to_rest(behind: hyst.Operator) -> None:
    model = behind @ PI @ low_pass(60.0, 0.5)
    rest = float(model(np.zeros(1))[0])
    done = invert_trajectory(model, rest_to_rest() + rest, "noncausal")
    # As above; the noise gain of both inverses is some thousand.
    assert done.max_abs < 1e-8
    assert "of the dynamics from the output on" in done.notes[0]


def test_the_end_of_a_moving_reference_is_looked_beyond_by_both() -> None:
    """What is wanted after the record is known to rest; the command of its end must know it."""
    y_ref = rest_to_rest(4000)
    cut = int(np.abs(y_ref).argmax()) + 1
    longer = np.concatenate([y_ref[:cut], np.full(400, y_ref[cut - 1])])
    short = invert_trajectory(BOTH, longer[:cut], "noncausal").u
    # The noise gains times the rounding of the series.
    np.testing.assert_allclose(
        short, invert_trajectory(BOTH, longer, "noncausal").u[:cut], atol=1e-8
    )


def test_the_memory_behind_dynamics_goes_on_where_history_ended() -> None:
    model = PI @ low_pass(60.0, 0.5)
    before = 5.0 * np.sin(np.linspace(0.0, 20.0, 1500)) * np.linspace(1.0, 0.2, 1500)
    before = np.concatenate([before, np.full(500, before[-1])])
    y_ref = rest_to_rest() + model(before)[-1]
    assert invert_trajectory(model, y_ref, "noncausal", history=before).max_abs < 1e-8
    assert invert_trajectory(model, y_ref, "noncausal").max_abs > 0.1


def test_a_branch_taken_while_dynamics_ring_is_no_interior() -> None:
    """From rest to a level at once, a resonance overshoots, and plays behind it remember that."""
    ringing = PI @ low_pass(20.0, 0.05)
    t = np.linspace(0.0, 40.0, 6000)
    y_ref = 3.0 + 0.2 * np.sin(t)
    done = invert_trajectory(ringing, y_ref, "noncausal")
    first, beyond = done.interior
    assert np.abs(done.predicted_error[2000:-100]).max() > 1e-3
    assert first == beyond or np.abs(done.predicted_error[first:beyond]).max() < 1e-6


def test_methods_for_dynamics_on_both_sides() -> None:
    assert hyst.compensation.methods_for(BOTH) == ("noncausal",)
    flat = LinearDynamics.from_transfer_function([1.0, 1.0], [1.0, -0.5], dt=1e-3)
    assert hyst.compensation.methods_for(flat @ BOTH) == ()
    with pytest.raises(NotInvertibleError, match=r"the zero -1\+0j"):
        invert_trajectory(flat @ BOTH, rest_to_rest(), "noncausal")


def test_a_band_lets_dynamics_be_inverted_that_pass_nothing_above_it() -> None:
    """A sampled resonance has a zero next to -1: at half the sample rate it passes nothing."""
    sampled = LinearDynamics.from_zeros_poles_gain([-0.9999], [0.9 + 0.3j, 0.9 - 0.3j], 0.05, 1e-3)
    model = sampled @ PI @ low_pass(60.0, 0.5)
    with pytest.raises(NotInvertibleError, match="band below"):
        invert_trajectory(model, rest_to_rest(), "noncausal")
    done = invert_trajectory(model, rest_to_rest(8000), "noncausal", band=200.0)
    # The window is smooth: of the reference next to nothing lies above 200 Hz.
    assert done.max_abs < 1e-6
    assert "what lies below 200 Hz" in done.notes[0]
    with pytest.raises(InputError, match="'exact' knows no band"):
        invert_trajectory(PI, rest_to_rest(), band=200.0)
    with pytest.raises(InputError, match="band"):
        invert_trajectory(model, rest_to_rest(), "noncausal", band=-1.0)
