"""Drives that begin and end at rest, within their limits."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.errors import InputError
from hyst.signals import design, from_rest

LIMITS = {"max_rate": 400.0, "max_acceleration": 50_000.0}


def largest(u: np.ndarray, dt: float) -> tuple[float, float]:
    """Give rate and acceleration with the amplifier at rest before and after."""
    whole = np.concatenate([[u[0]] * 3, u, [u[-1]] * 3])
    return np.abs(np.diff(whole)).max() / dt, np.abs(np.diff(whole, 2)).max() / dt**2


@pytest.mark.parametrize("kind", ["triangle", "reversals", "forc", "staircase", "multisine"])
@pytest.mark.parametrize("rest", [0.0, 50.0, -20.0, 130.0])
@pytest.mark.parametrize("bend", [True, False])
def test_limits_hold_from_rest_to_rest(kind: str, rest: float, bend: bool) -> None:
    dt = 1e-3
    limits = LIMITS if bend else {"max_rate": 400.0}
    band = (1.0, 5.0) if kind == "multisine" else None
    drive = design(
        kind, dt=dt, amplitude=50.0, offset=50.0, periods=2, limits=limits, band=band, seed=3
    )
    whole = from_rest(drive, rest, **limits)
    rate, acceleration = largest(whole.u, dt)
    assert (whole.u[0], whole.u[-1]) == (rest, rest) or drive.u[0] == rest
    assert rate <= 400.0
    assert not bend or acceleration <= 50_000.0
    # The drive itself is in it, sample by sample, where the note says.
    first, last = map(int, whole.notes[len(drive.notes)].rsplit("samples ", 1)[1].split(" to "))
    assert np.array_equal(whole.u[first : last + 1], drive.u)


def test_without_ramps_the_limit_is_broken_at_the_start() -> None:
    drive = design("triangle", dt=1e-3, amplitude=50.0, offset=50.0, limits={"max_rate": 400.0})
    assert drive.u[0] == 50.0  # so an amplifier at 0 V would see 50,000 V/s
    assert from_rest(drive, 0.0, max_rate=400.0).u[:2].tolist() == pytest.approx(
        [0.0, 0.4], rel=0.01
    )


def test_a_drive_of_any_size_is_scaled_with_it() -> None:
    drive = design("triangle", dt=1e-3, amplitude=50.0, offset=50.0, limits=LIMITS)
    small = design(
        "triangle", dt=1e-3, amplitude=50.0 / 1024, offset=50.0 / 1024,
        limits={name: value / 1024 for name, value in LIMITS.items()},
    )  # fmt: skip
    scaled = from_rest(small, 8.0 / 1024, max_rate=400.0 / 1024, max_acceleration=50_000.0 / 1024)
    assert np.array_equal(1024 * scaled.u, from_rest(drive, 8.0, **LIMITS).u)


def test_a_ramp_needs_a_rate() -> None:
    drive = design("multisine", dt=1e-3)
    with pytest.raises(InputError, match="max_rate is not given; a ramp from rest needs one"):
        from_rest(drive, 0.0, max_rate=np.inf)
