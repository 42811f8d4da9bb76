"""Structured text, read and run by rules of its own, against Python: equal bits."""

from __future__ import annotations

import ctypes
import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import structured_text_machine
from c_builds import same_bits, stepped, wandering
from distinct_code import DISTINCT
from structured_text_compiler import Compiler
from structured_text_machine import Instance, Machine
from structured_text_parser import StructuredTextError, units_of
from test_repetitive_projects import BLOCKS

from hyst import (
    DeadZone,
    InputError,
    ModelDescription,
    ModifiedPrandtlIshlinskii,
    Operator,
    PrandtlIshlinskii,
)
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.control.tracking_controller import TrackingController
from hyst.export import structured_text
from hyst.export.c.block import block_of, stepper_of
from hyst.export.c.numbers import Precision
from hyst.export.iec61131.project import text_files
from hyst.export.iec61131.words import is_taken
from hyst.models import Scheduled
from hyst.online import JointEstimator
from reference.examples import EXAMPLES

SAMPLES = 100_000
# What solves for every sample takes seconds for 10^5 of them.
SLOW = {
    "inverse-dynamic-jiles-atherton": 10_000,
    "rate-dependent-preview": 20_000,
    "inverse-degrading-bouc-wen": 20_000,
}


def first_of_each_kind() -> dict[str, str]:
    found: dict[str, str] = {}
    for name, model in EXAMPLES.items():
        found.setdefault(model.kind, name)
    return found


KINDS = first_of_each_kind()
OTHERS = [name for name in DISTINCT if name not in KINDS.values()]


@cache
def text_of(name: str, precision: Precision) -> str:
    block = block_of(EXAMPLES[name], precision)
    files, _ = text_files(block, "lens", precision, ModelDescription())
    return files["lens.st"].decode("ascii")


def instance_of(text: str, folder: Path, block: str = "lens") -> Instance:
    return Machine(text, block, folder).instance()


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_gives_the_bits_of_python(kind: str, tmp_path: Path) -> None:
    name = KINDS[kind]
    u = wandering(SLOW.get(kind, SAMPLES))
    y, fault = instance_of(text_of(name, "double"), tmp_path).run(("y", "fault"), u=u)
    expected = stepped(EXAMPLES[name].stepper(), u)
    assert np.isfinite(expected).all()
    assert same_bits(y, expected)
    first_bad = int(np.flatnonzero(~np.isfinite(u))[0])
    assert fault[first_bad:].all()


# One of each file of the core that looks at bits, or counts, in single precision.
@pytest.mark.parametrize(
    "name",
    [
        "pi", "inverse of mpi", "rate-dependent", "masing of a power", "inverse iwan",
        "memory element", "coleman-hodgdon", "dahl", "bouc-wen", "inverse degrading bouc-wen",
        "inverse preisach", "jiles-atherton of B", "lugre", "rate-dependent preview", "delay",
    ],
)  # fmt: skip
def test_single_precision_gives_the_bits_of_its_twin(name: str, tmp_path: Path) -> None:
    u = wandering(20_000).astype(np.float32)
    (y,) = instance_of(text_of(name, "single"), tmp_path).run(("y",), u=u)
    expected = stepped(stepper_of(block_of(EXAMPLES[name], "single"), "single"), u.astype(float))
    assert y.dtype == np.float32
    assert same_bits(y.astype(float), expected)


@pytest.mark.parametrize("name", OTHERS)
def test_every_other_code_can_be_written(name: str) -> None:
    units = units_of(text_of(name, "double"))
    assert units[-1].kind == "FUNCTION_BLOCK"
    assert units[-1].name == "lens"


