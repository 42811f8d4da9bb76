"""A thousand files, written in many ways and then damaged: right signals, or one sentence."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from mutations import DT, SAMPLES, U, Y, agrees, damaged, harmless, plain_sheet

from hyst.errors import InputError
from hyst.io import read_record, read_tables

WRITTEN = 300
DAMAGED = 700
# Damage that leaves fewer cannot be told from a short record.
FEWEST_READ = 0.05


def read(path: Path, data: bytes, repair: bool) -> tuple[np.ndarray, np.ndarray, float]:
    path.write_bytes(data)
    record = read_record(path, 1, 2, time=0, repair=repair)
    return record.u, record.y, record.dt


@pytest.mark.parametrize("part", range(3))
def test_files_written_in_many_ways(tmp_path: Path, part: int) -> None:
    rng = random.Random(100 + part)
    for number in range(WRITTEN // 3):
        sheet, _ = plain_sheet(rng)
        changed, encode = harmless(sheet, rng)
        data = encode(changed.text())
        u, y, dt = read(tmp_path / f"{number}.csv", data, repair=number % 2 == 0)
        assert (u.size, dt) == (SAMPLES, pytest.approx(DT, rel=1e-6)), data[:300]
        # Four decimals or eight digits were written.
        assert np.allclose(u, U, rtol=0.0, atol=1e-6), data[:300]
        assert np.allclose(y, Y, rtol=0.0, atol=1e-6), data[:300]


@pytest.mark.parametrize("part", range(5))
def test_damaged_files(tmp_path: Path, part: int) -> None:
    rng = random.Random(200 + part)
    read_anyhow = refused = 0
    for number in range(DAMAGED // 5):
        sheet, _ = plain_sheet(rng)
        changed, _ = harmless(sheet, rng)
        data = damaged(changed.text().replace("\r", "\n").encode(), rng)
        try:
            u, y, dt = read(tmp_path / f"{number}.csv", data, repair=number % 2 == 0)
        except InputError as error:
            sentence = str(error)
            assert 20 < len(sentence) < 600
            assert "\n" not in sentence
            refused += 1
            continue
        assert u.size > FEWEST_READ * SAMPLES
        known_unit = all(line.encode() in data for line in changed.names())
        assert agrees(u, y, dt, known_unit), (data[:200], dt, u.size)
        read_anyhow += 1
    # Both happen: the fuzzer neither leaves everything whole nor breaks everything.
    assert min(read_anyhow, refused) > DAMAGED // 50


def test_bytes_that_mean_nothing_are_refused(tmp_path: Path) -> None:
    rng = random.Random(7)
    beginnings = [b"PK\x03\x04", b"PAR1", b"\x1f\x8b\x08", b"MATLAB 5.0 MAT-file", b"\x89HDF\r\n"]
    for number in range(60):
        # A control character that no text holds.
        data = rng.choice([b"", *beginnings]) + b"\x01" + rng.randbytes(rng.randrange(1, 400))
        path = tmp_path / f"{number}{rng.choice(['.csv', '.dat', ''])}"
        path.write_bytes(data)
        with pytest.raises(InputError, match=r"\w+"):
            read_tables(path)
