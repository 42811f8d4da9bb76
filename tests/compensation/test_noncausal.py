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