@pytest.mark.parametrize("kind", KINDS)
def test_an_open_grammar_of_the_standard_takes_the_text(kind: str) -> None:
    """tree-sitter-iec61131-3-st, MIT: the only open checker of all this that registries have."""
    reason = "no tree-sitter grammar of structured text; pip install tree-sitter-iec61131-3-st"
    tree_sitter = pytest.importorskip("tree_sitter", reason=reason)
    grammar = pytest.importorskip("tree_sitter_iec61131_3_st", reason=reason)
    parser = tree_sitter.Parser(tree_sitter.Language(grammar.language()))
    assert not parser.parse(text_of(KINDS[kind], "double").encode()).root_node.has_error
    assert parser.parse(b"FUNCTION f : LREAL\nf := ;\nEND_FUNCTION").root_node.has_error


@pytest.mark.parametrize("kind", KINDS)
def test_no_variable_has_a_name_that_the_language_keeps(kind: str) -> None:
    names = {
        each.name for unit in units_of(text_of(KINDS[kind], "double")) for each in unit.variables
    }
    assert "numbers" in names
    assert not {each for each in names if is_taken(each)}


INVERSE = PrandtlIshlinskii([0.5, 0.2, 0.1], [0.1, 0.3, 0.7], 1.0).inverse()


@pytest.mark.parametrize(
    "model", [INVERSE, EXAMPLES["inverse of mpi"], EXAMPLES["inverse ramberg-osgood"]]
)
def test_limits_and_a_start_after_a_history(model: Operator, tmp_path: Path) -> None:
    drive = LimitedDrive(model, (-1.25, 2.0))
    written = structured_text(model, tmp_path / "out", name="lens", limits=(-1.25, 2.0))
    lens = instance_of((written.path / "lens.st").read_text(), tmp_path)
    v = wandering(20_000, size=4.0)
    y, fault = lens.run(("y", "fault"), u=v)
    assert same_bits(y, stepped(drive.stepper(), v))
    assert y.min() == -1.25
    assert y.max() == 2.0
    assert fault[-1] == 1 | 16
    # Back to a start after what had driven the actuator.
    history = [2.0, -1.25, 1.5, -0.5]
    lens.set("history", history)
    goal = v[np.isfinite(v)][:1000]
    (first, refused, fault) = lens.run(
        ("y", "history_refused", "fault"), u=goal[0], restart=True, history_count=4
    )
    (rest,) = lens.run(("y",), u=goal[1:], restart=False)
    expected = stepped(drive.stepper(drive.state_after(history)), goal)
    assert same_bits(np.concatenate([first, rest]), expected)
    assert not refused.any()
    assert fault[0] in (0, 16)
    # A history out of the limits starts as nothing had ever driven it.
    lens.set("history", [2.0, -1.5])
    first, refused = lens.run(("y", "history_refused"), u=goal[0], restart=True, history_count=2)
    (rest,) = lens.run(("y",), u=goal[1:], restart=False)
    assert refused[0]
    assert same_bits(np.concatenate([first, rest]), stepped(drive.stepper(), goal))
    _, too_many = lens.run(("y", "history_refused"), u=0.0, restart=True, history_count=33)
    assert too_many[0]


def test_a_start_after_the_history_of_the_export(tmp_path: Path) -> None:
    drive = LimitedDrive(INVERSE, (-1.25, 2.0))
    history = [2.0, -0.75, 0.5]
    structured_text(INVERSE, tmp_path / "out", name="lens", limits=(-1.25, 2.0), history=history)
    lens = instance_of((tmp_path / "out" / "lens.st").read_text(), tmp_path)
    v = wandering(5000, size=3.0)
    (y,) = lens.run(("y",), u=v)
    assert same_bits(y, stepped(drive.stepper(drive.state_after(history)), v))


def test_a_controller_with_limits(tmp_path: Path) -> None:
    model = TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=INVERSE, limits=(-1.7, 1.1), rate=700.0
    )
    written = structured_text(model, tmp_path / "out", name="lens")
    assert (written.inputs, written.output) == (("y_ref", "y"), "u")
    lens = instance_of((tmp_path / "out" / "lens.st").read_text(), tmp_path)
    y_ref, y = wandering(20_000, size=2.0), wandering(20_000, seed=11, size=2.0)
    (u,) = lens.run(("u",), y_ref=y_ref, y=y)
    assert same_bits(u, stepped(model.stepper(), y_ref, y))


