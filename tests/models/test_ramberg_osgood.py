"""Ramberg-Osgood: its equations, both memories, exact inverses, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import InputError, NotInvertibleError, RambergOsgood, load
from hyst.models import MasingOperator, PiecewiseLinear, PowerLaw
from reference.loading_curves import last_reversal, masing, power_law

MODES = ("masing", "last-reversal")
# A piezo as in S3: 250 V, about 1.6 um.
PIEZO = (4.0e-3, 1.4e-5, 0.9)


def minor_loops(seed: int, samples: int = 2000, size: float = 100.0) -> np.ndarray:
    """A band-limited walk: smooth, with loops inside loops."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.0, samples)
    u = sum(rng.normal() / k * np.sin(2.0 * np.pi * (k * t + rng.random())) for k in range(1, 30))
    return np.asarray(size * u / np.abs(u).max())


def eq_1(samples_per_second: int = 400) -> np.ndarray:
    """The input of S3 example 1, eq. 1."""
    t = np.arange(0.0, 3.0, 1.0 / samples_per_second)
    large, small = 250.0 * np.sin(2.0 * np.pi * t), 125.0 * np.sin(2.0 * np.pi * t) - 125.0
    return np.where(t <= 1.75, large, small)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("memory", MODES)
def test_it_follows_the_equations(memory: str, seed: int) -> None:
    u = minor_loops(seed, samples=250)
    f = power_law(*PIEZO)
    expected = masing(f, u) if memory == "masing" else last_reversal(f, u)
    y = RambergOsgood(*PIEZO, memory=memory)(u)
    # Some 30 branches added up, each off by a few roundings of the range.
    assert np.abs(y - expected).max() <= 1e-13 * np.ptp(expected)


def test_eqs_2_and_3_as_printed() -> None:
    y_star, u_star, alpha, gamma = 0.8, 190.0, 0.6, 1.9
    model = RambergOsgood.from_skeleton(y_star, u_star, alpha, gamma)
    u = np.linspace(0.0, 250.0, 50)
    skeleton = y_star * u / u_star * (1.0 + alpha * np.abs(u / u_star) ** (gamma - 1.0))
    np.testing.assert_allclose(model(u), skeleton, rtol=1e-14, atol=1e-14)
    down = np.linspace(250.0, -250.0, 50)
    way = (down - 250.0) / (2.0 * u_star)
    branch = skeleton[-1] + 2.0 * y_star * way * (1.0 + alpha * np.abs(way) ** (gamma - 1.0))
    np.testing.assert_allclose(
        model(np.concatenate([u, down]))[50:], branch, rtol=1e-13, atol=1e-13
    )


def test_theorem_4() -> None:
    """Slope against way since the reversal: one curve, c1 + c2 p^c3, on every branch (Fig. 4)."""
    y_star, u_star, alpha, gamma = 0.8, 190.0, 0.6, 1.9
    model = RambergOsgood.from_skeleton(y_star, u_star, alpha, gamma, memory="last-reversal")
    assert model.c1 == y_star / u_star
    assert model.c3 == gamma - 1.0
    u = eq_1(4000)
    middle = (u[1:] + u[:-1]) / 2.0
    turns = 1 + np.flatnonzero(np.diff(np.sign(np.diff(u))))
    y = model(u)
    for start, end in zip(turns, [*turns[1:], u.size - 1], strict=True):
        inside = slice(start + 5, end - 5)
        slope = (np.diff(y) / np.diff(u))[inside]
        p = np.abs(middle[inside] - u[start])
        expected = (y_star / u_star) * (1.0 + alpha * gamma * (p / (2.0 * u_star)) ** (gamma - 1))
        # Secants over steps below 0.4 of 500 V: their curvature error is 1e-5 of the slope.
        np.testing.assert_allclose(slope, expected, rtol=1e-4)
        np.testing.assert_allclose(model.slope(p), expected, rtol=1e-14)


