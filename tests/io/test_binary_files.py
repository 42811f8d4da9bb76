from __future__ import annotations

import builtins
import pickle
import random
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pyarrow
import pyarrow.parquet
import pytest
import scipy.io

from hyst.errors import InputError, MissingExtraError
from hyst.io import read_column, read_record, read_table

# Values no decimal of a few digits can hold.
U = np.sin(np.arange(40.0)) / 3.0
Y = np.cos(np.arange(40.0)) * 1e-17


def write_npz(path: Path, arrays: dict[str, Any]) -> None:
    np.savez(path, **arrays)


def write_npz_compressed(path: Path, arrays: dict[str, Any]) -> None:
    np.savez_compressed(path, **arrays)


def write_mat(path: Path, arrays: dict[str, Any]) -> None:
    scipy.io.savemat(path, arrays)


def write_mat_compressed(path: Path, arrays: dict[str, Any]) -> None:
    scipy.io.savemat(path, arrays, do_compression=True)


def write_mat_4(path: Path, arrays: dict[str, Any]) -> None:
    scipy.io.savemat(path, arrays, format="4")


def write_hdf5(path: Path, arrays: dict[str, Any]) -> None:
    with h5py.File(path, "w") as file:
        for name, array in arrays.items():
            file[name] = array


def write_mat_73(path: Path, arrays: dict[str, Any]) -> None:
    """Write as MATLAB does: 512 bytes before HDF5, axes reversed, the class as an attribute."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, array in arrays.items():
            file[name] = np.atleast_2d(array).T
            file[name].attrs["MATLAB_class"] = np.bytes_(b"double")
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


WRITERS: dict[str, tuple[str, Callable[[Path, dict[str, Any]], None]]] = {
    "npz": ("data.npz", write_npz),
    "npz compressed": ("data.npz", write_npz_compressed),
    "mat 4": ("data.mat", write_mat_4),
    "mat 5": ("data.mat", write_mat),
    "mat 7": ("data.mat", write_mat_compressed),
    "mat 7.3": ("data.mat", write_mat_73),
    "hdf5": ("data.h5", write_hdf5),
}


@pytest.fixture(params=WRITERS)
def write(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[dict[str, Any]], Path]:
    name, writer = WRITERS[request.param]

    def write_to(arrays: dict[str, Any]) -> Path:
        writer(tmp_path / name, arrays)
        return tmp_path / name

    return write_to


def test_every_format_keeps_every_bit(write: Callable[[dict[str, Any]], Path]) -> None:
    path = write({"u": U, "y": Y})
    record = read_record(path, "u", "y", rate=50.0)
    assert np.array_equal(record.u, U)
    assert np.array_equal(record.y, Y)
    assert (record.input_name, record.output_unit, record.dt) == ("u", "", 0.02)


def test_vectors_lying_and_standing_are_columns(write: Callable[[dict[str, Any]], Path]) -> None:
    path = write({"column": U[:, None], "row": U[None, :]})
    assert np.array_equal(read_column(path, "column")[0], U)
    assert np.array_equal(read_column(path, "row")[0], U)


def test_a_matrix_gives_a_column_for_each_of_its_columns(
    write: Callable[[dict[str, Any]], Path],
) -> None:
    path = write({"pair": np.column_stack((U, Y)), "t": np.arange(40.0)})
    table = read_table(path)
    assert set(table.names) == {"pair[0]", "pair[1]", "t"}
    assert np.array_equal(read_column(path, "pair[1]")[0], Y)


def test_a_square_matrix_is_taken_by_its_columns(write: Callable[[dict[str, Any]], Path]) -> None:
    path = write({"square": np.array([[1.0, 2.0], [3.0, 4.0]])})
    assert read_column(path, "square[0]")[0].tolist() == [1.0, 3.0]


def test_the_longer_axis_is_the_samples(write: Callable[[dict[str, Any]], Path]) -> None:
    path = write({"logged": np.stack((U, Y))})
    assert np.array_equal(read_column(path, "logged[1]")[0], Y)


def test_scalars_are_left_out(write: Callable[[dict[str, Any]], Path]) -> None:
    assert read_table(write({"rate": 200.0, "u": U})).names == ("u",)


def test_nan_is_named_by_its_index(write: Callable[[dict[str, Any]], Path]) -> None:
    path = write({"u": U, "y": np.where(np.arange(40) >= 7, np.nan, Y)})
    with pytest.raises(InputError, match="'y' is 'nan' at index 7, not a finite number"):
        read_record(path, "u", "y", rate=1.0)


def test_an_uneven_time_is_named_by_its_index(write: Callable[[dict[str, Any]], Path]) -> None:
    time = np.arange(40.0)
    time[30:] += 0.5
    path = write({"t": time, "u": U, "y": Y})
    with pytest.raises(InputError, match=r"worst gap is 1\.5 s after index 29"):
        read_record(path, "u", "y", time="t")


def test_columns_of_different_length_do_not_make_a_record(
    write: Callable[[dict[str, Any]], Path],
) -> None:
    path = write({"u": U, "y": Y[:39]})
    with pytest.raises(InputError, match="different numbers of values, 'u' 40 and 'y' 39"):
        read_record(path, "u", "y", rate=1.0)
    assert read_column(path, "y")[0].size == 39


def test_a_file_without_a_column_is_refused(write: Callable[[dict[str, Any]], Path]) -> None:
    with pytest.raises(InputError, match="holds no array of at least 2 real numbers"):
        read_table(write({"rate": 200.0}))


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", ">f8"])
@pytest.mark.parametrize("kind", ["npz", "mat 5", "hdf5"])
def test_numbers_of_every_type_are_read(tmp_path: Path, kind: str, dtype: str) -> None:
    name, writer = WRITERS[kind]
    writer(tmp_path / name, {"u": np.array([0, 1, 127], dtype=dtype)})
    assert read_column(tmp_path / name, "u")[0].tolist() == [0.0, 1.0, 127.0]


# NPZ


class Boom:
    """Unpickling this would raise a RuntimeError."""

    def __reduce__(self) -> tuple[Any, ...]:
        return exec, ("raise RuntimeError('a pickle was executed')",)


def test_an_archive_with_python_objects_is_refused_and_not_executed(tmp_path: Path) -> None:
    path = tmp_path / "objects.npz"
    np.savez(path, u=U, evil=np.array([Boom(), None], dtype=object))
    with pytest.raises(InputError, match="'evil' holds pickled Python objects, which hyst never"):
        read_column(path, "u")


def test_a_bare_pickle_is_refused_and_not_executed(tmp_path: Path) -> None:
    path = tmp_path / "pickle.npz"
    path.write_bytes(pickle.dumps(Boom()))
    with pytest.raises(InputError, match="is damaged or no NPZ archive"):
        read_table(path)


def test_an_array_alone_is_no_archive(tmp_path: Path) -> None:
    path = tmp_path / "array.npz"
    with path.open("wb") as file:
        np.save(file, U)
    with pytest.raises(InputError, match="is damaged or no NPZ archive"):
        read_table(path)


def test_texts_and_stray_files_in_an_archive_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "mixed.npz"
    np.savez(path, u=U, note=np.array(["a", "b"]), z=U + 1j, cube=np.zeros((2, 3, 4)))
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("readme.txt", "measured on a Monday")
    assert read_table(path).names == ("u",)


# MATLAB


def test_fields_of_a_struct_are_columns(tmp_path: Path) -> None:
    path = tmp_path / "struct.mat"
    inner = {"drive": U, "label": "text", "deep": {"stroke": Y}}
    for compression in (False, True):
        scipy.io.savemat(
            path, {"log": inner, "z": U + 1j, "c": [U, "x"]}, do_compression=compression
        )
        assert read_table(path).names == ("log.drive", "log.deep.stroke", "c{1}")
        assert np.array_equal(read_column(path, "log.deep.stroke")[0], Y)


def test_a_struct_of_version_7_3_has_the_same_names(tmp_path: Path) -> None:
    path = tmp_path / "struct.mat"
    write_mat_73(path, {"log/drive": U, "log/deep/stroke": Y})
    with h5py.File(path, "r+") as file:
        file["log/label"] = np.array([[116, 101, 120, 116]], dtype="u2")
        file["log/label"].attrs["MATLAB_class"] = np.bytes_(b"char")
        file["log/empty"] = np.array([0, 0], dtype="u8")
        file["log/empty"].attrs["MATLAB_class"] = np.bytes_(b"double")
        file["log/empty"].attrs["MATLAB_empty"] = 1
        file["#refs#/a"] = U
    assert set(read_table(path).names) == {"log.drive", "log.deep.stroke"}


def test_matlab_files_of_the_other_byte_order_are_read(tmp_path: Path) -> None:
    # Written by hand after the published format: header, then one array of 3 doubles.
    name = b"u".ljust(8, b"\0")
    body = b"".join(
        (
            *(n.to_bytes(4, "big") for n in (6, 8, 6, 0)),  # flags: class double
            *(n.to_bytes(4, "big") for n in (5, 8, 3, 1)),  # shape: 3 by 1
            *(n.to_bytes(4, "big") for n in (1, 1)),
            name,
            *(n.to_bytes(4, "big") for n in (9, 24)),
            np.array([1.5, -2.0, 1e300], dtype=">f8").tobytes(),
        )
    )
    header = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x01\x00MI"
    path = tmp_path / "big.mat"
    path.write_bytes(header + (14).to_bytes(4, "big") + len(body).to_bytes(4, "big") + body)
    assert read_column(path, "u")[0].tolist() == [1.5, -2.0, 1e300]


def test_objects_and_functions_are_left_out() -> None:
    folder = Path(scipy.io.__file__).parent / "matlab" / "tests" / "data"
    if not folder.is_dir():
        pytest.skip("this SciPy was installed without its test data")
    for name in ("testfunc_7.4_GLNX86.mat", "testobject_7.4_GLNX86.mat", "some_functions.mat"):
        with pytest.raises(InputError, match="holds no array of at least 2 real numbers"):
            read_table(folder / name)


def test_every_sample_file_of_scipy_is_read_as_scipy_reads_it() -> None:
    folder = Path(scipy.io.__file__).parent / "matlab" / "tests" / "data"
    paths = [path for path in sorted(folder.glob("test*.mat")) if "hdf5" not in path.name]
    if not paths:
        pytest.skip("this SciPy was installed without its test data")
    compared = 0
    for path in paths:
        for name, array in scipy.io.loadmat(path).items():
            if not isinstance(array, np.ndarray) or array.dtype.kind not in "biuf":
                continue
            if array.ndim == 2 and array.size > 1 and 1 in array.shape:
                assert np.array_equal(read_column(path, name)[0], array.ravel()), path.name
                compared += 1
    assert compared >= 10


# HDF5


def test_data_sets_are_named_by_their_path_and_keep_their_units(tmp_path: Path) -> None:
    path = tmp_path / "data.hdf5"
    write_hdf5(path, {"run 1/drive": U, "run 1/stroke": Y, "note": np.bytes_("text")})
    with h5py.File(path, "r+") as file:
        file["run 1/drive"].attrs["units"] = "V"
        file["run 1/stroke"].attrs["unit"] = np.bytes_(b"um")
    record = read_record(path, "run 1/drive", "RUN 1/stroke", rate=1.0)
    assert (record.input_name, record.input_unit, record.output_unit) == ("run 1/drive", "V", "um")


def test_links_to_other_files_are_not_followed(tmp_path: Path) -> None:
    write_hdf5(tmp_path / "other.h5", {"secret": U})
    with h5py.File(tmp_path / "data.h5", "w") as file:
        file["u"] = U
        file["linked"] = h5py.ExternalLink("other.h5", "/secret")
        raw = [(str(tmp_path / "raw.bin"), 0, U.nbytes)]
        file.create_dataset("outside", U.shape, U.dtype, external=raw)
    assert read_table(tmp_path / "data.h5").names == ("u",)


# Damage


def whole_file(kind: str, folder: Path) -> Path:
    if kind == "parquet":
        path = folder / "data.parquet"
        pyarrow.parquet.write_table(pyarrow.table({"u": U, "y": Y}), path)
        return path
    name, writer = WRITERS[kind]
    writer(folder / name, {"u": U, "y": Y})
    return folder / name


@pytest.mark.parametrize("kind", [*WRITERS, "parquet"])
@pytest.mark.parametrize("part", [0.05, 0.3, 0.6, 0.9, 0.99])
def test_a_file_cut_short_is_refused(tmp_path: Path, kind: str, part: float) -> None:
    path = whole_file(kind, tmp_path)
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(InputError, match=r"is damaged or no .*; save it again"):
        read_table(path)


@pytest.mark.parametrize("kind", ["npz", "mat 5", "hdf5", "parquet"])
@pytest.mark.parametrize(
    "content", [b"u,y\n1,2\n", b"\x00" * 1000, b"MATLAB 5.0", bytes(range(256))]
)
def test_a_file_of_another_kind_is_refused(tmp_path: Path, kind: str, content: bytes) -> None:
    path = tmp_path / ("data.parquet" if kind == "parquet" else WRITERS[kind][0])
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"is damaged or no .*; save it again"):
        read_table(path)


# Not HDF5: its C library can crash on flipped bits, and no program around it can prevent that.
@pytest.mark.parametrize("kind", ["npz", "npz compressed", "mat 4", "mat 5", "mat 7", "parquet"])
def test_flipped_bytes_raise_nothing_but_input_errors(tmp_path: Path, kind: str) -> None:
    path = whole_file(kind, tmp_path)
    content = path.read_bytes()
    rng = random.Random(4)
    refused = 0
    for _ in range(150):
        damaged = bytearray(content)
        for _ in range(rng.randrange(1, 5)):
            damaged[rng.randrange(len(damaged))] = rng.randrange(256)
        path.write_bytes(damaged)
        try:
            read_table(path)
        except InputError:
            refused += 1
    assert refused > 0


def test_a_wrong_type_in_a_matlab_file_is_refused_and_crashes_nothing(tmp_path: Path) -> None:
    path = whole_file("mat 5", tmp_path)
    content = bytearray(path.read_bytes())
    # 128 header, 8 tag, 16 flags, 16 shape, 8 name: the type of the numbers of the first array.
    assert content[176] == 9
    for kind in (0, 8, 10, 11, 14, 15, 19, 20, 255):
        content[176] = kind
        path.write_bytes(content)
        with pytest.raises(InputError, match=f"type {kind} is no type of number"):
            read_table(path)


# Extras


@pytest.mark.parametrize(
    ("kind", "package"), [("hdf5", "h5py"), ("mat 7.3", "h5py"), ("parquet", "pyarrow")]
)
def test_a_missing_package_is_named_with_its_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str, package: str
) -> None:
    path = whole_file(kind, tmp_path)
    real_import = builtins.__import__

    def without(name: str, *arguments: Any, **options: Any) -> Any:
        if name.split(".")[0] == package:
            raise ImportError(f"No module named {name!r}")
        return real_import(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtraError, match=rf'need {package}; pip install "hyst\[files\]"'):
        read_table(path)
