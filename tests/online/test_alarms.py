"""Alarms that start once and end once."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hyst
from hyst.online.alarms import Alarm, AlarmRule, Alarms

RULE = AlarmRule("error", start=2.0, stop=1.0, starts_after=2, ends_after=3)


def changes(values: list[float], rule: AlarmRule = RULE) -> list[tuple[int, bool]]:
    alarm = Alarm(rule)
    found = [(k, alarm.look(k, value, "too large")) for k, value in enumerate(values)]
    return [(k, event.starts) for k, event in found if event is not None]


@pytest.mark.parametrize(
    ("values", "wanted"),
    [
        ([2.0, 2.0], [(1, True)]),
        ([2.0, 1.9, 2.0, 1.9], []),
        ([3.0] * 10, [(1, True)]),
        ([3.0, 3.0, 1.5, 1.0, 1.0, 1.1, 1.0, 1.0, 1.0], [(1, True), (8, False)]),
        ([3.0, 3.0, 0.0, 0.0, 0.0, 3.0, 3.0], [(1, True), (4, False), (6, True)]),
        ([3.0, math.nan, math.nan, 3.0], [(3, True)]),
        ([math.inf, math.inf], [(1, True)]),
        ([], []),
    ],
)
def test_levels_and_counts(values: list[float], wanted: list[tuple[int, bool]]) -> None:
    assert changes(values) == wanted


@pytest.mark.parametrize("seed", range(20))
def test_starts_and_ends_take_turns_and_are_earned(seed: int) -> None:
    """Whatever comes: never two starts in a row, and each change has its run of values before."""
    values = np.random.default_rng(seed).choice([0.5, 1.0, 1.5, 2.0, 4.0], 400).tolist()
    found = changes(values)
    assert [starts for _, starts in found] == [k % 2 == 0 for k in range(len(found))]
    assert len(found) > 4
    for k, starts in found:
        run = values[k - 1 : k + 1] if starts else values[k - 2 : k + 1]
        assert all(value >= 2.0 if starts else value <= 1.0 for value in run)


def test_noise_between_the_levels_does_not_make_it_flicker() -> None:
    """A value that hovers about the start: with hysteresis one alarm, without many."""
    values = (2.0 + np.random.default_rng(1).normal(0.0, 0.2, 500)).tolist()
    assert changes(values) == changes(values)[:1]
    single = AlarmRule("error", start=2.0, stop=2.0)
    assert len(changes(values, single)) > 100


def test_the_end_tells_how_long_and_how_bad() -> None:
    alarms = Alarms([AlarmRule("error", 1.0, 0.5), AlarmRule("drift", 1.0, 0.5)])
    assert alarms.look(10.0, {"error": (3.0, "3 um")})[0].sentence == "3 um"
    assert alarms.active == ("error",)
    assert alarms.look(11.0, {"error": (7.0, ""), "drift": (0.0, "")}) == ()
    (event,) = alarms.look(15.0, {"error": (0.1, "")})
    assert (event.starts, event.value, event.sentence) == (False, 7.0, "after 5 s")
    assert alarms.active == ()


def test_rules_that_make_no_sense_are_refused() -> None:
    with pytest.raises(hyst.InputError, match="lower one for its end"):
        AlarmRule("error", 1.0, 2.0)
    with pytest.raises(hyst.InputError, match="finite"):
        AlarmRule("error", math.nan, 0.0)
    with pytest.raises(hyst.InputError, match="starts_after"):
        AlarmRule("error", starts_after=0)
    with pytest.raises(hyst.InputError, match="two alarms"):
        Alarms([RULE, RULE])
    with pytest.raises(hyst.InputError, match="no alarm is called"):
        Alarms([RULE]).look(0.0, {"other": (1.0, "")})
