"""Friction from displacement and force: what is found, what is left out, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst import Affine, LuGre, MaxwellSlip, NotIdentifiableError, Record
from reference.family_examples import DT, FamilyExample, decaying, family_example

Array = NDArray[np.float64]


def triangle(strokes: int = 8, samples: int = 1600) -> Array:
    """One speed, up and down."""
    return np.asarray(
        2.0 / np.pi * np.arcsin(np.sin(np.pi * strokes * np.arange(samples) / samples))
    )


def record_of(model: hyst.Operator, u: Array, noise: float = 0.005, seed: int = 0) -> Record:
    y = model(u)
    scatter = np.random.default_rng(seed).normal(size=u.size)
    return Record(u, y + noise * float(np.ptp(y)) * scatter, DT)


def over_the_bound(example: FamilyExample, name: str, runs: int) -> float:
    """Error of all constants over their Cramer-Rao bounds, in the mean square."""
    u, truth = example.drives[0], example.model.parameters()
    fits = [
        hyst.identify(example.records(0.005, seed), family=name, delay=0, **example.options)
        for seed in range(100, 100 + runs)
    ]
    places = [truth.names.index(each) for each in fits[0].parameter_names]
    scatter = 0.005 * float(np.ptp(example.model(u)))
    rows = example.model.jacobian(u)[fits[0].used[0].start :, places]
    bound = scatter * np.sqrt(np.diag(np.linalg.inv(rows.T @ rows)))
    errors = np.array([fit.parameter_values for fit in fits]) - truth.values[places]
    return float(np.sqrt(np.mean(np.square(errors / bound))))


@pytest.mark.parametrize(("name", "runs"), [("lugre", 20), ("maxwell-slip", 40)])
def test_errors_are_those_of_the_cramer_rao_bound(name: str, runs: int) -> None:
    # Of constants that hang together 20 runs know a ratio to 10 %, 40 to 7 %; 200 gave 1.08 for the
    # springs. Below 0.8 something else than the records would tell the constants.
    assert 0.8 < over_the_bound(family_example(name), name, runs) < 1.2


@pytest.mark.parametrize(
    ("friction", "free"),
    [
        (LuGre(30.0, 0.02, 0.0, 1.0, 1.0, 1.0, DT), set()),
        (LuGre(30.0, 0.02, 0.03, 1.0, 1.6, 5.0, DT), {"vs"}),
        (LuGre(30.0, 0.02, 0.02, 1.0, 1.0, 1.0, DT, Fv=0.6, vv=4.0), {"vv"}),
    ],
    ids=["neither", "stribeck", "saturating"],
)
@pytest.mark.parametrize(("in_size", "out_size", "sign"), [(1.0, 1.0, 1.0), (3e-6, 470.0, -1.0)])
def test_terms_that_are_there_are_found_and_others_left_out(
    friction: LuGre, free: set[str], in_size: float, out_size: float, sign: float
) -> None:
    model = Affine(sign, 0.2 * out_size) @ friction.in_units(in_size, out_size)
    found = hyst.identify(record_of(model, in_size * decaying()), family="lugre")
    names = {each.rpartition(".")[2] for each in found.parameter_names}
    assert names & {"vs", "vv"} == free
    assert found.verdict.level == "good"
    slow = 0.5 * in_size * decaying(3000, 3.0)
    # A fifth of the noise, on another motion: nine constants of 1300 samples with 0.5 % each.
    left = found.model(slow) - model(slow)
    assert float(np.std(left)) < 1e-3 * float(np.ptp(model(slow)))


def test_no_term_is_kept_for_the_rounding_it_describes() -> None:
    friction = LuGre(30.0, 0.02, 0.03, 1.0, 1.6, 5.0, DT)
    t = np.arange(1500) * 1e-3
    u = np.exp(-t) * np.sin(8.0 * np.pi * t)
    found = hyst.identify(Record(u, friction(u), DT), family="lugre", delay=0)
    assert "lugre.vs" in found.parameter_names
    assert "lugre.vv" not in found.parameter_names


def test_one_velocity_tells_no_curve_over_it() -> None:
    record = record_of(LuGre(30.0, 0.0, 0.01, 1.0, 1.5, 5.0, DT), triangle())
    found = hyst.identify(record, family="lugre")
    assert not any(each.endswith(".vs") for each in found.parameter_names)
    assert any("slide at one velocity" in each for each in found.undetermined)
    for option in ({"stribeck": "free"}, {"viscosity": "saturating"}):
        with pytest.raises(NotIdentifiableError, match=r"slide at one velocity .* give"):
            hyst.identify(record, family="lugre", **option)


def test_two_velocities_of_opposite_directions_are_one() -> None:
    up = np.linspace(-1.0, 1.0, 200, endpoint=False)
    down = np.linspace(1.0, -1.0, 80, endpoint=False)
    u = np.tile(np.concatenate([up, down]), 6)
    record = record_of(LuGre(30.0, 0.0, 0.01, 1.0, 1.5, 5.0, DT), u)
    with pytest.raises(NotIdentifiableError, match="slide at one velocity"):
        hyst.identify(record, family="lugre", stribeck="free")


@pytest.mark.parametrize("name", ["lugre", "maxwell-slip"])
def test_a_record_without_sliding_is_refused(name: str) -> None:
    y = 2.0 * decaying() + 0.01 * np.random.default_rng(3).normal(size=1500)
    with pytest.raises(NotIdentifiableError, match=r"slid.* drive further"):
        hyst.identify(Record(decaying(), y, DT), family=name, delay=0)


def test_a_damping_that_is_given_is_kept_in_every_unit() -> None:
    friction = LuGre(30.0, 0.02, 0.03, 1.0, 1.0, 1.0, DT)
    for size in (1.0, 2.0**20):
        record = record_of(friction.in_units(1.0, size), decaying())
        found = hyst.identify(record, family="lugre", sigma1=0.02 * size, delay=0)
        constants = dict(
            zip(found.model.parameters().names, found.model.parameters().values, strict=True)
        )
        # Powers of two scale it exactly.
        assert constants["lugre.sigma1"] == 0.02 * size
        assert not any(each.endswith("sigma1") for each in found.parameter_names)


def test_friction_that_could_give_energy_away_is_told() -> None:
    friction = LuGre(30.0, 0.1, 0.0, 1.0, 1.6, 5.0, DT)
    assert friction.passivity_margin() < 0.0
    found = hyst.identify(record_of(friction, decaying()), family="lugre")
    assert any("not passive" in each for each in found.undetermined)


def test_springs_that_all_slide_have_no_inverse_and_it_is_told() -> None:
    record = record_of(MaxwellSlip([5.0, 3.0], [0.25, 0.6]), decaying())
    fits = [
        hyst.identify(
            record_of(MaxwellSlip([5.0, 3.0], [0.25, 0.6]), decaying(), seed=seed),
            family="maxwell-slip",
            plays=2,
            delay=0,
        )
        for seed in range(6)
    ]
    held = [each for each in fits if each.parameter_values[0] == 0.0]
    assert record.u.size == 1500
    assert held  # on average every second one
    for each in held:
        assert any(note.startswith("k0 came out 0") for note in each.undetermined)
        assert not each.model.is_invertible()


def test_elements_given_by_their_ways_keep_them() -> None:
    record = record_of(MaxwellSlip([5.0, 3.0], [0.25, 0.6], 0.5), decaying())
    found = hyst.identify(record, family="maxwell-slip", radii=[0.05, 0.2], delay=0)
    springs = found.model.parts[0]
    # f / k of f = k r: two roundings.
    np.testing.assert_allclose(springs.f / springs.k, [0.05, 0.2], rtol=1e-15)
    # Stated errors of a percent.
    np.testing.assert_allclose(springs.k, [5.0, 3.0], rtol=0.05)


@pytest.mark.parametrize(
    ("training", "others"), [("B.5", ("B.1", "B.8")), ("B.8", ("B.1", "B.5")), ("A.1", ("A.5",))]
)
def test_a_magneto_rheological_damper_at_another_amplitude(
    measured_data: Path, training: str, others: tuple[str, ...]
) -> None:
    def damper(name: str) -> Record:
        path = measured_data / "mr-damper" / f"ensaio.{name}.mat"
        return hyst.read_record(path, input="dist", output="forc", rate=100.0)

    found = hyst.identify(
        damper(training), family="lugre", validation=[damper(each) for each in others]
    )
    errors = [
        each.rms_percent
        for name, each in found.metrics.items()
        if name.startswith("validation") and "offset" not in name
    ]
    assert len(errors) == len(others)
    # Demanded are 5 %; measured 2.6 to 4.6. A linear viscosity leaves 5.6 to 6.8.
    assert max(errors) < 5.0
