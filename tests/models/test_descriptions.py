"""What the numbers of a model mean goes wherever the model goes, and is no part of what it is."""

from __future__ import annotations

import copy
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import hyst
from hyst import InputError, ModelDescription
from hyst.control import TrackingController
from hyst.online import AdaptiveInverse, JointEstimator, RadiusEstimator
from hyst.operators import Provenance, Verdict

ORIGIN = Provenance(
    date="2026-01-31T12:00:00+00:00",
    data_sha256="0123456789abcdef" * 4,
    versions={"hyst": "0.2.0", "python": "3.11.2"},
    options={"family": "pi", "radii": [0.5, 1.0], "validation": None},
    command="hyst identify 'my data.csv' --input 0",
)
UNFIT = Verdict("unfit", ("A line is hardly worse.", "Record a loop."))
ABOUT = ModelDescription(
    "drive",
    "position",
    "V",
    "um",
    input_low=0.0,
    input_high=100.0,
    dt=0.001,
    delay=2,
    family="pi",
    errors={"training": {"rms": 0.25, "rms_percent": 1.5, "max_abs": 0.75}},
    provenance=ORIGIN,
    verdict=UNFIT,
    delay_interval=(1.75, 2.5),
    smallest_swing=5.0,
)
PLAYS = hyst.PrandtlIshlinskii([0.5], [1.0], p0=1.0)


def joint() -> JointEstimator:
    estimator = JointEstimator(PLAYS, dt=0.001)
    for u in (1.0, 3.0, -2.0):
        estimator.update(u, 1.5 * u)
    return estimator


def described(thing: Any) -> Any:
    """Give the thing with ``ABOUT``: what is frozen as a copy, what estimates as it is."""
    if hasattr(thing, "with_description"):
        return thing.with_description(ABOUT)
    thing.description = ABOUT
    return thing


THINGS: dict[str, Callable[[], Any]] = {
    "operator": lambda: PLAYS,
    "composition": lambda: hyst.Affine(2.0) @ PLAYS,
    "controller": lambda: TrackingController([], [], [], [1.0, -1.0], 1.0, PLAYS),
    "joint": joint,
    "radius": lambda: RadiusEstimator([0.5], [1.0], 1.0, 1.0),
    "inverse": lambda: AdaptiveInverse(joint(), window=1.0),
}


@pytest.fixture(params=sorted(THINGS))
def thing(request: pytest.FixtureRequest) -> Any:
    return THINGS[request.param]()


def test_at_first_there_is_nothing_to_say(thing: Any) -> None:
    assert thing.description == ModelDescription()


def test_it_is_saved_and_loaded(thing: Any, tmp_path: Path) -> None:
    path = tmp_path / "thing.json"
    described(thing).save(path)
    found = hyst.load(path)
    assert type(found) is type(thing)
    assert found.description == ABOUT
    other = ModelDescription(input_unit="A")
    found.save(path, other)
    assert found.description == ABOUT
    assert hyst.load(path).description == other


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))]
)
def test_copies_carry_it(thing: Any, again: Callable[[Any], Any]) -> None:
    assert again(thing).description == ModelDescription()
    found = again(described(thing))
    assert found.description == ABOUT
    if isinstance(thing, JointEstimator):
        found.update(-4.0, -6.0)  # a copy has a state of its own
        assert found.counts["used"] == thing.counts["used"] + 1


@pytest.mark.parametrize("name", ["operator", "composition", "controller"])
def test_equality_and_hashing_pass_it_over(name: str) -> None:
    plain = THINGS[name]()
    told = described(plain)
    assert plain.description == ModelDescription()
    assert told == plain
    assert hash(told) == hash(plain)
    assert told.to_dict() == plain.to_dict()


def test_an_inverse_means_the_same_with_the_signals_exchanged() -> None:
    about = PLAYS.with_description(ABOUT).inverse().description
    assert (about.input_name, about.input_unit) == ("position", "um")
    assert (about.output_name, about.output_low, about.output_high) == ("drive", 0.0, 100.0)
    assert about.provenance == ORIGIN
    assert about.is_inverse
    assert about.errors == ABOUT.errors  # of the model that is inverted, whose output is the input
    assert about.smallest_swing is None  # of what is the output here
    assert about.verdict == UNFIT  # what is wrong about the model is wrong about its inverse
    assert about.delay_interval == (1.75, 2.5)
    assert about.is_inverse
    assert not about.of_inverse().is_inverse
    assert PLAYS.inverse().description == ModelDescription(is_inverse=True)
    assert PLAYS.inverse().inverse().description == ModelDescription()


