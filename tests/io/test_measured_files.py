from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from hyst.errors import InputError
from hyst.io import read_column, read_record, read_table
from hyst.signals import loop_area, reversals, suggest_dead_band


def test_the_piezo_record(measured_data: Path) -> None:
    path = measured_data / "piezo-dbo" / "Model_Vi_Do.dat"
    table = read_table(path)
    assert len(table.columns) == 7
    for idle in (1, 2, 3):
        assert table.columns[idle].min() == table.columns[idle].max() == 0.0
    record = read_record(path, input=0, output="4", rate=200)
    assert (record.samples, record.dt) == (8027, 0.005)
    # 0..3.6 V, six decimals in the file.
    assert record.u.min() == pytest.approx(0.0, abs=1e-3)
    assert record.u.max() == pytest.approx(3.6, abs=1e-3)
    settled = record.slice(400, 8027)
    assert np.ptp(settled.y) == pytest.approx(45.6, abs=0.5)
    # 40 cycles of 1 Hz.
    assert reversals(record.u, suggest_dead_band(record.u)).size == 80
    with pytest.raises(InputError, match="output 'column 1' is 0 throughout"):
        read_record(path, input=0, output=1, rate=200)


@pytest.mark.parametrize("name", ["A.1", "A.5", "B.1", "B.5", "B.8"])
def test_the_damper_records(measured_data: Path, name: str) -> None:
    path = measured_data / "mr-damper" / f"ensaio.{name}.mat"
    record = read_record(path, input="dist", output="forc", rate=100)
    assert (record.samples, record.dt, record.input_name) == (1501, 0.01, "dist")
    reference = scipy.io.loadmat(path)
    assert np.array_equal(record.u, reference["dist"].ravel())
    assert np.array_equal(record.y, reference["forc"].ravel())
    if "Tout" in reference:
        assert read_record(path, "dist", "forc", time="Tout").dt == pytest.approx(0.01, rel=1e-9)


def test_a_damper_time_axis_of_another_length_is_refused(measured_data: Path) -> None:
    path = measured_data / "mr-damper" / "ensaio.B.1.mat"
    with pytest.raises(InputError, match="'forc' 1501 and 'tout' 1002"):
        read_record(path, "dist", "forc", time="tout")


@pytest.mark.parametrize(("name", "rows", "worst"), [("3bar", 7834, 2.66), ("7bar", 8720, 0.287)])
def test_the_seal_records_have_uneven_time(
    measured_data: Path, name: str, rows: int, worst: float
) -> None:
    path = measured_data / "pneumatic-seal" / f"O-ring_{name}.csv"
    columns = {"input": 4, "output": 6, "time": 0, "time_unit": "ms"}
    with pytest.raises(InputError, match=rf"worst gap is {worst} s after line \d+ and the median"):
        read_record(path, **columns)  # type: ignore[arg-type]
    # Gaps of that length are filled in only for those who ask for it.
    with pytest.raises(InputError, match=r"samples are missing there, and repair fills in 5 at"):
        read_record(path, **columns, repair=True)  # type: ignore[arg-type]
    record = read_record(path, **columns, repair=True, longest_gap=300)  # type: ignore[arg-type]
    assert record.dt == 0.01
    stamps, _, _ = read_column(path, 0)
    assert stamps.size == rows
    assert record.samples == math.floor((stamps[-1] - stamps[0]) / 10.0) + 1
    assert f"the worst gap was {worst} s" in record.notes[0]
    # The wanted rate is 100 Hz, and most rows keep it.
    assert np.median(np.diff(stamps)) == 10.0


@pytest.mark.parametrize(
    ("name", "loops", "samples"),
    [
        ("M130_27s", 3, 256),
        ("MnZn_HP_ferrite", 4, 129),
        ("MnZn_ferrite", 4, 129),
        ("amorf", 1, 322),
    ],
)
def test_the_magnetic_loops(measured_data: Path, name: str, loops: int, samples: int) -> None:
    folder = measured_data / "magnetic-bh"
    table = read_table(folder / f"H_{name}.mat")
    names = ("HmeasT",) if loops == 1 else tuple(f"HmeasT[{k}]" for k in range(loops))
    assert table.names == names
    for k in range(loops):
        h, _, _ = read_column(folder / f"H_{name}.mat", k)
        b, _, _ = read_column(folder / f"B_{name}.mat", k)
        assert h.size == b.size == samples
        assert loop_area(h, b) > 0.0  # B lags H
