"""Choose a kind of drive by name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from hyst.errors import InputError
from hyst.signals.drive import Drive
from hyst.signals.held_levels import levels
from hyst.signals.multisines import multisine
from hyst.signals.noise_drive import lowpassed_noise
from hyst.signals.sequences import forc, prbs, staircase, triangle
from hyst.signals.swept_sines import swept_sine

_MULTISINES: dict[str, dict[str, Any]] = {
    "multisine": {},
    "odd-multisine": {"lines": "odd"},
    "schroeder": {"phases": "schroeder"},
}
_PATHS = ("triangle", "reversals", "forc", "staircase")
KINDS = (*_MULTISINES, "noise", "levels", "prbs", "swept-sine", *_PATHS)


def design(
    kind: str,
    *,
    dt: float,
    amplitude: float = 1.0,
    rms: float | None = None,
    offset: float = 0.0,
    samples: int = 1000,
    periods: int = 1,
    band: tuple[float, float] | None = None,
    limits: Mapping[str, float] | None = None,
    decay: float = 0.85,
    clock: int = 1,
    register: int = 10,
    seed: int = 0,
    spectrum: str = "flat",
    corner: float | None = None,
    uniform: bool = False,
    keep: str = "amplitude",
    spacing: str = "linear",
    hold: int = 5,
) -> Drive:
    """Design a drive of a kind.

    Parameters
    ----------
    kind
        One of ``KINDS``.
    dt
        Sample time, s.
    amplitude, rms, offset
        Input units; ``rms`` takes the place of the amplitude of multisines and noise.
    samples
        Of one period; of the rest on each step of a staircase.
    periods
        Periods, cycles, reversal curves or steps.
    band
        Frequencies of multisines and sweeps, Hz.
    limits
        ``max_rate`` and ``max_acceleration``; triangles, reversal curves and stairs need the rate.
    decay, clock, register, seed
        As of the single kinds.
    spectrum, corner, uniform, keep, spacing, hold
        As of the single kinds; noise needs the corner of its low pass.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If the kind is not known, or as the single kinds.

    Examples
    --------
    >>> design("prbs", dt=0.1, register=5).period
    31
    """
    given = dict(limits or {})
    repeated: dict[str, Any] = {"periods": periods, "offset": offset, **given}
    sized: dict[str, Any] = {"amplitude": amplitude if rms is None else None, "rms": rms}
    made: dict[str, Any] = {**sized, "uniform": uniform, "keep": keep, "seed": seed, **repeated}
    if kind in _MULTISINES:
        shape = {"spectrum": spectrum, "corner": corner, **_MULTISINES[kind]}
        return multisine(dt, samples, band=band, **shape, **made)
    if kind == "noise":
        if corner is None:
            raise InputError("noise needs a low pass; give its corner, in Hz")
        return lowpassed_noise(dt, samples, corner, **made)
    if kind == "levels":
        return levels(dt, samples, amplitude, hold=hold, seed=seed, **repeated)
    if kind == "prbs":
        start = seed % (2**register - 1) + 1 if 2 <= register <= 20 else 1
        return prbs(dt, amplitude, register=register, clock=clock, seed=start, **repeated)
    if kind == "swept-sine":
        ends = band if band is not None else (1.0 / (samples * dt), 0.4 / dt)
        return swept_sine(dt, samples, ends, amplitude, spacing=spacing, keep=keep, **repeated)
    if kind in _PATHS:
        return _path(kind, dt, amplitude, offset, samples, periods, decay, given)
    raise InputError(f"unknown kind {kind!r}; choose one of {', '.join(KINDS)}")


def _path(
    kind: str,
    dt: float,
    amplitude: float,
    offset: float,
    samples: int,
    periods: int,
    decay: float,
    given: Mapping[str, float],
) -> Drive:
    rate = given.get("max_rate", math.inf)
    bend = given.get("max_acceleration", math.inf)
    if math.isinf(rate):
        raise InputError(f"a {kind} is driven at its largest rate; give max_rate")
    low, high = offset - amplitude, offset + amplitude
    if kind == "forc":
        return forc(dt, low, high, rate, curves=periods, max_acceleration=bend)
    if kind == "staircase":
        hold = samples * dt
        return staircase(dt, low, high, rate, steps=periods, hold=hold, max_acceleration=bend)
    factor = decay if kind == "reversals" else 1.0
    return triangle(
        dt,
        amplitude,
        rate,
        cycles=periods,
        decay=factor,
        offset=offset,
        max_acceleration=bend,
    )
