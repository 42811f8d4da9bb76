"""Files as instruments and tools write them, made anew by the tests from known signals."""

from __future__ import annotations

import datetime
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import openpyxl
import scipy.io
from nptdms import ChannelObject, TdmsWriter

N = 240
DT = 0.005
T = DT * np.arange(N)
# Values no decimal of a few digits can hold; both turn often enough to be a record.
U = 50.0 - 50.0 * np.cos(2.0 * np.pi * np.arange(N) / 60.0)
Y = 0.6 * np.roll(U, 3) + np.sin(np.arange(N)) / 3.0


# MATLAB


def structure_with_time(path: Path, labels: tuple[str, str] = ("drive", "pos")) -> None:
    """Write a scope with two axes as Simulink does: signals is a struct array."""
    signals = np.zeros((1, 2), dtype=[(k, object) for k in ("values", "dimensions", "label")])
    for k, (values, label) in enumerate(zip((U, Y), labels, strict=True)):
        signals[0, k] = (values[:, None], 1.0, label)
    scipy.io.savemat(path, {"ScopeData": {"time": T[:, None], "signals": signals}})


def controldesk(path: Path, compressed: bool = True) -> None:
    """Write a recording of dSPACE ControlDesk: X with the times, Y a struct array."""
    kinds = [(k, object) for k in ("Name", "Path", "Data", "Unit", "XIndex")]
    y = np.zeros((1, 2), dtype=kinds)
    y[0, 0] = ("u_volt", "Model", U[None, :], "V", 1.0)
    y[0, 1] = ("pos", "Model", Y[None, :], "um", 1.0)
    x = {"Name": "", "Data": T[None, :], "Unit": "s"}
    scipy.io.savemat(path, {"rec1_001": {"X": x, "Y": y}}, do_compression=compressed)


def blocks_of_one(path: Path) -> None:
    """Write scalars as Simulink logs them: 1 x 1 x N."""
    block = {"values": Y.reshape(1, 1, -1)}
    scipy.io.savemat(
        path, {"time": T[:, None], "u": U.reshape(1, 1, -1), "pos": {"signals": block}}
    )


def cells(path: Path) -> None:
    log = np.empty((1, 3), dtype=object)
    log[0, 0], log[0, 1], log[0, 2] = T[:, None], U[:, None], Y[:, None]
    scipy.io.savemat(path, {"log": log}, do_compression=True)


def with_object(path: Path, kind: str, name: str = "run") -> None:
    """Write a vector beside an object of MATLAB, by the published format of the outside of it."""
    scipy.io.savemat(path, {"u": U})
    opaque = _element(6, struct.pack("<II", 17, 0))
    for text in (name, "MCOS", kind):
        opaque += _element(1, text.encode())
    numbers = _element(6, struct.pack("<II", 13, 0)) + _element(5, struct.pack("<ii", 1, 1))
    opaque += _element(14, numbers + _element(1, b"") + _element(6, struct.pack("<I", 7)))
    path.write_bytes(path.read_bytes() + _element(14, opaque))


def _element(kind: int, content: bytes) -> bytes:
    return struct.pack("<II", kind, len(content)) + content + b"\0" * (-len(content) % 8)


def struct_array_of_7_3(path: Path) -> None:
    """Write a struct array and a cell as MATLAB 7.3 does: fields are lists of references."""
    with h5py.File(path, "w", userblock_size=512) as file:
        kept = file.create_group("#refs#")
        scope = _struct(file, "ScopeData")
        scope["time"] = T[None, :]
        scope["time"].attrs["MATLAB_class"] = np.bytes_(b"double")
        signals = _struct(scope, "signals")
        values, labels = [], []
        for name, array in (("drive", U), ("pos", Y)):
            values.append(_kept(kept, array.reshape(-1, 1, 1)[::1], b"double"))
            codes = np.array([[ord(letter)] for letter in name], dtype="u2")
            labels.append(_kept(kept, codes, b"char"))
        signals["values"] = np.array(values, dtype=h5py.ref_dtype)[:, None]
        signals["label"] = np.array(labels, dtype=h5py.ref_dtype)[:, None]
        file["log"] = np.array(values, dtype=h5py.ref_dtype)[:, None]
        file["log"].attrs["MATLAB_class"] = np.bytes_(b"cell")
        file["tt"] = np.zeros((1, 6), dtype="u4")
        file["tt"].attrs["MATLAB_class"] = np.bytes_(b"timetable")
        file["tt"].attrs["MATLAB_object_decode"] = np.int32(3)
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


