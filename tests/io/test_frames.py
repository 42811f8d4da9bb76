"""Records out of data frames and arrays with coordinates, without a library that is not there."""

from __future__ import annotations

import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import hyst

T = np.arange(400) * 0.01
U = np.sin(2.0 * np.pi * T) * np.linspace(1.0, 0.5, T.size)
Y = 0.5 * U + 0.1 * np.roll(U, 3)


class Frame:
    """The little of a data frame that is asked for, as polars has it."""

    def __init__(self, **columns: Any) -> None:
        self._columns = columns
        self.columns = list(columns)

    def __getitem__(self, name: str) -> Any:
        return self._columns[name]


def is_the_record(record: hyst.Record) -> bool:
    same = np.array_equal(record.u, U) and np.array_equal(record.y, Y)
    return same and record.dt == pytest.approx(0.01, rel=1e-12)


def test_columns_by_name_and_place_with_units_in_their_names() -> None:
    frame = Frame(**{"t_ms": 1e3 * T, "drive [V]": U, "y": Y, "text": ["a"] * T.size})
    record = hyst.Record.from_dataframe(frame, "drive", 2, time="t_ms")
    assert is_the_record(record)
    assert (record.input_name, record.input_unit, record.output_name) == ("drive", "V", "y")
    assert is_the_record(hyst.Record.from_dataframe(frame, 1, "y", rate=100.0))


@pytest.fixture
def frame() -> Any:
    pandas = pytest.importorskip("pandas")
    dates = pandas.Timestamp("2026-03-29 01:59:59") + pandas.to_timedelta(T, unit="s")
    made = pandas.DataFrame({"u": U, "y": Y, "when": dates, "text": "a"})
    made.attrs["units"] = {"u": "V", "y": "um"}
    return made


def test_units_of_a_frame_are_those_it_says(frame: Any) -> None:
    record = hyst.Record.from_dataframe(frame, "u", "y", rate=100.0)
    assert (record.input_unit, record.output_unit) == ("V", "um")


@pytest.mark.parametrize("zone", [None, "UTC", "Europe/Berlin"])
def test_dates_tell_the_time_as_a_column_and_as_the_index(frame: Any, zone: str | None) -> None:
    # Of another zone too: there the clock went from 02:00 to 03:00 in the first second.
    frame["when"] = frame["when"].dt.tz_localize("UTC").dt.tz_convert(zone)
    assert is_the_record(hyst.Record.from_dataframe(frame, "u", "y", time="when"))
    assert is_the_record(hyst.Record.from_dataframe(frame.set_index("when"), "u", "y"))


def test_numbers_of_an_index_are_seconds_and_counts_are_none(frame: Any) -> None:
    assert is_the_record(hyst.Record.from_dataframe(frame.set_index(T), "u", "y"))
    with pytest.raises(hyst.InputError, match="counts rows and is no time; give rate, in Hz, or"):
        hyst.Record.from_dataframe(frame, "u", "y")


def test_missing_values_are_named_and_left_out_where_asked(frame: Any) -> None:
    frame["y"] = frame["y"].astype("Float64")
    frame.loc[5, "y"] = None
    with pytest.raises(hyst.InputError, match="'y' is 'nan' at index 5, not a finite number"):
        hyst.Record.from_dataframe(frame, "u", "y", rate=100.0)
    record = hyst.Record.from_dataframe(frame, "u", "y", rate=100.0, repair=True)
    assert record.notes[0] == "left out 1 row that held no number or no finite one"
    assert record.y[5] == pytest.approx((Y[4] + Y[6]) / 2.0, rel=1e-12)
    frame.loc[7, "when"] = None
    with pytest.raises(hyst.InputError, match="'when' is 'nan' at index 7"):
        hyst.Record.from_dataframe(frame.assign(y=Y), "u", "y", time="when")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("u", "nix"), "the data frame has no column 'nix'; there are u, y, when, text"),
        (("u", "u"), "input and output are the same column"),
        (("u", "text"), "'text' is 'a' at index 0, not a finite number"),
    ],
)
def test_wrong_columns_are_refused(frame: Any, arguments: tuple[str, str], said: str) -> None:
    with pytest.raises(hyst.InputError, match=said):
        hyst.Record.from_dataframe(frame, *arguments, rate=100.0)


