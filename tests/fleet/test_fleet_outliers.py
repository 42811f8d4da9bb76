"""How many ordinary devices are called odd, and that several odd ones are found."""

from __future__ import annotations

import numpy as np

from hyst.fleet.device import Device
from hyst.fleet.loop_of_model import POINTS
from hyst.fleet.outliers import judge_fleet


def devices(random: np.random.Generator, count: int, kinds: int = 1) -> list[Device]:
    """Devices whose gain, loop and error scatter normally by 5 % around one of some kinds."""
    x = np.linspace(0.0, 1.0, POINTS)
    made = []
    for k in range(count):
        kind = np.random.default_rng(k % kinds).uniform(0.6, 1.4, 3)
        gain, width, bend = kind * (1.0 + 0.05 * random.standard_normal(3))
        middle, half = x + 0.1 * bend * x * (1.0 - x), 0.3 * width * x * (1.0 - x)
        error = 0.3 * (1.0 + 0.05 * random.standard_normal())
        numbers = {"gain": gain, "rms_percent": error}
        rising, falling = tuple(middle - half), tuple(middle + half)
        made.append(Device(f"{k}", numbers=numbers, rising=rising, falling=falling))
    return made


def test_of_a_thousand_ordinary_devices_hardly_one_is_odd() -> None:
    random = np.random.default_rng(1)
    fleets = [judge_fleet(devices(random, count, kinds)) for count, kinds in FLEETS]
    named = sum(len(each.outliers) for each in fleets)
    # About 0.1 in a fleet are chosen: of 60 fleets 6; a Poisson count is below 15 in 999 of 1000.
    assert named < 15


FLEETS = [(20, 1)] * 25 + [(100, 1)] * 15 + [(100, 4)] * 12 + [(500, 12)] * 6 + [(1000, 1)] * 2


def changed(device: Device, **numbers: float) -> Device:
    return Device(
        device.identifier,
        numbers={**device.numbers, **numbers},
        rising=device.rising,
        falling=device.falling,
    )


def test_several_odd_devices_do_not_hide_each_other() -> None:
    fleet = devices(np.random.default_rng(2), 60)
    for k in (5, 15, 25):
        fleet[k] = changed(fleet[k], gain=2.0 * fleet[k].numbers["gain"])
    for k in (35, 45, 55):
        fleet[k] = changed(fleet[k], rms_percent=3.0)
    found = {each.identifier: each.reasons[0] for each in judge_fleet(fleet).outliers}
    assert set(found) >= {"5", "15", "25", "35", "45", "55"}
    assert found["5"].startswith("gain: ")
    assert found["35"].startswith("error of the model: ")


def test_what_lies_between_kinds_is_odd() -> None:
    fleet = devices(np.random.default_rng(3), 600, kinds=12)
    fleet[100] = changed(fleet[100], gain=1.45 * fleet[100].numbers["gain"])
    judged = judge_fleet(fleet)
    assert [each.identifier for each in judged.outliers] == ["100"]
    assert judged.outliers[0].reasons[0].startswith("gain: ")
    assert "most like it" in judged.outliers[0].reasons[0]


def test_an_output_that_falls_is_odd() -> None:
    fleet = devices(np.random.default_rng(4), 20)
    fleet[7] = changed(fleet[7], gain=-fleet[7].numbers["gain"])
    judged = judge_fleet(fleet)
    assert judged.outliers[0].identifier == "7"
    assert "falls" in " ".join(judged.outliers[0].reasons)