def _struct(parent: Any, name: str) -> Any:
    group = parent.create_group(name)
    group.attrs["MATLAB_class"] = np.bytes_(b"struct")
    return group


def _kept(group: Any, array: Any, kind: bytes) -> Any:
    stored = group.create_dataset(f"k{len(group)}", data=array)
    stored.attrs["MATLAB_class"] = np.bytes_(kind)
    return stored.ref


# HDF5


def compound(path: Path, chunks: bool = False, dtype: str = "<f8") -> None:
    """Write one data set with named fields, as PyTables does."""
    kinds = [("time", "<f8"), ("voltage", dtype), ("displacement", dtype), ("note", "S4")]
    rows = np.zeros(N, dtype=kinds)
    rows["time"], rows["voltage"], rows["displacement"] = T, U, Y
    with h5py.File(path, "w") as file:
        group = file.create_group("run")
        group.create_dataset("table", data=rows, chunks=(50,) if chunks else None)
        group["table"].attrs["units"] = ["s", "V", "um", ""]


def packed(path: Path) -> None:
    """Write packed numbers with missing ones, as netCDF-4 does."""
    with h5py.File(path, "w") as file:
        file["time"] = T
        file["time"].attrs["units"] = "seconds since 2024-01-01"
        for name, values, unit in (("u", U, "V"), ("y", Y, "um")):
            codes = np.round(values / 0.0125).astype("i4")
            file[name] = codes
            file[name].attrs["scale_factor"] = 0.0125
            file[name].attrs["add_offset"] = 2.0
            file[name].attrs["_FillValue"] = np.int32(-2147483647)
            file[name].attrs["units"] = unit


# LabVIEW


def waveforms(path: Path, steps: tuple[float, float] = (DT, DT)) -> None:
    """Write two waveforms, which have an increment and no channel of time."""
    channels = [
        ChannelObject("Log", name, values, {"wf_increment": step, "unit_string": unit})
        for name, values, unit, step in zip(
            ("drive", "pos"), (U, Y), ("V", "um"), steps, strict=True
        )
    ]
    with TdmsWriter(path) as writer:
        for start in range(0, N, 100):
            part = [
                ChannelObject(c.group, c.channel, c.data[start : start + 100], c.properties)
                for c in channels
            ]
            writer.write_segment(part)


def tdms_with_stamps(path: Path) -> None:
    start = np.datetime64("2024-05-01T12:00:00", "us")
    stamps = start + (np.arange(N) * 5000).astype("timedelta64[us]")
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("Log", "stamp", stamps),
                ChannelObject("Log", "drive", U.astype("f4")),
                ChannelObject("Log", "pos", Y),
                ChannelObject("Log", "remark", ["a", "b"]),
            ]
        )


# Excel


def workbook(
    path: Path,
    header: tuple[str, str, str] = ("time [s]", "drive [V]", "pos [um]"),
    preamble: int = 0,
    notes: bool = False,
    sheets: int = 1,
) -> None:
    book = openpyxl.Workbook()
    for k in range(sheets):
        sheet = book.active if k == 0 else book.create_sheet(f"Sheet{k + 1}")
        sheet.title = f"Sheet{k + 1}"
        for line in range(preamble):
            sheet.append([None, f"made by tool {line}"])
        sheet.append(header)
        for row in zip(T.tolist(), U.tolist(), Y.tolist(), strict=True):
            sheet.append([row[0], row[1] * (k + 1), row[2]])
    if notes:
        book.create_sheet("Notes").append(["measured on", datetime.date(2024, 5, 1)])
    book.save(path)


# Tektronix


