"""An inverse or a model alone whose drive is limited, against plants that know nothing of it."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import hyst
from hyst import _single
from hyst.compensation import invert_trajectory
from hyst.control import LimitedDrive
from hyst.control.limited_drive.monotone import require_monotone
from hyst.errors import InputError, NotInvertibleError
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

STAGE = hyst.PrandtlIshlinskii([0.4, 0.2, 0.3, 0.1], [0.2, 0.7, 1.5, 4.0], p0=0.6)
MAP = hyst.DeadZone([0.9, 0.2, -0.1, 0.15], [0.0, 1.0, -1.0, -2.0])


def plant(model: hyst.PrandtlIshlinskii, u: Array, z: Array | None = None) -> Array:
    """Give the output of a bank of plays by their equation."""
    z = np.zeros(model.r.size) if z is None else z
    y = np.empty(u.size)
    for k, each in enumerate(u):
        z = np.maximum(each - model.r, np.minimum(each + model.r, z))
        y[k] = model.p0 * each + model.p @ z
    return y


def references(seed: int) -> Array:
    """Give what is wanted: jumps, rests and slow ways, far out of reach and back."""
    rng = np.random.default_rng(seed)
    jumps = np.repeat(rng.uniform(-9.0, 9.0, 60) * rng.uniform(0.0, 1.0, 60), 4)
    return np.concatenate([jumps, np.interp(np.arange(240) / 4.0, np.arange(60), jumps[::4])])


def require_nearest(u: Array, y: Array, wanted: Array, limits: tuple[float, float]) -> int:
    """Require that y is what is wanted, or as near as an end of the drive lets it come."""
    lost = 1e-11 * max(np.abs(y).max(), np.abs(wanted).max())  # of some dozen operations
    low, high = limits
    reached = np.abs(y - wanted) <= lost
    below = (u == high) & (y < wanted + lost)
    above = (u == low) & (y > wanted - lost)
    assert (reached | below | above).all()
    assert ((u >= low) & (u <= high)).all()
    return int((below | above).sum())


def random_bank(rng: np.random.Generator, t: int) -> hyst.PrandtlIshlinskii:
    """Give plays of any weights that have an inverse; some ideal, some of equal radii."""
    n = int(rng.integers(1, 12))
    r = np.sort(rng.uniform(0.0, 3.0, n))
    if t % 5 == 0:
        r[0] = 0.0
    if t % 3 == 0:
        r = np.round(2.0 * r) / 2.0
    p = rng.uniform(0.0, 1.0, n)
    if t % 4 == 0:
        p[-1] = -0.1
    return hyst.PrandtlIshlinskii(p, r, p0=float(rng.uniform(0.3, 1.0)))


LIMITS = [(-3.0, 4.0), (-0.5, 0.3), (0.0, 5.0), (-1.0, 6.0), (1.0, 3.0), (-4.0, -2.0)]


@pytest.mark.parametrize("limits", LIMITS)
def test_the_plant_comes_as_near_as_its_drive_lets_it(limits: tuple[float, float]) -> None:
    rng = np.random.default_rng(1)
    held = banks = 0
    for t in range(12):
        model = random_bank(rng, t)
        block = LimitedDrive(model.inverse(), limits)
        wanted = references(t)
        if t % 3 == 0:  # turning points that meet again to the last bit
            wanted = np.round(2.0 * wanted) / 2.0
        u = block(wanted)
        held += require_nearest(u, plant(model, u), wanted, limits)
        banks += block.bank is not None
    assert held > 300
    assert banks == 12


def test_the_model_is_left_out_only_where_a_bank_ends_what_has_no_memory() -> None:
    assert LimitedDrive(STAGE.inverse(), (-3.0, 4.0)).keeps_forward is False
    assert LimitedDrive(STAGE.inverse(), (-0.1, 0.1)).keeps_forward is False
    falling = (STAGE @ hyst.Affine(-1.0)).inverse()
    assert LimitedDrive(falling, (-3.0, 4.0)).keeps_forward is True
    assert LimitedDrive(STAGE.inverse(), (-3.0, 4.0), 1.0, dt=1.0).keeps_forward is True
    assert LimitedDrive((MAP @ STAGE).inverse(), (-3.0, 4.0)).keeps_forward is False
    assert LimitedDrive((STAGE @ MAP).inverse(), (-3.0, 4.0)).keeps_forward is True
    assert LimitedDrive((STAGE @ STAGE).inverse(), (-3.0, 4.0)).keeps_forward is True


@pytest.mark.parametrize("beyond", [4.0, -4.0, 9.0])
def test_a_memory_that_no_drive_within_the_limits_leaves(beyond: float) -> None:
    """An actuator that was driven farther before the limits came."""
    limits = (-1.0, 1.5)
    inverse = STAGE.inverse()
    before = np.array([beyond, -0.8 * beyond, 0.5])
    y, z = STAGE.run(before)
    memory = inverse.run(y)[1]
    block = LimitedDrive(inverse, limits)
    assert block.bank is not None
    wanted = references(3)
    u, _ = block.run(wanted, np.append(memory, 0.5))
    assert require_nearest(u, plant(STAGE, u, z), wanted, limits) > 100


@pytest.mark.parametrize("model", [STAGE, MAP @ STAGE, STAGE @ MAP, hyst.Affine(-2.0, 1.0) @ STAGE])
@pytest.mark.parametrize("limits", [(-0.4, 0.5), (-2.0, 3.0)])
def test_it_commands_what_compensate_commands_when_it_clips(
    model: hyst.Operator, limits: tuple[float, float]
) -> None:
    wanted = references(5)
    clipped = invert_trajectory(model, wanted, input_range=limits, outside="clip")
    assert clipped.clipped > 20
    block = LimitedDrive(model.inverse(), limits)
    assert np.abs(block(wanted) - clipped.u).max() < 1e-12 * (limits[1] - limits[0]) * 100


@pytest.mark.parametrize("limits", [(-2.0, 3.0), (-0.3, 0.3)])
def test_within_limits_all_bits_are_those_of_the_inverse(limits: tuple[float, float]) -> None:
    inverse = (MAP @ STAGE).inverse()
    wanted = 0.1 * references(2)
    inside = (MAP @ STAGE)(np.clip(inverse(wanted), 0.98 * limits[0], 0.98 * limits[1]))
    step = LimitedDrive(inverse, limits).stepper()
    u = np.array([step(v) for v in inside])
    assert np.array_equal(u, inverse(inside))
    assert step.limited is False


def test_a_held_sample_by_hand() -> None:
    # y = u + 0.5 play(u, 1); its inverse is v - play(v, 1)/3. At 2 the play is at 1: y = 2.5.
    block = LimitedDrive(hyst.PrandtlIshlinskii([0.5], [1.0], p0=1.0).inverse(), (-2.0, 2.0))
    step = block.stepper()
    assert step(1.0) == 1.0
    assert (step.limited, step.fault) == (False, False)
    assert [step(9.0), step(1e30), step(2.4)] == [2.0, 2.0, pytest.approx(1.9, abs=1e-15)]
    assert step.limited is True
    step.clear_fault()
    assert step.limited is False
    assert step.state.tolist() == [pytest.approx(1.5, abs=1e-15), pytest.approx(1.9, abs=1e-15)]


def test_the_lowest_drive_may_lie_above_the_start() -> None:
    # y = u - 0.3 play(u, 1): 1.5 gives 1.35, and a little more belongs to 1.3505, on the way up.
    model = hyst.PrandtlIshlinskii([-0.3], [1.0], p0=1.0)
    for sign in (1.0, -1.0):
        ends = sorted([sign * 1.5, sign * 3.0])
        step = LimitedDrive(model.inverse(), (ends[0], ends[1])).stepper()
        for _ in range(2):
            assert step(sign * 1.3505) == pytest.approx(sign * (1.5 + 0.0005 / 0.7), rel=1e-14)
            assert step(sign * 0.2) == sign * 1.5


def test_a_model_is_driven_within_its_limits_and_its_rate() -> None:
    block = LimitedDrive(STAGE, (-1.0, 2.0), 0.5, dt=1.0)
    u = np.array([5.0, 5.0, 5.0, 5.0, 5.0, -5.0])
    driven = np.array([0.5, 1.0, 1.5, 2.0, 2.0, 1.5])
    step = block.stepper()
    # A sum of five terms, rounded in another order.
    assert np.abs([step(each) for each in u] - plant(STAGE, driven)).max() < 1e-14
    assert step.state[-1] == 1.5
    assert step.limited is True
    assert step(np.nan) == STAGE(driven)[-1]
    assert step.fault is True


def invertible_both_ways() -> list[str]:
    return [n for n, m in EXAMPLES.items() if m.is_invertible() and m.inverse().is_invertible()]


@pytest.mark.parametrize("name", invertible_both_ways())
def test_every_inverse_is_limited_as_its_actuator_is(name: str) -> None:
    """It reaches what the actuator can, at once after hundreds of held samples, and else an end."""
    model, limits = EXAMPLES[name], (-0.7, 1.0)
    ways = np.concatenate([np.linspace(0.0, 1.0, 60), np.linspace(1.0, -0.7, 60)])
    v = model(ways)  # within reach by construction
    span = float(np.ptp(v))
    if not 0.0 < span < 1e6:
        pytest.skip("this example does not move within this drive")
    rises = np.sign(v[59] - v[-1])
    wanted = v.mean() + 0.6 * span * np.random.default_rng(3).standard_normal(300)
    step = LimitedDrive(model.inverse(), limits, drive="output").stepper()
    actuator = model.stepper()
    missed, ends = [], 0
    for each in wanted:
        u = step(each)
        assert limits[0] <= u <= limits[1]
        away = actuator(u) - each
        if not step.limited:
            missed.append(abs(away))
        elif not step.fault:  # no drive belongs to what a friction cannot hold
            assert u in limits
            # Short of it: beyond by no more than rounding, or by what iterated inverses leave.
            assert rises * away * (1.0 if u == limits[1] else -1.0) < 1e-7 * span
            ends += 1
        step.clear_fault()
    assert len(missed) > 20
    assert ends > 20
    # Rounding through inverse and forward operator in hundreds of steps; iterated inverses more.
    assert max(missed) < 1e-7 * span


def test_halves_and_steps_make_the_whole_bit_for_bit() -> None:
    for block in (
        LimitedDrive((MAP @ STAGE).inverse(), (-2.0, 3.0)),
        LimitedDrive((STAGE @ MAP).inverse(), (-2.0, 3.0), 40.0, dt=0.01),
        LimitedDrive(STAGE, (-2.0, 3.0)),
    ):
        wanted = references(8)
        whole, end = block.run(wanted)
        first, middle = block.run(wanted[:177])
        second, same = block.run(wanted[177:], middle)
        assert np.array_equal(np.concatenate([first, second]), whole)
        assert np.array_equal(same, end)
        step = block.stepper()
        assert np.array_equal([step(v) for v in wanted], whole)
        assert np.array_equal(step.state, end)
        assert np.array_equal(block(wanted), whole)


@pytest.mark.parametrize("power", [-40, 3, 70])
@pytest.mark.parametrize("rate", [None, 30.0])
def test_units_that_differ_by_a_power_of_two_give_the_same_bits(
    power: int, rate: float | None
) -> None:
    scale = 2.0**power
    wanted = references(4)
    for limits in [(-2.0, 3.0), (-0.2, 0.3)]:
        one = LimitedDrive(STAGE.inverse(), limits, rate, dt=0.01)
        ends = limits[0] * scale, limits[1] * scale
        inverse = STAGE.in_units(scale, scale).inverse()
        other = LimitedDrive(inverse, ends, None if rate is None else rate * scale, dt=0.01)
        assert np.array_equal(other(wanted * scale), one(wanted) * scale)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_bad_samples_hold_the_last_drive_and_move_nothing(bad: float) -> None:
    for rate in (None, 1e3):
        step = LimitedDrive(STAGE.inverse(), (1.0, 3.0), rate, dt=0.01).stepper()
        assert step(bad) == 1.0
        assert (step.fault, step.limited) == (True, False)
        u, before = step(2.0), step.state.copy()
        assert step(bad) == u
        assert np.array_equal(step.state, before)
        with pytest.raises(InputError, match=r"x is .* at index 1"):
            LimitedDrive(STAGE.inverse(), (1.0, 3.0), rate, dt=0.01).run([1.0, bad])


def test_history_leaves_the_memory_of_the_actuator() -> None:
    drives = np.array([2.5, -1.5, 1.0, 0.2])
    z = np.zeros(STAGE.r.size)
    for each in drives:
        z = np.maximum(each - STAGE.r, np.minimum(each + STAGE.r, z))
    fine = np.interp(np.arange(31) / 10.0, np.arange(4), drives)  # the same turning points
    wanted = references(6)
    for rate in (None, 1e6):
        block = LimitedDrive(STAGE.inverse(), (-2.0, 3.0), rate, dt=0.01)
        for history in (drives, fine):
            state = block.state_after(history)
            assert state[-1] == 0.2
            u, _ = block.run(wanted, state)
            require_nearest(u, plant(STAGE, u, z), wanted, (-2.0, 3.0))
    assert np.array_equal(LimitedDrive(STAGE, (-2.0, 3.0)).state_after(drives)[:-1], z)
    with pytest.raises(InputError, match=r"history\[1\] = -2.5 is outside the limits -2 to 3"):
        block.state_after([1.0, -2.5])
    with pytest.raises(InputError, match="history"):
        block.state_after([np.nan])


def test_files_copies_and_what_loads_them(tmp_path: Path) -> None:
    about = hyst.ModelDescription(input_low=-2.0, input_high=3.0, input_unit="V", dt=0.01)
    inverse = (MAP @ STAGE).with_description(about).inverse()
    scaled = hyst.Affine(0.7) @ STAGE.inverse()
    blocks = [
        LimitedDrive(inverse),
        LimitedDrive(inverse, rate=5.0),
        LimitedDrive(inverse, "none", 5.0),
        LimitedDrive(STAGE, (-1.0, 1.0)),
        LimitedDrive(scaled, (-1.0, 1.0), forward=scaled.inverse()),
        LimitedDrive(scaled, (-1.0, 1.0)),
    ]
    assert len({repr(each) for each in blocks}) == 5  # the last two differ in what was told
    assert (blocks[0].limits, blocks[0].drive, blocks[1].dt) == ((-2.0, 3.0), "output", 0.01)
    assert [each.drive for each in blocks[3:]] == ["input", "output", "output"]
    assert blocks[0].description.output_unit == "V"
    for k, block in enumerate(blocks):
        block.save(tmp_path / f"{k}.json")
        for same in (hyst.load(tmp_path / f"{k}.json"), pickle.loads(pickle.dumps(block))):
            assert same == block
            assert hash(same) == hash(block)
            assert same.description == block.description
            assert np.array_equal(same(references(1)), block(references(1)))
    assert blocks[0] != blocks[1]
    assert blocks[0] != inverse


def test_drives_in_single_precision_stay_within_and_near() -> None:
    """The core itself in single, as a target runs it, against the plant in double."""
    limits = (-2.0, 3.0)
    block = LimitedDrive(STAGE.inverse(), limits)
    told = hyst._engine.Chain(STAGE.inverse().stages()).constants(0)
    numbers = block.bank_limits(*limits, np.float32)
    choices = {name: numbers.pop(name) for name in ("moved_low", "moved_high")}
    stages: list[Any] = [
        ("pi", "", told["numbers"], told["tables"], told["choices"]),
        ("bank_limits", "", numbers, {}, choices),
    ]
    step = _single.Stepper(stages, block.initial_state().tolist())
    wanted = np.concatenate([references(k) for k in range(4)])
    u = np.array([step(v) for v in wanted])
    y = plant(STAGE, u)
    lost = 2e-5  # of a dozen roundings to 24 bits of numbers up to 9
    assert ((u >= -2.0) & (u <= 3.0)).all()
    assert ((np.abs(y - wanted) < lost) | (u == 3.0) | (u == -2.0)).all()
    assert (y[u == 3.0] < wanted[u == 3.0] + lost).all()
    assert (y[u == -2.0] > wanted[u == -2.0] - lost).all()
    assert step.limited is True
    assert step.fault is False


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"operator": 3.0}, "give an operator"),
        ({"limits": (2.0, 1.0)}, "lowest drive first"),
        ({"limits": None}, "does not tell the range of the drive"),
        ({"limits": "auto"}, "limits"),
        ({"limits": "none"}, "nothing is limited"),
        ({"rate": -1.0}, "rate"),
        ({"rate": 1.0}, "whose time is not known"),
        ({"rate": 1.0, "dt": 0.0}, "dt"),
        ({"drive": "u"}, "give 'input' for a model"),
        ({"forward": STAGE, "operator": STAGE, "drive": "input"}, "leave it out for a model"),
        ({"forward": hyst.Affine(2.0)}, "not the exact inverse of forward"),
        ({"operator": STAGE @ STAGE.inverse()}, "not known which signal the drive is"),
    ],
)
def test_refusals(arguments: dict[str, Any], message: str) -> None:
    given = {"operator": STAGE.inverse(), "limits": (-1.0, 1.0)} | arguments
    with pytest.raises(InputError, match=message):
        LimitedDrive(given.pop("operator"), **given)


def test_limits_within_which_a_branch_turns_back_are_refused() -> None:
    # y = z + z^2 with z = u here, which falls below -1/2 and rises above.
    bent = hyst.Butterfly(hyst.Affine(1.0), [[0.0, 1.0, 1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    with pytest.raises(NotInvertibleError, match=r"between the drives -0\.5 and -0\.48"):
        require_monotone(bent, (-3.0, 1.0))
    require_monotone(bent, (-0.5, 1.0))
    require_monotone(bent, (-3.0, -0.5))
    require_monotone(hyst.Affine(-1.0) @ STAGE, (-3.0, 3.0))
