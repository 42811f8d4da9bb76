from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hyst.errors import InputError
from hyst.io import Table, read_record, read_table


def table_of(folder: Path, content: str | bytes, name: str = "data.csv") -> Table:
    path = folder / name
    path.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
    return read_table(path)


def columns_of(table: Table) -> list[list[float]]:
    return [column.tolist() for column in table.columns]


WANTED = [[0.5, 1.5, -2e-3], [1.0, 2.25, 3.0]]


@pytest.mark.parametrize(
    "text",
    [
        "0.5,1\n1.5,2.25\n-2e-3,3\n",
        "0.5,1\r\n1.5,2.25\r\n-2e-3,3",
        "0.5,1\r1.5,2.25\r-2e-3,3\r",
        "0.5, 1\n1.5, 2.25\n-2E-3, 3\n",
        "0.5;1\n1.5;2.25\n-2e-3;3\n",
        "0,5;1\n1,5;2,25\n-2e-3;3\n",
        "0,5;1,0;\n1,5;2,25;\n-0,002;3,0;\n",
        "0.5\t1\n1.5\t2.25\n-2e-3\t3\n",
        "0,5\t1\n1,5\t2,25\n-2e-3\t3\n",
        "0.5 1\n1.5 2.25\n-2e-3 3\n",
        "   0.5   1\n   1.5   2.25\n-2e-3   3   \n",
        "0,5 1\n1,5 2,25\n-0,002 3\n",
        "0.5\t 1\n 1.5\t2.25 \n-2e-3 \t 3\n",
        '"0.5","1"\n"1.5","2.25"\n"-2e-3","3"\n',
        '"0,5","1,0"\n"1,5","2,25"\n"-0,002","3,0"\n',
        ".5,1.\n1.5,2.25\n-.002,+3\n",
        "# made by hand\n0.5,1\n\n% a break\n1.5,2.25\n   \n// the rest\n-2e-3,3\n\n",
        "0.5,1\n1.5,2.25\n-2e-3,3\n\x1a",
        "sep=;\n0.5;1\n1.5;2.25\n-2e-3;3\n",
    ],
)
def test_every_way_of_writing_gives_the_same_numbers(tmp_path: Path, text: str) -> None:
    table = table_of(tmp_path, text)
    assert columns_of(table) == WANTED
    assert table.names == ("column 0", "column 1")
    assert table.units == ("", "")


BODY = "0.5;1\n1.5;2.25\n-2e-3;3\n"
NAMES_AND_UNITS = (("drive", "stroke"), ("V", "um"))


@pytest.mark.parametrize(
    ("text", "names", "units"),
    [
        ("drive;stroke\n" + BODY, ("drive", "stroke"), ("", "")),
        ("drive [V];stroke [um]\n" + BODY, *NAMES_AND_UNITS),
        ("drive (V); stroke (um)\n" + BODY, *NAMES_AND_UNITS),
        ("drive/V;stroke / um\n" + BODY, *NAMES_AND_UNITS),
        ('"drive [V]";"stroke [um]"\n' + BODY, *NAMES_AND_UNITS),
        ("drive;stroke\n[V];[um]\n" + BODY, *NAMES_AND_UNITS),
        ("drive;stroke\n(V);(um)\n\n" + BODY, *NAMES_AND_UNITS),
        ("# drive [V]; stroke [um]\n" + BODY, *NAMES_AND_UNITS),
        ("% first comment\n%drive [V];stroke [um]\n" + BODY, *NAMES_AND_UNITS),
        ("drive [V];stroke [um];\n" + BODY.replace("\n", ";\n"), *NAMES_AND_UNITS),
        ("drive [V];stroke [um]\n" + BODY.replace("\n", ";\n"), *NAMES_AND_UNITS),
        ("drive [V] stroke [um]\n" + BODY.replace(";", " "), *NAMES_AND_UNITS),
        ("drive(V)\tstroke(um)\n" + BODY.replace(";", "\t"), *NAMES_AND_UNITS),
        ("drive [V] stroke [um]\n" + BODY.replace(";", "\t"), *NAMES_AND_UNITS),
        ("drive [V];stroke [um]\n" + BODY.replace(".", ","), *NAMES_AND_UNITS),
        ("Spannung U [V];Weg [µm]\n" + BODY, ("Spannung U", "Weg"), ("V", "µm")),
        ("speed/m/s;H/(A/m)\n" + BODY, ("speed", "H"), ("m/s", "A/m")),
        ("x[0];x[1]\n" + BODY, ("x[0]", "x[1]"), ("", "")),
        ("Model;TBS1000\nRecord Length;2500\nTIME;CH1\n" + BODY, ("TIME", "CH1"), ("", "")),
        ("a title of its own\n\ndrive [V];stroke [um]\n" + BODY, *NAMES_AND_UNITS),
        ("a title of its own\n" + BODY, ("column 0", "column 1"), ("", "")),
        ("# a comment; with one; too many\n" + BODY, ("column 0", "column 1"), ("", "")),
    ],
)
def test_headers_give_names_and_units(
    tmp_path: Path, text: str, names: tuple[str, ...], units: tuple[str, ...]
) -> None:
    table = table_of(tmp_path, text)
    assert (table.names, table.units) == (names, units)
    assert columns_of(table) == WANTED