def test_what_is_estimated_anew_has_neither_the_errors_nor_the_origin_of_its_start() -> None:
    estimator = JointEstimator(PLAYS.with_description(ABOUT), dt=0.001)
    for about in (estimator.description, estimator.model.description):
        assert (about.input_unit, about.delay, about.dt) == ("V", 2, 0.001)
        assert about.errors == {}
        assert about.provenance is None
        assert about.verdict == UNFIT  # estimation changes constants, not the shape
    inverse = AdaptiveInverse(estimator, window=1.0, despite_verdict=True)
    assert inverse.model.description == inverse.good_model.description == estimator.description


def test_only_what_is_unfit_of_the_start_stays_with_an_estimate() -> None:
    good = ModelDescription(verdict=Verdict("good", ("What is left is noise.",)))
    assert JointEstimator(PLAYS.with_description(good)).description.verdict is None
    assert good.of_other_constants().verdict is None
    assert ABOUT.of_other_constants().verdict is None


@pytest.mark.parametrize(
    "command_from",
    [
        lambda model, **how: AdaptiveInverse(JointEstimator(model), 1.0, **how),
        lambda model, **how: TrackingController(
            [], [], [], [1.0, -1.0], 1.0, model.inverse(), **how
        ),
        lambda model, **how: TrackingController.from_continuous(
            1.0, 1.0, inverse=model.inverse(), **how
        ),
        lambda model, **how: TrackingController(
            *([], [], [], [1.0, -1.0], 1.0),
            hyst.compensation.reduce_inverse(model, 1, 5.0),
            **how,
        ),
        lambda model, **how: hyst.compensation.invert_trajectory(model, [0.0, 1.0], **how),
    ],
)
def test_no_command_comes_from_what_is_unfit_unless_told(command_from: Callable[..., Any]) -> None:
    unfit = PLAYS.with_description(ModelDescription(verdict=UNFIT))
    with pytest.raises(InputError, match=r"unfit: A line is hardly worse; .*--despite-verdict"):
        command_from(unfit)
    command_from(unfit, despite_verdict=True)
    for level in ("fair", "good"):
        judged = Verdict(level, ("Something is left.",))  # type: ignore[arg-type]
        command_from(PLAYS.with_description(ModelDescription(verdict=judged)))
    command_from(PLAYS)  # nobody judged it


def test_saved_and_copied_what_is_unfit_comes_back_as_it_is(tmp_path: Path) -> None:
    unfit = PLAYS.with_description(ABOUT)
    inverse = AdaptiveInverse(JointEstimator(unfit), 1.0, despite_verdict=True)
    controller = TrackingController(
        [], [], [], [1.0, -1.0], 1.0, unfit.inverse(), despite_verdict=True
    )
    for each in (inverse, controller):
        each.save(tmp_path / "saved.json")
        assert type(hyst.load(tmp_path / "saved.json")) is type(each)
        assert type(copy.deepcopy(each)) is type(each)


@pytest.mark.parametrize("description", [None, ModelDescription()])
def test_exports_refuse_what_is_unfit(description: ModelDescription | None, tmp_path: Path) -> None:
    inverse = PLAYS.with_description(ABOUT).inverse()
    exports: dict[str, Callable[..., Any]] = {
        "c": hyst.export.c_project,
        "mex": hyst.export.mex,
        "model.fmu": lambda *given, **how: hyst.export.fmu(*given, binary=False, **how),
    }
    for name, export in exports.items():
        with pytest.raises(InputError, match=r"nothing is exported.*unfit: A line is hardly"):
            export(inverse, tmp_path / name, description=description)
        assert not (tmp_path / name).exists()
        export(inverse, tmp_path / name, description=description, despite_verdict=True)
        assert (tmp_path / name).exists()
    if description is None:
        for name in ("c", "mex"):
            readme = (tmp_path / name / "README.md").read_text()
            assert "| verdict | unfit: A line is hardly worse. |" in readme
    with pytest.raises(InputError, match="nothing is exported"):
        hyst.export.c_project(PLAYS, tmp_path / "told", description=ABOUT)
    with pytest.raises(InputError, match="nothing is exported"):
        hyst.export.c_project(JointEstimator(PLAYS.with_description(ABOUT)), tmp_path / "joint")


