"""A scheduled inverse whose drive is limited, against plays whose constants move, in NumPy."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst.control import LimitedSchedule
from hyst.errors import InputError

Array = NDArray[np.float64]

R = np.array([0.3, 1.0, 2.5])
COLD = hyst.PrandtlIshlinskii([0.4, 0.3, 0.2], R, p0=0.6)
WARM = hyst.PrandtlIshlinskii([0.2, 0.5, 0.4], R, p0=0.9)
MODEL = hyst.models.Scheduled([COLD, WARM], [20.0, 40.0], name="temperature")
LIMITS = (-2.0, 3.0)


def plant(u: Array, s: Array, z: Array | None = None) -> Array:
    """Give the output of plays whose weights follow s, by their equation."""
    z, y = np.zeros(R.size) if z is None else z, np.empty(u.size)
    for k, each in enumerate(u):
        z = np.maximum(each - R, np.minimum(each + R, z))
        share = (s[k] - 20.0) / 20.0
        p = COLD.p + share * (WARM.p - COLD.p)
        y[k] = (COLD.p0 + share * (WARM.p0 - COLD.p0)) * each + p @ z
    return y


def signals(seed: int) -> tuple[Array, Array]:
    """Give what is wanted, far out of reach and back, and a temperature that drifts and jumps."""
    rng = np.random.default_rng(seed)
    wanted = np.repeat(rng.uniform(-9.0, 9.0, 100) * rng.uniform(0.0, 1.0, 100), 3)
    drift = 30.0 + 8.0 * np.sin(np.arange(300) / 40.0)
    return wanted, np.where(rng.uniform(size=300) < 0.02, 21.0, drift)


def held_and_missed(u: Array, y: Array, wanted: Array) -> tuple[int, int]:
    """Count samples held at a limit, and those that a drive within the limits would have met."""
    lost = 1e-11  # some dozen roundings of numbers up to 9, hundreds of times
    low, high = LIMITS
    below, above = (u == high) & (y < wanted + lost), (u == low) & (y > wanted - lost)
    within = (u >= low) & (u <= high)
    met = within & ((np.abs(y - wanted) < lost) | below | above)
    return int(np.sum(below | above)), int(np.sum(~met))


@pytest.mark.parametrize("seed", range(3))
def test_the_plant_comes_as_near_as_its_drive_lets_it(seed: int) -> None:
    wanted, s = signals(seed)
    u = LimitedSchedule(MODEL.inverse(), LIMITS)(wanted, s)
    held, missed = held_and_missed(u, plant(u, s), wanted)
    assert missed == 0
    assert 30 < held < 270


def test_after_a_history_too() -> None:
    wanted, s = signals(5)
    z = np.zeros(3)
    for each in (2.5, -1.5, 0.5):
        z = np.maximum(each - R, np.minimum(each + R, z))
    block = LimitedSchedule(MODEL.inverse(), LIMITS)
    u = block.run(wanted, s, block.state_after([2.5, -1.5, 0.5], 25.0)).y
    held, missed = held_and_missed(u, plant(u, s, z), wanted)
    assert missed == 0
    assert 30 < held < 270
    with pytest.raises(InputError, match=r"history\[1\] = 3.5 is outside"):
        block.state_after([1.0, 3.5], 25.0)


def test_a_model_is_driven_within_limits_and_rate() -> None:
    s = np.array([20.0, 30.0, 40.0, 40.0])
    step = LimitedSchedule(MODEL, LIMITS, 2.0, dt=1.0).stepper()
    y = [step(9.0, each) for each in s]
    assert np.abs(y - plant(np.array([2.0, 3.0, 3.0, 3.0]), s)).max() < 1e-14
    assert (step.limited, step.fault, step.outside) == (True, False, False)
    assert step(1.0, np.nan) == y[-1]
    assert step.fault is True


def test_within_limits_all_bits_are_those_of_the_inverse() -> None:
    wanted, s = signals(2)
    wide = LimitedSchedule(MODEL.inverse(), (-1e3, 1e3))
    assert np.array_equal(wide(wanted, s), MODEL.inverse().run(wanted, s).y)
    step = wide.stepper()
    assert np.array_equal([step(*each) for each in zip(wanted, s, strict=True)], wide(wanted, s))
    assert step.limited is False


def test_halves_files_and_copies(tmp_path: Path) -> None:
    about = hyst.ModelDescription(input_low=-2.0, input_high=3.0, dt=0.01)
    described = MODEL.with_description(about)
    wanted, s = signals(4)
    for block in (LimitedSchedule(described.inverse(), rate=50.0), LimitedSchedule(described)):
        assert block.limits == LIMITS
        whole = block.run(wanted, s)
        first = block.run(wanted[:111], s[:111])
        second = block.run(wanted[111:], s[111:], first.state)
        assert np.array_equal(np.concatenate([first.y, second.y]), whole.y)
        assert np.array_equal(second.state, whole.state)
        block.save(tmp_path / "block.json")
        for same in (hyst.load(tmp_path / "block.json"), pickle.loads(pickle.dumps(block))):
            assert same == block
            assert hash(same) == hash(block)
            assert np.array_equal(same(wanted, s), whole.y)


def test_refusals() -> None:
    with pytest.raises(InputError, match="give a Scheduled model or its inverse"):
        LimitedSchedule(COLD, LIMITS)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="does not tell the range"):
        LimitedSchedule(MODEL.inverse())
    with pytest.raises(InputError, match="give dt"):
        LimitedSchedule(MODEL.inverse(), LIMITS, 1.0)
    with pytest.raises(InputError, match="temperature has shape"):
        LimitedSchedule(MODEL.inverse(), LIMITS).run([1.0, 2.0], [20.0])
    with pytest.raises(InputError, match="x is nan at index 1"):
        LimitedSchedule(MODEL.inverse(), LIMITS).run([1.0, np.nan], 20.0)
