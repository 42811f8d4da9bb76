"""Numbers to text and back by the engine, against ``repr`` and ``float`` of Python."""

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import _engine
from hyst.io import fast_numbers, writing
from hyst.io.fast_numbers import Body, parse_numbers
from hyst.io.writing import rows_of_text, write_columns

EDGES = [
    0.0, -0.0, 1.0, -1.0, 1e15, 1e16, 123456789012345678.0, 9999999999999998.0, 1e-4, 1e-5,
    0.00012345, 9.5e-5, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1e22, 1e23,
    0.1, 1 / 3, 2.0**53, 2.0**-1074, 9007199254740993.0, 4.35, 1e100, -2.5e-7, 100.0, 1234.5,
]  # fmt: skip


def text_of(values: list[float]) -> bytes:
    return b"".join(rows_of_text([np.array(values)]))


@given(st.lists(st.floats(), min_size=1))
def test_text_of_doubles_is_that_of_repr(values: list[float]) -> None:
    assert text_of(values).decode() == "".join(f"{value!r}\n" for value in values)


@given(st.lists(st.integers(0, 2**64 - 1), min_size=1))
def test_text_of_any_bits_is_that_of_repr(bits: list[int]) -> None:
    values = [struct.unpack("<d", struct.pack("<Q", each))[0] for each in bits]
    assert text_of(values).decode() == "".join(f"{value!r}\n" for value in values)


def test_text_at_the_edges_of_the_ways_of_writing() -> None:
    assert text_of(EDGES).decode().split() == [repr(value) for value in EDGES]


def test_text_is_the_same_without_the_engine(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    write_columns(tmp_path / "a.csv", ["a, b", "c"], [np.array(EDGES), -np.array(EDGES)])
    monkeypatch.setattr(writing, "has_number_text", lambda: False)
    write_columns(tmp_path / "b.csv", ["a, b", "c"], [np.array(EDGES), -np.array(EDGES)])
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    assert (tmp_path / "a.csv").read_text().startswith('"a, b",c\n0.0,-0.0\n')


NUMBERS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.from_regex(
        r"[+-]?([0-9]{1,25}\.?[0-9]{0,25}|\.[0-9]{1,25})([eE][+-]?[0-9]{1,2})?", fullmatch=True
    ),
)


@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1), st.sampled_from([",", ";", "\t", None]))
def test_numbers_read_are_those_of_float(
    rows: list[tuple[str, str]], separator: str | None
) -> None:
    text = "\n".join((separator or "  ").join(row) for row in rows).encode()
    found = parse_numbers(Body(text), 2, separator, [0, 1])
    assert found is not None
    assert found.T.tolist() == [[float(a), float(b)] for a, b in rows]


@pytest.mark.parametrize(
    "text",
    ["1,2\n3", "1,2\n3,4,5", "1,2\n,4", "1,2\n3,", "1,2\n\n3,4", "1,2\n3,x", "1,2\n3,inf",
     "1,2\n3,nan", "1,2\n3,1e400", "1,2\n3,0x1p3", "1,2\n3,1e", "1,2\n3,--1", "1,2\n3,+-1",
     "1,2\n3,.", "1,2\n3,1_0", "1,2\n3,1 2", "1,2\n3;4", "1,2\n3,4\n"],
)  # fmt: skip
def test_what_is_no_plain_row_is_left_to_the_reader_of_all_texts(text: str) -> None:
    assert parse_numbers(Body(text.encode()), 2, ",", [0, 1]) is None


def test_blanks_stand_around_cells_and_columns_not_wanted_are_counted() -> None:
    found = parse_numbers(Body(b" 1 , 2\t, x \n+3, 4 ,5"), 3, ",", [0, 1])
    assert found is not None
    assert found[:2].tolist() == [[1.0, 3.0], [2.0, 4.0]]
    assert np.isnan(found[2]).all()
    assert parse_numbers(Body(b"1,2,3\n4,5"), 3, ",", [0]) is None


def test_numbers_are_the_same_without_the_engine(monkeypatch: pytest.MonkeyPatch) -> None:
    body = Body("\n".join(f"{a!r};{-a!r}" for a in EDGES).encode())
    by_engine = parse_numbers(body, 2, ";", [0, 1])
    monkeypatch.setattr(fast_numbers, "has_number_text", lambda: False)
    otherwise = parse_numbers(body, 2, ";", [0, 1])
    assert by_engine is not None
    assert otherwise is not None
    assert by_engine.tobytes() == otherwise.tobytes()


def test_ranges_outside_the_text_or_the_columns_are_refused() -> None:
    assert _engine.has_number_text()
    values = np.empty((1, 1))
    with pytest.raises(ValueError, match="text out of range"):
        _engine.text_as_rows(b"1", 0, 2, ",", [0], values)
    with pytest.raises(ValueError, match="column out of range"):
        _engine.text_as_rows(b"1", 0, 1, ",", [1], values)
    with pytest.raises(ValueError, match="rows out of range"):
        _engine.rows_as_text([np.zeros(2)], 0, 3)
