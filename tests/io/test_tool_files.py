"""Files of MATLAB, Simulink, dSPACE and HDF5 tools: the right signals under the right names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
import tool_files as files
from tool_files import DT, KINDS, T, U, Y

from hyst.errors import InputError
from hyst.io import read_column, read_record, read_table


@pytest.mark.parametrize("kind", KINDS)
def test_the_signals_of_every_kind_are_read_to_the_bit(tmp_path: Path, kind: str) -> None:
    name, write, u, y = KINDS[kind]
    write(tmp_path / name)
    record = read_record(tmp_path / name, u, y, rate=1.0 / DT)
    # One kind keeps the input in single precision.
    wanted = U.astype("f4").astype(float) if kind == "TDMS stamps" else U
    # A workbook is written with 16 digits, a few units in the last place.
    rounding = 1e-15 if kind == "Excel" else 0.0
    np.testing.assert_allclose(record.u, wanted, rtol=rounding, atol=0.0)
    np.testing.assert_allclose(record.y, Y, rtol=rounding, atol=0.0)


@pytest.mark.parametrize(
    ("kind", "time"),
    [
        ("structure with time", "ScopeData.time"),
        ("ControlDesk", "rec1_001.X.Data"),
        ("1 x 1 x N", "time"),
        ("cells", "log{1}"),
        ("compound", "run/table/time"),
        ("TDMS waveforms", "Log/time"),
        ("TDMS stamps", "stamp"),
        ("Excel", "time"),
    ],
)
def test_the_time_of_every_kind_gives_the_step(tmp_path: Path, kind: str, time: str) -> None:
    name, write, u, y = KINDS[kind]
    write(tmp_path / name)
    record = read_record(tmp_path / name, u, y, time=time)
    assert (record.samples, record.dt) == (U.size, DT)


# MATLAB


@pytest.mark.parametrize("compressed", [False, True])
def test_controldesk_gives_names_and_units(tmp_path: Path, compressed: bool) -> None:
    files.controldesk(tmp_path / "rec.mat", compressed)
    record = read_record(tmp_path / "rec.mat", "u_volt", "pos", time="rec1_001.X.Data")
    said = (record.input_name, record.input_unit, record.output_name, record.output_unit)
    assert said == ("u_volt", "V", "pos", "um")
    again = read_record(tmp_path / "rec.mat", "rec1_001.Y(1).Data", "rec1_001.Y(2).Data", rate=200)
    assert np.array_equal(again.u, record.u)


def test_axes_of_a_scope_go_by_label_path_or_number(tmp_path: Path) -> None:
    path = tmp_path / "scope.mat"
    files.structure_with_time(path, labels=("Strom [A]", "Weg"))
    for column in ("Weg", "ScopeData.signals(2).values", 2):
        assert np.array_equal(read_column(path, column)[0], Y)
    assert read_column(path, "Strom")[1:] == ("Strom", "A")


def test_a_path_in_a_label_is_no_unit(tmp_path: Path) -> None:
    path = tmp_path / "scope.mat"
    files.structure_with_time(path, labels=("Model Root/u/In1", "Model Root/y"))
    assert read_column(path, "Model Root/u/In1")[1:] == ("Model Root/u/In1", "")
    assert read_column(path, "Model Root/y")[1:] == ("Model Root/y", "")


@pytest.mark.parametrize("labels", [("", ""), ("pos", "pos")])
def test_signals_without_a_label_of_their_own_go_by_their_path(
    tmp_path: Path, labels: tuple[str, str]
) -> None:
    path = tmp_path / "scope.mat"
    files.structure_with_time(path, labels=labels)
    assert np.array_equal(read_column(path, "ScopeData.signals(1).values")[0], U)
    if labels[0]:
        with pytest.raises(InputError, match="'pos' fits the columns 1 and 2; give the full"):
            read_column(path, "pos")


def test_struct_arrays_and_cells_of_version_7_3(tmp_path: Path) -> None:
    path = tmp_path / "scope.mat"
    files.struct_array_of_7_3(path)
    record = read_record(path, "drive", "pos", time="ScopeData.time")
    assert np.array_equal(record.u, U)
    assert np.array_equal(record.y, Y)
    assert record.dt == DT
    assert np.array_equal(read_column(path, "log{2}")[0], Y)
    with pytest.raises(InputError, match=r"'tt' is a timetable, .* save t = seconds\(tt"):
        read_column(path, "tt")


@pytest.mark.parametrize("shape", [(1, 1, -1), (-1, 1, 1), (1, -1, 1, 1), (1, 2, -1)])
def test_axes_of_length_1_do_not_count(tmp_path: Path, shape: tuple[int, ...]) -> None:
    values = np.column_stack((U, Y)).T if 2 in shape else Y
    for name in ("a.mat", "a.npz", "a.h5"):
        path, array = tmp_path / name, values.reshape(shape)
        if name == "a.mat":
            scipy.io.savemat(path, {"y": array})
        elif name == "a.npz":
            np.savez(path, y=array)
        else:
            with h5py.File(path, "w") as file:
                file["y"] = array
        assert np.array_equal(read_column(path, "y[1]" if 2 in shape else "y")[0], Y)


def save_mat(path: Path, z: np.ndarray) -> None:
    scipy.io.savemat(path, {"u": U, "z": z})


def save_mat_4(path: Path, z: np.ndarray) -> None:
    scipy.io.savemat(path, {"u": U, "z": z}, format="4")


def save_npz(path: Path, z: np.ndarray) -> None:
    np.savez(path, u=U, z=z)


def save_hdf5(path: Path, z: np.ndarray) -> None:
    with h5py.File(path, "w") as file:
        file["u"], file["z"] = U, z


@pytest.mark.parametrize(
    ("name", "save"),
    [("a.mat", save_mat), ("a.mat", save_mat_4), ("a.npz", save_npz), ("a.h5", save_hdf5)],
)
def test_complex_numbers_are_real_only_without_an_imaginary_part(
    tmp_path: Path, name: str, save: Callable[[Path, np.ndarray], None]
) -> None:
    save(tmp_path / name, Y + 0j)
    assert np.array_equal(read_column(tmp_path / name, "z")[0], Y)
    turned = Y + 0j
    turned[-1] += 1e-9j
    save(tmp_path / name, turned)
    assert read_table(tmp_path / name).names == ("u",)
    with pytest.raises(InputError, match="'z' is complex; save its real part"):
        read_column(tmp_path / name, "z")


@pytest.mark.parametrize(
    ("kind", "export"),
    [
        ("timetable", r"t = seconds\(run\.Properties\.RowTimes"),
        ("timeseries", r"t = run\.Time and y = squeeze\(run\.Data\)"),
        ("table", r"u = run\.u"),
        ("datetime", r"t = seconds\(run - run\(1\)\)"),
        ("Simulink.SimulationOutput", r"t = run\.tout"),
        ("Simulink.SimulationData.Dataset", r"t = run\{1\}\.Values\.Time"),
        ("MyClass", "the vectors in it"),
    ],
)
@pytest.mark.parametrize("column", ["run", "run.Data", "run{1}.Values"])
def test_an_object_of_matlab_is_refused_with_what_to_export(
    tmp_path: Path, kind: str, export: str, column: str
) -> None:
    path = tmp_path / "run.mat"
    files.with_object(path, kind)
    assert read_table(path).names == ("u",)
    with pytest.raises(InputError, match=rf"'run' is an? {kind}, an object .*{export}"):
        read_column(path, column)


def test_a_file_of_nothing_but_an_object_says_what_to_export(tmp_path: Path) -> None:
    path = tmp_path / "run.mat"
    files.with_object(path, "timetable")
    content = path.read_bytes()
    scipy.io.savemat(path, {})
    path.write_bytes(path.read_bytes() + content[content.index(b"\x0e\0\0\0", 136) :])
    with pytest.raises(InputError, match="real numbers: 'run' is a timetable"):
        read_table(path)


# HDF5


@pytest.mark.parametrize("dtype", ["<f8", ">f8"])
@pytest.mark.parametrize("chunks", [False, True])
def test_fields_of_a_compound_type_are_columns(tmp_path: Path, dtype: str, chunks: bool) -> None:
    path = tmp_path / "run.h5"
    files.compound(path, chunks, dtype)
    names = ("run/table/voltage", "run/table/displacement")
    record = read_record(path, *names, time="run/table/time")
    assert np.array_equal(record.u, U)
    assert (record.input_unit, record.output_unit, record.dt) == ("V", "um", DT)
    with pytest.raises(InputError, match="'run/table/note' holds no numbers"):
        read_column(path, "run/table/note")


def test_packed_numbers_are_unpacked_and_missing_ones_named(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    files.packed(path)
    record = read_record(path, "u", "y", time="time")
    # Packed to 0.0125: half of that, and what the sum rounds.
    assert np.abs(record.u - U - 2.0).max() <= 0.5 * 0.0125 + 1e-12
    assert (record.dt, record.output_unit) == (DT, "um")
    with h5py.File(path, "r+") as file:
        file["y"][17] = -2147483647
    with pytest.raises(InputError, match="'y' has no value at index 17"):
        read_record(path, "u", "y", time="time")


def test_a_missing_value_by_another_name_is_named(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file["u"], file["y"] = U, np.where(np.arange(U.size) == 9, -9999.0, Y)
        file["y"].attrs["missing_value"] = [-9999.0, -8888.0]
    with pytest.raises(InputError, match="'y' has no value at index 9"):
        read_record(path, "u", "y", rate=200)
    repaired = read_record(path, "u", "y", rate=200, repair=True)
    assert repaired.notes[0].startswith("left out 1 row ")
    # The straight line between the neighbours, half of their sum.
    assert repaired.y[9] == pytest.approx((Y[8] + Y[10]) / 2.0, rel=1e-12)


def test_parts_that_were_never_written_are_no_measurements(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file["u"] = U
        file.create_dataset("y", U.shape, "f8", chunks=(50,))[:100] = Y[:100]
        pair = file.create_dataset("pair", (*U.shape, 2), "f8", chunks=(50, 1))
        pair[:, 0] = U
        pair[50:, 1] = Y[50:]
        file.create_dataset("never", U.shape, "f8")
        file.create_dataset("nor this", U.shape, "f8", chunks=(50,))
    with pytest.raises(InputError, match="'y' has no value at index 100"):
        read_column(path, "y")
    with pytest.raises(InputError, match=r"'pair\[1\]' has no value at index 0"):
        read_column(path, "pair[1]")
    assert np.array_equal(read_column(path, "pair[0]")[0], U)
    for name in ("never", "nor this"):
        with pytest.raises(InputError, match=f"'{name}' was declared but never written"):
            read_column(path, name)


def test_references_between_data_sets_and_circles_of_groups_are_harmless(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file["a/u"] = U
        file["a/again"] = file["a"]
        file["a/soft"] = h5py.SoftLink("/a")
        file["refs"] = np.array([file["a/u"].ref] * 3, dtype=h5py.ref_dtype)
    assert read_table(path).names == ("a/u",)
    with pytest.raises(InputError, match="'refs' holds references to other data sets"):
        read_column(path, "refs")


@pytest.mark.parametrize("attribute", ["Units", "Unit", "UNITS", "unit"])
def test_the_attribute_of_units_in_other_letters(tmp_path: Path, attribute: str) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        for name, values, unit in (("t", 1e3 * T, "ms"), ("u", U, "V"), ("y", Y, "um")):
            file[name] = values
            file[name].attrs[attribute] = unit
    record = read_record(path, "u", "y", time="t")
    # Without the unit the step would be a thousand times as long.
    assert record.dt == pytest.approx(DT, rel=1e-12)
    assert (record.input_unit, record.output_unit) == ("V", "um")


def test_texts_that_would_keep_the_library_for_ever_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file["u"] = U
        file["u"].attrs["units"] = "V"  # a text of variable length
    assert read_column(path, "u")[2] == "V"
    content = bytearray(path.read_bytes())
    heap = content.index(b"GCOL")
    # After the head of 16 bytes one text with its own head and 8 bytes, then the free space.
    free = heap + 16 + 16 + 8
    assert content[free : free + 2] == b"\0\0"
    content[free + 8 : free + 16] = bytes(8)
    path.write_bytes(content)
    with pytest.raises(InputError, match="is damaged"):
        read_table(path)


# NumPy


def test_an_array_alone_has_numbered_columns(tmp_path: Path) -> None:
    for name, array in (("tall", np.column_stack((T, U, Y))), ("wide", np.stack((T, U, Y)))):
        path = tmp_path / f"{name}.npy"
        np.save(path, array)
        record = read_record(path, 1, "2", time=0)
        assert np.array_equal(record.u, U)
        assert (record.dt, record.input_name) == (DT, "column 1")


def test_fields_of_a_structured_array_are_columns(tmp_path: Path) -> None:
    rows = np.zeros(U.size, dtype=[("u", "f8"), ("y", ">f4"), ("who", "S3")])
    rows["u"], rows["y"] = U, Y
    np.save(tmp_path / "log.npy", rows)
    np.savez(tmp_path / "log.npz", log=rows)
    for name in ("log.npy", "log.npz"):
        record = read_record(tmp_path / name, "log/u", "log/y", rate=200)
        assert np.array_equal(record.u, U)
        assert np.array_equal(record.y, Y.astype("f4").astype(float))
    vector = tmp_path / "vector.npy"
    np.save(vector, U)
    assert np.array_equal(read_column(vector, "vector")[0], U)


def test_an_array_of_objects_is_refused_and_not_executed(tmp_path: Path) -> None:
    path = tmp_path / "objects.npy"
    np.save(path, np.array([{}, None], dtype=object))
    with pytest.raises(InputError, match="pickled Python objects, which hyst never loads"):
        read_table(path)


@pytest.mark.parametrize(
    ("values", "mask"), [("data", "mask"), ("y", "y_mask"), ("y", "mask_y"), ("y", "y.mask")]
)
def test_a_masked_sample_is_no_measurement(tmp_path: Path, values: str, mask: str) -> None:
    path = tmp_path / "log.npz"
    y = np.ma.masked_array(Y, mask=np.arange(Y.size) == 31, fill_value=1e20)
    arrays: dict[str, Any] = {"u": U, values: y.filled(), mask: y.mask}
    np.savez(path, **arrays)
    with pytest.raises(InputError, match=f"'{values}' is 'masked' at index 31"):
        read_record(path, "u", values, rate=200)
    repaired = read_record(path, "u", values, rate=200, repair=True)
    assert np.array_equal(np.delete(repaired.y, 31), np.delete(Y, 31))
    assert repaired.y[31] == pytest.approx((Y[30] + Y[32]) / 2.0, rel=1e-12)
    arrays[mask] = np.zeros(Y.size, dtype=bool)
    np.savez(path, **arrays | {values: Y})
    assert np.array_equal(read_record(path, "u", values, rate=200).y, Y)
