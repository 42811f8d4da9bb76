"""Headers that stand again among the rows, and signs that are no faults."""

from __future__ import annotations

from pathlib import Path

import pytest
from io_checks import same_signals
from lab_files import rows, signals, write

from hyst.errors import InputError
from hyst.io import read_record

T, U, Y = signals()
HEADER = "time,u,y"
BODY = rows((T, U, Y))


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize(
    ("header", "again"),
    [("u,y", "y,u"), ("u [V],y [um]", "u [mV],y [um]"), ("u (V),y (um)", "y (um),u (V)")],
)
def test_a_header_in_another_order_or_with_other_units_begins_a_table(
    tmp_path: Path, header: str, again: str, repair: bool
) -> None:
    columns = {"u": U, "y": Y, "u [m": 1e3 * U}
    second = [columns.get(name[:4], columns[name[0]]) for name in again.split(",")]
    path = write(tmp_path, [header, *rows((U, Y)), again, *rows(second)])
    # Left out as a row without numbers it would join the columns of one with those of the other.
    with pytest.raises(InputError, match="holds 2 tables below each other"):
        read_record(path, "u", "y", rate=200.0, repair=repair)
    record = read_record(path, "u", "y", rate=200.0, table=2)
    milli = record.input_unit == "mV"
    assert milli == ("mV" in again)
    same_signals(record, 1e3 * U if milli else U, Y)


@pytest.mark.parametrize(
    ("head", "again"),
    [
        (["# u y"], ["# y u"]),
        (["# u [V] y [um]"], ["# u [V] y [um]"]),
        (["% u y", "% V um"], ["% u y", "% mV um"]),
    ],
)
def test_a_header_in_comments_that_stands_again_begins_a_table(
    tmp_path: Path, head: list[str], again: list[str]
) -> None:
    milli = "mV" in again[-1]
    second = (Y, U) if again[0] == "# y u" else (1e3 * U if milli else U, Y)
    lines = [*head, *rows((U, Y), " "), *again, *rows(second, " ")]
    path = write(tmp_path, lines)
    with pytest.raises(InputError, match="holds 2 tables below each other"):
        read_record(path, "u", "y", rate=200.0)
    record = read_record(path, "u", "y", rate=200.0, table=2)
    same_signals(record, 1e3 * U if milli else U, Y)


def test_other_comments_among_the_rows_are_passed_over(tmp_path: Path) -> None:
    head = ["# by hand", "# u y"]
    body = rows((U, Y), " ")
    path = write(tmp_path, [*head, *body[:30], "# by hand", "# stage moved", "# u", *body[30:]])
    record = read_record(path, "u", "y", rate=200.0)
    same_signals(record, U, Y)
    assert (record.samples, record.notes) == (U.size, ())


def test_the_minus_sign_of_mathematics(tmp_path: Path) -> None:
    body = [line.replace("-", "\N{MINUS SIGN}") for line in BODY]
    assert body != BODY
    path = write(tmp_path, [HEADER, *body])
    same_signals(read_record(path, "u", "y", time="time"), U, Y)
