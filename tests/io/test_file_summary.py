"""What a file holds, told before anything is made of it."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io
from tool_files import DT, KINDS, T, U, Y

from hyst.io import summarize_file


@pytest.mark.parametrize("kind", [name for name in KINDS if name != "cells"])
def test_every_kind_is_guessed_right(tmp_path: Path, kind: str) -> None:
    name, write, u, y = KINDS[kind]
    write(tmp_path / name)
    found = {each.guess: each for each in summarize_file(tmp_path / name).columns if each.guess}
    assert (found["input"].name, found["output"].name) == (u, y)
    assert found["time"].low == 0.0
    assert found["time"].high == pytest.approx(DT * (U.size - 1), rel=1e-12)  # a sum of stamps


@pytest.mark.parametrize(
    ("name", "stamps"),
    [
        ("time", np.repeat(np.arange(0, U.size, 4) * DT, 4)[: U.size]),  # a clock of a quarter
        ("micros", (np.arange(U.size) * 5000 + 2**32 - 200_000) % 2**32),
        ("timestamp", (np.arange(U.size) * 5 + 65_000) % 65_536),
    ],
)
def test_stamps_that_repeat_or_start_again_are_a_time(
    tmp_path: Path, name: str, stamps: np.ndarray
) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{t!r},{u!r},{y!r}" for t, u, y in zip(stamps.tolist(), U.tolist(), Y.tolist())]  # noqa: B905
    path.write_text("\n".join([f"{name},drive,pos", *rows]))
    assert [each.guess for each in summarize_file(path).columns] == ["time", "input", "output"]


@pytest.mark.parametrize(("code", "rows"), [(-9999.0, [7, 8, 30]), (9.91e37, [12])])
def test_codes_are_named(tmp_path: Path, code: float, rows: list[int]) -> None:
    y = Y.copy()
    y[rows] = code
    np.save(tmp_path / "log.npy", np.column_stack([U, y]))
    found = summarize_file(tmp_path / "log.npy").columns
    assert found[0].flaw == ""
    assert found[1].flaw.startswith(f"{code:.6g} at index {rows[0]}, {len(rows)} in all, a code")


@pytest.mark.parametrize(
    ("header", "guesses"),
    [
        ("pos [um],drive [V],t [ms]", ("output", "input", "time")),
        ("y,u,time", ("output", "input", "time")),
        ("a [nm],b1 [V],c", ("output", "input", "time")),
        ("DriveVoltage,sensorPosition,Timestamp", ("input", "output", "time")),
        ("first,second,third", ("input", "output", "time")),
    ],
)
def test_names_count_before_units_and_units_before_the_order(
    tmp_path: Path, header: str, guesses: tuple[str, ...]
) -> None:
    path = tmp_path / "log.csv"
    rows = [f"{a!r},{b!r},{k * 5}" for k, (a, b) in enumerate(zip(U.tolist(), Y.tolist()))]  # noqa: B905
    path.write_text("\n".join([header, *rows]) + "\n")
    assert tuple(each.guess for each in summarize_file(path).columns) == guesses


def test_sizes_units_ranges_and_what_is_wrong_are_told(tmp_path: Path) -> None:
    path = tmp_path / "log.mat"
    y = Y.copy()
    y[[7, 9]] = np.nan
    scipy.io.savemat(path, {"u": U, "y": y, "still": np.zeros(5), "z": U + 1j, "rate": 200.0})
    found = summarize_file(path)
    by_name = {each.name: each for each in found.columns}
    assert by_name["u"].low == U.min()
    assert by_name["y"].high == np.nanmax(y)
    assert by_name["y"].flaw == "'nan' at index 7, 2 in all"
    assert (by_name["still"].size, by_name["still"].guess) == (5, "")
    assert dict(found.left_out)["z"].startswith("is complex")
    assert dict(found.left_out)["rate"] == "is a single number"


def test_a_file_too_large_to_read_is_listed_all_the_same(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file["t"], file["u"], file["y"] = T, U, Y
        file.create_dataset("huge", (10**9,), "f8", chunks=(1000,))[0] = 1.0
    found = {each.name: each for each in summarize_file(path).columns}
    assert (found["huge"].size, found["huge"].flaw) == (10**9, "not read")
    assert np.isnan(found["huge"].low)
    assert (found["u"].high, found["u"].flaw) == (U.max(), "")
