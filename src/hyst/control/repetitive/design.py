"""Filters of a repetitive controller chosen such that what they do is proven."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number, as_positive, as_sample_time
from hyst.control.plants.identified import identified_plant
from hyst.control.plants.parts import has_dynamics_behind
from hyst.control.repetitive.certificate import (
    ConditionValues,
    RepetitiveCertificate,
    certified,
    ordered_slopes,
    refuse_lasting,
    shown_by,
)
from hyst.control.repetitive.filters import RepetitiveFilters, inverse_taps, low_pass, narrowest
from hyst.control.sampled.certificate import stable_weight
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.errors import InputError
from hyst.models import LinearDynamics
from hyst.operators import Operator

Array = NDArray[np.float64]
Found: TypeAlias = tuple[RepetitiveFilters, RepetitiveCertificate]

LARGEST_PERIOD = 2**23  # twice as many are counted in single precision
_HALVES = (0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
_WIDEST, _STEP, _BANDS = 0.45, 0.8, 24  # of pi/dt: the widest band, and how bands go down from it
_ENOUGH = 0.9  # of contraction, for a band that is chosen: 1 % after 44 periods
_SCALES = np.linspace(0.7, 1.7, 51)
_LONGER = 4  # lengths after which nothing gained means that longer ones gain nothing
_NEAR = 0.02  # of the least contraction: fewer taps are taken
_FLOOR = 0.02  # of Q where it stops: the inverse is not left to itself there


@dataclass(frozen=True)
class _Asked:
    """What a design is given, checked."""

    plant: SampledPlant
    period: int
    uncertainty: Any
    slopes: tuple[float, float]
    gain: float


def as_period(period: Any) -> int:
    """Check the samples of a period.

    Parameters
    ----------
    period
        A whole number above 1, also as a float.

    Raises
    ------
    InputError
        If it is none.
    """
    number = as_number(period, "period")
    if number != math.floor(number):
        raise InputError(
            f"the period is {number:.9g} samples; a memory holds whole ones, so {_whole(number)}"
        )
    if not 2.0 <= number <= LARGEST_PERIOD:
        raise InputError(f"the period is {number:.9g} samples; give 2 to {LARGEST_PERIOD}")
    return int(number)


def _whole(period: float) -> str:
    for times in range(2, 21):
        samples = times * period
        if abs(samples - round(samples)) < 1e-6:
            return (
                f"give {times} periods as one, {round(samples)} samples, or a dt of which the "
                "period is a multiple"
            )
    return "give a dt of which the period is a multiple"


def taken_apart(plant: Any, inverse: Any, dt: float | None) -> tuple[Any, Any]:
    """Give plant and inverse; of a model with hysteresis, its own.

    Parameters
    ----------
    plant
        A model, or a linear system.
    inverse
        As given; None for that of the model.
    dt
        Sample time, s; that of the plant if None.

    Raises
    ------
    NotInvertibleError
        If the hysteresis of the model has no exact inverse.
    """
    if not isinstance(plant, Operator):
        return plant, inverse
    if not has_dynamics_behind(plant):
        time = as_sample_time(plant.dt if dt is None else dt)
        at_once = LinearDynamics(np.zeros((0, 0)), [], [], 1.0, time)
        return at_once, plant.inverse() if inverse is None else inverse
    found = identified_plant(plant)
    return found.dynamics, found.hysteresis.inverse() if inverse is None else inverse


def designed(
    plant: Any,
    period: int,
    dt: float | None,
    bandwidth: float | None,
    uncertainty: Any,
    slopes: Any,
    delay: float,
    gain: float,
) -> Found:
    """Choose filters, and prove what they do.

    Parameters
    ----------
    plant, period, dt, bandwidth, uncertainty, slopes, delay, gain
        As ``RepetitiveController.design`` takes them; the period checked.

    Raises
    ------
    InputError
        As there.
    """
    if uncertainty is None and bandwidth is None:
        raise InputError(
            "neither uncertainty nor bandwidth is given, so nothing says up to where the plant is "
            "known well enough to learn; give one of them"
        )
    share = as_positive(gain, "gain", "a share of the error learned a period")
    if share > 1.0:
        raise InputError(f"gain is {share:.6g}; give at most 1, the whole error")
    sampled = sampled_plant(plant, dt, delay)
    refuse_lasting(sampled)
    wu = 0.0 if uncertainty is None else uncertainty
    asked = _Asked(sampled, period, wu, ordered_slopes(slopes), share)
    best: Found | None = None
    for passed in _bands(bandwidth, sampled.dt):
        if bandwidth is None and passed * period < 2.0 * math.pi:
            break  # below the first harmonic there is nothing to learn
        found = _at_band(asked, passed)
        if found is None:
            break
        if best is None or found[1].contraction < best[1].contraction:
            best = found
        if found[1].contraction <= (_ENOUGH if bandwidth is None else 1.0):
            break
    return _proven(best, asked, bandwidth)


def _bands(bandwidth: float | None, dt: float) -> Iterator[float]:
    """Give angles up to which Q passes, the widest first."""
    if bandwidth is None:
        yield from (_WIDEST * math.pi * _STEP**k for k in range(_BANDS))
        return
    passed = as_positive(bandwidth, "bandwidth", "rad/s") * dt
    if passed > 0.9 * math.pi:
        raise InputError(
            f"bandwidth is {bandwidth:.6g} rad/s, {passed / math.pi:.3g} of half the sample rate; "
            "give at most 0.9 of it"
        )
    yield passed


def _at_band(asked: _Asked, passed: float) -> Found | None:
    """Give the best filters that pass up to an angle; None where Q is longer than the period."""
    # An octave to fall in, or more where the filter would be longer than the period.
    stopped = passed + max(passed, narrowest(asked.period / 2.0))
    smooth = low_pass(passed, min(stopped, math.pi))
    plant, weight = asked.plant, stable_weight(asked.uncertainty, "uncertainty")
    w = shown_by(plant, weight, smooth.size + 2 * _HALVES[-1] + 1)
    angle = w * plant.dt
    bare = RepetitiveFilters(asked.period, smooth, np.ones(1), 0)
    values = ConditionValues(bare, plant, weight, asked.slopes)
    Q, doubt = bare.Q(angle), values.doubt(w)
    P = values.middle * plant.system.response(np.exp(1j * angle))[:, 0, 0]
    if not np.abs(P).max() > 0.0:
        raise InputError("the plant passes nothing, so nothing can be learned; give its numerator")
    late = _lateness(P, angle, passed)
    tried: list[tuple[float, RepetitiveFilters]] = []
    for half in _HALVES:
        lead = late + half
        taps = max(2 * half + 1, lead + 1)  # a memory of errors holds them up to now
        if smooth.size - 1 + lead >= asked.period:
            break
        learn = inverse_taps(angle, P, np.maximum(Q, _FLOOR), doubt, lead, taps)
        filters = RepetitiveFilters(asked.period, smooth, learn, lead)
        L = filters.L(angle)
        tried.append((float((Q * (np.abs(1.0 - L * P) + np.abs(L) * doubt)).max()), filters))
        if len(tried) > _LONGER and _least(tried) > _least(tried[:-_LONGER]) - _NEAR:
            break
    if not tried:
        return None
    # The condition on the grid; the certificate closes in on what is between.
    least = _least(tried)
    filters = next(each for value, each in tried if value <= least + _NEAR)
    L = filters.L(angle)
    # Least squares fear doubt more than its worst case needs: all of L is scaled for that.
    left = [(Q * (np.abs(1.0 - k * L * P) + k * np.abs(L) * doubt)).max() for k in _SCALES]
    scale = asked.gain * _SCALES[int(np.argmin(left))]
    filters = replace(filters, learn=scale * filters.learn)
    return filters, certified(filters, plant, plant.dt, asked.uncertainty, asked.slopes)


def _least(tried: list[tuple[float, RepetitiveFilters]]) -> float:
    return min(value for value, _ in tried)


def _lateness(P: NDArray[np.complex128], angle: Array, passed: float) -> int:
    """Give the samples by which a plant is late over a band, at least the one of its hold."""
    within = angle <= max(passed, float(angle[0]))
    phase = np.unwrap(np.angle(P[within] * np.sign(P[0].real or 1.0)))
    a = angle[within]
    # The straight line through 0 that fits the phase; evenly over frequency.
    share = np.gradient(a) if a.size > 1 else np.ones(1)
    slope = -float((share * a * phase).sum() / (share * a * a).sum())
    return max(round(slope), 1)


def _proven(
    best: Found | None,
    asked: _Asked,
    bandwidth: float | None,
) -> Found:
    if best is None:
        raise InputError(
            f"the period of {asked.period} samples is shorter than the filter that such a band "
            "needs; give a shorter dt, a wider bandwidth or several periods as one"
        )
    if not best[1].holds:
        what = "no band" if bandwidth is None else f"a bandwidth of {bandwidth:.6g} rad/s"
        raise InputError(
            f"{what} can be proven: at {best[1].frequency:.4g} rad/s a period may leave "
            f"{best[1].contraction:.4g} times the error of the one before; give a lower bandwidth, "
            "a smaller uncertainty or narrower slopes"
        )
    return best