def test_what_is_no_frame_is_refused(frame: Any) -> None:
    for other in (np.zeros((4, 2)), {"u": U}, None):
        with pytest.raises(hyst.InputError, match="the data frame is of type"):
            hyst.Record.from_dataframe(other, "u", "y", rate=100.0)
    with pytest.raises(hyst.InputError, match="there is no option 'header'"):
        hyst.Record.from_dataframe(frame, "u", "y", rate=100.0, header=None)
    with pytest.raises(hyst.InputError, match=r"must increase"):
        hyst.Record.from_dataframe(frame.iloc[::-1], "u", "y", time="when")
    with pytest.raises(hyst.InputError, match="different numbers of values, 'u' 400 and 'y' 399"):
        hyst.Record.from_dataframe(Frame(u=U, y=Y[1:]), "u", "y", rate=100.0)


@pytest.fixture
def dataset() -> Any:
    xarray = pytest.importorskip("xarray")
    signals = {"u": ("time", U, {"units": "V"}), "y": ("time", Y)}
    wide = {"wide": (("time", "k"), np.zeros((T.size, 2)))}
    return xarray.Dataset(signals | wide, {"time": ("time", 1e3 * T, {"units": "ms"})})


def test_variables_of_a_dataset_with_their_coordinate(dataset: Any) -> None:
    record = hyst.Record.from_xarray(dataset, "u", "y")
    assert is_the_record(record)
    assert record.input_unit == "V"
    dates = np.datetime64("2026-01-01") + (1e9 * T).astype("timedelta64[ns]")
    assert is_the_record(hyst.Record.from_xarray(dataset.assign_coords(time=dates), "u", "y"))
    bare = dataset.drop_vars("time")
    assert is_the_record(hyst.Record.from_xarray(bare, "u", "y", rate=100.0))
    with pytest.raises(hyst.InputError, match="there is no coordinate 'time'; give rate"):
        hyst.Record.from_xarray(bare, "u", "y")


def test_channels_of_an_array(dataset: Any) -> None:
    array = dataset[["u", "y"]].to_dataarray("channel").transpose("time", "channel")
    assert is_the_record(hyst.Record.from_xarray(array, "u", "y"))
    with pytest.raises(hyst.InputError, match="there is no 'z'; there are u, y"):
        hyst.Record.from_xarray(array, "u", "z")
    with pytest.raises(hyst.InputError, match="the array has the dimensions time; give 'time' and"):
        hyst.Record.from_xarray(array.sel(channel="u"), "u", "y")


def test_other_dimensions_and_other_things_are_refused(dataset: Any) -> None:
    with pytest.raises(hyst.InputError, match="'wide' has the dimensions time, k; give one along"):
        hyst.Record.from_xarray(dataset, "u", "wide")
    with pytest.raises(hyst.InputError, match="there is no 'q'; there are u, y, wide"):
        hyst.Record.from_xarray(dataset, "u", "q")
    with pytest.raises(hyst.InputError, match="the data are of type SimpleNamespace"):
        hyst.Record.from_xarray(SimpleNamespace(), "u", "y")


def test_no_library_of_frames_is_loaded() -> None:
    program = (
        "import sys, hyst\nclass F:\n    columns = ['u', 'y']\n"
        "    def __getitem__(self, name):\n"
        "        return {'u': [0.0, 1.0, 0.0, 1.0], 'y': [0.0, 2.0, 1.0, 2.0]}[name]\n"
        "assert hyst.Record.from_dataframe(F(), 'u', 'y', rate=10.0).dt == 0.1\n"
        "assert not {'pandas', 'xarray', 'matplotlib'} & set(sys.modules)\n"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
