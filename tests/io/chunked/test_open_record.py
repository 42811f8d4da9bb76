"""Records read in chunks against the same records read as a whole."""

import functools
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

from hyst.errors import InputError
from hyst.io import RecordFile, open_record, read_record
from hyst.io.chunked import text_columns

ROWS = 150_000  # more than are read at a time
ROWS_OF_TEXT = 40_000
DT = 1e-4


def signals(rows: int = ROWS) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    t = np.arange(rows) * DT
    return t, 50.0 * np.sin(3.0 * t), np.cos(3.0 * t) + 0.01 * np.sin(1e3 * t)


@functools.cache
def rows_of_text() -> list[str]:
    columns = [signal.tolist() for signal in signals(ROWS_OF_TEXT)]
    return [f"{a!r},{b!r},{c!r}" for a, b, c in zip(*columns, strict=True)]


@pytest.fixture(autouse=True)
def small_pieces_of_text(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_columns, "_BYTES", 1 << 18)


def write_text(path: Path, changes: dict[int, str] | None = None, decimal: str = ".") -> Path:
    separator = "," if decimal == "." else ";"
    lines = ["t [s],u [V],y [um]", *rows_of_text()]
    for line, text in (changes or {}).items():
        lines[line - 1] = text
    text = "\n".join(lines) + "\n"
    if decimal == ",":
        text = text.replace(",", separator).replace(".", ",")
    path.write_text(text)
    return path


def write_parquet(path: Path, **changed: np.ndarray) -> Path:
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    columns = dict(zip(("t [s]", "u [V]", "y [um]"), signals(), strict=True)) | changed
    parquet.write_table(arrow.table(columns), path, row_group_size=40_000)
    return path


def write_hdf5(path: Path) -> Path:
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        for name, unit, signal in zip("tuy", ("s", "V", "um"), signals(), strict=True):
            file.create_dataset(name, data=signal, chunks=(7_000,)).attrs["unit"] = unit
    return path


WRITERS = {
    "a.parquet": write_parquet,
    "a.h5": write_hdf5,
    "a.csv": write_text,
    "comma.csv": lambda path: write_text(path, decimal=","),
}


@pytest.mark.parametrize("name", WRITERS)
def test_chunks_are_the_whole_record_again_and_again(name: str, tmp_path: Path) -> None:
    path = WRITERS[name](tmp_path / name)
    rows = ROWS_OF_TEXT if path.suffix == ".csv" else ROWS
    _t, u, y = signals(rows)
    record = pickle.loads(pickle.dumps(open_record(path, "u", "y", time="t")))
    assert isinstance(record, RecordFile)
    assert (len(record), record.dt, record.u_unit, record.y_unit) == (rows, DT, "V", "um")
    for samples in (13_001, ROWS, 10 * ROWS):
        chunks = list(record.chunks(samples))
        assert {each.size for each, _ in chunks[:-1]} <= {samples}
        assert np.array_equal(np.concatenate([each for each, _ in chunks]), u)
        assert np.array_equal(np.concatenate([each for _, each in chunks]), y)
    assert record.load() == read_record(path, "u", "y", time="t")


@pytest.mark.parametrize(
    ("line", "text"),
    [
        (30_000, "2.9998,,0.5"),
        (30_000, "2.9998,overload,0.5"),
        (30_000, "2.9998,0.5"),
        (30_000, "2.9997,0.5,0.5"),
        (30_000, "2.9998,99999,0.5"),
        (5, "0.0003,n.c.,0.5"),
    ],
)
def test_text_is_refused_as_by_the_reader_of_whole_files(
    line: int, text: str, tmp_path: Path
) -> None:
    path = write_text(tmp_path / "bad.csv", {line: text})
    with pytest.raises(InputError) as whole:
        read_record(path, "u", "y", time="t")
    with pytest.raises(InputError) as chunked:
        open_record(path, "u", "y", time="t")
    said = str(whole.value).split("; correct it")[0]
    assert str(chunked.value).split("; correct it")[0] == said
    assert f"line {line}" in said or f"line {line - 1}" in said


