"""Choose a kind of drive by name."""

from __future__ import annotations

import math
from collections.abc import Mapping

from hyst.errors import InputError
from hyst.signals.drive import Drive
from hyst.signals.multisines import multisine
from hyst.signals.sequences import forc, prbs, staircase, triangle
from hyst.signals.swept_sines import swept_sine

_MULTISINES: dict[str, dict[str, str]] = {
    "multisine": {},
    "odd-multisine": {"lines": "odd"},
    "schroeder": {"phases": "schroeder"},
}
_PATHS = ("triangle", "reversals", "forc", "staircase")
KINDS = (*_MULTISINES, "prbs", "swept-sine", *_PATHS)


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
) -> Drive:
    """Design a drive of a kind.

    Parameters
    ----------
    kind
        One of ``KINDS``.
    dt
        Sample time, s.
    amplitude, rms, offset
        Input units; ``rms`` takes the place of the amplitude of multisines.
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
    if kind in _MULTISINES:
        more = _MULTISINES[kind]
        return multisine(
            dt,
            samples,
            amplitude=amplitude if rms is None else None,
            rms=rms,
            band=band,
            lines=more.get("lines", "all"),
            phases=more.get("phases", "random"),
            periods=periods,
            offset=offset,
            seed=seed,
            **given,
        )
    if kind == "prbs":
        start = seed % (2**register - 1) + 1 if 2 <= register <= 20 else 1
        return prbs(
            dt,
            amplitude,
            register=register,
            clock=clock,
            periods=periods,
            offset=offset,
            seed=start,
            **given,
        )
    if kind == "swept-sine":
        ends = band if band is not None else (1.0 / (samples * dt), 0.4 / dt)
        return swept_sine(
            dt,
            samples,
            ends,
            amplitude,
            periods=periods,
            offset=offset,
            max_rate=given.get("max_rate", math.inf),
            max_acceleration=given.get("max_acceleration", math.inf),
        )
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
