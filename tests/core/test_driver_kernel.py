"""The driver of the core, compiled here, gives the codes and the bits of Python."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hyst
from hyst.export.c.core_sources import core_folder
from hyst.operators.driver.points import Points

CORE = core_folder()


class Table(ctypes.Structure):
    """hyst_driver."""

    _fields_ = (
        ("count", ctypes.c_size_t),
        ("code", ctypes.c_void_p),
        ("volt", ctypes.c_void_p),
        ("slope", ctypes.c_void_p),
        ("lowest", ctypes.c_int32),
        ("highest", ctypes.c_int32),
    )


@pytest.fixture(params=["double", "single"])
def kernel(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Any, bool]:
    if shutil.which("gcc") is None:
        pytest.skip("gcc is not installed")
    single = request.param == "single"
    library = tmp_path / "driver.so"
    flags = ["-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", f"-I{CORE / 'include'}"]
    flags += ["-DHYST_SINGLE"] * single
    subprocess.run(["gcc", *flags, str(CORE / "src/driver.c"), "-o", str(library)], check=True)
    found = ctypes.CDLL(str(library))
    real = ctypes.c_float if single else ctypes.c_double
    found.hyst_driver_volt.restype, found.hyst_driver_code.restype = real, ctypes.c_int32
    found.hyst_driver_volt.argtypes = [ctypes.POINTER(Table), ctypes.c_int32]
    found.hyst_driver_code.argtypes = [ctypes.POINTER(Table), real]
    return found, single


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_codes_and_volts_are_those_of_python(
    kernel: tuple[Any, bool], seed: int, sign: float
) -> None:
    core, single = kernel
    rng = np.random.default_rng(seed)
    codes = np.cumsum(rng.integers(1, 900, 9)) - 2000
    steps = np.diff(codes, prepend=codes[0] - 1)
    volts = sign * (np.cumsum(steps * rng.uniform(0.01, 0.04, 9)) - 40.0)
    driver = hyst.Driver.from_table(codes, volts)
    points = Points.of(driver.table_codes, driver.table_volts, single)
    limits = driver.codes_within(-20.0, 20.0, single=single)
    held = points.codes.astype(np.int32), points.volts, points.slopes
    table = Table(points.codes.size, *(each.ctypes.data for each in held), *limits)
    every = np.arange(codes[0] - 3, codes[-1] + 4)
    expected = points.volts_of(every)
    given = [core.hyst_driver_volt(table, int(code)) for code in every]
    assert np.array_equal(np.array(given, dtype=expected.dtype), expected)
    # Codes' own volts, halves between them, and what lies beyond both ends.
    wanted = np.concatenate(
        [expected, 0.5 * (expected[1:] + expected[:-1]), rng.uniform(-99.0, 99.0, 2000)]
    ).astype(expected.dtype)
    nearest = points.codes_of(wanted, *limits)
    assert [core.hyst_driver_code(table, float(each)) for each in wanted] == nearest.tolist()
    inside = points.volts_of(nearest)
    assert inside.min() >= -20.0
    assert inside.max() <= 20.0
