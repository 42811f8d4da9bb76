"""Files of oscilloscopes, of LabVIEW and of spreadsheets."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest
import tool_files as files
from tool_files import DT, N, T, U, Y

from hyst.errors import InputError, MissingExtraError
from hyst.io import read_column, read_record, read_table

# Tektronix


@pytest.mark.parametrize("version", [1, 2, 3])
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", ["i1", "i2", "i4", "f4"])
def test_a_waveform_of_every_version_is_read(
    tmp_path: Path, version: int, order: str, kind: str
) -> None:
    path = tmp_path / "ch1.wfm"
    wanted = files.wfm(path, U - 50.0, "V", version=version, order=order, kind=kind)
    table = read_table(path)
    assert (table.names, table.units) == (("time", "value"), ("s", "V"))
    assert np.array_equal(table.columns[1], wanted)
    # As the header says it: start plus step times number.
    assert np.array_equal(table.columns[0], -0.1 + DT * np.arange(N))


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"width": 1},
        {"order": "LSB"},
        {"short": True},
        {"text": True},
        {"kind": "RP"},
        {"kind": "RP", "width": 1, "short": True},
    ],
)
def test_a_channel_in_isf_is_read(tmp_path: Path, how: dict[str, Any]) -> None:
    path = tmp_path / "ch1.isf"
    wanted = files.isf(path, Y, "V", **how)
    table = read_table(path)
    assert (table.names, table.units) == (("time", "Ch1"), ("s", "V"))
    # Sums in another order than the test's: rounding of numbers up to 65535 and 64.
    assert np.abs(table.columns[1] - wanted).max() <= 1e-12
    assert np.abs(table.columns[0] - (-0.1 + T)).max() <= 1e-15


def test_two_channels_in_two_files_are_one_record(tmp_path: Path) -> None:
    u = files.isf(tmp_path / "ch1.isf", U, "V")
    y = files.wfm(tmp_path / "ch2.wfm", Y, "um")
    record = read_record(
        tmp_path / "ch1.isf", "Ch1", "value", time="time", output_file=tmp_path / "ch2.wfm"
    )
    assert np.abs(record.u - u).max() <= 1e-12  # as above
    assert np.array_equal(record.y, y)
    assert (record.dt, record.input_unit, record.output_unit) == (DT, "V", "um")
    by_rate = read_record(
        tmp_path / "ch1.isf", "Ch1", "value", rate=200, output_file=tmp_path / "ch2.wfm"
    )
    assert np.array_equal(by_rate.y, record.y)


def test_what_is_not_one_record_of_samples_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "ch1.wfm"
    files.wfm(path, U, "V", frames=3)
    with pytest.raises(InputError, match="no plain record \\(3 frames; save one\\)"):
        read_table(path)
    path = tmp_path / "ch1.isf"
    files.isf(path, U, "V")
    path.write_bytes(path.read_bytes().replace(b"PT_FMT Y", b"PT_FMT ENV"))
    with pytest.raises(InputError, match="points of the kind ENV; save samples, not an envelope"):
        read_table(path)
    files.isf(path, U, "V")
    path.write_bytes(path.read_bytes().replace(b"NR_PT 240", b"NR_PT 241"))
    with pytest.raises(InputError, match="240 points and the count 241"):
        read_table(path)


@pytest.mark.parametrize("name", ["ch1.isf", "ch1.wfm"])
def test_a_scope_file_cut_short_is_refused(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    (files.isf if name.endswith("isf") else files.wfm)(path, U, "V")
    content = path.read_bytes()
    for part in (0.1, 0.5, 0.8):
        path.write_bytes(content[: int(part * len(content))])
        with pytest.raises(InputError, match="is damaged"):
            read_table(path)


# TDMS


def test_waveforms_get_their_time_from_the_increment(tmp_path: Path) -> None:
    path = tmp_path / "log.tdms"
    files.waveforms(path)
    table = read_table(path)
    assert table.headers == ("Log/time", "Log/drive", "Log/pos")
    assert table.units == ("s", "V", "um")
    assert np.array_equal(table.columns[0], T)
    files.waveforms(path, (DT, DT / 2.0))
    assert read_table(path).headers[:2] == ("Log/drive/time", "Log/pos/time")


def test_units_of_channels_stand_in_properties_or_names(tmp_path: Path) -> None:
    path = tmp_path / "log.tdms"
    channels = [
        files.ChannelObject("Log", "drive (V)", U),
        files.ChannelObject("Log", "pos (V)", Y, {"NI_UnitDescription": "um"}),
    ]
    with files.TdmsWriter(path) as writer:
        writer.write_segment(channels)
    table = read_table(path)
    assert (table.names, table.units) == (("drive", "pos"), ("V", "um"))


def test_a_tdms_without_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.tdms"
    with files.TdmsWriter(path) as writer:
        writer.write_segment([files.ChannelObject("Log", "remark", ["a", "b"])])
    with pytest.raises(InputError, match="'Log/remark' holds no real numbers"):
        read_table(path)


# Excel


@pytest.mark.parametrize("preamble", [0, 3])
@pytest.mark.parametrize("notes", [False, True])
def test_the_sheet_with_numbers_is_read(tmp_path: Path, preamble: int, notes: bool) -> None:
    path = tmp_path / "log.xlsx"
    files.workbook(path, preamble=preamble, notes=notes)
    record = read_record(path, "drive", "pos [um]", time="time")
    # A workbook is written with 16 digits.
    np.testing.assert_allclose(record.u, U, rtol=1e-15, atol=0.0)
    np.testing.assert_allclose(record.y, Y, rtol=1e-15, atol=0.0)
    assert (record.dt, record.input_unit) == (DT, "V")


def test_columns_of_several_sheets_go_by_the_sheet(tmp_path: Path) -> None:
    path = tmp_path / "log.xlsx"
    files.workbook(path, sheets=2)
    second = read_column(path, "Sheet2!drive [V]")[0]
    np.testing.assert_allclose(second, 2.0 * U, rtol=1e-15, atol=0.0)  # 16 digits
    with pytest.raises(InputError, match="'drive' fits the columns 1 and 4; give the full header"):
        read_column(path, "drive")


def test_an_empty_cell_and_an_error_are_named_by_their_row(tmp_path: Path) -> None:
    path = tmp_path / "log.xlsx"
    files.workbook(path)
    book = openpyxl.load_workbook(path)
    book.active["C12"] = None
    book.save(path)
    with pytest.raises(InputError, match=r"log\.xlsx: 'pos' has no value at line 12"):
        read_record(path, "drive", "pos", time="time")
    book.active["C12"] = "#DIV/0!"
    book.save(path)
    with pytest.raises(InputError, match=r"'pos' is '#DIV/0!' at line 12"):
        read_record(path, "drive", "pos", time="time")


def test_formulas_without_saved_values_are_no_numbers(tmp_path: Path) -> None:
    path = tmp_path / "log.xlsx"
    book = openpyxl.Workbook()
    for row in range(1, 20):
        book.active.append([f"=ROW(A{row})", f"=2*A{row}"])
    book.save(path)
    with pytest.raises(InputError, match="no sheet with columns of numbers; formulas count only"):
        read_table(path)


def test_a_text_called_workbook_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.xlsx"
    path.write_text("u,y\n1,2\n")
    with pytest.raises(InputError, match="is damaged or no Excel workbook"):
        read_table(path)


# Extras


@pytest.mark.parametrize(
    ("name", "module", "package"),
    [("a.tdms", "nptdms", "npTDMS"), ("a.xlsx", "openpyxl", "openpyxl")],
)
def test_a_missing_package_is_named_with_its_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, module: str, package: str
) -> None:
    (tmp_path / name).write_bytes(b"whatever")
    monkeypatch.setitem(sys.modules, module, None)  # so that importing it fails
    with pytest.raises(MissingExtraError, match=rf'need {package}; pip install "hyst\[files\]"'):
        read_table(tmp_path / name)
