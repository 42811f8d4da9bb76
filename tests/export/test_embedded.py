"""What `make embedded` and `make misra` conclude from what they measure; neither runs here."""

from __future__ import annotations

import numpy as np
import pytest
from embedded.__main__ import main, may_skip
from embedded.building import Sizes
from embedded.call_graph import read_call_graph
from embedded.cases import Case, cases
from embedded.emulator import Report, read_report
from embedded.measuring import Cost, Result, compare
from embedded.misra import accepted, excess, unseen
from embedded.rounding_bound import NoBoundError
from embedded.table import stale_rows, table_in, table_of, with_table
from embedded.target import BUILDS

CASES = {each.name: each for each in cases()}

GRAPH = """graph: { title: "stage.c"
node: { title: "step" label: "step\\nstage.c:1:1\\n16 bytes (static)\\n0 dynamic objects" }
node: { title: "near" label: "near\\nstage.c:9:1\\n24 bytes (static)" }
node: { title: "far" label: "far\\nstage.c:19:1\\n40 bytes (static)" }
edge: { sourcename: "step" targetname: "near" label: "stage.c:3:3" }
edge: { sourcename: "step" targetname: "far" label: "stage.c:4:3" }
edge: { sourcename: "near" targetname: "memcpy" label: "stage.c:10:3" }
"""


@pytest.mark.parametrize("name", CASES)
def test_single_precision_is_within_its_bound(name: str) -> None:
    """The targets give these bits, so here is where the derivation is tested."""
    case = CASES[name]
    try:
        bound = case.bound()
    except NoBoundError as error:
        pytest.skip(str(error))
    error = np.abs(case.expected("single") - case.expected("double")).max()
    assert error <= bound


@pytest.mark.parametrize("name", ["pi", "inverse of mpi", "linear", "ramberg-osgood", "sections"])
def test_the_bound_is_one_of_rounding(name: str) -> None:
    """Far below what one wrong bit in the middle of a number would make: 2^-12 of the output."""
    case = CASES[name]
    assert case.bound() < 2.0**-12 * np.abs(case.expected("double")).max()


def test_every_record_is_exact_in_single_precision() -> None:
    for case in CASES.values():
        np.testing.assert_array_equal(case.inputs.astype(np.float32), case.inputs)
        assert not np.isfinite(case.inputs).all()


def test_the_deepest_way_is_found() -> None:
    graph = read_call_graph(GRAPH)
    assert graph.deepest("step") == 16 + 40
    assert graph.deepest("near") == 24


def test_pointers_of_the_core_are_known_by_the_names_of_an_export() -> None:
    more = (
        'node: { title: "b.c:jiles_change" label: "jiles_change\\nb.c:1:1\\n8 bytes (static)" }\n'
        'node: { title: "my_core_branch_advance" label: "advance\\na.c:1:1\\n4 bytes (static)" }\n'
        'edge: { sourcename: "my_core_branch_advance" targetname: "__indirect_call" label: "" }\n'
        'edge: { sourcename: "far" targetname: "my_core_branch_advance" label: "" }\n'
    )
    assert read_call_graph(GRAPH + more).deepest("step") == 16 + 40 + 4 + 8


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('edge: { sourcename: "far" targetname: "step" label: "" }', "recursion"),
        ('edge: { sourcename: "far" targetname: "__indirect_call" label: "" }', "pointer"),
        ('node: { title: "free" label: "free\\n8 bytes (dynamic)" }', "run time"),
    ],
)
def test_a_stack_without_a_bound_is_refused(line: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read_call_graph(GRAPH + line).deepest("step")


def report_of(lines: dict[str, int]) -> str:
    good = {"stack": 8, "state": 16, "fault": 1, "unsaved": 0, "nothing": 64, "return": 64}
    good |= {"hundred": 64 + 640, "y": 0x3F800000, "ticks": 64 + 64}
    return "\n".join(f"{word} {number:x}" for word, number in (good | lines).items())


def test_a_report_is_read() -> None:
    report = read_report(report_of({}), "single")
    assert report.y.tolist() == [1.0]
    assert report.instructions.tolist() == [10]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [({"hundred": 64 + 650}, "100 instructions"), ({"unsaved": 1}, "saved and loaded")],
)
def test_a_report_that_cannot_be_right_is_refused(wrong: dict[str, int], message: str) -> None:
    with pytest.raises(RuntimeError, match=message):
        read_report(report_of(wrong), "single")


def test_a_word_from_the_target_is_passed_on() -> None:
    with pytest.raises(RuntimeError, match="stopped with a fault"):
        read_report("the processor has stopped with a fault", "single")