@pytest.mark.parametrize("memory", MODES)
@pytest.mark.parametrize("seed", range(5))
def test_inverse_gives_the_input_back(memory: str, seed: int) -> None:
    u = minor_loops(seed)
    for constants in (PIEZO, (1.0, 0.0, 1.0), (1.0, 30.0, 0.05), (1e-2, 1e-9, 5.0)):
        model = RambergOsgood(*constants, memory=memory)
        inverse = model.inverse()
        # 1e-12 of the range is what the model promises.
        assert np.abs(inverse(model(u)) - u).max() <= 1e-12 * np.ptp(u)
        y = minor_loops(seed + 50, size=float(np.abs(model(u)).max()))
        assert np.abs(model(inverse(y)) - y).max() <= 1e-12 * np.ptp(y)
        assert inverse.inverse()(u).tobytes() == model(u).tobytes()


@pytest.mark.parametrize("memory", MODES)
def test_small_steps_and_rests_do_not_confuse_the_inverse(memory: str) -> None:
    # Steps of a few roundings, rests, tiny reversals: what a computed reference has at its tops.
    rng = np.random.default_rng(3)
    u = np.sin(np.linspace(0.0, 30.0, 4000))
    u[::7] = u[1::7][: u[::7].size]
    u += rng.integers(-2, 3, u.size) * 2.3e-16
    model = RambergOsgood(1.0, 0.7, 1.2, memory=memory)
    assert np.abs(model.inverse()(model(u)) - u).max() <= 1e-12 * np.ptp(u)


def test_masing_loops_close_and_published_ones_drift() -> None:
    # Down to 0 and up to 1 again, with a small loop on the way: back where the outer loop began.
    u = np.array([0.0, 1.0, 0.0, 0.6, 0.3, 1.0])
    closed, forgetful = (RambergOsgood(1.0, 1.0, 1.0, memory=memory)(u) for memory in MODES)
    assert closed[-1] == pytest.approx(closed[1], abs=1e-15)
    # By hand, in y = d + d^2/2 from each reversal: 2 - 1.5 + .78 - .345 + .945 = 1.88 against 2.
    assert forgetful[1] == pytest.approx(2.0, abs=1e-15)
    assert forgetful[-1] == pytest.approx(1.88, abs=1e-14)


@given(
    loop=st.lists(st.floats(-0.9, 0.9), min_size=1, max_size=40),
    depth=st.integers(1, 6),
    memory_before=st.lists(st.floats(-3.0, 3.0), max_size=6),
)
def test_every_loop_closes_whatever_room_there_is(
    loop: list[float], depth: int, memory_before: list[float]
) -> None:
    """A path that returns to its last reversal finds the output it left, at any depth.

    That is all a closed loop needs of the memory, and what the policy for a full stack keeps.
    """
    model = RambergOsgood(1.0, 0.7, 1.3, depth=depth)
    before = np.array([*memory_before, 0.95, -0.95])
    y, state = model.run(before)
    y_loop, state_loop = model.run([*loop, -0.95], state)
    assert y_loop[-1] == pytest.approx(y[-1], abs=1e-13)
    after = [-1.5, 0.3, 2.0]
    np.testing.assert_allclose(
        model.run(after, state_loop)[0], model.run(after, state)[0], atol=1e-12
    )


def test_a_full_stack_loses_only_the_area_of_the_deepest_loops() -> None:
    nested = [0.0]
    for k in range(12):
        nested.append((-1.0) ** k * (1.0 - 0.05 * k))
    u = np.interp(np.linspace(0.0, 12.0, 600), np.arange(13.0), nested)
    full, short = RambergOsgood(1.0, 0.7, 1.3), RambergOsgood(1.0, 0.7, 1.3, depth=8)
    (y, state), (y_short, state_short) = full.run(u), short.run(u)
    assert not full.overflowed(state)
    assert short.overflowed(state_short)
    until = int(np.argmax(y != y_short))
    # The ninth reversal ends segment 9 of 12.
    assert until / 600.0 == pytest.approx(9.0 / 12.0, abs=0.01)
    # What is lost is at most the width of the loops beyond: 4 f(a/4) - 2 f(a/2) short of a line.
    width = 0.7 * 0.95**2.3
    assert 0.0 < np.abs(y - y_short).max() < width
    assert np.abs(short.inverse()(y_short) - u).max() <= 1e-12 * np.ptp(u)
    # Back outside the loops that were lost, both are one again.
    after = np.array([0.9, -1.2, 1.3])
    np.testing.assert_allclose(
        short.run(after, state_short)[0], full.run(after, state)[0], atol=1e-13
    )