def isf(
    path: Path,
    values: np.ndarray,
    unit: str,
    *,
    width: int = 2,
    order: str = "MSB",
    short: bool = False,
    text: bool = False,
    kind: str = "RI",
) -> np.ndarray:
    """Write a channel as ISF; returns the values that the levels stand for."""
    scale = float(np.ptp(values)) / (200.0 if width == 1 else 60000.0)
    middle = float(values.max() + values.min()) / 2.0
    zero = middle if kind == "RI" else float(values.min())
    levels, shift = np.round((values - zero) / scale).astype(int), 3.0
    letter = {"RI": "i", "RP": "u"}[kind]
    if text:
        block = ",".join(map(str, levels)).encode()
    else:
        sign = ">" if order == "MSB" else "<"
        data = levels.astype(f"{sign}{letter}{width}").tobytes()
        digits = str(len(data))
        block = f"#{len(digits)}{digits}".encode() + data
    names = (
        ("BYT_N", "ENC", "BN_F", "BYT_O", "NR_P", "PT_F", "XIN", "XZE", "XUN", "YMU", "YZE", "YOF",
         "YUN", "WFI")
        if short
        else ("BYT_NR", "ENCDG", "BN_FMT", "BYT_OR", "NR_PT", "PT_FMT", "XINCR", "XZERO", "XUNIT",
              "YMULT", "YZERO", "YOFF", "YUNIT", "WFID")
    )  # fmt: skip
    label = '"Ch1, DC coupling, 5.0V/div: sample mode"'
    encoding = "ASC" if text else "BIN"
    said = (width, encoding, kind, order, levels.size, "Y", DT, -0.1, '"s"')
    said += (repr(scale), zero, shift, f'"{unit}"', label)
    preamble = ";".join(f"{name} {value}" for name, value in zip(names, said, strict=True))
    path.write_bytes(f":WFMPRE:{preamble};:CURVE ".encode() + block + b"\n")
    return zero + scale * (levels - shift)


# Where the manual puts, in each version: the values' description, the time's, and the curve's.
WFM_PLACES = {1: (166, 478, 790), 2: (168, 480, 792), 3: (168, 488, 808)}


def wfm(
    path: Path,
    values: np.ndarray,
    unit: str,
    *,
    version: int = 3,
    order: str = "<",
    kind: str = "i2",
    margin: int = 4,
    frames: int = 1,
) -> np.ndarray:
    """Write a channel by the manual of the waveform format; returns what it stands for.

    Some samples before and after the record are no part of it, as the manual says.
    """
    scale = 1.0 if kind[0] == "f" else float(np.ptp(values)) / 200.0
    shift = 0.0 if kind[0] == "f" else 0.5
    stored = (values / scale).astype(f"{order}{kind}")
    width = stored.dtype.itemsize
    explicit, implicit, curve = WFM_PLACES[version]
    header = bytearray(curve + 30)

    def put(offset: int, form: str, *content: Any) -> None:
        struct.pack_into(order + form, header, offset, *content)

    header[:2] = b"\x0f\x0f" if order == "<" else b"\xf0\xf0"
    header[2:10] = f":WFM#00{version}".encode()
    put(15, "B", width)
    put(16, "i", len(header))
    put(72, "I", frames - 1)
    put(114, "III", 1, 1, 2)
    put(explicit, "ddI20s", scale, shift, 100, unit.encode())
    put(explicit + 72, "ii", {"i2": 0, "i4": 1, "f4": 4, "f8": 5, "i1": 7}[kind], 0)
    put(implicit, "ddI20s", DT, -0.1, 100, b"s")
    start, end = margin * width, margin * width + stored.nbytes
    put(curve + 14, "IIII", start, end, end + start, end + start)
    path.write_bytes(bytes(header) + b"\x7f" * start + stored.tobytes() + b"\x7f" * start)
    return stored.astype(float) * scale + shift


Writer = Callable[[Path], Any]

# Every kind, for tests that treat all of them alike; each with the columns of input and output.
KINDS: dict[str, tuple[str, Writer, str, str]] = {
    "structure with time": ("a.mat", structure_with_time, "drive", "pos"),
    "ControlDesk": ("a.mat", controldesk, "u_volt", "pos"),
    "1 x 1 x N": ("a.mat", blocks_of_one, "u", "pos.signals.values"),
    "cells": ("a.mat", cells, "log{2}", "log{3}"),
    "compound": ("a.h5", compound, "run/table/voltage", "run/table/displacement"),
    "TDMS waveforms": ("a.tdms", waveforms, "drive", "pos"),
    "TDMS stamps": ("a.tdms", tdms_with_stamps, "drive", "pos"),
    "Excel": ("a.xlsx", workbook, "drive", "pos"),
}
