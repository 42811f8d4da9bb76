"""Good, fair and unfit: over simulated records of every kind, and what may lower a level."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hyst
from hyst.diagnosis import Finding
from hyst.operators import Verdict
from reference.family_examples import family_example
from reference.foreign_records import DRIVES, DT, FOREIGN, drive, plays, record, switching
from reference.judged_as_given import judged_as_given

NAMES = tuple(hyst.families)
SEEDS = range(3)
PLAYS = hyst.families.PrandtlIshlinskii(plays=3)


def verdict_on(
    records: hyst.Record | list[hyst.Record], family: str = "pi", **options: object
) -> Verdict:
    if family == "pi":
        options = {"plays": 3} | options
    return hyst.identify(records, family=family, delay=0, allow_unconverged=True, **options).verdict


@pytest.mark.parametrize("name", NAMES)
def test_what_a_family_leaves_of_its_own_records_is_noise(name: str) -> None:
    """Evidence of one in 100,000 for each cause: not one of these verdicts should be another."""
    example = family_example(name)
    levels = {
        (noise, seed): verdict_on(example.records(noise, seed), name, **example.options).level
        for noise in (0.003, 0.01, 0.05)
        for seed in SEEDS
    }
    assert set(levels.values()) == {"good"}, levels


@pytest.mark.parametrize("name", NAMES)
def test_a_perfect_fit_is_good(name: str) -> None:
    example = family_example(name)
    assert verdict_on(example.records(), name, **example.options).level == "good"


def test_nearly_all_own_records_are_good_whatever_the_drive() -> None:
    levels = []
    for kind in DRIVES:
        for noise in (0.003, 0.01, 0.03, 0.05):
            for seed in range(5):
                amplitude = 10.0 ** (seed - 2)
                u = drive(kind, amplitude, seed, 2500)
                y = (-1.0) ** seed * plays(amplitude, seed)(u)
                levels.append(verdict_on(record(u, y, noise, seed)).level)
    assert levels.count("good") >= 0.95 * len(levels)


def foreign(what: str) -> dict[tuple[str, float], hyst.Record | list[hyst.Record]]:
    """Give records of one kind over three drives, noises and amplitudes."""
    return {
        (kind, noise): FOREIGN[what](drive(kind, 10.0 ** (2 * seed - 1), seed), seed, noise)
        for kind in ("triangle", "decaying sine", "multisine")
        for seed, noise in enumerate((0.0, 0.002, 0.005))
    }


@pytest.mark.parametrize("what", FOREIGN)
def test_no_foreign_record_is_good_as_it_was_measured(what: str) -> None:
    levels = {key: judged_as_given(each, PLAYS).level for key, each in foreign(what).items()}
    assert "good" not in levels.values(), levels


@pytest.mark.parametrize("what", [each for each in FOREIGN if each not in ("outliers", "noise")])
def test_no_foreign_record_is_good_after_a_diagnosis(what: str) -> None:
    levels = {key: verdict_on(each).level for key, each in foreign(what).items()}
    assert "good" not in levels.values(), levels


def test_outliers_are_left_out_by_name_and_harm_nothing() -> None:
    for each in foreign("outliers").values():
        verdict = verdict_on(each)
        assert verdict.level == "good"
        assert any(line.startswith("8 samples were left out: ") for line in verdict.sentences)


def test_noise_alone_is_refused() -> None:
    for each in foreign("noise").values():
        with pytest.raises(hyst.NotIdentifiableError, match="is noise"):
            verdict_on(each)


@pytest.mark.parametrize("what", ["square", "butterfly", "noise"])
@pytest.mark.parametrize("family", ["pi", "gpi", "linear"])
def test_what_no_command_may_come_from_is_unfit(what: str, family: str) -> None:
    u = drive("decaying sine", 30.0, 4)
    options = {"plays": 3} if family == "pi" else {}
    made = dataclasses.replace(hyst.families[family], **options)
    verdict = judged_as_given(FOREIGN[what](u, 4, 0.002), made)
    assert verdict.level == "unfit"
    assert verdict.sentences[0].startswith("No command should come from this model.")
    if what != "noise":
        assert "butterfly" in verdict.sentences[0]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_damper_over_the_displacement_is_unfit_with_its_reason(sign: float) -> None:
    u = drive("sine", 10.0, 3)
    speed = np.gradient(u) / DT
    y = sign * (np.tanh(speed / 30.0) + 0.005 * speed) + 0.02 * u
    verdict = verdict_on(record(u, y, 0.01))
    assert verdict.level == "unfit"
    assert "follows the speed of the input" in verdict.sentences[0]
    assert "butterfly" not in verdict.sentences[0]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_line_is_good_on_a_line_and_unfit_on_a_wide_loop(sign: float) -> None:
    u = drive("triangle", 5.0, 1)
    assert verdict_on(record(u, sign * 3.0 * u + 1.0, 0.01), "linear").level == "good"
    assert verdict_on(record(u, sign * switching(u), 0.01), "linear").level == "unfit"


def test_a_line_on_a_narrow_loop_is_fair() -> None:
    u = drive("triangle", 5.0, 1)
    y = u + 0.3 * hyst.PrandtlIshlinskii([1.0], [1.0], 0.0)(u)
    assert verdict_on(record(u, y, 0.002), "linear").level == "fair"


def test_a_model_with_memory_that_is_hardly_better_than_a_line_is_unfit() -> None:
    """The output turns before the input, and plays turn after it."""
    u = drive("sine", 1.0, 1)
    y = u - 0.5 * hyst.PrandtlIshlinskii([1.0], [0.3], 0.0)(u)
    verdict = verdict_on(record(u, y, 0.002), weights="non-negative")
    assert verdict.level == "unfit"
    assert "hardly better than a straight line" in verdict.sentences[0]


def test_drift_and_hum_do_not_make_a_model_unfit() -> None:
    """They are none of the model, whatever a line leaves beside them."""
    u = drive("triangle", 40.0, 3)
    y = plays(40.0, 3)(u)
    t = np.arange(u.size) * DT
    for more in (0.3 * np.ptp(y) * t / t[-1], 0.15 * np.ptp(y) * np.sin(2.0 * np.pi * 50.0 * t)):
        assert verdict_on(record(u, y + more, 0.002)).level == "fair"


@pytest.mark.parametrize("pole", [0.7, 0.95])
def test_coloured_noise_is_the_records_own_where_the_drive_repeats(pole: float) -> None:
    """Without repetition nobody can tell it from what the model lacks, and that is said."""
    rng = np.random.default_rng(2)
    coloured = np.empty(4000)
    state = 0.0
    for k, each in enumerate(rng.normal(size=4000)):
        state = pole * state + each
        coloured[k] = state
    coloured *= 0.01 / coloured.std()
    again, once = drive("triangle", seed=1), drive("multisine", seed=1)
    assert verdict_on(record(again, plays()(again) + coloured)).level == "good"
    verdict = verdict_on(record(once, plays()(once) + coloured))
    assert verdict.level == "fair"
    assert any("several times" in each for each in verdict.sentences)


def test_a_few_samples_cannot_tell_noise_from_misfit() -> None:
    k = np.arange(60)
    u = np.sin(k / 3.0)
    y = u + 0.3 * np.sign(np.cos(k / 3.0))
    verdict = verdict_on(record(u, y, 0.005), plays=1)
    assert verdict.level != "good"


def test_validation_far_above_training_is_told_with_both_numbers() -> None:
    u = drive("triangle", 1.0, 1)
    true = plays(seed=1)
    other = true(0.3 * u) * 1.5
    seen = record(0.3 * u, other, 0.002, 7)
    found = hyst.identify(record(u, true(u), 0.002), family="pi", plays=3, delay=0, validation=seen)
    training, judged = found.metrics["training"].rms, found.metrics["validation"].rms
    assert judged > 3.0 * training
    assert found.verdict.level == "fair"
    first = found.verdict.sentences[0]
    assert f"{training:.3g} um" in first
    assert f"{judged:.3g} um" in first
    assert "less far" in first


def test_validation_as_good_as_training_is_not_told() -> None:
    u, v = drive("triangle", 1.0, 1), drive("decaying sine", 1.0, 2)
    true = plays(seed=1)
    found = hyst.identify(
        record(u, true(u), 0.002),
        family="pi",
        plays=3,
        delay=0,
        validation=record(v, true(v), 0.002, 3),
    )
    assert found.verdict.level == "good"


def test_a_validation_record_that_it_knows_nothing_of_is_unfit() -> None:
    u = drive("triangle", 1.0, 1)
    true = plays(seed=1)
    noise = hyst.Record(u, np.random.default_rng(1).normal(size=u.size), DT)
    found = hyst.identify(
        record(u, true(u), 0.002), family="pi", plays=3, delay=0, validation=noise
    )
    assert found.verdict.level == "unfit"


@pytest.mark.parametrize(
    ("severity", "level"), [("warning", "fair"), ("remark", "good"), ("left out", "good")]
)
def test_a_warning_of_the_diagnosis_allows_no_better_than_fair(severity: str, level: str) -> None:
    u = drive("triangle", 1.0, 1)
    said = "The output is 10 samples ahead."
    finding = Finding("output ahead of input", severity, said, samples=np.arange(10))
    verdict = judged_as_given(record(u, plays(seed=1)(u), 0.002), PLAYS, (finding,))
    assert verdict.level == level
    assert ("output ahead of input" in verdict.sentences[0]) == (severity == "warning")
    assert (f"10 samples were left out: {said}" in verdict.sentences) == (severity == "left out")


@pytest.mark.parametrize("name", ["dynamics", "rate dependence"])
@pytest.mark.parametrize("family", ["rdpi", "pi"])
def test_only_a_model_that_knows_the_rate_answers_a_warning_of_rate(name: str, family: str) -> None:
    example = family_example(family)
    made = dataclasses.replace(hyst.families[family], **example.options)
    finding = Finding(name, "warning", "the loops differ with the rate.")
    verdict = judged_as_given(example.records(0.01, 5), made, (finding,))
    assert verdict.level == ("good" if family == "rdpi" else "fair")


def test_a_model_that_knows_the_rate_and_leaves_more_than_noise_answers_nothing() -> None:
    records = [
        dataclasses.replace(each, y=each.y + 0.3 * np.abs(each.u)) for each in _rated(0.005, 6)
    ]
    finding = Finding("rate dependence", "warning", "the loops differ with the rate.")
    verdict = judged_as_given(records, hyst.families.RateDependent(plays=2), (finding,))
    assert verdict.level != "good"
    assert any("rate dependence" in each for each in verdict.sentences)


def _rated(noise: float, seed: int) -> list[hyst.Record]:
    return family_example("rdpi").records(noise, seed)


def test_a_clockwise_loop_that_is_described_is_told_and_lowers_nothing() -> None:
    clockwise = Finding("run direction", "warning", "the loop is run clockwise.", "Friction does.")
    ahead = Finding("output ahead of input", "warning", "the output turns early.")
    example = family_example("dahl")
    dahl = hyst.families.Dahl(**example.options)
    verdict = judged_as_given(example.records(0.01, 5), dahl, (clockwise,))
    assert verdict.level == "good"
    assert "The loop is run clockwise. Friction does." in verdict.sentences
    # Beside an output that is ahead of its input it would be the same thing told twice.
    verdict = judged_as_given(example.records(0.01, 5), dahl, (clockwise, ahead))
    assert verdict.level == "fair"
    assert not any("clockwise" in each for each in verdict.sentences)
    line = judged_as_given(example.records(0.01, 5), hyst.families.Linear(), (clockwise,))
    assert any("doubtful (run direction)" in each for each in line.sentences)


@pytest.mark.parametrize("what", ["drift", "hum", "square", "rate", "change", "another shape"])
@pytest.mark.parametrize("scales", [(2.0**-40, 2.0**33), (2.0**200, 2.0**-200)])
def test_levels_and_causes_do_not_depend_on_units(what: str, scales: tuple[float, float]) -> None:
    records = FOREIGN[what](drive("decaying sine", 1.0, 2), 2, 0.002)
    given = records if isinstance(records, list) else [records]
    scaled = [
        dataclasses.replace(each, u=each.u * scales[0], y=each.y * scales[1]) for each in given
    ]
    plain, other = verdict_on(given), verdict_on(scaled)
    assert other.level == plain.level
    assert len(other.sentences) == len(plain.sentences)
    # Percentages are the same to the last digit; amounts are in another unit.
    for one, two in zip(plain.sentences, other.sentences, strict=True):
        assert one.count("%") == two.count("%")
        assert [part.split()[-1] for part in one.split(" %")[:-1]] == [
            part.split()[-1] for part in two.split(" %")[:-1]
        ]


def test_an_error_along_a_constant_on_its_bound_is_not_called_noise() -> None:
    """The force of sliding is at its bound: the model cannot move as its derivative there says."""
    u = drive("triangle", 5.0, 1)
    y = u + 0.1 * hyst.PrandtlIshlinskii([1.0], [1.0], 0.0)(u)
    verdict = verdict_on(record(u, y, 0.002), "dahl")
    assert verdict.level == "fair"
    # 0.2 % of noise of some 11, where the model leaves five times that.
    assert "noise of 0.02" in verdict.sentences[0]


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_model_with_memory_that_is_worse_than_a_line_is_unfit(sign: float) -> None:
    """Far from where it starts, friction has slid; a line leaves hardly 1 % of the range."""
    t = np.linspace(0.0, 10.0, 4000)
    u = 50.0 - 50.0 * np.cos(2.0 * np.pi * t) * np.linspace(1.0, 0.15, t.size)
    y = sign * (0.5 * u - 0.04 * hyst.PrandtlIshlinskii([1.0], [15.0], 0.0)(u))
    assert verdict_on(record(u, y, 0.001), "linear").level != "unfit"
    verdict = verdict_on(record(u, y, 0.001), "dahl")
    assert verdict.level == "unfit"
    assert "A straight line describes the record better" in verdict.sentences[0]
