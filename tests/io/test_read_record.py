from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hyst.errors import InputError
from hyst.io import read_column, read_record
from hyst.signals import Record

U = [0.0, 1.0, 2.0, 1.0, 0.0, 1.0]
Y = [0.0, 0.5, 1.5, 1.2, 0.2, 0.7]


def written(folder: Path, lines: list[str], name: str = "loop.csv") -> Path:
    path = folder / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.fixture
def loop(tmp_path: Path) -> Path:
    rows = [f"{5 * k},{u},{y}" for k, (u, y) in enumerate(zip(U, Y, strict=True))]
    return written(tmp_path, ["t [ms],Drive [V],stroke/um", *rows])


@pytest.mark.parametrize("column", ["Drive", "Drive [V]", "drive", "DRIVE [v]", " Drive ", 1, "1"])
def test_a_column_is_chosen_by_header_name_or_index(loop: Path, column: int | str) -> None:
    record = read_record(loop, input=column, output="stroke", rate=200.0)
    assert record == Record(U, Y, 0.005, "Drive", "stroke", "V", "um")
    assert record.notes == ()
    values, name, unit = read_column(loop, column)
    assert (values.tolist(), name, unit) == (U, "Drive", "V")


def test_an_index_may_be_a_numpy_integer_and_a_path_a_string(loop: Path) -> None:
    assert read_record(str(loop), np.int64(1), np.uint8(2), rate=200.0).samples == 6


def test_case_decides_where_names_differ_by_it(tmp_path: Path) -> None:
    path = written(tmp_path, ["v,V", "1,2", "3,4"])
    assert read_column(path, "v")[0].tolist() == [1.0, 3.0]
    assert read_column(path, "V")[0].tolist() == [2.0, 4.0]


def test_a_name_that_fits_two_columns_is_refused_and_the_header_still_works(tmp_path: Path) -> None:
    path = written(tmp_path, ["u [V],u [mV],u [V]", "1,2,3", "4,5,6"])
    with pytest.raises(InputError, match="'u' fits the columns 0 and 1 and 2; give the full"):
        read_column(path, "u")
    with pytest.raises(InputError, match=r"'u \[V\]' fits the columns 0 and 2"):
        read_column(path, "u [V]")
    assert read_column(path, "u [mV]")[0].tolist() == [2.0, 5.0]


def test_a_header_of_digits_goes_before_an_index(tmp_path: Path) -> None:
    path = tmp_path / "numbered.npz"
    np.savez(path, **{"1": np.array([1.0, 2.0]), "0": np.array([3.0, 4.0])})
    assert read_column(path, "0")[0].tolist() == [3.0, 4.0]
    assert read_column(path, 0)[0].tolist() == [1.0, 2.0]


@pytest.mark.parametrize("column", ["force", "3", 3, -1, True, 1.5, None, "", "9" * 400])
def test_a_missing_column_is_refused_with_those_there_are(loop: Path, column: object) -> None:
    with pytest.raises(InputError, match=r"has no column .*t \[ms\], Drive \[V\], stroke/um"):
        read_column(loop, column)  # type: ignore[arg-type]


def test_a_long_list_of_columns_is_cut(tmp_path: Path) -> None:
    names = [f"c{k}" for k in range(40)]
    path = written(tmp_path, [";".join(names), ";".join(["1"] * 40), ";".join(["2"] * 40)])
    with pytest.raises(InputError, match=r"there are c0, c1, .*c11 and 28 more$"):
        read_column(path, "x")


def test_time_comes_from_the_column_in_the_unit_of_its_header(loop: Path) -> None:
    assert read_record(loop, "Drive", "stroke", time="t").dt == 0.005
    assert read_record(loop, "Drive", "stroke", time=0, time_unit="s").dt == 5.0
    assert read_record(loop, "Drive", "stroke", time=0, time_unit="us").dt == 5e-6


@pytest.mark.parametrize(
    ("header", "dt"),
    [
        ("t", 5.0),
        ("t [s]", 5.0),
        ("t (MS)", 5e-3),
        ("t/µs", 5e-6),
        ("t [μs]", 5e-6),
        ("t [min]", 300.0),
    ],
)
def test_units_of_time(tmp_path: Path, header: str, dt: float) -> None:
    rows = [f"{5 * k};{u};{y}" for k, (u, y) in enumerate(zip(U, Y, strict=True))]
    path = written(tmp_path, [f"{header};u;y", *rows])
    # One rounding, in the product of step and unit.
    assert read_record(path, "u", "y", time="t").dt == pytest.approx(dt, rel=1e-15)


