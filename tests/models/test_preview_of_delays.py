"""Inverses that know some samples ahead: of delays, and of compositions with them."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.models.previewed_delay import PreviewedDelay

DT = 1e-3
PLAYS = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], p0=1.0)
CREEP = hyst.Creep([0.02, 0.03], [0.01, 1.0], DT)
LAG = hyst.Lag(0.42e-3, DT)


def wanted(samples: int = 400, seed: int = 0) -> np.ndarray:
    """A smooth reference that rests at 0, where creep is, for longer than commands come early."""
    steps = np.random.default_rng(seed).normal(size=samples)
    steps[:100] = 0.0
    return np.convolve(steps.cumsum(), np.hanning(21) / 10.0)[:samples]


def reached(model: hyst.Operator, y: np.ndarray, preview: int) -> np.ndarray:
    """What the model answers to commands that come late and are given in time."""
    command = model.inverse(preview=preview)(np.append(y, np.full(preview, y[-1])))
    return model(command[preview:])


@pytest.mark.parametrize("preview", [3, 4, 20])
@pytest.mark.parametrize("samples", [3.0, 3.25, 2.0, 0.4])
def test_a_delay_whose_line_is_short_is_exact(samples: float, preview: int) -> None:
    y = wanted()
    found = reached(hyst.Delay(samples, DT), y, preview)
    np.testing.assert_allclose(found, y, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("samples", [0.75, 1.6, 4.9])
@pytest.mark.parametrize("seed", range(3))
def test_more_preview_makes_it_better_by_the_stated_bound(samples: float, seed: int) -> None:
    y, whole, f = wanted(seed=seed), int(samples), samples - int(samples)
    for preview in range(whole + 1, whole + 12):
        error = np.abs(reached(hyst.Delay(samples, DT), y, preview) - y).max()
        bound = f * ((1.0 - f) / f) ** (preview - whole) * np.abs(np.diff(y)).max()
        assert error <= bound * (1.0 + 1e-9) + 1e-14
        assert error >= 1e-3 * bound  # it is no bound of something else
    # As many as its docstring says are of use: then rounding alone is left.
    least, most = hyst.Delay(samples, DT).preview_range()
    assert least == whole + 1
    assert np.abs(reached(hyst.Delay(samples, DT), y, most) - y).max() <= 1e-13


ORDERS = {
    "delay of the drive": CREEP @ PLAYS @ LAG @ hyst.Delay(2.25, DT),
    "delay of the sensor": hyst.Delay(3.0, DT) @ CREEP @ PLAYS @ LAG,
    "delays on both sides": hyst.Delay(1.2, DT) @ CREEP @ PLAYS @ hyst.Delay(2.8, DT),
    "an actuator": hyst.Affine(-3.0, 0.0) @ CREEP @ PLAYS @ LAG @ hyst.Delay(4.3, DT),
}


@pytest.mark.parametrize("name", ORDERS)
@pytest.mark.parametrize("more", [0, 7, 60])
@pytest.mark.parametrize("scale", [1.0, 1e-8, -2e5])
def test_compositions_are_followed(name: str, more: int, scale: float) -> None:
    model, y = ORDERS[name].in_units(1.0, abs(scale)), scale * wanted(seed=1)
    least, most = model.preview_range()
    found = reached(model, y, least + more)
    exact = least == most or more == 60
    # Exact to rounding, or wrong by less than a step at the newest sample (gain below 2 behind it).
    bound = 1e-13 * np.ptp(y) if exact else 2.0 * np.abs(np.diff(y)).max()
    assert np.abs(found - y).max() <= bound


def test_exact_inverses_only_wait() -> None:
    y = wanted()
    at_once = (CREEP @ PLAYS @ LAG).inverse()
    late = (CREEP @ PLAYS @ LAG).inverse(preview=5)
    assert late(y)[5:].tolist() == at_once(y)[:-5].tolist()
    assert PLAYS.inverse(preview=5)(y)[5:].tolist() == PLAYS.inverse()(y)[:-5].tolist()


def test_too_short_previews_say_what_is_needed() -> None:
    with pytest.raises(hyst.NotInvertibleError, match=r"must know 3 samples .* of 2 is too short"):
        hyst.Delay(2.75, DT).inverse(preview=2)
    both = hyst.Delay(1.2, DT) @ PLAYS @ hyst.Delay(2.8, DT)
    with pytest.raises(hyst.NotInvertibleError, match=r"a preview of 3 is too short: .* need 4"):
        both.inverse(preview=3)
    assert isinstance(both.inverse(preview=4), hyst.Operator)


@pytest.mark.parametrize("samples", [0.5, 7.5])
def test_half_a_sample_is_refused_whatever_the_preview(samples: float) -> None:
    for preview in (None, 8, 900):
        with pytest.raises(hyst.NotInvertibleError, match="half way between two samples loses"):
            (PLAYS @ hyst.Delay(samples, DT)).inverse(preview=preview)
    alternating = np.resize([1.0, -1.0], 20)
    assert hyst.Delay(0.5, DT)(alternating)[1:].tolist() == [0.0] * 19


def test_what_has_no_inverse_has_none_with_preview() -> None:
    with pytest.raises(hyst.NotInvertibleError, match="play"):
        (hyst.Delay(1.0, DT) @ hyst.Play(1.0)).inverse(preview=50)


def test_they_are_saved_and_stepped(tmp_path) -> None:
    inverse = ORDERS["delays on both sides"].inverse(preview=12)
    inverse.save(tmp_path / "inverse.json")
    again, y = hyst.load(tmp_path / "inverse.json"), wanted(80)
    step = again.stepper()
    assert [step(value) for value in y.tolist()] == inverse(y).tolist()


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((0.5, 3), "above half a sample"),
        ((1.1, 3), "above half a sample"),
        ((0.7, -1), "ahead is -1; give a whole number"),
        ((0.7, 1001), "ahead is 1001"),
    ],
)
def test_bad_constants_are_named(arguments: tuple, why: str) -> None:
    with pytest.raises(hyst.InputError, match=why):
        PreviewedDelay(*arguments)