@pytest.mark.parametrize(
    ("encoding", "mark"),
    [
        *(("utf-8", b""), ("utf-8-sig", b""), ("utf-16", b""), ("latin-1", b"")),
        *(("utf-16-le", b"\xff\xfe"), ("utf-16-be", b"\xfe\xff")),
        *(("utf-16-le", b""), ("utf-16-be", b"")),
    ],
)
def test_encodings(tmp_path: Path, encoding: str, mark: bytes) -> None:
    content = mark + "Größe [µm];y\n1,5;2\n2,5;3\n".encode(encoding)
    table = table_of(tmp_path, content)
    assert (table.names, table.units) == (("Größe", "y"), ("µm", ""))
    assert columns_of(table) == [[1.5, 2.5], [2.0, 3.0]]


def test_a_missing_first_value_is_no_header(tmp_path: Path) -> None:
    table = table_of(tmp_path, "nan,1\n2,3\n")
    assert np.isnan(table.columns[0][0])
    assert table.columns[1].tolist() == [1.0, 3.0]


def test_a_single_column_may_have_a_name_of_several_words(tmp_path: Path) -> None:
    table = table_of(tmp_path, "wanted stroke (um)\n1.5\n2.5\n")
    assert (table.names, table.units) == (("wanted stroke",), ("um",))
    assert columns_of(table) == [[1.5, 2.5]]


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        ("stroke [um]\n1,5\n2,5\n", [[1.5, 2.5]]),
        ('"stroke"\n1,5\n2,5\n', [[1.5, 2.5]]),
        ("1,5\n-2,05\n", [[1.5, -2.05]]),
        ("1,5e-3\n2,5\n", [[1.5e-3, 2.5]]),
        ("1,5\n2,5\n", [[1.0, 2.0], [5.0, 5.0]]),  # nothing says it is one column
        ("u,y\n1,5\n2,5\n", [[1.0, 2.0], [5.0, 5.0]]),
        ("u y\n1,5\n2,5\n", [[1.0, 2.0], [5.0, 5.0]]),
        ("1,5,06\n2,5,07\n", [[1.0, 2.0], [5.0, 5.0], [6.0, 7.0]]),
    ],
)
def test_a_column_with_decimal_commas_is_not_two_columns(
    tmp_path: Path, text: str, columns: list[list[float]]
) -> None:
    assert columns_of(table_of(tmp_path, text)) == columns


def test_columns_of_text_do_not_hinder_the_others(tmp_path: Path) -> None:
    text = "clock;u;note\n01.02.2020 12:00:01,5;1,5;start, slowly\n01.02.2020 12:00:02,0;2,5;\n"
    table = table_of(tmp_path, text)
    assert table.names == ("clock", "u", "note")
    assert table.columns[1].tolist() == [1.5, 2.5]
    assert table.columns[0].tolist() == [0.0, 0.5]
    assert np.isnan(table.columns[2]).all()