def test_the_step_of_decimal_stamps_is_a_decimal(tmp_path: Path) -> None:
    stamps = 1.5e9 + np.arange(6) * 0.01
    rows = [f"{t:.2f},{u},{y}" for t, u, y in zip(stamps, U, Y, strict=True)]
    # Doubles near 1.5e9 are 2.4e-7 apart, so a step of 0.01 is known to 1e-5.
    assert read_record(written(tmp_path, rows), 1, 2, time=0).dt == pytest.approx(0.01, rel=1e-5)
    rows = [f"{0.01 * k:.2f},{u},{y}" for k, (u, y) in enumerate(zip(U, Y, strict=True))]
    assert read_record(written(tmp_path, rows), 1, 2, time=0).dt == 0.01


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "neither of rate and time given"),
        ({"rate": 1.0, "time": 0}, "both of rate and time given"),
        ({"rate": 0.0}, "rate is 0.0; give the samples per second"),
        ({"rate": -5.0}, "rate is -5.0"),
        ({"rate": np.nan}, "rate is nan"),
        ({"rate": np.inf}, "rate is inf"),
        ({"rate": 1.0, "time_unit": "s"}, "time_unit is 's'; .* only with a time column"),
        ({"time": 0, "time_unit": "weeks"}, "time_unit is 'weeks'; give s, ms"),
        ({"time": "stroke"}, "output and time are the same column, 'stroke/um'"),
        ({"time": 1}, r"input and time are the same column, 'Drive \[V\]'"),
        ({"rate": 1.0, "dead_band": -1.0}, "dead_band is -1.0"),
    ],
)
def test_options_that_make_no_sense_are_refused(
    loop: Path, options: dict[str, object], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        read_record(loop, "Drive", "stroke", **options)  # type: ignore[arg-type]


def test_input_and_output_must_be_different_columns(loop: Path) -> None:
    with pytest.raises(InputError, match="input and output are the same column"):
        read_record(loop, "Drive", "drive", rate=1.0)


def test_an_unknown_unit_of_time_in_the_header_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, ["t [d];u;y", "0;0;0", "1;1;2", "2;0;1", "3;1;2"])
    with pytest.raises(InputError, match=r"'t \[d\]' has the unit 'd'.*give time_unit"):
        read_record(path, "u", "y", time="t")
    assert read_record(path, "u", "y", time="t", time_unit="h").dt == 3600.0


def uneven(folder: Path, stamps: list[float]) -> Path:
    u = np.resize([0.0, 1.0], len(stamps))
    return written(folder, [f"{t} {v} {2 * v + 1}" for t, v in zip(stamps, u, strict=True)])


