"""What a file says of its size is checked before there is memory for it."""

from __future__ import annotations

import os
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pyarrow
import pyarrow.parquet
import pytest
import scipy.io

import hyst
from hyst.errors import InputError
from hyst.io import read_column, read_record, read_table

MANY = 3_000_000
U = np.sin(np.arange(100.0))


def npz(path: Path) -> None:
    np.savez_compressed(path, u=U, huge=np.zeros(MANY))


def mat(path: Path) -> None:
    scipy.io.savemat(path, {"u": U, "huge": np.zeros(MANY)}, do_compression=True)


def hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["u"] = U
        file.create_dataset("huge", data=np.zeros(MANY), compression="gzip")


def npy(path: Path) -> None:
    np.save(path, np.zeros(MANY, dtype=[("huge", "f8"), ("u", "f8")]))


def parquet(path: Path) -> None:
    zeros = np.zeros(MANY)
    pyarrow.parquet.write_table(pyarrow.table({"u": zeros, "huge": zeros}), path)


FILES: dict[str, Callable[[Path], None]] = {
    "a.npz": npz, "a.mat": mat, "a.h5": hdf5, "a.npy": npy, "a.parquet": parquet,
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_more_numbers_than_allowed_are_refused_before_they_are_read(
    tmp_path: Path, name: str
) -> None:
    path = tmp_path / name
    FILES[name](path)
    tracemalloc.start()
    try:
        with pytest.raises(
            InputError, match=r"e\+06 numbers .* at most 1e\+06 .*raise max_samples"
        ):
            read_table(path, max_samples=1_000_000)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    # A byte for each of the numbers would be 3 MB.
    assert peak < 2_000_000


@pytest.mark.parametrize("name", ["a.npz", "a.mat", "a.h5"])
def test_columns_that_are_not_wanted_cost_nothing(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    FILES[name](path)
    tracemalloc.start()
    try:
        column = read_column(path, "u")[0]
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert np.array_equal(column, U)
    assert peak < 2_000_000  # as above


def test_a_small_file_that_declares_much_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "huge.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset("u", (10**9,), "f8", chunks=(1000,))[0] = 1.0
        file["y"] = U
    with pytest.raises(InputError, match=r"holds 1e\+09 numbers"):
        read_table(path)
    assert np.array_equal(read_column(path, "y")[0], U)
    path = tmp_path / "huge.npz"
    header = b"\x93NUMPY\x01\x00" + (118).to_bytes(2, "little")
    said = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("u.npy", header + said.ljust(117) + b"\n" + bytes(800))
    with pytest.raises(InputError, match=r"holds 1e\+12 numbers"):
        read_table(path)


def test_a_struct_that_decompresses_without_end_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bomb.mat"
    scipy.io.savemat(path, {"s": {"u": np.zeros(MANY)}}, do_compression=True)
    assert read_table(path).names == ("s.u",)
    with pytest.raises(InputError, match="compressed data hold more than the 8000000 bytes"):
        read_table(path, max_samples=1_000_000)


def test_what_is_no_regular_file_is_no_model_and_no_spec(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a device or a pipe, not a regular file"):
        hyst.load(os.devnull)
    huge = tmp_path / "model.json"
    with huge.open("wb") as file:
        file.truncate(300_000_000)  # takes no room on the disk
    with pytest.raises(InputError, match="has 300000000 bytes, more than a file of its kind"):
        hyst.load(huge)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names on this system")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    path = tmp_path / "pipe.csv"
    os.mkfifo(path)
    with pytest.raises(InputError, match=r"pipe\.csv is a device or a pipe, not a regular file"):
        read_record(path, 0, 1, rate=1.0)