@given(
    values=st.lists(
        st.tuples(st.floats(allow_nan=False, allow_infinity=False), st.floats(-1e3, 1e3)),
        min_size=1,
        max_size=20,
    ),
    separator=st.sampled_from([",", ";", "\t", " "]),
    header=st.booleans(),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_every_double_survives_to_the_last_bit(
    tmp_path: Path, values: list[tuple[float, float]], separator: str, header: bool
) -> None:
    lines = [f"u{separator}y"] if header else []
    lines += [f"{u!r}{separator}{y!r}" for u, y in values]
    table = table_of(tmp_path, "\n".join(lines))
    assert columns_of(table) == [list(column) for column in zip(*values, strict=True)]
    if separator in "\t;":
        table = table_of(tmp_path, "\n".join(lines).replace(".", ","))
        assert columns_of(table) == [list(column) for column in zip(*values, strict=True)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("u,y\n1,2\n3,x\n5,6\n", "'y' is 'x' at line 3, not a finite number"),
        ("u,y\n1,2\n3,\n5,6\n", "'y' has no value at line 3"),
        ("u,y\n1,2\n# comment\n\n3,nan\n5,6\n", "'y' is 'nan' at line 5, not a finite number"),
        ("u,y\n1,2\n-inf,1\n5,6\n", "'u' is '-inf' at line 3"),
        ("u,y\n1,2\n1e999,1\n5,6\n", "'u' is '1e999' at line 3"),
        ("u,y\nerr,1\n1,2\n3,4\n", "'u' is 'err' at line 2"),
        ("err,1\n1,2\n3,4\n", "line 1 has 'err' above the number 1, so it is neither a header"),
        (",0,1\n0,1.5,2\n1,2.5,3\n", "line 1 has '' above the number 0"),
        ("t,0,1\n0,1.5,2\n1,2.5,3\n", "line 1 has 't' above the number 0"),
        ("u,y\n1,2\n#DIV/0!,3\n5,6\n", "'u' is '#DIV/0!' at line 3"),
        ("u,y\n1_0,1\n1,2\n3,4\n", "'u' is '1_0' at line 2"),
        ("u,y\n٣,1\n1,2\n3,4\n", "'u' is '٣' at line 2"),
        ("u,y\n0x10,1\n1,2\n3,4\n", "'u' is '0x10' at line 2"),
        ("u;y\n1,5;2\n1.234;1\n2,5;3\n", "'u' is '1.234' at line 3"),
        ("u;y\n1.234,5;2\n2.5;3\n3,5;3\n", r"'u' is '2\.5' at line 3, while the decimal sign"),
        ("u y\n1 2\n2 " + 50 * "z" + "\n3 4\n", r"'y' is 'z{37}\.\.\.' at line 3"),
    ],
)
def test_the_first_entry_that_is_no_number_is_named(
    tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "data.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read_record(path, input=0, output=1, rate=1.0)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", r"data\.csv is empty"),
        (b"\n\n   \n", "holds no line of numbers"),
        (b"# only a comment\n", "holds no line of numbers"),
        (b"u,y\n", "holds no line of numbers"),
        (b"to whom it may concern\nthis is a letter\n", "holds no line of numbers"),
        (b"\xef\xbb\xbf", "holds no line of numbers"),
        (b"u,y\n1,2\n3,4,5\n", "line 3 has 3 values and line 2 has 2"),
        (b"u,y\n1,2\n\n# pause\n3\n4,5\n", "line 5 has 1 values and line 2 has 2"),
        (b"1 2\n3 4\n5", "line 3 has 1 values and line 1 has 2"),
        (b"u,y,z\n1,2\n3,4\n", "line 1 names 3 columns, but the lines below it have 2"),
        (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", "not a text file: .* 0x1a at line 2"),
        (b"PK\x03\x04\x14\x00", "is damaged or no NPZ archive"),
        (b"1,2\n3,\x004\n", "not a text file: .* 0x00 at line 2"),
        (b"\xff\xfe1\x00,\x002", "starts as utf-16-le but breaks off at byte 4"),
        (b"\xef\xbb\xbf1,2\n3,\xff\n", "starts as utf-8 but breaks off at byte 6"),
    ],
)
def test_what_is_no_table_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(InputError, match=message):
        table_of(tmp_path, content)


ALPHABET = st.sampled_from([*"0123456789.,;\t eE+-#%/\n\r\"'[]()uyVµ\x00\x1a", "nan", "inf"])
SCRAPS = st.lists(ALPHABET).map(lambda scraps: "".join(scraps).encode())


@given(content=st.one_of(st.binary(max_size=300), SCRAPS))
@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=400
)
def test_no_content_raises_anything_but_an_input_error(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "data.txt"
    path.write_bytes(content)
    with contextlib.suppress(InputError):
        table = read_table(path)
        assert len({column.size for column in table.columns}) == 1
        for column, flaw in zip(table.columns, table.flaws, strict=True):
            assert (flaw is None) == bool(np.isfinite(column).all())
    with contextlib.suppress(InputError):
        read_record(path, input=0, output=1, time=2, repair=True)


def test_the_columns_cannot_be_written_to(tmp_path: Path) -> None:
    table = table_of(tmp_path, "1,2\n3,4\n")
    with pytest.raises(ValueError, match="read-only"):
        table.columns[0][0] = 9.0