@pytest.mark.parametrize(
    ("stamps", "message"),
    [
        ([0.0, 1.0, 2.0, 3.5, 4.5], r"worst gap is 1\.5 s after line 3 and the median gap 1 s"),
        ([0.0, 1.0, 2.0, 2.4, 3.4], r"worst gap is 0\.4 s after line 3 and the median gap 1 s"),
        ([0.0, 1.0, 2.0, 3.0, 4.02], r"worst gap is 1\.02 s after line 4 .*tolerance 1%"),
        ([0.0, 1.0, 1.0, 2.0, 3.0], r"time goes from 1 s to 1 s at line 3; it must increase"),
        ([0.0, 1.0, 2.0, 1.5, 3.0], r"time goes from 2 s to 1\.5 s at line 4; it must increase"),
        ([0.0, 1e308, -1e308, 1.0, 2.0], "it must increase"),
        ([-1.7e308, 1.7e308, 1.71e308, 1.72e308], "worst gap is inf s after line 1"),
    ],
)
def test_uneven_time_is_refused(tmp_path: Path, stamps: list[float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_record(uneven(tmp_path, stamps), 1, 2, time=0)


def test_jitter_within_one_percent_is_even(tmp_path: Path) -> None:
    record = read_record(uneven(tmp_path, [0.0, 1.009, 2.0, 3.0, 4.0]), 1, 2, time=0)
    assert (record.dt, record.samples, record.notes) == (1.0, 5, ())


def test_uneven_time_is_resampled_on_request(tmp_path: Path) -> None:
    rows = ["0 0 0", "10 1 10", "20 2 20", "50 5 50", "60 0 0", "70 7 14"]
    record = read_record(written(tmp_path, rows), 1, 2, time=0, time_unit="ms", repair=True)
    assert record.dt == 0.01
    assert record.u.tolist() == pytest.approx([0, 1, 2, 3, 4, 5, 0, 7], rel=1e-14)
    assert record.y.tolist() == pytest.approx([0, 10, 20, 30, 40, 50, 0, 14], rel=1e-14)
    assert record.notes == (
        "resampled linearly onto steps of 0.01 s, 2 of 8 samples filled in; the worst gap was "
        "0.03 s after line 3",
    )


def test_faulty_rows_are_left_out_on_request(tmp_path: Path) -> None:
    rows = ["u,y", "0,0", "1,2", "bad,3", "3,6", "0,1", "3,nan", "0,2", "1,5"]
    record = read_record(written(tmp_path, rows), "u", "y", rate=10.0, repair=True)
    assert record.dt == 0.1
    # Rows 2 and 5 lie halfway between their neighbours.
    assert record.u.tolist() == pytest.approx([0, 1, 2, 3, 0, 0, 0, 1], abs=1e-14)
    assert record.y.tolist() == pytest.approx([0, 2, 4, 6, 1, 1.5, 2, 5], rel=1e-14)
    assert record.notes == (
        "left out 2 rows that held no number or no finite one",
        "resampled linearly onto steps of 0.1 s, 2 of 8 samples filled in; the worst gap was 0.2 s "
        "after line 3",
    )


def test_nothing_is_noted_and_nothing_changed_when_nothing_needs_repair(loop: Path) -> None:
    repaired = read_record(loop, "Drive", "stroke", time="t", repair=True)
    assert repaired == read_record(loop, "Drive", "stroke", time="t")
    assert repaired.notes == ()


def test_repair_does_not_invent_a_record(tmp_path: Path) -> None:
    path = uneven(tmp_path, [0.0, 1.0, 2.0, 3.0, 1e6])
    with pytest.raises(InputError, match="999996 samples are missing there, and repair fills in 5"):
        read_record(path, 1, 2, time=0, repair=True)
    with pytest.raises(InputError, match="resampling 5 samples onto their median gap would make"):
        read_record(path, 1, 2, time=0, repair=True, longest_gap=10**7)
    rows = ["u,y", "0,a", "1,b", "0,c", "1,d"]
    with pytest.raises(InputError, match="'y' is 'a' at line 2"):
        read_record(written(tmp_path, rows), "u", "y", rate=1.0, repair=True)
    rows = ["u,y", "0,1", "1,", "0,3", "1,"]
    with pytest.raises(InputError, match="has 2 usable samples"):
        read_record(written(tmp_path, rows), "u", "y", rate=1.0, repair=True)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (["1,2"], "has 1 usable samples"),
        (["1,2", "2,3"], "has 2 usable samples"),
        (["1,2", "1,3", "1,4", "1,1"], "input 'column 0' is 1 throughout"),
        (["1,2", "2,2", "1,2", "2,2"], "output 'column 1' is 2 throughout"),
        (["1,1", "2,2", "3,3", "4,4"], "input 'column 0' has 0 reversals beyond its dead band"),
        (["1,1", "2,2", "9,3", "6,1"], "input 'column 0' has 1 reversals .* needs at least 2"),
    ],
)
def test_a_record_without_hysteresis_to_see_is_refused(
    tmp_path: Path, rows: list[str], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        read_record(written(tmp_path, rows), 0, 1, rate=1.0)


def test_noise_on_a_ramp_is_no_reversal_unless_the_user_says_so(tmp_path: Path) -> None:
    noise = 0.3 * np.random.default_rng(2).standard_normal(200)
    rows = [f"{0.1 * k + noise[k]},{k}" for k in range(200)]
    path = written(tmp_path, rows)
    with pytest.raises(InputError, match=r"has 0 reversals beyond its dead band of \d"):
        read_record(path, 0, 1, rate=1.0)
    assert read_record(path, 0, 1, rate=1.0, dead_band=0.0).samples == 200


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("absent.csv", r"absent\.csv does not exist; check the path"),
        ("folder.csv", r"folder\.csv is a folder; name a file in it"),
        ("picture.csv", r"picture\.csv is not a text file: it holds the control character 0x1a"),
        ("data", "data holds no line of numbers"),
        ("empty.npz", r"empty\.npz is empty"),
    ],
)
def test_what_is_no_data_file_is_refused(tmp_path: Path, name: str, message: str) -> None:
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "picture.csv").write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR")
    (tmp_path / "data").write_text("to whom it may concern\n")
    (tmp_path / "empty.npz").touch()
    with pytest.raises(InputError, match=message):
        read_record(tmp_path / name, 0, 1, rate=1.0)


def test_a_suffix_may_be_in_capitals(tmp_path: Path) -> None:
    assert read_column(written(tmp_path, ["1", "2"], "DATA.TXT"), 0)[0].tolist() == [1.0, 2.0]


def test_an_unreadable_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(path: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    path = written(tmp_path, ["1", "2"])
    monkeypatch.setattr(Path, "read_bytes", forbidden)
    with pytest.raises(InputError, match=r"loop\.csv cannot be read: Permission denied"):
        read_column(path, 0)


def test_a_faulty_trajectory_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, ["wanted [um]", "1", "nan", "3"])
    with pytest.raises(InputError, match="'wanted' is 'nan' at line 3, not a finite number"):
        read_column(path, "wanted")


NUMBERS = st.one_of(st.floats(width=16), st.integers(-3, 3).map(float), st.floats(allow_nan=False))


@given(rows=st.lists(st.tuples(NUMBERS, NUMBERS, NUMBERS), max_size=12), repair=st.booleans())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
def test_any_table_gives_a_sound_record_or_an_input_error(
    tmp_path: Path, rows: list[tuple[float, float, float]], repair: bool
) -> None:
    path = written(tmp_path, [f"{t};{u};{y}" for t, u, y in rows], "any.csv")
    try:
        record = read_record(path, 1, 2, time=0, repair=repair)
    except InputError:
        return
    assert 3 <= record.samples <= 10 * len(rows)
    assert record.u.min() < record.u.max()
    assert record.dt > 0.0