@pytest.mark.parametrize("band", [0.05, 0.4])
def test_a_dead_band_keeps_noise_from_resetting_the_memory(band: float) -> None:
    rng = np.random.default_rng(0)
    clean = np.sin(np.linspace(0.0, 12.0, 3000))
    noisy = clean + 0.004 * rng.normal(size=clean.size)
    plain = RambergOsgood(1.0, 1.0, 1.0, memory="last-reversal")
    calm = RambergOsgood(1.0, 1.0, 1.0, memory="last-reversal", dead_band=band)
    expected = plain(clean)
    assert np.abs(plain(noisy) - expected).max() > 0.3  # the noise resets p at every sample
    # The new branch starts at most a dead band late, with the slope of the end of the old one
    # instead of its own: 2 M(2) band = 6 band or less, and noise times the steepest slope, 3.
    assert np.abs(calm(noisy) - expected).max() < 6.0 * band + 3.0 * 0.02
    for model in (calm, plain):
        assert np.abs(model.inverse()(model(noisy)) - noisy).max() <= 1e-12 * np.ptp(noisy)


def test_noise_on_a_reference_does_no_harm_in_nested_memory() -> None:
    rng = np.random.default_rng(1)
    y_ref = np.sin(np.linspace(0.0, 12.0, 3000))
    noise = 1e-3 * rng.normal(size=y_ref.size)
    inverse = RambergOsgood(1.0, 1.0, 1.0).inverse()
    # The inverse has slopes from 1 down, and its Lipschitz constant is f^-1'(0) + variation = 2.
    moved = np.abs(inverse(y_ref + noise) - inverse(y_ref)).max()
    assert moved <= 2.0 * np.abs(noise).max()


def test_the_state_can_be_cut_anywhere() -> None:
    u = minor_loops(4)
    for memory in MODES:
        for model in (
            RambergOsgood(*PIEZO, memory=memory),
            RambergOsgood(*PIEZO, memory).inverse(),
        ):
            signal = u if isinstance(model, RambergOsgood) else u / 100.0
            y, end = model.run(signal)
            first, state = model.run(signal[:777])
            second, last = model.run(signal[777:], state)
            assert np.concatenate([first, second]).tobytes() == y.tobytes()
            assert last.tobytes() == end.tobytes()
            step = model.stepper()
            assert np.array([step(value) for value in signal.tolist()]).tobytes() == y.tobytes()


def test_jacobian_against_differences() -> None:
    u = minor_loops(5, samples=300, size=2.0)
    theta = np.array([0.5, 0.3, 1.3])
    for memory, band in (("masing", 0.0), ("last-reversal", 0.0), ("last-reversal", 0.1)):
        model = RambergOsgood(*theta, memory=memory, dead_band=band)
        for operator in (model, model.inverse()):
            jacobian = operator.jacobian(u)
            for j in range(3):
                step = np.zeros(3)
                step[j] = 1e-6
                after, before = (operator.with_parameters(theta + s)(u) for s in (step, -step))
                # Second derivatives below 1e3, so the central difference is off by 1e-9 and by
                # rounding over the step, 1e-9.
                np.testing.assert_allclose(
                    jacobian[:, j], (after - before) / 2e-6, rtol=1e-6, atol=1e-6
                )


