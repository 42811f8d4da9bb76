"""Model files: readable, exact, and refused in one sentence when anything is wrong with them."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hyst import (
    Affine,
    Composition,
    DeadZone,
    GeneralizedPrandtlIshlinskii,
    InputError,
    ModifiedPrandtlIshlinskii,
    Operator,
    Play,
    PrandtlIshlinskii,
    load,
)
from hyst.operators import ModelDescription, Verdict

BANK = PrandtlIshlinskii([0.5, 0.25], [1.0, 2.0], p0=0.3, z0=[0.5, 0.25])
ZONE = DeadZone([1.0, 0.5], [0.0, 1.5])
MODEL = (
    Affine(2.0, -1.0)
    @ ModifiedPrandtlIshlinskii(BANK, ZONE)
    @ GeneralizedPrandtlIshlinskii(ZONE, BANK)
)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "model.json"


def assert_refused(file: Path, what: str) -> None:
    with pytest.raises(InputError, match=what) as refusal:
        load(file)
    message = str(refusal.value)
    assert "\n" not in message
    assert file.name in message


def test_a_person_can_read_it(file: Path) -> None:
    BANK.save(file, ModelDescription(input_name="drive", input_unit="V", dt=0.005, delay=2))
    assert file.read_text(encoding="utf-8") == (
        "{\n"
        '  "format": "hyst model",\n'
        '  "version": 3,\n'
        '  "description": {\n'
        '    "input_name": "drive",\n'
        '    "output_name": "y",\n'
        '    "input_unit": "V",\n'
        '    "output_unit": "",\n'
        '    "dt": 0.005,\n'
        '    "delay": 2,\n'
        '    "family": ""\n'
        "  },\n"
        '  "model": {\n'
        '    "kind": "prandtl-ishlinskii",\n'
        '    "p0": 0.3,\n'
        '    "p": [0.5, 0.25],\n'
        '    "r": [1.0, 2.0],\n'
        '    "z0": [0.5, 0.25]\n'
        "  }\n"
        "}\n"
    )


def test_the_file_is_replaced_whole(file: Path) -> None:
    Play(1.0).save(file)
    Play(2.0).save(file)
    assert load(file) == Play(2.0)
    assert [each.name for each in file.parent.iterdir()] == ["model.json"]


def test_where_no_file_can_be(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder; name a file"):
        MODEL.save(tmp_path)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "notes").write_text("")
    with pytest.raises(InputError, match=r"notes is a file; name a folder"):
        MODEL.save(tmp_path / "notes" / "deep" / "model.json")


def test_folders_on_the_way_are_made(tmp_path: Path) -> None:
    path = tmp_path / "results" / "run 1" / "model.json"
    MODEL.save(path)
    assert load(path) == MODEL
    assert [each.name for each in path.parent.iterdir()] == ["model.json"]


@pytest.mark.parametrize(
    "description",
    [
        ModelDescription(),
        ModelDescription("U/V", "x [ 1 2 ]", "µm", "日本 \"'\\\n[\n 1\n]", family="mpi"),
        ModelDescription(input_low=-4.9e-21, input_high=1e300, output_low=5e-324, output_high=0.1),
        ModelDescription(dt=1.0 / 3.0, delay=7),
        ModelDescription(delay=-1.0 / 3.0, delay_interval=(-0.7, 2), smallest_swing=5e-324),
        ModelDescription(verdict=Verdict("unfit", ("Two loops, one µm apart.", "Record anew."))),
    ],
)
def test_descriptions_come_back(file: Path, description: ModelDescription) -> None:
    MODEL.save(file, description)
    found = load(file)
    assert found == MODEL
    assert found.description == description


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"dt": float("nan")}, "dt is nan; give a finite number"),
        ({"input_low": float("inf")}, "input_low is inf"),
        ({"input_high": "5"}, "input_high is '5'; give a finite number"),
        ({"output_low": True}, "output_low is True; give a finite number"),
        ({"delay": float("inf")}, r"delay is inf; give a finite number"),
        ({"delay": None}, "delay is None; give a finite number"),
        ({"delay": True}, "delay is True"),
        ({"input_unit": 5}, "input_unit is 5; give text"),
        ({"input_name": None}, "input_name is None; give text"),
        ({"delay_interval": (2.0, 1.0)}, r"delay_interval is \(2\.0, 1\.0\); give the lower"),
        ({"delay_interval": (2.0,)}, "delay_interval is .*; give two numbers"),
        ({"delay_interval": 2.0}, r"delay_interval is 2\.0; give two numbers"),
        ({"smallest_swing": 0.0}, r"smallest_swing is 0\.0; give a way above 0"),
        ({"verdict": "unfit"}, "a verdict has the entries 'level' and 'sentences'"),
        ({"verdict": {"level": "bad", "sentences": ["No."]}}, "the level of a verdict is 'bad'"),
        ({"output_name": "\ud800"}, "output_name is .*; give text"),
    ],
)
def test_descriptions_that_are_none(entries: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        ModelDescription(**entries)


def test_no_file(file: Path, tmp_path: Path) -> None:
    assert_refused(file, "cannot be read: No such file")
    assert_refused(tmp_path, "cannot be read: Is a directory")
    assert_refused(tmp_path / "model.json" / "deeper", "cannot be read")
    with pytest.raises(InputError, match="cannot be read: embedded null"):
        load("model\0.json")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "not JSON: line 1, column 1"),
        (b"{", "not JSON: line 1, column 2"),
        (b"\x00\x01\x02", "not JSON"),
        (b"\x89PNG\r\n\x1a\n\xff", "cannot be read: .*utf-8"),
        ("\ufeff{}".encode(), "not JSON"),
        (b"null", "not a model file"),
        (b"[]", "not a model file"),
        (b'"hyst model"', "not a model file"),
        (b"1e999", "the number 1e999 is not finite"),
        (b"{} {}", "not JSON: line 1, column 4"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"a":' * 100_000, "nested too deeply"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_no_model_file(file: Path, content: bytes, message: str) -> None:
    file.write_bytes(content)
    assert_refused(file, message)


def test_no_truncated_file_is_taken(file: Path) -> None:
    MODEL.save(file)
    whole = file.read_bytes()
    for length in range(0, len(whole) - 2, 7):  # the last two bytes are the brace and a line feed
        file.write_bytes(whole[:length])
        assert_refused(file, "not JSON")


def changed(file: Path, change: Callable[[dict[str, Any]], None], model: Operator = MODEL) -> None:
    model.save(file)
    content = json.loads(file.read_text(encoding="utf-8"))
    change(content)
    file.write_text(json.dumps(content), encoding="utf-8")


def entry(*path: str | int, value: Any) -> Callable[[dict[str, Any]], None]:
    """A change of one entry; `...` takes it away."""

    def change(content: Any) -> None:
        for key in path[:-1]:
            content = content[key]
        if value is ...:
            del content[path[-1]]
        else:
            content[path[-1]] = value

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            entry("format", value=...),
            "not a model file; its entry 'format' must be 'hyst model' or",
        ),
        (entry("format", value="hyst"), "not a model file"),
        (
            entry("version", value=...),
            "version None of the model file; this hyst reads versions 1, 2, 3, 4 and 5",
        ),
        (entry("version", value=6), "version 6 of the model file"),
        (entry("version", value="1"), "version '1'"),
        (entry("version", value=1.0), r"version 1\.0"),
        (entry("version", value=True), "version True"),
        (entry("model", value=...), "the entry 'model' is missing"),
        (entry("description", value=...), "the entry 'description' is missing"),
        (entry("author", value="me"), "unknown entry 'author'; remove it or update hyst"),
        (entry("description", value=[]), "'description' must be an object"),
        (entry("description", "colour", value=1), "unknown entry 'colour' in 'description'"),
        (entry("description", "dt", value=None), "'dt' in 'description' is null; leave"),
        (entry("description", "dt", value="fast"), "in 'description', dt is 'fast'; give a finite"),
        (entry("description", "delay", value="2"), r"in 'description', delay is '2'"),
        (entry("description", "delay_interval", value=[1]), "in 'description', delay_interval is"),
        (entry("description", "verdict", value={"level": "good"}), "in 'description', a verdict"),
        (entry("description", "dt", value=0.0), r"in 'description', dt is 0\.0"),
        (entry("description", "family", value=["pi"]), "in 'description', family is"),
        (entry("model", value=None), "an object with an entry 'kind'"),
        (entry("model", value=[]), "an object with an entry 'kind'"),
        (entry("model", "kind", value=...), "an object with an entry 'kind'"),
        (entry("model", "kind", value=3), "an object with an entry 'kind'"),
        (entry("model", "kind", value="presiach"), "unknown kind of operator 'presiach'; .* knows"),
        (entry("model", "stages", value=...), "composition: the entry 'stages' is missing"),
        (entry("model", "stages", value={}), "'stages' must be a list"),
        (entry("model", "stages", value=[]), "a composition has no stage"),
        (entry("model", "stages", 0, value=7), "an object with an entry 'kind'"),
        (entry("model", "stages", 0, value=None), "the entry 'stages' holds None"),
        (entry("model", "stages", 2, value={"kind": "affine"}), "affine: the entry 'gain' is miss"),
    ],
)
def test_entries_of_the_file(
    file: Path, change: Callable[[dict[str, Any]], None], message: str
) -> None:
    changed(file, change)
    assert_refused(file, message)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("p", ..., "the entry 'p' is missing"),
        ("r", ..., "the entry 'r' is missing"),
        ("p0", ..., "the entry 'p0' is missing"),
        ("q", 1.0, "unknown entry 'q'; remove it or update hyst"),
        ("p", "half", "p has dtype <U4"),
        ("p", ["0.5", "0.25"], "p has dtype <U4"),
        ("p", [0.5, "0.25"], "p has dtype <U"),
        ("p", 0.5, r"p has shape \(\)"),
        ("p", [0.5], "p has 1 entries but r has 2"),
        ("p", [[0.5, 0.25]], r"p has shape \(1, 2\)"),
        ("p", [[0.5], 0.25], "p is not a rectangular array"),
        ("p", {"0": 0.5}, "p has dtype object"),
        ("p", None, "the entry 'p' holds None"),
        ("p", [0.5, None], "the entry 'p' holds None"),
        ("p", [0.5, True], "the entry 'p' holds True"),
        ("p0", True, "the entry 'p0' holds True"),
        ("p0", [0.5], r"p0 is \[0\.5\]; give a finite number"),
        ("p0", "0.5", "p0 is '0.5'; give a finite number"),
        ("r", [2.0, 1.0], "sort the thresholds"),
        ("r", [-1.0, 1.0], r"r\[0\] is -1.0; thresholds are zero or positive"),
        ("z0", None, "the entry 'z0' holds None"),
        ("z0", [1.0], "z0 has 1 entries"),
        ("z0", [[0.5, 0.25]], r"z0 has shape \(1, 2\)"),
    ],
)
def test_entries_of_a_bank(file: Path, key: str, value: Any, message: str) -> None:
    changed(file, entry("model", key, value=value), BANK)
    assert_refused(file, message)
    # The same inside other models, however deep.
    changed(file, entry("model", "stages", 1, "pi", key, value=value))
    assert_refused(file, message)


@pytest.mark.parametrize(
    ("model", "key", "value", "message"),
    [
        (Play(1.0), "r", -1.0, "r is -1.0; a threshold is zero or positive"),
        (Play(1.0), "z0", None, "the entry 'z0' holds None"),
        (ZONE, "variant", "sideways", "variant is 'sideways'; choose"),
        (ZONE, "variant", ["two-sided"], "variant is .* choose"),
        (ZONE, "variant", ..., "the entry 'variant' is missing"),
        (ZONE, "weights", [1.0], "1 weights but 2 thresholds"),
        (Affine(1.0), "offset", ..., "the entry 'offset' is missing"),
        (MODEL.parts[0], "envelope", {"kind": "play", "r": 1.0}, "envelope is a play"),
        (MODEL.parts[0], "envelope", None, "the entry 'envelope' holds None"),
        (MODEL.parts[0], "pi", {"kind": "play", "r": 1.0}, "pi is a play"),
        (MODEL.parts[1], "output_map", {"kind": "stop", "r": 1.0}, "output_map is a stop"),
        (MODEL.parts[1], "output_map", "dead-zone", "an object with an entry 'kind'"),
    ],
)
def test_entries_of_other_operators(
    file: Path, model: Operator, key: str, value: Any, message: str
) -> None:
    changed(file, entry("model", key, value=value), model)
    assert_refused(file, message)


@pytest.mark.parametrize(
    "number", ["NaN", "Infinity", "-Infinity", "1e999", "-1e999", "1" * 400, "-" + "9" * 6000]
)
@pytest.mark.parametrize("key", ["p0", "p", "dt"])
def test_numbers_that_are_not_finite(file: Path, number: str, key: str) -> None:
    BANK.save(file, ModelDescription(dt=0.3))
    text = file.read_text(encoding="utf-8")
    old = {"p0": '"p0": 0.3', "p": '"p": [0.5', "dt": '"dt": 0.3'}[key]
    assert old in text
    file.write_text(text.replace(old, re.sub(r"[\d.]+$", number, old)), encoding="utf-8")
    assert_refused(file, "the number .* is not finite in double precision")


def test_entries_given_twice(file: Path) -> None:
    Play(1.0).save(file)
    text = file.read_text(encoding="utf-8")
    for once in ('"version": 3', '"kind": "play"', '"r": 1.0'):
        file.write_text(text.replace(once, f"{once}, {once}"), encoding="utf-8")
        assert_refused(file, "the entry .* is there more than once")


def test_operators_nested_too_deeply(file: Path) -> None:
    # Deep enough to end the recursion, and not to end that of the JSON parser itself.
    depth = 400
    model = '{"kind": "composition", "stages": [' * depth + '{"kind": "play", "r": 1.0}'
    model += "]}" * depth
    frame = '{"format": "hyst model", "version": 1, "description": {}, "model": '
    file.write_text(frame + model + "}", encoding="utf-8")
    assert_refused(file, "nested too deeply")


def test_nested_compositions_are_flattened(file: Path) -> None:
    model: dict[str, Any] = {"kind": "play", "r": 1.0}
    for _ in range(50):
        model = {"kind": "composition", "stages": [model]}
    changed(file, entry("model", value=model))
    assert load(file) == Composition((Play(1.0),))


def test_long_lists_and_many_entries_take_no_time(file: Path) -> None:
    n = 100_000
    long = PrandtlIshlinskii([1e-5] * n, range(n), p0=1.0)
    long.save(file)
    assert load(file) == long
    many = {f"k{i}": 1.0 for i in range(n)}
    changed(file, lambda content: content["model"].update(many), Play(1.0))
    assert_refused(file, "unknown entry 'k0'")


def test_a_model_without_inverse_is_loaded(file: Path) -> None:
    for model in (Play(1.0), PrandtlIshlinskii([1.0], [1.0]), DeadZone([1.0], [1.0])):
        model.save(file)
        assert load(file) == model
        assert not load(file).is_invertible()


def test_whole_numbers_are_numbers(file: Path) -> None:
    """What a person would write by hand."""
    changed(file, entry("model", "p", value=[1, 2]), BANK)
    assert load(file) == PrandtlIshlinskii([1.0, 2.0], [1.0, 2.0], p0=0.3, z0=[0.5, 0.25])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_a_device_or_a_pipe_is_never_replaced(tmp_path: Path) -> None:
    """Renaming a file onto /dev/null, which root may do, would remove the device."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(InputError, match="not a regular file"):
        PrandtlIshlinskii([0.5], [1.0]).save(pipe)
    assert pipe.is_fifo()
