"""Commands for rate-dependent plays planned ahead, judged by the paper's equations."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import InputError, NotInvertibleError, RateDependentPrandtlIshlinskii
from hyst.compensation import invert_trajectory
from hyst.models import Delay, RateCurve, RateDependentPreview
from reference.rate_dependent_plays import ACTUATOR, DT, EXAMPLE, output, rate, reference_signal

Array = np.ndarray
MODEL = RateDependentPrandtlIshlinskii(**EXAMPLE, dt=DT)
N = 20


def late_error(command: Array, y_ref: Array, constants: dict, late: int) -> Array:
    """S4 eqs. 37-38 driven by all commands, over the middle period of the reference."""
    widening = constants["beta"] * rate(command, DT)
    y = output(constants["p"], constants["r"], constants["p0"], command, widening)
    third = y_ref.size // 3
    return (y[late:] - y_ref[: y.size - late])[third : 2 * third]


# Measured: 0.068, 0.29, 1.5 and 2.2 with rms 0.007, 0.042, 0.24 and 0.43; the planner in Python
# that this replaced left 0.089, 0.26, 0.68 and 2.2 with rms 0.064, 0.17, 0.35 and 0.70. Which local
# minimum is met changes with rounding, so the largest error has room, the rms hardly any.
@pytest.mark.parametrize(
    ("f", "largest", "rms"),
    [(10.0, 0.2, 0.064), (30.0, 1.0, 0.17), (60.0, 3.0, 0.4), (100.0, 5.0, 0.9)],
)
def test_what_is_left_of_the_example(f: float, largest: float, rms: float) -> None:
    y_ref = reference_signal(f)
    command = MODEL.inverse(preview=N)(y_ref)
    error = late_error(command, y_ref, EXAMPLE, N)
    assert np.abs(error).max() < largest
    assert np.sqrt(np.mean(error**2)) < rms


@pytest.mark.parametrize("f", [20.0, 50.0, 100.0])
@pytest.mark.parametrize("phase", [0.0, 1.1, 2.5])
def test_relatives_are_followed_better_than_explicitly(f: float, phase: float) -> None:
    y_ref = 40.0 * np.sin(2.0 * np.pi * f * np.arange(round(3.0 / f / DT)) * DT + phase)
    model = RateDependentPrandtlIshlinskii(**ACTUATOR, dt=DT)
    late = late_error(model.inverse(preview=N)(y_ref), y_ref, ACTUATOR, N)
    at_once = late_error(model.explicit_inverse()(y_ref), y_ref, ACTUATOR, 0)
    # Measured: 8 to 60 times less.
    assert np.sqrt(np.mean(late**2)) < np.sqrt(np.mean(at_once**2)) / 4.0


def test_it_is_never_exact_by_accident() -> None:
    y_ref = reference_signal(100.0)
    error = late_error(MODEL.inverse(preview=N)(y_ref), y_ref, EXAMPLE, N)
    assert np.abs(error).max() > 0.1


def test_more_preview_leaves_less() -> None:
    y_ref = reference_signal(60.0)
    rms = []
    for late in (2, 8, 20):
        command = MODEL.inverse(preview=late)(y_ref)
        rms.append(np.sqrt(np.mean(late_error(command, y_ref, EXAMPLE, late) ** 2)))
    # Measured at 5, 10 and 20: 1.2, 0.30 and 0.24; the explicit inverse leaves 6.8.
    assert rms[0] > 2.0 * rms[1] > 2.0 * rms[2]


@pytest.mark.parametrize("samples", [1, 7])
def test_the_first_command_is_held_until_all_is_known(samples: int) -> None:
    command = MODEL.inverse(preview=samples)(np.full(30, 4.0))
    # Virgin plays reach 4 = 0.5 u + 0.3667 (u - 3) + 0.269 max(u - 6, 0) + ..
    held = 4.0 + 0.3667 * 3.0
    assert np.abs(command - (held / 0.8667)).max() < 1e-12
    moved = MODEL.inverse(preview=samples)(np.linspace(4.0, 9.0, 30))
    assert np.array_equal(moved[:samples], command[:samples])
    assert moved[samples + 1] > moved[samples]


def test_record_stepper_and_two_halves_have_the_same_bits() -> None:
    inverse, y_ref = MODEL.inverse(preview=9), reference_signal(60.0)[:300]
    whole, end = inverse.run(y_ref)
    for at in (1, 5, 9, 10, 11, 123):
        first, state = inverse.run(y_ref[:at])
        second, last = inverse.run(y_ref[at:], state)
        assert np.array_equal(np.concatenate([first, second]), whole)
        assert np.array_equal(last, end)
    step = inverse.stepper()
    assert np.array_equal([step(each) for each in y_ref], whole)


def test_it_knows_nothing_beyond_its_preview() -> None:
    y_ref = reference_signal(60.0)
    louder = np.concatenate([y_ref[:250], 3.0 * y_ref[250:]])
    a, b = (MODEL.inverse(preview=N)(each) for each in (y_ref, louder))
    assert np.array_equal(a[:250], b[:250])
    assert np.abs(a - b)[250 : 250 + N].max() > 0.1  # and uses all of it at once


@pytest.mark.parametrize("scales", [(2.0**-12, 1.0), (1.0, 2.0**9), (2.0**5, 2.0**-7)])
@pytest.mark.parametrize("curve", [7e-4, RateCurve(2e-4, [1e-8], [2e-4], [5000.0])])
def test_units_change_no_bit(scales: tuple[float, float], curve: float | RateCurve) -> None:
    model = RateDependentPrandtlIshlinskii(EXAMPLE["p"], EXAMPLE["r"], curve, DT, 0.5)
    y_ref = reference_signal(60.0)
    command = model.inverse(preview=N)(y_ref)
    other = model.in_units(*scales).inverse(preview=N)(scales[1] * y_ref)
    assert np.array_equal(other, scales[0] * command)


def test_limits_hold_to_the_bit_and_are_no_more_than_that() -> None:
    y_ref = reference_signal(60.0)
    inverse = RateDependentPreview(MODEL, N, command_range=(-25.0, 27.0), largest_change=3.0)
    command = inverse(y_ref)
    assert command.min() >= -25.0
    assert command.max() <= 27.0
    assert np.abs(np.diff(command)).max() <= 3.0 * (1.0 + 1e-15)  # one rounding of the difference
    free = MODEL.inverse(preview=N)(y_ref)
    assert np.abs(free).max() > 28.0
    wide = RateDependentPreview(MODEL, N, command_range=(-1e3, 1e3), largest_change=1e3)
    assert np.array_equal(wide(y_ref), free)


def test_maps_before_and_after_are_inverted_exactly() -> None:
    before, after = hyst.Affine(0.5, 1.0), hyst.DeadZone([1.0, 0.3], [0.0, 5.0])
    y_ref = reference_signal(30.0)
    whole = after @ MODEL @ before
    command = whole.inverse(preview=N)(y_ref)
    alone = MODEL.inverse(preview=N)(after.inverse()(y_ref))
    assert np.array_equal(command, before.inverse()(alone))


def test_a_delay_takes_its_part_of_the_preview() -> None:
    y_ref = reference_signal(30.0)
    whole = Delay(3, DT) @ MODEL
    assert np.array_equal(whole.inverse(preview=N)(y_ref), MODEL.inverse(preview=N - 3)(y_ref))


@pytest.mark.parametrize("samples", [0.7, 1.6])
def test_a_delay_that_gets_better_by_preview_leaves_some_to_the_plays(samples: float) -> None:
    y_ref = reference_signal(30.0)
    whole = Delay(samples, DT) @ MODEL
    error = whole(whole.inverse(preview=40)(y_ref))[40:] - y_ref[:-40]
    middle = error[y_ref.size // 3 : 2 * (y_ref.size // 3)]
    # Measured 0.041, as the plays alone with 20; 0.31 and 0.41 if the delay takes all it can use.
    assert np.sqrt(np.mean(middle**2)) < 0.1


def test_more_preview_than_is_planned_only_delays() -> None:
    y_ref = reference_signal(60.0)[:200]
    late, later = MODEL.inverse(preview=60)(y_ref), MODEL.inverse(preview=75)(y_ref)
    assert np.array_equal(later[15:], late[:-15])
    assert np.array_equal(later[:15], np.full(15, late[0]))


def test_a_model_with_an_exact_inverse_gives_it_late() -> None:
    still = RateDependentPrandtlIshlinskii(EXAMPLE["p"], EXAMPLE["r"], 0.0, DT, 0.5)
    y_ref = reference_signal(60.0)
    exact = still.inverse()(y_ref)
    assert np.array_equal(still.inverse(preview=4)(y_ref)[4:], exact[:-4])


def test_a_record_is_the_operator_without_what_it_holds_first() -> None:
    y_ref = reference_signal(10.0)
    record = invert_trajectory(MODEL, y_ref, "preview", preview=N).u
    late = MODEL.inverse(preview=N)(y_ref)[N:]
    # They differ in that the operator moves to its first command, which the record begins with.
    assert np.abs(record[:-N] - late)[500:].max() < 1.0
    history = np.array([0.0, 20.0, -5.0])
    memory = MODEL.run(history)[1]
    planner = RateDependentPreview(MODEL, N)
    told = invert_trajectory(MODEL, y_ref, "preview", preview=N, history=history).u
    longer = np.concatenate([y_ref, y_ref[-1] + (y_ref[-1] - y_ref[-2]) * np.arange(1.0, N + 1)])
    direct, _ = planner.run(longer, planner.state_within_a_record(memory))
    assert np.array_equal(told, direct[N:])


def test_files_and_description(tmp_path) -> None:
    inverse = RateDependentPreview(MODEL, 7, (-5.0, 5.0), 0.5)
    inverse.save(tmp_path / "inverse.json")
    loaded = hyst.load(tmp_path / "inverse.json")
    assert loaded == inverse
    y_ref = 0.2 * reference_signal(60.0)
    assert np.array_equal(loaded(y_ref), inverse(y_ref))


def test_refusals() -> None:
    with pytest.raises(NotInvertibleError, match="at least 1 of the next"):
        MODEL.inverse(preview=0)
    with pytest.raises(InputError, match=r"preview is 2\.5"):
        MODEL.inverse(preview=2.5)
    with pytest.raises(InputError, match="preview is 1001"):
        MODEL.inverse(preview=1001)
    with pytest.raises(InputError, match="from 1 to 60"):
        RateDependentPreview(MODEL, 61)
    with pytest.raises(InputError, match="plays is a PrandtlIshlinskii"):
        RateDependentPreview(MODEL.at_rest(), 5)
    with pytest.raises(InputError, match="ascending"):
        RateDependentPreview(MODEL, 5, (1.0, 1.0))
    with pytest.raises(InputError, match="largest_change is 0"):
        RateDependentPreview(MODEL, 5, None, 0.0)
    with pytest.raises(NotInvertibleError, match="p0 is 0"):
        RateDependentPrandtlIshlinskii([1.0], [1.0], 1e-4, DT).inverse(preview=5)
    with pytest.raises(NotInvertibleError, match="has none"):
        MODEL.inverse(preview=5).inverse()
    with pytest.raises(NotInvertibleError, match="inverse\\(preview=20\\)"):
        MODEL.inverse()
