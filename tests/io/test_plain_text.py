"""Large plain tables are read by other means, and the same comes out to the bit."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lab_files import rows, signals, write

from hyst.io import read_record, read_table
from hyst.io.fast_numbers import Body, parse_numbers
from hyst.io.plain_text import read_plain
from hyst.io.table import Table
from hyst.io.text import read_text

T, U, Y = signals(3000)


def same(table: Table | None, other: Table) -> bool:
    """Everything that a table says; numbers bit for bit."""
    assert table is not None
    assert table.lines is not None
    assert other.lines is not None
    return (
        (table.names, table.units, table.headers, table.aliases, table.step, table.notes)
        == (other.names, other.units, other.headers, other.aliases, other.step, other.notes)
        and all(
            a.tobytes() == b.tobytes() for a, b in zip(table.columns, other.columns, strict=True)
        )
        and np.array_equal(table.lines, other.lines)
        and list(table.flaws) == list(other.flaws)
    )


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "  ", ", "])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("form", ["{:.4f}", "{:+.9e}", "{!r}", "{:g}"])
@pytest.mark.parametrize("top", [["t [ms],u,y"], ["Sample rate: 5 Hz", "t,u,y", "s,V,um"], []])
def test_plain_tables(separator: str, end: str, form: str, top: list[str]) -> None:
    head = [line.replace(",", separator) for line in top]
    body = rows((T, U, -Y), separator, lambda v: form.format(float(v)))
    data = (end.join([*head, *body]) + end).encode()
    table = read_plain(data, "a.csv", large=0)
    (other,) = read_text(data, "a.csv")
    assert same(table, other)


@pytest.mark.parametrize("separator", [";", "\t"])
def test_decimal_commas(separator: str) -> None:
    body = rows((T, U, Y), separator, lambda v: f"{v:.6f}".replace(".", ","))
    data = "\n".join([separator.join("tuy"), *body]).encode()
    assert same(read_plain(data, "a.csv", large=0), read_text(data, "a.csv")[0])


def start_and_step() -> bytes:
    body = rows((np.arange(3000.0), U, Y), write=lambda v: f"{v:.6g}")
    return "\n".join(["X,A,B,Start,Increment", "Sequence,V,V,1.5,0.25", *body]).encode()


def test_a_time_that_is_counted() -> None:
    data = start_and_step()
    assert same(read_plain(data, "a.csv", large=0), read_text(data, "a.csv")[0])


BODY = rows((T, U, Y))
ENGINE = "hyst.io.fast_numbers.has_number_text"


@pytest.mark.parametrize(
    "change",
    [
        lambda lines: [*lines, "End of file"],
        lambda lines: [*lines[:2000], "t,u,y", *lines[2000:]],
        lambda lines: [*lines[:2000], "1.0,2.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "1.0,2.0,3.0,4.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "1.0,,3.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "1.0,2 5,3.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "1.0,2-5,3.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "1.0,1e999,3.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "", *lines[2000:]],
        lambda lines: [*lines[:2000], "# a break", *lines[2000:]],
        lambda lines: [*lines[:2000], "1.0,-,3.0", *lines[2001:]],
        lambda lines: [*lines[:2000], "1.0,nan,3.0", *lines[2001:]],
        lambda lines: [f"{line}," for line in lines],
        lambda lines: [f'"{line}"' for line in lines],
    ],
)
def test_whatever_is_unusual_is_left_to_the_reader_of_all_texts(
    change: Callable[[list[str]], list[str]],
) -> None:
    data = "\n".join(change(["t,u,y", *BODY])).encode()
    assert read_plain(data, "a.csv", large=0) is None


@given(
    table=st.lists(
        st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 3), min_size=2, max_size=9
    )
)
def test_every_double_survives_by_either_parser(table: list[tuple[float, ...]]) -> None:
    body = "\n".join(",".join(map(repr, row)) for row in table).encode()
    wanted = np.array(table).T
    for by_engine in (True, False):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(ENGINE, partial(bool, by_engine))
            found = parse_numbers(Body(b"7" + body, 1), 3, ",", range(3))
        assert found is not None
        assert found.tobytes() == wanted.tobytes()


@pytest.mark.parametrize("by_engine", [True, False])
@pytest.mark.parametrize(
    "body", [b"1,2,3\n4,5", b"1,2,3\n4,5,6,7", b"1,2,3\n4,,6", b"1,2,3\n4,5-6,7", b"1,2,3\n4,+,6"]
)
def test_neither_parser_takes_what_is_no_number(
    body: bytes, by_engine: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ENGINE, partial(bool, by_engine))
    assert parse_numbers(Body(body), 3, ",", range(3)) is None


def test_without_the_engine_the_same_comes_out(monkeypatch: pytest.MonkeyPatch) -> None:
    data = "\n".join(["t,u,y", *BODY]).encode()
    table = read_plain(data, "a.csv", large=0)
    monkeypatch.setattr(ENGINE, partial(bool, False))
    other = read_plain(data, "a.csv", large=0)
    assert other is not None
    assert same(table, other)


def test_columns_not_wanted_are_not_kept(tmp_path: Path) -> None:
    many = [np.round(U + k, 4) for k in range(30)]
    path = write(tmp_path, [",".join(f"c{k}" for k in range(30)), *rows(many)])
    record = read_record(path, "c7", "c20", rate=10.0)
    assert np.array_equal(record.u, many[7])
    assert np.array_equal(record.y, many[20])
    table = read_plain(path.read_bytes(), "a.csv", ["c7"], 0)
    assert table is not None
    assert [each.size for each in table.columns] == [3000 if k == 7 else 0 for k in range(30)]
    assert np.isfinite(read_table(path).columns).all()
