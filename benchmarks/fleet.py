"""A production lot: 1000 records of 500 samples, 12 types, 3 odd devices, 2 broken files.

Printed are wall seconds on all cores, figures off, processor seconds, the same in units of one
least-squares fit by numba and SciPy of ten plays and their radii to 10^4 samples from one start, in
the same run; which odd devices and broken files were named, and which others. ``--count N`` takes
another number of devices.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from pathlib import Path

import hyst
import hyst.demo
from benchmarks.fit_speed import unit_seconds


class _File:
    """A device in a file of the lot."""

    def __init__(self, path: Path) -> None:
        self.identifier, self.file = path.stem, str(path)

    def load(self) -> hyst.Record:
        return hyst.read_record(self.file, "drive", "position", time="time")


def main() -> None:
    """Print how long a lot takes, and what was found in it."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=1000)
    count = parser.parse_known_args()[0].count
    unit = unit_seconds()
    print(f"  unit, numba and scipy.optimize.least_squares: {unit:.3f} s")
    with tempfile.TemporaryDirectory() as folder:
        lot, out = Path(folder) / "lot", Path(folder) / "out"
        odd = hyst.demo.write_simulated_fleet(lot, count)
        sources = [_File(path) for path in sorted(lot.glob("*.csv"))]
        wall, spent = time.perf_counter(), _processor_seconds()
        fleet = hyst.fleet.identify(sources, folder=out)
        wall, spent = time.perf_counter() - wall, _processor_seconds() - spent
    print(f"  {count} devices: {wall:.1f} s, {wall / unit:.0f} units; on {os.cpu_count()} cores")
    print(
        f"  processor time {spent:.1f} s, {spent / unit:.0f} units; {1e3 * spent / count:.0f} ms, "
        f"{spent / unit / count:.2f} units a device"
    )
    for each in fleet.sentences():
        print(f"  {each}")
    named = {each.identifier for each in fleet.outliers} | set(fleet.failures)
    for each in odd:
        what = "named" if each.identifier in named else "MISSED"
        print(f"  {each.identifier}, {each.oddness}: {what}")
    print(f"  others named: {sorted(named - {each.identifier for each in odd}) or 'none'}")


def _processor_seconds() -> float:
    told = os.times()
    return told.user + told.system + told.children_user + told.children_system


if __name__ == "__main__":
    main()
