"""Large records: time and memory by length, of records in memory and of records in their file.

Each row is a process of its own, so that its largest memory is its own. Prints processor time, in
units of the peer's fit of ten plays too (benchmarks.fit_speed), largest memory, and what of it is
beyond three times the record (two doubles a sample) and 150 MB.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import hyst
from benchmarks.fit_speed import MAPPED, NOISE, decaying, measured, unit_seconds
from benchmarks.timing import report

PIECE = 10**6
ALLOWED, TIMES = 150.0, 3.0


def main(arguments: list[str] | None = None) -> None:
    """Print a row for each length; ``--largest 8`` for 10^8 samples too."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--largest", type=int, default=6)
    largest = parser.parse_args([] if arguments is None else arguments).largest
    unit = unit_seconds()
    print(f"a unit is {unit:.3f} s of processor time: the peer's fit of ten plays to 10^4 samples")
    spent: dict[int, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        for power in range(5, largest + 1):
            path = written(Path(folder) / f"record_{power}.parquet", 10**power)
            spent[power] = row(path, "file", power, unit)
            if power <= 6:
                row(path, "memory", power, unit)
            if power == 6:
                row(path, "auto", power, unit)
            path.unlink()
    for power in range(7, largest + 1):
        print(
            f"10^{power} over 10^{power - 1}: {spent[power] / spent[power - 1]:.1f} times the time"
        )


def row(path: Path, how: str, power: int, unit: float) -> float:
    """Identify in a process of its own, print what it took, and give its processor time."""
    called = how if how == "file" else f"{how}:{power}"
    command = [sys.executable, "-m", "benchmarks.large_records", str(path), called]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    took = json.loads(told.splitlines()[-1])
    bound = TIMES * 16.0 * 10**power / 1e6 + ALLOWED
    print(
        f"  10^{power}, {how:6s} {took['seconds']:7.1f} s  {took['seconds'] / unit:8.0f} units  "
        f"{took['steps']:3d} steps  {took['memory']:6.0f} MB, {took['memory'] / bound:5.2f} of 3 "
        f"times the record and 150 MB",
        flush=True,
    )
    if power == 6:
        name = f"large_records: memory of 10^6 samples, {how}, over 3 records and 150 MB"
        report(name, took["memory"] / bound, better="smaller", spread=0.02)
    return float(took["seconds"])


def written(path: Path, samples: int) -> Path:
    """Write a record of a modified Prandtl-Ishlinskii stage, piece by piece."""
    import pyarrow
    import pyarrow.parquet

    noise, state = np.random.default_rng(1), MAPPED.initial_state()
    schema = pyarrow.schema([("u", pyarrow.float64()), ("y", pyarrow.float64())])
    with pyarrow.parquet.ParquetWriter(path, schema, compression=None) as file:
        for first in range(0, samples, PIECE):
            k = np.arange(first, min(first + PIECE, samples))
            shape = 1.0 - 0.6 * np.sin(np.pi * k / samples)
            u = shape * np.sin(2.0 * np.pi * 5.0 * 1e-3 * k + 0.3)
            y, state = MAPPED.run(u, state)
            y = y + 0.3 + NOISE * noise.standard_normal(u.size)
            file.write_table(pyarrow.table({"u": u, "y": y}, schema=schema))
    return path


def identified(path: str, how: str) -> None:
    """Identify from a file, and print what it took as JSON."""
    given: hyst.Record | hyst.io.RecordFile
    if how == "file":
        given = hyst.open_record(path, input="u", output="y", rate=1000.0)
    else:  # made here: a reader of files would count
        given = measured(MAPPED, decaying(10 ** int(how.partition(":")[2])))
    before = time.process_time()
    asked = {} if how.startswith("auto") else {"family": "mpi", "plays": 4, "delay": 0}
    found = hyst.identify(given, **asked)
    spent = time.process_time() - before
    told = {"seconds": spent, "memory": largest_memory(), "steps": found.iterations}
    print(json.dumps(told))


def largest_memory() -> float:
    """Give the largest memory of this process, MB; ``ru_maxrss`` holds that of its parent, too."""
    status = Path("/proc/self/status").read_text()  # of Linux alone
    return 1.024e-3 * float(status.partition("VmHWM:")[2].split()[0])


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] != "--largest":
        identified(sys.argv[1], sys.argv[2])
    else:
        main(sys.argv[1:])
