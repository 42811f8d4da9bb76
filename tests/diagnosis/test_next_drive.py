"""The drive that would add most, and the command that writes it."""

from __future__ import annotations

import shlex

import numpy as np
import pytest
from simulated_actuators import DT, NESTED, Array, plays, record, sine, through, triangle

import hyst
from hyst.diagnosis.next_drive import NextDrive


def proposed(*inputs: Array) -> NextDrive:
    """What is proposed for records with these drives."""
    found = hyst.diagnose([record(u, plays(u), 0.02) for u in inputs]).next_drive
    assert found is not None
    return found


def test_one_amplitude_wants_minor_loops_from_where_it_rests() -> None:
    assert proposed(triangle()).kind == "forc"
    assert proposed(sine(400.0, 2000, -50.0, 50.0)[100:]).kind == "reversals"
    low, high = proposed(triangle()).drive.u.min(), proposed(triangle()).drive.u.max()
    assert (low, high) == (0.0, 100.0)


def test_no_repetition_wants_the_same_loop_again() -> None:
    found = proposed(hyst.signals.decaying_triangle(DT, 50.0, 200.0, cycles=10).u)
    assert (found.kind, found.periods) == ("triangle", 3)


def test_one_rate_wants_another_and_several_want_a_judge() -> None:
    found = proposed(triangle(), through(NESTED))
    assert found.kind == "triangle"
    # Half of the nested branches have 400 V/s, the next slower ones 320: a median of 360.
    assert found.max_rate == pytest.approx(360.0 / 5.0, rel=0.01)
    inputs = [triangle(), triangle(2500.0, 5000), through(NESTED)]
    assert proposed(*inputs).kind == "reversals"


def test_it_stays_within_range_rate_and_length() -> None:
    for u in (triangle(), sine(40.0, 1000), through(NESTED), triangle(4e4, 60_000)):
        found = proposed(u)
        drive = found.drive
        # Amplitude and offset are rounded to six digits.
        assert drive.u.min() >= u.min() - 1e-4
        assert drive.u.max() <= u.max() + 1e-4
        assert drive.max_rate <= np.abs(np.diff(u)).max() / DT * 1.01
        assert 100 <= len(drive) <= 2e6


def test_command_says_all_of_it() -> None:
    found = proposed(triangle())
    words = shlex.split(found.command)
    assert words[:2] == ["hyst", "excite"]
    assert words[words.index("--name") + 1] == "u [V]"
    assert f"--offset={found.offset:.12g}" in words
    assert hyst.diagnose(record(triangle(), plays(triangle()))).to_dict()["next_drive"]


def test_nothing_moves_nothing_is_proposed() -> None:
    assert hyst.diagnose(hyst.Record(np.ones(50), np.ones(50), DT)).next_drive is None