def test_exports_take_it_from_the_model(tmp_path: Path) -> None:
    model = PLAYS.with_description(ABOUT)
    told = hyst.export.c_project(model, tmp_path / "told", despite_verdict=True)
    given = hyst.export.c_project(
        PLAYS, tmp_path / "given", description=ABOUT, despite_verdict=True
    )
    for file in told.files:
        assert (told.path / file).read_bytes() == (given.path / file).read_bytes()
    assert "drive in V" in (told.path / "stage.h").read_text()
    other = hyst.export.c_project(
        model,
        tmp_path / "other",
        description=ModelDescription(input_unit="A"),
        despite_verdict=True,
    )
    assert "u in A" in (other.path / "stage.h").read_text()
    inverse = hyst.export.mex(model.inverse(), tmp_path / "inverse", despite_verdict=True)
    assert "position" in (inverse.path / "stage.m").read_text()


@pytest.mark.parametrize("export", ["c_project", "fmu", "mex"])
def test_further_arguments_of_exports_are_named(export: str, tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="positional"):
        getattr(hyst.export, export)(PLAYS, tmp_path / "out.fmu", "2.0")


def test_a_person_can_read_where_it_comes_from(tmp_path: Path) -> None:
    PLAYS.with_description(ABOUT).save(tmp_path / "model.json")
    text = (tmp_path / "model.json").read_text(encoding="utf-8")
    assert (
        '    "errors": {\n'
        '      "training": {\n'
        '        "rms": 0.25,\n'
        '        "rms_percent": 1.5,\n'
        '        "max_abs": 0.75\n'
        "      }\n"
        "    },\n"
        '    "provenance": {\n'
        '      "date": "2026-01-31T12:00:00+00:00",\n'
    ) in text
    assert '"radii": [0.5, 1.0],' in text


def changed(**changes: Any) -> dict[str, Any]:
    about = ABOUT.to_dict()
    return about | {"provenance": about["provenance"] | changes}


@pytest.mark.parametrize(
    ("description", "message"),
    [
        (changed(data_sha256="12"), "data_sha256 is '12'; give 64 hexadecimal digits"),
        (changed(date="yesterday"), "date is 'yesterday'; give a date in UTC"),
        (changed(date="2026-01-31T12:00:00+01:00"), "give a date in UTC"),
        (changed(date="2026-01-31"), "give a date in UTC"),
        (changed(versions={"hyst": 2}), r"versions\.hyst is 2; give text"),
        (changed(versions=["0.2.0"]), "versions is .* give a mapping"),
        (changed(command=None), "command is None; give text"),
        (changed(user="me"), "unknown entry 'user' in 'provenance'"),
        ({"provenance": {"date": "2026-01-31T12:00:00+00:00"}}, "'data_sha256' is missing"),
        ({"provenance": "mine"}, "provenance is 'mine'; give a mapping"),
        ({"provenance": None}, "'provenance' in 'description' is null"),
        ({"errors": []}, r"errors is \[\]; give a mapping"),
        ({"errors": {"training": 0.5}}, "errors of 'training' is 0.5; give a mapping"),
        ({"errors": {"training": {"mean": 0.5}}}, "unknown error 'mean' of 'training'"),
        ({"errors": {"training": {"rms": "small"}}}, "rms of 'training' in errors is 'small'"),
    ],
)
def test_entries_that_mean_nothing_are_refused(
    description: dict[str, Any], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "model.json"
    PLAYS.save(path)
    content = json.loads(path.read_text())
    path.write_text(json.dumps({**content, "description": description}))
    with pytest.raises(InputError, match=message) as refused:
        hyst.load(path)
    assert "\n" not in str(refused.value)
    assert str(path) in str(refused.value)


@pytest.mark.parametrize("place", ["errors", "options"])
@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e999"])
def test_numbers_that_are_not_finite_are_refused(place: str, number: str, tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    PLAYS.with_description(ABOUT).save(path)
    old = {"errors": '"rms": 0.25', "options": "[0.5, 1.0]"}[place]
    text = path.read_text()
    assert old in text
    new = f'"rms": {number}' if place == "errors" else f"[0.5, {number}]"
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match="is not finite in double precision"):
        hyst.load(path)
    with pytest.raises(InputError, match=r"rms of 'training' in errors is nan"):
        ModelDescription(errors={"training": {"rms": float("nan")}})


def test_only_a_description_is_carried() -> None:
    with pytest.raises(InputError, match="the description is a dict; give a ModelDescription"):
        PLAYS.with_description({"input_unit": "V"})  # type: ignore[arg-type]


def test_what_it_was_made_of_may_change_afterwards() -> None:
    figures = {"rms": 1.0}
    about = ModelDescription(errors={"training": figures})
    figures["rms"] = 2.0
    assert about.errors["training"]["rms"] == 1.0
    assert hash(about) == hash(ModelDescription(errors={"training": {"rms": 1.0}}))