@pytest.mark.parametrize("kind", ["compared", "limited, of several stages"])
def test_a_repetitive_controller(kind: str, tmp_path: Path) -> None:
    model = BLOCKS[kind]
    files, names = text_files(block_of(model, "double"), "lens", "double", ModelDescription())
    lens = instance_of(files["lens.st"].decode("ascii"), tmp_path)
    y_ref, y = wandering(20_000, size=2.0), wandering(20_000, seed=9, size=2.0)
    assert (names.inputs, names.output) == (("y_ref", "y"), "u")
    (u,) = lens.run(("u",), y_ref=y_ref, y=y)
    assert same_bits(u, stepped(model.stepper(), y_ref, y))


def test_a_scheduled_model(tmp_path: Path) -> None:
    models = [PrandtlIshlinskii([0.5 * k, 0.2], [0.1, 0.3], 1.0) for k in (1, 2, 3)]
    model = Scheduled(models, [20.0, 40.0, 80.0])
    written = structured_text(model, tmp_path / "out", name="lens")
    assert written.inputs == ("u", "scheduled_by")
    lens = instance_of((tmp_path / "out" / "lens.st").read_text(), tmp_path)
    u = wandering(20_000)
    s = 50.0 + 40.0 * np.sin(np.arange(u.size) / 71.0)
    y, fault = lens.run(("y", "fault"), u=u, scheduled_by=s)
    assert same_bits(y, stepped(model.stepper(), u, s))
    assert fault[-1] == 1 | 8  # not finite, and off the schedule


def test_a_scheduled_inverse_with_limits_starts_after_a_history(tmp_path: Path) -> None:
    models = [PrandtlIshlinskii([0.5 * k, 0.2], [0.1, 0.3], 1.0) for k in (1, 2, 3)]
    drive = LimitedSchedule(Scheduled(models, [20.0, 40.0, 80.0]).inverse(), (-1.25, 2.0))
    structured_text(drive, tmp_path / "out", name="lens")
    lens = instance_of((tmp_path / "out" / "lens.st").read_text(), tmp_path)
    v = wandering(5000)
    s = 50.0 + 40.0 * np.sin(np.arange(v.size) / 71.0)
    y, fault = lens.run(("y", "fault"), u=v, scheduled_by=s)
    assert same_bits(y, stepped(drive.stepper(), v, s))
    assert fault[-1] == 1 | 8 | 16
    # With the value of the call that restarts it.
    history = [2.0, -0.75, 0.5]
    lens.set("history", history)
    first, refused = lens.run(
        ("y", "history_refused"), u=0.25, scheduled_by=30.0, restart=True, history_count=3
    )
    (rest,) = lens.run(("y",), u=v[:1000], scheduled_by=s[:1000], restart=False)
    step = drive.stepper(drive.state_after(history, 30.0))
    assert first[0] == step(0.25, 30.0)
    assert not refused[0]
    assert same_bits(rest, stepped(step, v[:1000], s[:1000]))
    (refused,) = lens.run(
        ("history_refused",), u=0.25, scheduled_by=np.nan, restart=True, history_count=3
    )
    assert refused[0]


def test_fault_and_restart(tmp_path: Path) -> None:
    lens = instance_of(text_of("pi", "double"), tmp_path)
    u = np.array([1.0, 3.0, np.nan, np.inf, -2.0])
    before, fault = lens.run(("y", "fault"), u=u)
    assert before[1] == before[2] == before[3]  # the last output is repeated
    assert fault.tolist() == [0, 0, 1, 1, 1]
    _, fault = lens.run(("y", "fault"), u=0.0, clear_fault=True)
    assert fault[0] == 0
    again, _ = lens.run(("y", "fault"), u=u[:1], restart=True, clear_fault=False)
    after, _ = lens.run(("y", "fault"), u=u[1:], restart=False)
    assert same_bits(np.concatenate([again, after]), before)


