"""What a report says of identified dynamics, and the files that go with it."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.identification.families.hammerstein import IdentifiedHammerstein
from hyst.models import LinearDynamics
from hyst.signals import Record, multisine

DT = 1e-3
W = 2.0 * np.pi * 80.0
G = LinearDynamics.from_continuous([1.0], [W**-2, 0.3 / W, 1.0], DT)
U = multisine(DT, 3000, amplitude=10.0).u


@pytest.fixture(scope="module")
def found() -> tuple[IdentifiedHammerstein, Record]:
    y = (G @ hyst.PrandtlIshlinskii([0.5], [1.5], 1.0))(U)
    y = y + 0.01 * y.std() * np.random.default_rng(0).normal(size=y.size)
    record = Record(U, y, DT)
    result = hyst.identify(record, family="hammerstein", hysteresis="pi", plays=1, state_order=2)
    assert isinstance(result, IdentifiedHammerstein)
    return result, record


def test_the_report_writes_the_frequency_response(
    found: tuple[IdentifiedHammerstein, Record], tmp_path: Path
) -> None:
    result, record = found
    sections = hyst.report.dynamics_sections(result)
    written = hyst.report.write_report(result, record, (), tmp_path / "out", sections=sections)
    names = {each.name for each in written}
    assert {"dynamics.png", "frequency_response.csv"} <= names
    assert (tmp_path / "out" / "dynamics.png").read_bytes().startswith(b"\x89PNG")
    with open(tmp_path / "out" / "frequency_response.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    f = np.array([float(each["frequency [Hz]"]) for each in rows])
    gain = np.array([float(each["gain"]) for each in rows])
    # The record tells the gain below 400 Hz to a hundredth; at the end a zero of sampling is near.
    low = f < 400.0
    assert gain[low] == pytest.approx(np.abs(G.frequency_response(f[low])), rel=0.03)
    assert all(float(each["gain low"]) <= float(each["gain high"]) for each in rows)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "resonance" in page
    assert "continuous system with numerator in s" in page
    assert "frequency_response.csv" in page
    numbers = json.loads((tmp_path / "out" / "metrics.json").read_text(encoding="utf-8"))
    (resonance,) = numbers["dynamics"]["resonances"]
    assert resonance["frequency_hz"] == pytest.approx(80.0, abs=0.1)
    assert resonance["damping"] == pytest.approx(0.15, abs=0.002)
    denominator = numbers["dynamics"]["continuous"]["denominator"]
    assert denominator == pytest.approx([1.0, 0.3 * W, W * W], rel=0.01)


def test_the_summary_tells_resonances_and_the_continuous_system(
    found: tuple[IdentifiedHammerstein, Record],
) -> None:
    summary = found[0].summary()
    assert "rad/s)   damping 0.1" in summary
    assert "as continuous system, input held" in summary
    (row, zero) = hyst.report.dynamics_table(found[0]).rows
    assert row[0] == "resonance"
    assert row[1].startswith(f"{found[0].resonances[0].frequency:.6g} +- ")
    assert zero[0] == "real zero"


def test_units_change_no_resonance(found: tuple[IdentifiedHammerstein, Record]) -> None:
    result, record = found
    scaled = hyst.identify(
        Record(4.0 * record.u, 0.125 * record.y, DT),
        family="hammerstein",
        hysteresis="pi",
        plays=1,
        state_order=2,
    )
    assert isinstance(scaled, IdentifiedHammerstein)
    assert scaled.resonances == result.resonances
    ours, theirs = result.frequency_response(), scaled.frequency_response()
    assert np.array_equal(ours.response, theirs.response)
    assert np.array_equal(ours.gain_error, theirs.gain_error)
    assert np.array_equal(ours.excited, theirs.excited)


def test_other_families_have_no_such_table() -> None:
    u = 10.0 * np.sin(np.linspace(0.0, 20.0, 500)) * np.linspace(1.0, 0.5, 500)
    record = Record(u, hyst.PrandtlIshlinskii([0.5], [1.5], 1.0)(u), DT)
    plain = hyst.identify(record, family="pi", plays=1)
    assert hyst.report.dynamics_table(plain).rows == ()


@pytest.mark.usefixtures("undrawn")
def test_a_drive_that_determines_no_impulse_response_has_none_in_the_report(
    found: tuple[IdentifiedHammerstein, Record],
) -> None:
    assert hyst.report.dynamics_sections(found[0])[-1].heading.startswith("For comparison")
    u = multisine(DT, 3000, amplitude=10.0, band=(1.0, 150.0)).u
    y = (G @ hyst.PrandtlIshlinskii([0.5], [1.5], 1.0))(u)
    y = y + 0.01 * y.std() * np.random.default_rng(0).normal(size=y.size)
    banded = hyst.identify(
        Record(u, y, DT), family="hammerstein", hysteresis="pi", plays=1, state_order=2
    )
    sections = hyst.report.dynamics_sections(banded)
    assert [each.heading for each in sections] == ["The loop without a model of it", "The dynamics"]
    assert "does not determine an impulse response" in " ".join(sections[1].texts)
    assert "impulse response" not in sections[0].caption


def test_a_comparison_tells_what_its_errors_are(
    found: tuple[IdentifiedHammerstein, Record],
) -> None:
    """Sizes before dynamics are scored in the sample; other families by what was left out."""
    static = hyst.PrandtlIshlinskii([0.5], [1.5], 1.0)(U)
    own = hyst.report.candidates_table(found[0])
    other = hyst.report.candidates_table(
        hyst.identify(Record(U, static, DT), family="linear,pi", plays=1)
    )
    assert "Bayesian" in own.title
    assert "left out" not in own.title
    assert "left out" in other.title
