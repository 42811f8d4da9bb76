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

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

import hyst
import hyst.demo

Array = NDArray[np.float64]


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
    print(f"  processor time {spent:.1f} s, {1e3 * spent / count:.0f} ms a device")
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


def unit_seconds() -> float:
    """Time one fit of ten plays and radii to 10^4 samples, compiled before."""
    t = np.linspace(0.0, 1.0, 10_000)
    u = (1.0 - 0.6 * np.sin(np.pi * t)) * np.sin(2.0 * np.pi * 50.0 * t)
    r = np.linspace(0.05, 0.8, 10)
    truth = _plays(u, r)[0] @ np.linspace(0.5, 0.1, 10) + u
    y = truth + 0.01 * np.random.default_rng(1).standard_normal(u.size)
    start = np.concatenate((np.full(10, 0.2), np.linspace(0.04, 0.9, 10), [1.0]))

    def error(theta: Array) -> Array:
        return np.asarray(_plays(u, theta[10:20])[0] @ theta[:10] + theta[20] * u - y)

    def jacobian(theta: Array) -> Array:
        z, slopes = _plays(u, theta[10:20])
        return np.column_stack((z, slopes * theta[:10], u))

    times = []
    for _ in range(3):
        begun = time.perf_counter()
        least_squares(error, start, jacobian, x_scale="jac")
        times.append(time.perf_counter() - begun)
    return min(times)


@numba.njit(cache=False)
def _plays(u: Array, r: Array) -> tuple[Array, Array]:
    """Give the plays of a drive, and how each moves with its radius."""
    z, slopes = np.empty((u.size, r.size)), np.empty((u.size, r.size))
    for i in range(r.size):
        at, slope = 0.0, 0.0
        for k in range(u.size):
            if u[k] - r[i] > at:
                at, slope = u[k] - r[i], -1.0
            elif u[k] + r[i] < at:
                at, slope = u[k] + r[i], 1.0
            z[k, i], slopes[k, i] = at, slope
    return z, slopes


if __name__ == "__main__":
    main()
