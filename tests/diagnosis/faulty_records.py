"""Records with faults put in at known samples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from healthy_records import Array, plays, triangle_wave

import hyst
from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings import (
    codes,
    dropouts,
    outliers,
    output_is_noise,
    quantisation,
    saturated_sensor,
    still_signals,
    wrapped_counter,
)

FINDINGS_ON_VALUES = (
    codes,
    still_signals,
    wrapped_counter,
    dropouts,
    outliers,
    saturated_sensor,
    output_is_noise,
    quantisation,
)

NOISE = 0.02


def case_record(measured_data: Path, name: str) -> hyst.Record:
    """Give the record of a case that lies beside the measured data."""
    file = measured_data.parent / "cases" / name / "loop.csv"
    if not file.is_file():
        pytest.skip(f"{file} is not here")
    table = np.loadtxt(file, delimiter=",", skiprows=1)
    return record(table[:, 1], table[:, 2], float(table[1, 0]))


def record(u: Array, y: Array, dt: float = 1e-3) -> hyst.Record:
    return hyst.Record(u, y, dt, input_unit="V", output_unit="um")


def good(
    samples: int = 4000, period: float = 1000.0, seed: int = 0, kind: str = "triangle"
) -> tuple[Array, Array]:
    """Give input of 0 to 100 V and the output of plays with noise of 0.02 um."""
    t = np.arange(samples)
    wave = triangle_wave(samples, period) if kind == "triangle" else np.sin(2 * np.pi * t / period)
    u = 50.0 + 50.0 * wave
    y = plays(u) + np.random.default_rng(seed).normal(0.0, NOISE, samples)
    return u, y


def diagnosed(*records: hyst.Record) -> hyst.Diagnosis:
    """Give what the findings on values alone find."""
    evidence = Evidence(records)
    return hyst.Diagnosis(
        tuple(each for finding in FINDINGS_ON_VALUES for each in finding.find(evidence))
    )


def only(found: hyst.Diagnosis, name: str) -> Finding:
    """Give the one finding of a name, and see that nothing else than remarks was found."""
    (finding,) = found.named(name)
    others = [each for each in found.findings if each.severity != "remark" and each.name != name]
    assert not others, found.summary()
    return finding