def test_two_blocks_in_one_project_share_no_name(tmp_path: Path) -> None:
    other = text_of("pi", "double").replace("lens", "mirror")
    both = text_of("pi", "single") + other
    u = wandering(1000)
    (first,) = instance_of(both, tmp_path, "lens").run(("y",), u=u)
    (second,) = instance_of(both, tmp_path, "mirror").run(("y",), u=u)
    assert first.dtype == np.float32
    assert same_bits(second, stepped(EXAMPLES["pi"].stepper(), u))
    with pytest.raises(StructuredTextError, match="taken"):
        instance_of(other + other, tmp_path, "mirror")


def test_what_is_written(tmp_path: Path) -> None:
    about = ModelDescription(
        input_name="position", input_unit="um", output_name="voltage", output_unit="V"
    )
    written = structured_text(INVERSE, tmp_path / "out", name="lens", description=about)
    assert written.files == ("README.md", "lens.st", "manifest.json")
    text = (written.path / "lens.st").read_text()
    assert "u : LREAL; (* position in um *)" in text
    assert max(map(len, text.splitlines())) <= 120
    manifest = json.loads((written.path / "manifest.json").read_text())
    assert (manifest["target"], manifest["precision"]) == ("st", "double")
    assert set(manifest["files"]) == {"README.md", "lens.st"}
    readme = (written.path / "README.md").read_text()
    assert "lens_1(u := u);" in readme
    with pytest.raises(InputError, match="exists"):
        structured_text(INVERSE, tmp_path / "out", name="lens")
    again = structured_text(INVERSE, tmp_path / "again", name="lens", description=about)
    assert (again.path / "lens.st").read_text() == text


TEN = PrandtlIshlinskii(np.linspace(0.3, 0.05, 10), np.linspace(0.1, 2.0, 10), 1.0)
TEN_AND_MAP = ModifiedPrandtlIshlinskii(
    TEN, DeadZone([1.0, 0.2, 0.1, 0.3], [0.0, 0.5, 1.5, -0.4])
).inverse()


class _Counting(Compiler):
    """Counts the statements that are run."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.lines.insert(0, "unsigned counted;")

    def body(self, statements: list[Any]) -> None:
        for each in statements:
            self.lines.append("counted += 1;")
            super().body([each])


@pytest.mark.parametrize(
    ("model", "limits", "most"),
    [(TEN, None, 92), (TEN_AND_MAP, None, 128), (TEN_AND_MAP, (-1.5, 2.0), 173)],
)
def test_a_sample_costs_the_statements_that_the_page_tells(
    model: Operator,
    limits: tuple[float, float] | None,
    most: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(structured_text_machine, "Compiler", _Counting)
    written = structured_text(model, tmp_path / "out", name="lens", limits=limits)
    lens = instance_of((written.path / "lens.st").read_text(), tmp_path)
    counted = ctypes.c_uint.in_dll(lens.machine.compiled, "counted")
    lens.run(("y",), u=0.0)
    costs = []
    for each in np.sin(np.arange(3000) / 50.0) * np.linspace(0.2, 4.0, 3000):
        counted.value = 0
        lens.run(("y",), u=each)
        costs.append(counted.value)
    assert max(costs) == most


@pytest.mark.parametrize("name", ["limit", "Step", "LREAL", "t", "Real_to_dint", "AT", "trunc"])
def test_a_name_that_structured_text_keeps_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"collides in the other language|has or keeps for itself"):
        structured_text(INVERSE, tmp_path / "out", name=name)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["numbers", "State", "i", "began", "ignored"])
def test_a_name_that_the_block_has_inside_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a variable inside the block"):
        structured_text(INVERSE, tmp_path / "out", name=name)
    assert not (tmp_path / "out").exists()


def test_an_estimator_is_refused_with_what_to_do(tmp_path: Path) -> None:
    estimator = JointEstimator(PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0))
    with pytest.raises(InputError, match="estimator is not written"):
        structured_text(estimator, tmp_path / "out")
