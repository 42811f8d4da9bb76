"""The main job on simulated records: what went in comes out, and the rest is said."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from simulated_records import TRUE_PI, drive, record

import hyst
from hyst.identification.fit.radius_search import _moves

ENVELOPE = hyst.DeadZone([1.0, -0.4, 0.5], [0.0, 0.25, -0.4])
GPI = hyst.GeneralizedPrandtlIshlinskii(ENVELOPE, TRUE_PI)
MPI = hyst.ModifiedPrandtlIshlinskii(TRUE_PI, hyst.DeadZone([1.0, -0.4, 0.5], [0.0, 0.5, -0.8]))


def test_recovers_a_pi_model_exactly() -> None:
    given = record(hyst.Affine(1.0, 2.5) @ TRUE_PI)
    found = hyst.identify(given, family="pi", plays=3)
    expected = [1.0, 0.5, 0.4, 0.3, 0.1, 0.3, 0.6, 2.5]
    np.testing.assert_allclose(found.parameter_values, expected, atol=1e-6)
    assert found.delay == 0
    assert found.status == "converged"
    assert found.undetermined == ()


def test_a_falling_output_has_a_negative_gain_and_is_invertible() -> None:
    given = record(hyst.Affine(-1.0, 2.5) @ TRUE_PI)
    found = hyst.identify(given, family="pi", plays=3)
    u = drive(500, seed=3)
    np.testing.assert_allclose(found.model(u), 2.5 - TRUE_PI(u), atol=1e-6)
    np.testing.assert_allclose(found.model.inverse()(found.model(u)), u, atol=1e-12)


@pytest.mark.parametrize(("family", "true"), [("gpi", GPI), ("mpi", MPI)])
def test_asymmetric_models_are_matched_by_their_family(family: str, true: hyst.Operator) -> None:
    """The knots are not where the true ones are, so a small misfit remains."""
    found = hyst.identify(record(true), family=family, plays=3, knots=12)
    symmetric = hyst.identify(record(true), family="pi", plays=3)
    assert found.metrics["training"].rms_percent < 0.3
    assert found.metrics["training"].rms < symmetric.metrics["training"].rms / 5.0


@pytest.mark.parametrize(
    ("true", "family"), [(hyst.Affine(2.0, 1.0), "linear"), (TRUE_PI, "pi"), (GPI, "gpi")]
)
def test_auto_takes_the_family_the_record_came_from(true: hyst.Operator, family: str) -> None:
    found = hyst.identify(record(true, noise=0.02))
    assert found.family == family
    families = {each.family for each in found.candidates}
    assert families >= {"linear", "pi", "gpi", "mpi"}
    assert sum(each.chosen for each in found.candidates) == 1


def test_auto_finds_the_number_of_plays() -> None:
    found = hyst.identify(record(TRUE_PI, noise=0.005), family="pi")
    assert len([name for name in found.parameter_names if ".p[" in name]) == 3


def test_the_choice_is_the_simplest_within_one_standard_error() -> None:
    found = hyst.identify(record(TRUE_PI, noise=0.02))
    best = min(found.candidates, key=lambda each: each.score)
    limit = best.score + best.standard_error
    chosen = next(each for each in found.candidates if each.chosen)
    assert chosen.score <= limit
    assert all(
        each.parameters >= chosen.parameters for each in found.candidates if each.score <= limit
    )


def test_standard_errors_cover_the_truth() -> None:
    truth = np.array([1.0, 0.5, 0.4, 0.3, 0.1, 0.3, 0.6, 0.0])
    distances = []
    for seed in range(12):
        found = hyst.identify(record(TRUE_PI, noise=0.02, seed=seed), family="pi", plays=3)
        distances.append((found.parameter_values - truth) / found.standard_errors)
    # 96 distances, standard normal if the errors are right; correlated, hence the wide margins.
    assert 0.7 < np.sqrt(np.mean(np.square(distances))) < 1.4


def test_several_records_keep_their_own_memory() -> None:
    records = [record(TRUE_PI, drive(1500, seed=seed)) for seed in (1, 2, 3)]
    found = hyst.identify(records, family="pi", plays=3)
    np.testing.assert_allclose(found.parameter_values[:4], [1.0, 0.5, 0.4, 0.3], atol=1e-6)
    assert [each.total for each in found.used] == [1500, 1500, 1500]


def test_an_unknown_history_does_not_spoil_the_fit() -> None:
    """The record starts with a memory no model starts with; it is used once that is wiped out."""
    marked = hyst.PrandtlIshlinskii(TRUE_PI.p, TRUE_PI.r, TRUE_PI.p0, z0=[-0.9, -0.7, -0.5])
    u = 0.2 * np.concatenate([np.linspace(0.0, 5.0, 100), 5.0 * np.cos(np.linspace(0.0, 60, 4000))])
    found = hyst.identify(record(marked, u), family="pi", plays=3)
    assert found.used[0].start > 0
    np.testing.assert_allclose(found.parameter_values[:4], [1.0, 0.5, 0.4, 0.3], atol=1e-6)


def test_a_single_rise_from_rest_is_used_from_its_first_sample() -> None:
    """Growing amplitude reaches its range only at the end, so no memory is assumed before it."""
    t = np.linspace(0.0, 1.0, 3000)
    found = hyst.identify(record(TRUE_PI, t * np.sin(40.0 * t)), family="pi", plays=3)
    assert found.used[0].start == 0
    np.testing.assert_allclose(found.parameter_values[:4], [1.0, 0.5, 0.4, 0.3], atol=1e-6)


def test_given_radii_are_kept_and_unreachable_ones_left_out() -> None:
    found = hyst.identify(record(TRUE_PI), family="pi", radii=[0.1, 0.3, 0.6, 1.5])
    radii = [
        value
        for name, value in zip(found.parameter_names, found.parameter_values, strict=True)
        if ".r[" in name
    ]
    np.testing.assert_array_equal(radii, [0.1, 0.3, 0.6])
    assert len(found.undetermined) == 1
    assert "1.5" in found.undetermined[0]


def test_idle_plays_are_left_out_and_said() -> None:
    found = hyst.identify(record(hyst.PrandtlIshlinskii([0.5], [0.3], 1.0)), family="pi", plays=6)
    assert "of 6 plays" in found.undetermined[0]
    np.testing.assert_allclose(found.model(drive()), 0.0 * drive() + found.model(drive()))
    assert found.metrics["training"].rms < 1e-6


def test_a_family_the_records_cannot_serve_is_left_out_of_a_comparison_and_said() -> None:
    """A slow sweep excites no impulse response; "is it hysteresis?" still has an answer."""
    swept, families = record(TRUE_PI, noise=0.01), "linear,pi,hammerstein"
    found = hyst.identify(swept, family=families, delay=0, fir_order=64)
    assert {each.family for each in found.candidates} == {"linear", "pi"}
    assert found.family == "pi"
    assert [each[:30] for each in found.undetermined] == ["hammerstein is not compared: th"[:30]]


def test_a_family_the_records_cannot_serve_is_refused_where_it_is_alone() -> None:
    with pytest.raises(hyst.NotIdentifiableError, match=r"impulse response|persistently exciting"):
        hyst.identify(record(TRUE_PI, noise=0.01), family="hammerstein", fir_order=64)


def test_a_record_without_dynamics_is_not_given_any_in_a_comparison() -> None:
    found = hyst.identify(record(TRUE_PI, noise=0.01), family="linear,pi,hammerstein", delay=0)
    assert "hammerstein" in {each.family for each in found.candidates}
    assert found.family == "pi"


def test_a_record_too_short_for_dynamics_can_be_compared_without_them() -> None:
    u = np.array([0.0, 1.0] * 8)
    found = hyst.identify(hyst.Record(u, 2.0 * u, 1e-3), family="linear,hammerstein", delay=0)
    assert found.family == "linear"
    assert "usable samples are too few to tell dynamics" in found.undetermined[0]


def test_many_idle_plays_make_no_more_moves_than_as_many_at_work() -> None:
    """Plays without weight are as good as each other: one of them is tried in the gaps."""
    plays = 40
    bounds = SimpleNamespace(lower=np.zeros(2 * plays + 2), upper=np.full(2 * plays + 2, 2.0))
    radii, kinks = np.linspace(0.1, 1.9, plays), np.linspace(0.0, 2.0, 9)
    idle, at_work = (
        sum(1 for _ in _moves(bounds, np.r_[1.0, np.full(plays, weight), radii, 0.0], plays, kinks))
        for weight in (0.0, 1.0)
    )
    assert at_work < idle <= at_work + plays + 1


def test_validation_records_are_judged_with_and_without_offset() -> None:
    training, other = record(TRUE_PI), record(hyst.Affine(1.0, 0.25) @ TRUE_PI, drive(seed=9))
    found = hyst.identify(training, family="pi", plays=3, validation=[other, training])
    assert found.metrics["validation 1"].rms == pytest.approx(0.25, abs=1e-6)
    assert found.metrics["validation 1, free offset"].rms == pytest.approx(0.0, abs=1e-6)
    assert found.metrics["validation 2"].rms == pytest.approx(0.0, abs=1e-6)


def test_predict_adds_the_delay() -> None:
    given = record(TRUE_PI, delay=3)
    found = hyst.identify(given, family="pi", plays=3)
    assert found.delay == 3
    np.testing.assert_allclose(found.predict(given.u)[3:], given.y[3:], atol=1e-6)


def test_the_result_is_the_same_every_time() -> None:
    given = record(MPI, noise=0.01)
    first, second = (hyst.identify(given, family="mpi", plays=2) for _ in range(2))
    np.testing.assert_array_equal(first.parameter_values, second.parameter_values)


def test_scaling_input_and_output_scales_the_model() -> None:
    """Volts to kilovolts and micrometres to metres: nothing in the fit has units."""
    given = record(TRUE_PI, noise=0.01)
    scaled = hyst.Record(1e-3 * given.u, 1e-6 * given.y, given.dt)
    plain, small = (hyst.identify(each, family="pi", plays=3) for each in (given, scaled))
    # Both stop within 1e-3 of a residual variance of the minimum.
    np.testing.assert_allclose(
        small.parameter_values[:4], 1e-3 * plain.parameter_values[:4], rtol=1e-3
    )
    np.testing.assert_allclose(
        small.parameter_values[4:7], 1e-3 * plain.parameter_values[4:7], rtol=1e-3
    )


def test_progress_tells_each_step() -> None:
    steps: list[str] = []
    hyst.identify(record(TRUE_PI), family="pi", progress=steps.append)
    assert steps[0] == "diagnosis"
    assert steps[-1] == "verdict"


def test_summary_and_dictionary_hold_the_numbers() -> None:
    found = hyst.identify(record(TRUE_PI, noise=0.01), family="pi", plays=3)
    content = found.to_dict()
    assert content["family"] == "pi"
    assert content["metrics"]["training"]["rms"] == found.metrics["training"].rms
    assert len(content["parameters"]) == 8
    assert "prandtl_ishlinskii.r[3]" in found.summary()