def test_comments_and_blank_lines_among_rows_keep_the_count_of_lines(tmp_path: Path) -> None:
    path = write_text(tmp_path / "a.csv", {10_000: "# here\n", 30_000: "2.9998,x,1"})
    with pytest.raises(InputError, match="line 30001"):
        open_record(path, "u", "y", rate=1e4)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"u [V]": np.full(ROWS, 2.0)}, "the input 'u' is 2 throughout"),
        ({"u [V]": np.arange(float(ROWS))}, "the input 'u' has 0 reversals"),
        ({"y [um]": np.where(np.arange(ROWS) == 140_000, np.nan, 1.0)}, "index 140000"),
        ({"t [s]": np.arange(ROWS) * DT + (np.arange(ROWS) > 140_000)}, "after index 140000"),
        ({"t [s]": np.cumsum(np.linspace(DT, 2.0 * DT, ROWS))}, "time is uneven"),
        ({"t [s]": np.round(np.arange(ROWS) * DT, 3)}, "coarser than the samples"),
    ],
)
def test_whole_columns_are_checked(
    changed: dict[str, np.ndarray], said: str, tmp_path: Path
) -> None:
    path = write_parquet(tmp_path / "a.parquet", **changed)
    with pytest.raises(InputError, match=said):
        open_record(path, "u", "y", time="t")


def test_a_level_that_only_a_piece_takes_for_a_code_is_none(tmp_path: Path) -> None:
    u = np.where(np.arange(ROWS) < 131_000, 1e-3 * np.sin(np.arange(ROWS)), 5.0)
    u[140_000:] = np.linspace(-5.0, 5.0, ROWS - 140_000)
    path = write_parquet(tmp_path / "a.parquet", **{"u [V]": u})
    assert np.array_equal(read_record(path, "u", "y", time="t").u, u)
    assert len(open_record(path, "u", "y", time="t")) == ROWS


def test_dates_count_from_the_first(tmp_path: Path) -> None:
    stamps = np.datetime64("2026-05-01T12:00:00", "ns") + np.arange(ROWS) * np.timedelta64(
        100_000, "ns"
    )
    path = write_parquet(tmp_path / "a.parquet", **{"t [s]": stamps})
    assert open_record(path, "u", "y", time=0).dt == DT


def test_formats_without_chunks_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    _t, u, y = signals()
    np.savez(path, u=u, y=y)
    with pytest.raises(InputError, match="save it as Parquet, HDF5 or CSV"):
        open_record(path, "u", "y", rate=1e4)


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_that_changes_meanwhile_is_refused(name: str, tmp_path: Path) -> None:
    path = WRITERS[name](tmp_path / name)
    record = open_record(path, "u", "y", time="t")
    chunks = record.chunks(1000)
    # As many samples, all finite: only the file itself says that they are others.
    content = path.read_bytes()
    path.write_bytes(content[:-9] + content[-9:].replace(b"1", b"2") + b" ")
    with pytest.raises(InputError, match="has changed since its "):
        next(chunks)
    path.unlink()
    with pytest.raises(InputError, match="does not exist; check the path"):
        next(record.chunks(1000))
    with pytest.raises(InputError, match="samples is 0"):
        record.chunks(0)


def test_columns_that_changed_places_are_not_taken_for_each_other(tmp_path: Path) -> None:
    path = write_text(tmp_path / "a.csv")
    record = open_record(path, "u", "y", time="t")
    path.write_text(path.read_text().replace("u [V],y [um]", "y [um],u [V]"))
    os.utime(path, ns=(0, 0))
    with pytest.raises(InputError, match="has changed"):
        next(record.chunks(1000))
    assert open_record(path, "u", "y", time="t").input_name == "u"


def test_text_of_two_bytes_a_character_is_named(tmp_path: Path) -> None:
    path = write_text(tmp_path / "a.csv")
    path.write_text(path.read_text(), encoding="utf-16")
    with pytest.raises(InputError, match="is written in UTF-16, which cannot be read in chunks"):
        open_record(path, "u", "y", time="t")