@pytest.mark.parametrize(
    ("constants", "part"),
    [
        ((0.0, 0.0, 1.0), "c1 is 0"),
        ((-1.0, 1.0, 1.0), "c1 is -1"),
        ((1.0, -0.5, 1.0), "turn negative at p = 2"),
        ((1.0, -1e-3, 0.005), "c2 is -0.001"),
        ((1.0, -1e-3, 1e-320), "c2 is -0.001"),
        ((1.0, 1.0, 0.0), "c3 is 0"),
        ((1.0, 1.0, -0.5), "MasingOperator"),
        ((float("nan"), 1.0, 1.0), "c1 is nan"),
        ((1.0, float("inf"), 1.0), "c2 is inf"),
    ],
)
def test_refused_constants(constants: tuple[float, float, float], part: str) -> None:
    with pytest.raises(InputError) as caught:
        RambergOsgood(*constants)
    assert part in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        ({"memory": "none"}, "'masing' or 'last-reversal'"),
        ({"depth": 0}, "1 to 100000"),
        ({"depth": 2.5}, "whole number"),
        ({"dead_band": 0.1}, "small loops close"),
        ({"dead_band": -0.1, "memory": "last-reversal"}, "give 0 or more"),
    ],
)
def test_refused_memories(arguments: dict, part: str) -> None:
    with pytest.raises(InputError, match=part):
        RambergOsgood(1.0, 1.0, 1.0, **arguments)


def test_refused_skeletons() -> None:
    for bad in ((0.0, 1.0, 1.0, 2.0), (1.0, -1.0, 1.0, 2.0), (1.0, 1.0, -1.0, 2.0), (1, 1, 1, 1.0)):
        with pytest.raises(InputError):
            RambergOsgood.from_skeleton(*bad)


def test_nan_is_held_in_real_time_and_refused_in_a_record() -> None:
    model = RambergOsgood(1.0, 1.0, 1.0)
    with pytest.raises(InputError, match=r"u\[1\] is nan"):
        model([0.0, float("nan")])
    step = model.stepper()
    y = step(2.0)
    assert step(float("nan")) == y
    assert step.fault
    assert step(float("inf")) == y
    step.clear_fault()
    # An input whose output no double can hold is answered alike, and leaves no trace.
    before = step.state.copy()
    assert step(1e200) == y
    assert step.fault
    assert step.state.tobytes() == before.tobytes()


def test_files_keep_the_memory(tmp_path) -> None:
    for model in (
        RambergOsgood(*PIEZO, depth=7),
        RambergOsgood(*PIEZO, memory="last-reversal", dead_band=0.5),
        RambergOsgood(*PIEZO).inverse(),
    ):
        model.save(tmp_path / "model.json")
        again = load(tmp_path / "model.json")
        assert again == model
        assert again(minor_loops(0)).tobytes() == model(minor_loops(0)).tobytes()


@pytest.mark.parametrize("law", [(1.0, 1.0, -0.5), (0.0, 2.0, 0.7), (0.0, 2.0, -0.4)])
@pytest.mark.parametrize("memory", MODES)
def test_softening_curves_are_valid_for_the_general_operator(law, memory: str) -> None:
    model = MasingOperator(PowerLaw(*law), memory=memory)
    u = minor_loops(6, samples=300, size=2.0)
    f = power_law(*law)
    expected = masing(f, u) if memory == "masing" else last_reversal(f, u)
    # x^(c3 + 1) with c3 + 1 = 0.5 turns a rounding of 1e-16 in x near a reversal into 1e-8.
    np.testing.assert_allclose(model(u), expected, atol=1e-7 if law[2] < 0.0 else 1e-12)
    assert np.abs(model.inverse()(model(u)) - u).max() <= 1e-12 * np.ptp(u)


def test_a_flat_curve_has_no_inverse() -> None:
    with pytest.raises(NotInvertibleError, match="flat from 0 on"):
        MasingOperator(PiecewiseLinear([1.0], [1.0])).inverse()