def test_one_bit_is_seen() -> None:
    wanted = np.array([1.0, 2.0])
    report = Report(wanted.copy(), np.array([1, 1]), 8, 16, 1)
    assert compare(report, wanted) == []
    report.y[1] = np.nextafter(2.0, 3.0)
    assert "1 outputs differ, the first is y[1]" in compare(report, wanted)[0]
    assert compare(Report(wanted, np.array([1, 1]), 8, 16, 0), wanted) != []


def result_of(name: str, worst: int, state: int) -> Result:
    cost = Cost(worst, worst - 1.0, Sizes(400, 100, 8), 8, state)
    return Result(name, dict.fromkeys(BUILDS, cost), 1e-6, 1e-5, ())


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr("embedded.table.compiler_version", lambda: "12.2.1")
    return table_of([result_of("pi", 100, 24), result_of("play", 40, 16)])


def test_a_table_is_found_again(kept: str) -> None:
    page = "before\n<!-- table: make embedded-table -->\n<!-- end of table -->\nafter\n"
    assert table_in(with_table(page, kept)) == kept
    assert with_table(with_table(page, "old"), kept) == with_table(page, kept)
    assert stale_rows(kept, kept) == []


def test_a_table_is_stale_by_a_hundredth(kept: str) -> None:
    made = table_of([result_of("pi", 102, 24), result_of("play", 40, 16)])
    assert "pi: M4F is 102, the table says 100" in stale_rows(kept, made)


def test_another_compiler_may_cost_more_but_not_change_the_state(
    kept: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("embedded.table.compiler_version", lambda: "14.1.0")
    assert not stale_rows(kept, table_of([result_of("pi", 120, 24), result_of("play", 50, 16)]))
    slow = stale_rows(kept, table_of([result_of("pi", 130, 24), result_of("play", 40, 16)]))
    assert "pi: M4F is 130, the table says 100" in slow
    grown = stale_rows(kept, table_of([result_of("pi", 100, 28), result_of("play", 40, 16)]))
    told = "Another compiler. The table: Measured with arm-none-eabi-gcc 12.2.1."
    assert grown[0] == f"{told} Here: Measured with arm-none-eabi-gcc 14.1.0."
    assert grown[1:] == ["pi: state is 28, the table says 24"]


def test_a_model_that_comes_or_goes_makes_a_table_stale(kept: str) -> None:
    made = table_of([result_of("pi", 100, 24), result_of("stop", 40, 16)])
    assert stale_rows(kept, made) == [
        "play is in the table and is no more",
        "stop is not in the table",
    ]


def test_only_the_absence_of_the_compiler_skips(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CI", raising=False)
    assert may_skip(["arm-none-eabi-gcc", "qemu-system-arm"])
    assert not may_skip(["qemu-system-arm"])
    monkeypatch.setenv("CI", "true")
    assert not may_skip(["arm-none-eabi-gcc", "qemu-system-arm"])


def test_a_model_that_does_not_exist_is_an_error(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["embedded", "pi", "pie"])
    with pytest.raises(SystemExit):
        main()
    assert "there is no model pie;" in capsys.readouterr().err


PAGE = """| rule | kind | core | exports | why |
|---|---|---|---|---|
| 10.3 | required | 2 | 0 | The reason is given in a sentence. |
| 15.5 | advisory | any | any | The reason is given in a sentence. |
| 17.8 | advisory | any | any | none |
"""


def test_a_deviation_is_accepted_with_a_reason_and_a_number() -> None:
    allowed = accepted(PAGE, "core")
    assert allowed == {"misra-c2012-10.3": 2.0, "misra-c2012-15.5": float("inf")}
    places = {("core/src/play.c", line) for line in (1, 2, 3)}
    assert excess({"misra-c2012-15.5": places}, allowed) == []
    assert excess({"misra-c2012-10.3": places}, allowed) == [
        "misra-c2012-10.3: 3 places, 2 accepted: play.c:1, play.c:2, play.c:3"
    ]
    assert len(excess({"misra-c2012-21.3": places, "nullPointer": places}, allowed)) == 2
    assert excess({"misra-c2012-10.3": places}, accepted(PAGE, "export")) != []


def test_an_add_on_that_did_not_run_is_told() -> None:
    assert "cannot have run" in unseen({"nullPointer": {("play.c", 1)}})[0]
    assert unseen({"misra-c2012-15.5": {("play.c", 1)}}) == []


def test_the_case_says_how_inputs_enter() -> None:
    case = Case("two", CASES["pi"].model, np.zeros((3, 2)))
    assert case.step == "return stage_step(model, u[0], u[1]);"
