"""What a long record needs of memory, measured in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SAMPLES = 200_000
RECORD = 16 * SAMPLES / 1e6
"""MB: input and output."""

CHILD = """
import pathlib
import sys
import numpy as np
import hyst

def largest():
    # What getrusage tells begins with the memory of the process that started this one.
    status = pathlib.Path("/proc/self/status").read_text()
    return 1.024e-3 * float(status.partition("VmHWM:")[2].split()[0])

def identified(samples):
    t = 1e-3 * np.arange(samples)
    u = (1.0 - 0.6 * np.sin(np.pi * t / t[-1])) * np.sin(10.0 * np.pi * t + 0.3)
    true = hyst.PrandtlIshlinskii([0.5, 0.4, 0.3, 0.2], [0.08, 0.22, 0.43, 0.71], 1.0)
    y = true(u) + 0.01 * np.random.default_rng(1).standard_normal(samples)
    asked = {"family": "pi", "plays": 4, "delay": 0, "creep": None, "drift": False}
    hyst.identify(hyst.Record(u, y, 1e-3), **asked)

identified(4000)
before = largest()
identified(int(sys.argv[1]))
print(largest() - before)
"""


def test_a_long_record_needs_a_few_times_its_own_memory() -> None:
    if not Path("/proc/self/status").exists():
        pytest.skip("the largest memory of a process is read where Linux tells it")
    command = [sys.executable, "-c", CHILD, str(SAMPLES)]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    # Measured: 18. A Jacobian of all samples and its ten constants would add five, a copy as many.
    assert float(told) <= 21.0 * RECORD
