"""Text of every shape: what stands around the numbers, how they are written, several tables."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
from io_checks import same_signals
from lab_files import DT, cell, rows, signals, write

from hyst.errors import InputError
from hyst.io import read_record, read_records, read_table, read_tables

T, U, Y = signals()
HEADER = "time,u,y"
BODY = rows((T, U, Y))


def lvm(
    separator: str, decimal: str, *, x: str = "One", segments: int = 1, comment: str = ""
) -> str:
    """A LabVIEW measurement file as its specification describes it."""
    named = {"\t": "Tab", ",": "Comma"}[separator]
    top = ["LabVIEW Measurement", "Writer_Version,2", f"Separator,{named}", "Multi_Headings,Yes"]
    top += [f"Decimal_Separator,{decimal}"] if decimal else []
    top += [f"X_Columns,{x}", "Date,2026/11/28", f"Time,12:00:00{decimal or '.'}5"]
    lines = [line.replace(",", separator, 1) for line in top] + ["***End_of_Header***", ""]
    for _ in range(segments):
        head = ["Channels,2", "Samples,60,60", "Y_Unit_Label,V,um", "X_Dimension,Time,Time"]
        lines += [each.replace(",", separator) for each in head]
        lines += [f"Delta_X{separator}0{decimal or '.'}005000", "***End_of_Header***"]
        names = {"Multi": ["X_Value", "u", "X_Value", "y"]}.get(x, ["X_Value", "u", "y"])
        lines += [separator.join([*names, "Comment"])]
        columns: tuple[object, ...] = {"One": (T, U, Y), "Multi": (T, U, T, Y)}.get(
            x, ([""] * T.size, U, Y)
        )
        body = rows(columns, separator, lambda v: cell(v).replace(".", decimal or "."))  # type: ignore[arg-type]
        body[3] += separator + comment if comment else ""
        lines += [*body, ""]
    return "\n".join(lines)


@pytest.mark.parametrize("name", ["run.lvm", "run.txt", "run"])
@pytest.mark.parametrize(
    "text",
    [
        *(lvm("\t", "."), lvm("\t", ","), lvm(",", "."), lvm("\t", "", comment="a loud bang")),
        *(lvm("\t", ".", x="No"), lvm("\t", ",", x="No"), lvm("\t", ".").replace("\n", "\r\n")),
    ],
)
def test_labview_files(tmp_path: Path, text: str, name: str) -> None:
    path = write(tmp_path, text, name)
    for how in ({"time": "X_Value"}, {"rate": 200.0}, {}):
        record = read_record(path, "u", "y", **how)  # type: ignore[arg-type]
        assert record.dt == pytest.approx(DT, rel=1e-12)
        assert (record.input_unit, record.output_unit) == ("V", "um")
        same_signals(record, U, Y)


def test_labview_files_of_several_segments_and_time_columns(tmp_path: Path) -> None:
    path = write(tmp_path, lvm("\t", ".", segments=3), "run.lvm")
    with pytest.raises(InputError, match=r"holds 3 tables below each other .*choose one with tabl"):
        read_record(path, "u", "y", time="X_Value")
    same_signals(read_record(path, "u", "y", time="X_Value", table=3), U, Y)
    assert len(read_records(path, "u", "y", time="X_Value")) == 3
    path = write(tmp_path, lvm("\t", ".", x="Multi"), "run.lvm")
    same_signals(read_record(path, "u", "y", time=0), U, Y)
    late = lvm("\t", ".", x="Multi").replace("\t0.0050\t", "\t0.0090\t")
    with pytest.raises(InputError, match=r"'y' has its own stamps in 'X_Value \[s\]', other ones"):
        read_record(write(tmp_path, late, "run.lvm"), "u", "y", time=0)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize(
    "top",
    [
        ["Model,TBS1000", "Record Length,2500", "Sample Interval,0.005", HEADER],
        ["Rig: 5", "Gain = 2,5", "Drive: 10 V at 1 Hz", "", HEADER],
        ["[Header]", "A=1", "B=2", "[Data]", HEADER],
        ["5 records", "60", HEADER],
        ["1,2", "3,4", "the table,of,all", "", HEADER],
        ["# Sample rate: 200 Hz", "# by hand", HEADER],
        ["Program,v1,0", "Temp,23.5,C", HEADER],
    ],
)
def test_preambles(tmp_path: Path, top: list[str], end: str) -> None:
    path = write(tmp_path, end.join([*top, *BODY]) + end)
    record = read_record(path, "u", "y", time="time")
    assert record.dt == DT
    same_signals(record, U, Y)


@pytest.mark.parametrize(
    ("line", "dt"),
    [
        *(("Sample Interval,0.005", 0.005), ("SampleRate;200", 0.005), ("Increment: 5 ms", 0.005)),
        *(("# Sample rate: 2 kHz", 5e-4), ("#Sampling frequency [Hz] = 50", 0.02)),
        *(("dt = 0,005 s", 0.005), ('"Abtastrate","1,0 kHz"', 1e-3), ("tInc=1e-6", 1e-6)),
    ],
)
def test_a_rate_that_the_file_states_is_used_where_none_is_given(
    tmp_path: Path, line: str, dt: float
) -> None:
    path = write(tmp_path, [line, "u;y", *rows((U, Y), ";")])
    record = read_record(path, "u", "y")
    assert record.dt == pytest.approx(dt, rel=1e-12)
    assert "between samples, which was used" in record.notes[0]
    other = read_record(path, "u", "y", rate=3.0)
    assert other.dt == 1 / 3
    assert "the rate given is 3 Hz, the file itself states" in other.notes[0]


def test_rates_that_contradict_each_other_are_not_used(tmp_path: Path) -> None:
    path = write(tmp_path, ["Sample rate: 200 Hz", "dt = 0.001 s", "u;y", *rows((U, Y), ";")])
    with pytest.raises(InputError, match=r"neither of rate and time given, and .* states no rate"):
        read_record(path, "u", "y")


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("end", [",", ""])
@pytest.mark.parametrize("start", [0.0, -0.25])
def test_start_and_step_in_the_header(
    tmp_path: Path, separator: str, end: str, start: float
) -> None:
    top = ["X,CH1,CH2,Start,Increment,", f"Sequence,V,um,{start:e},5.0e-03"]
    body = [line + end for line in rows((np.arange(60.0), U, Y), write=lambda v: f"{v:.6g}")]
    path = write(tmp_path, [line.replace(",", separator) for line in [*top, *body]])
    for how in ({"time": "X"}, {"rate": 200.0}, {}):
        record = read_record(path, "CH1", "CH2", **how)  # type: ignore[arg-type]
        assert record.dt == DT
        assert (record.input_unit, record.output_unit) == ("V", "um")
        same_signals(record, U, Y)


@pytest.mark.parametrize(
    "bottom",
    [
        ["End of file, 60 samples"],
        ["", "Mean,1.5", "Deviation,0.3"],
        ["***"],
        ["End", "of", "measurement", "at 12:00:01"],
        ["0.3000,5.0"],
    ],
)
@pytest.mark.parametrize("repair", [False, True])
def test_footers_are_left_out_and_told(tmp_path: Path, bottom: list[str], repair: bool) -> None:
    path = write(tmp_path, [HEADER, *BODY, *bottom])
    record = read_record(path, "u", "y", time="time", repair=repair)
    same_signals(record, U, Y)
    assert record.notes[0].startswith("left out ")
    assert "below the rows, at line " in record.notes[0]


@pytest.mark.parametrize("top", [["=~= log =~=", ".003,12"], ["003"], ["12.5"]])
def test_half_a_line_at_the_start_is_left_out_and_told(tmp_path: Path, top: list[str]) -> None:
    path = write(tmp_path, [*top, *BODY], "log.txt")
    record = read_record(path, 1, 2, time=0)
    same_signals(record, U, Y)
    assert f"left out line {len(top)} above the rows" in record.notes[0]


def test_an_odd_line_among_the_rows_is_refused_or_repaired(tmp_path: Path) -> None:
    path = write(tmp_path, [HEADER, *BODY[:30], "0.1500,3.0", *BODY[31:]])
    with pytest.raises(InputError, match="line 32 has 2 values and line 2 has 3"):
        read_record(path, "u", "y", time="time")
    record = read_record(path, "u", "y", time="time", repair=True)
    assert record.samples == 60
    # Halfway between its neighbours.
    assert record.y[30] == pytest.approx((Y[29] + Y[31]) / 2, rel=1e-12)
    assert record.notes[0] == "left out 1 row that held no number or no finite one"


@pytest.mark.parametrize(
    "between", [[HEADER], ["", HEADER], ["second run", HEADER], ["", "Run 2", "rate: 5", HEADER]]
)
def test_appended_files(tmp_path: Path, between: list[str]) -> None:
    path = write(tmp_path, [HEADER, *BODY, *between, *BODY[:40], *between, *BODY])
    message = r"holds 3 tables below each other \(1: 60 rows from line 2 on, time, u, y; 2: 40 rows"
    for repair in (False, True):
        with pytest.raises(InputError, match=message):
            read_record(path, "u", "y", time="time", repair=repair)
    assert [each.samples for each in read_records(path, "u", "y", time="time")] == [60, 40, 60]
    same_signals(read_record(path, "u", "y", time="time", table=3), U, Y)
    with pytest.raises(InputError, match="table is 4"):
        read_record(path, "u", "y", time="time", table=4)


def test_tables_with_other_columns(tmp_path: Path) -> None:
    other = ["Results", "", "f,A,B,C", *rows((U, U, Y, Y))]
    path = write(tmp_path, ["Loop", "", HEADER, *BODY, "", *other, "", "Loop 2", HEADER, *BODY])
    assert [each.names for each in read_tables(path)] == [
        ("time", "u", "y"),
        ("f", "A", "B", "C"),
        ("time", "u", "y"),
    ]
    # Only one of the tables has these columns.
    same_signals(read_record(path, "A", "B", rate=200.0), U, Y)
    with pytest.raises(InputError, match="holds 3 tables"):
        read_table(path)
    assert read_table(path, table=2).names[0] == "f"


@pytest.mark.parametrize(
    ("separator", "decimal", "sign"),
    [
        *((";", ",", "."), ("\t", ",", "."), (";", ",", "'"), (";", ",", " ")),
        *(
            (";", ",", "\N{NARROW NO-BREAK SPACE}"),
            (";", ".", "'"),
            (",", ".", "\N{RIGHT SINGLE QUOTATION MARK}"),
        ),
        *((";", ".", ","), ("\t", ".", ","), (",", ".", "quoted")),
    ],
)
@pytest.mark.parametrize("factor", [1e3, 1e5])
def test_thousands_set_apart(
    tmp_path: Path, separator: str, decimal: str, sign: str, factor: float
) -> None:
    quote = '"' if sign == "quoted" else ""
    mark = "," if sign == "quoted" else sign

    def written(value: float) -> str:
        text = f"{value:,.3f}".replace(",", "T").replace(".", decimal).replace("T", mark)
        return f"{quote}{text}{quote}" if quote and "," in text else text

    y = np.round(factor * Y, 3)
    path = write(tmp_path, [separator.join(["t", "u", "y"]), *rows((T, U, y), separator, written)])
    for repair in (False, True):
        record = read_record(path, 1, 2, time=0, repair=repair)
        assert record.dt == DT
        assert np.array_equal(record.y, y)
        assert "between thousands" in record.notes[0]


@pytest.mark.parametrize("letter", ["D", "d"])
@pytest.mark.parametrize("separator", ["  ", ",", ";"])
def test_exponents_of_fortran(tmp_path: Path, letter: str, separator: str) -> None:
    body = rows((T, U, Y), separator, lambda v: f"{v:.9E}".replace("E", letter))
    record = read_record(write(tmp_path, body, "loop.dat"), 1, 2, time=0)
    assert record.dt == DT
    same_signals(record, U, Y)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_line_breaks_in_quoted_headers(tmp_path: Path, separator: str) -> None:
    top = separator.join(['"Time\n[ms]"', '"Drive\nof the\nstage [V]"', "y"])
    path = write(tmp_path, ["a first line", top, *rows((1e3 * T, U, Y), separator)])
    record = read_record(path, "Drive of the stage", "y", time="Time")
    assert (record.dt, record.input_unit) == (DT, "V")
    assert "at line 6" in str(read_table(path).place(0)).replace("line", "at line")
    same_signals(record, U, Y)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("pad", [0, 1, 4096])
def test_utf_16_without_a_mark_and_padding_of_zeros(
    tmp_path: Path, encoding: str, pad: int
) -> None:
    text = "\n".join([HEADER, *BODY]) + "\n"
    for content in (text.encode(encoding), text.encode()):
        path = write(tmp_path, content + b"\0" * pad)
        record = read_record(path, "u", "y", time="time")
        same_signals(record, U, Y)
        assert (record.dt, record.samples) == (DT, U.size)


@pytest.mark.parametrize("name", ["loop.log", "loop.001", "loop", "loop.xyz", "loop.h5", "a.b.CSV"])
def test_the_suffix_does_not_decide(tmp_path: Path, name: str) -> None:
    path = write(tmp_path, [HEADER, *BODY], name)
    stated = {"format": "text"} if name.endswith(".h5") else {}
    record = read_record(path, "u", "y", time="time", **stated)
    same_signals(record, U, Y)
    assert (record.dt, record.samples) == (DT, U.size)


def test_files_of_other_formats_are_known_by_their_beginning(tmp_path: Path) -> None:
    np.savez(tmp_path / "loop.npz", u=U, y=Y)
    for name in ("loop.csv", "loop", "loop.dat"):
        path = write(tmp_path, (tmp_path / "loop.npz").read_bytes(), name)
        same_signals(read_record(path, "u", "y", rate=200.0), U, Y)
    with pytest.raises(InputError, match="format is 'excel'; give one of text, "):
        read_record(path, "u", "y", rate=200.0, format="excel")


@pytest.mark.parametrize("name", ["loop.csv.gz", "loop.gz", "loop.csv"])
def test_packed_files(tmp_path: Path, name: str) -> None:
    packed = gzip.compress("\n".join([HEADER, *BODY]).encode())
    same_signals(read_record(write(tmp_path, packed, name), "u", "y", time="time"), U, Y)
    for damaged in (packed[:-20], packed[:-8] + b"12345678", b"\x1f\x8b"):
        with pytest.raises(InputError, match="damaged or breaks off"):
            read_record(write(tmp_path, damaged, name), "u", "y", time="time")


def test_packed_files_of_other_formats(tmp_path: Path) -> None:
    np.savez(tmp_path / "loop.npz", u=U, y=Y)
    packed = gzip.compress((tmp_path / "loop.npz").read_bytes())
    record = read_record(write(tmp_path, packed, "loop.npz.gz"), "u", "y", rate=200.0)
    same_signals(record, U, Y)
    assert (record.dt, record.samples) == (0.005, U.size)


def test_a_limit_of_samples(tmp_path: Path) -> None:
    path = write(tmp_path, [HEADER, *BODY])
    with pytest.raises(InputError, match="holds 183 numbers in the columns to read, and at"):
        read_record(path, "u", "y", time="time", max_samples=50)


@pytest.mark.parametrize(
    "odd",
    [
        "0.0000,0.0",
        "0.0000,0.0e",
        "0.0+15.0,0.1x",
        "1",
        "x",
        "-----",
        "err,err,err",
        "err.err,err,err.1x",
    ],
)
@pytest.mark.parametrize("top", [["time_ms,u_V,y_um"], ["time,u,y", "ms,V,um"]])
def test_an_odd_line_below_the_header_does_not_hide_its_units(
    tmp_path: Path, top: list[str], odd: str
) -> None:
    path = write(tmp_path, [*top, odd, *rows((1e3 * T, U, Y))])
    record = read_record(path, 1, 2, time=0)
    assert (record.dt, record.input_unit) == (DT, "V")
    same_signals(record, U, Y)


def test_half_a_first_row_does_not_hide_a_header_that_does_not_fit(tmp_path: Path) -> None:
    body = [line + "," for line in BODY]
    path = write(tmp_path, ["time_ms,u,y", "0.0000,0.0000,1", *body])
    with pytest.raises(InputError, match="line 1 names 3 columns, but the lines below it have 4"):
        read_record(path, 1, 2, time=0)


@pytest.mark.parametrize(
    ("top", "separator", "names"),
    [
        (["| time | u | y |", "|---|---|---|"], "|", ("u", "y")),
        (["Name,time,u,y", "Unit,s,V,um"], ",", ("u", "y")),
        (["CURVE\tTABLE", "\tt\tu\ty", "\ts\tV vs. Ref.\tA"], "\t", ("u", "y")),
        (["CATMAN_40", "Time  1 - default rate\tu \ty", "s\tV \tµm"], "\t", ("u", "y")),
        (["time,u,y,remark"], ",", ("u", "y")),
        (["time_ms,u,y", "from,drive,sensor"], ",", ("u", "y")),
        (["time,u,y", "(ms),drive,sensor"], ",", ("u", "y")),
    ],
)
def test_heads_of_some_programs(
    tmp_path: Path, top: list[str], separator: str, names: tuple[str, str]
) -> None:
    factor = 1e3 if "ms" in "".join(top) else 1.0
    body = rows((factor * T, U, Y), separator)
    if top[0][0] in "|NC" and "CATMAN" not in top[0]:
        body = [separator + line for line in body]
    if "remark" in top[0]:
        body = [line + "," for line in body]
        body[20] += "a bang"
    time = {"CURVE": "t", "CATMAN_40": 0, "time_ms": 0}.get(top[0].split(separator)[0], "time")
    record = read_record(write(tmp_path, [*top, *body]), *names, time=time)
    assert record.dt == DT
    same_signals(record, U, Y)


@pytest.mark.parametrize("repair", [False, True])
def test_a_header_among_the_rows_is_not_left_out(tmp_path: Path, repair: bool) -> None:
    body = rows((1e3 * T, U, Y))
    path = write(tmp_path, [*body[:30], "time_ms,u,y", *body[30:]])
    with pytest.raises(InputError, match="line 31 holds 3 texts among rows that have no header"):
        read_record(path, 1, 2, time=0, repair=repair)
