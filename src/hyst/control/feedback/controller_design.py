"""A feedback controller for an identified plant."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_not_negative, as_number
from hyst.control.discretization import discretize
from hyst.control.feedback.designed_controller import ControllerDesign, Tried
from hyst.control.feedback.frequencies import frequencies_around
from hyst.control.feedback.gain_search import Demands, best_shape
from hyst.control.feedback.loop_plant import LoopPlant, as_rates, loop_plant
from hyst.control.feedback.margins import LoopMargins, largest_noise_gain, margins_of
from hyst.control.feedback.resonances import Resonance, resonances, with_resonances_elsewhere
from hyst.control.feedback.structures import Shape, controller_points
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.errors import InputError, SolverError

Array = NDArray[np.float64]

Kind: TypeAlias = Literal["auto", "i", "pi", "pid"]

_TIMES = 24
_WORTH = {"i": 1.0, "pi": 1.2, "pid": 1.5}  # by how much a richer kind has to be better
_OF_NYQUIST = 0.8
_OFF = (-1.0, 1.0, -0.5, 0.5)  # of the mismatch; its ends come first
_SHRINK, _SHRINKS = 0.995, 20  # steps that grow
_NEAR = 0.9  # of a bound, from which what lies between two frequencies of the grid is looked at
_BELOW = 0.999  # of Ms is searched, so that what lies between two frequencies of the grid is kept


def design_controller(
    plant: Any,
    kind: Kind = "auto",
    *,
    notch: bool | Literal["auto"] = "auto",
    dt: float | None = None,
    delay: float = 0.0,
    peak_sensitivity: float = 1.5,
    gain_margin: float | None = None,
    phase_margin: float | None = None,
    noise_gain: float = 2.0,
    mismatch: float = 0.05,
    Wu: Any = None,
) -> ControllerDesign:
    """Design an integral, PI or PID controller with notches for a plant behind an exact inverse.

    The integral gain ki is the largest with ``max |S| <= Ms`` and the other demands met, for the
    plant and for the plant with all its lightly damped resonances ``mismatch`` lower and higher.
    For each shape of C that gain is a closed form of the exact frequency response, of the sampled
    loop with hold and computing time where dt is given; times and notches are searched.

    Parameters
    ----------
    plant
        As ``simulate_closed_loop`` takes it: continuous, sampled, LinearDynamics with its delay.
    kind
        ``"i"``, ``"pi"``, ``"pid"``, or ``"auto"``: PI or PID only where they allow 1.2 or 1.5
        times the integral gain of the simpler one.
    notch
        ``"auto"``: resonances get a notch where it allows 1.15 times the gain; True: each of up to
        four does; False: none.
    dt
        Sample time of the block, s; left out: of the plant, or a loop in continuous time.
    delay
        Computing time, s.
    peak_sensitivity
        Ms, above 1; 1.4 is careful, 2 is fast. It brings a gain margin of Ms / (Ms - 1) and a phase
        margin of 2 arcsin(1 / (2 Ms)).
    gain_margin, phase_margin
        Further demands, a factor above 1 and degrees.
    noise_gain
        Bound of ``max |C S|``, sensor noise to v, over that at rest, which is 1 / P(0); above 1.
    mismatch
        Share by which the frequency of each resonance may be off, 0 to 0.3.
    Wu
        Weight of the uncertainty of the plant: then stability is kept for every plant within Wu,
        ``|Wu T| < 1``, or in a sampled loop ``a |C S| < 1`` with all that folds down.

    Returns
    -------
    ControllerDesign

    Raises
    ------
    InputError
        If the plant cannot be used, is unstable, has a zero or a pole at the origin, dt is too slow
        for one of its resonances, or a demand is out of its range.
    SolverError
        If no gain keeps the demands.

    Source
    ------
    The criterion is that of K.J. Astrom, H. Panagopoulos and T. Hagglund, Design of PI controllers
    based on non-convex optimization, Automatica 34, 1998; on more than one plant, with notches.

    Examples
    --------
    >>> w = 2.0 * np.pi * 500.0
    >>> design = design_controller(([w * w], [1.0, 0.1 * w, w * w]), dt=1e-4)
    >>> design.margins.stable, design.worst.peak_sensitivity <= 1.5
    (True, True)
    """
    met = loop_plant(plant, dt, delay)
    _refuse_demands(kind, notch, peak_sensitivity, gain_margin, phase_margin, noise_gain)
    off = as_not_negative(mismatch, "mismatch", "a share, 0 to 0.3")
    if off > 0.3:
        raise InputError(f"mismatch is {off:g}; give a share of 0.3 at most")
    gain = _usable_gain(met)
    found = resonances(met)
    _refuse_slow(met, found, off)
    others = _elsewhere(met, found, off)
    w = _grid([met, *others])
    demands = Demands(
        s=controller_points(w, met.dt),
        plants=np.array([math.copysign(1.0, gain) * each.response(w) for each in (met, *others)]),
        dt=met.dt,
        peak=1.0 + _BELOW * (float(peak_sensitivity) - 1.0),
        noise_gain=_BELOW * float(noise_gain) / abs(gain),
        gain_margin=gain_margin,
        phase_margin=phase_margin,
        deviation=None if Wu is None else _deviation(met, Wu, w, abs(gain)),
    )
    times = _candidate_times(met)
    notched = () if notch is False else found
    kinds = ("i", "pi", "pid") if kind == "auto" else (kind,)
    promised = _Promised(
        float(peak_sensitivity), gain_margin, phase_margin, float(noise_gain) / abs(gain), Wu
    )
    tried: list[Tried] = []
    for each in kinds:
        shape, ki = best_shape(demands, each, times, notched, notch is True)
        if ki > 0.0:
            signed = math.copysign(ki, gain)
            plants = (met, *others)
            held = _tried(each, shape, signed, plants, demands, promised)
            tried += [held] if held is not None else []
    if not tried:
        raise SolverError(
            "the loop bears any gain, or none: a plant without lag or dead time bears any gain; "
            "give dt and delay of the block, or allow a larger peak_sensitivity"
        )
    best = tried[0]
    for other in tried[1:]:
        if abs(other.ki) > _WORTH[other.kind] * abs(best.ki):
            best = other
    return _result(best, tuple(tried), met, others, off, found)


def _refuse_demands(
    kind: str,
    notch: Any,
    peak: float,
    gain_margin: float | None,
    phase_margin: float | None,
    noise_gain: float,
) -> None:
    if kind not in get_args(Kind):
        raise InputError(f"kind is {kind!r}; give one of {', '.join(get_args(Kind))}")
    if not (isinstance(notch, bool) or (isinstance(notch, str) and notch == "auto")):
        raise InputError(f"notch is {notch!r}; give 'auto', True or False")
    if not 1.0 < as_number(peak, "peak_sensitivity") <= 10.0:
        raise InputError(f"peak_sensitivity is {peak:g}; give a number above 1, 10 at most")
    if not 1.0 < as_number(noise_gain, "noise_gain") < math.inf:
        raise InputError(f"noise_gain is {noise_gain:g}; give a factor above 1")
    if gain_margin is not None and as_number(gain_margin, "gain_margin") <= 1.0:
        raise InputError(f"gain_margin is {gain_margin:g}; give a factor above 1")
    if phase_margin is not None and not 0.0 < as_number(phase_margin, "phase_margin") < 90.0:
        raise InputError(f"phase_margin is {phase_margin:g}; give degrees between 0 and 90")


def _usable_gain(plant: LoopPlant) -> float:
    gain = plant.static_gain()
    if math.isinf(gain):
        raise InputError(
            "the plant has a pole at the origin, so it does not rest where it is put, and no "
            "integral controller is designed for it; write C by hand and check it with loop_margins"
        )
    largest = float(np.abs(plant.response(_grid([plant]))).max())
    if abs(gain) <= 1e-9 * largest:
        raise InputError(
            "the plant has a zero at the origin: its static gain is 0, so no constant input holds "
            "an output; integral control cannot work"
        )
    return gain


def _refuse_slow(plant: LoopPlant, found: tuple[Resonance, ...], mismatch: float) -> None:
    if not plant.dt or not found:
        return
    fastest = max(found, key=lambda each: each.frequency)
    highest = fastest.frequency * (1.0 + mismatch)
    if highest > _OF_NYQUIST * plant.nyquist:
        least = highest / (math.pi * _OF_NYQUIST)
        raise InputError(
            f"dt = {plant.dt:.6g} s is too slow for the resonance at "
            f"{fastest.frequency / (2.0 * math.pi):.4g} Hz, which reaches {fastest.peak:.3g} times "
            f"the static gain; sample at {math.ceil(least):d} Hz or faster, a dt of at most "
            f"{1.0 / math.ceil(least):.4g} s"
        )


def _elsewhere(
    plant: LoopPlant, found: tuple[Resonance, ...], mismatch: float
) -> tuple[LoopPlant, ...]:
    if not found or mismatch == 0.0:
        return ()
    others = []
    for share in _OFF:
        source = plant.system if plant.continuous is None else plant.continuous
        moved = with_resonances_elsewhere(source, found, 1.0 + share * mismatch)
        late = 0.0 if plant.continuous is None else plant.dead_time
        others.append(loop_plant(moved, plant.dt or None, late))
    return tuple(others)


def _grid(plants: list[LoopPlant]) -> Array:
    features = np.concatenate([as_rates(each.system) for each in plants])
    late = plants[0].dead_time
    if late:
        features = np.append(features, 1.0 / late)
    w = frequencies_around(features, plants[0].nyquist, 50, 100.0)
    return w[w < plants[0].nyquist * (1.0 - 1e-9)] if plants[0].dt else w


def _uncertain(plant: LoopPlant, Wu: Any, w: Array) -> Array:
    """Give by how much the plant may be off."""
    if plant.sampled is not None:
        return folded_uncertainty(plant.sampled, Wu, w)
    weight = weight_response(as_linear_system(Wu, "Wu"), w)
    return np.asarray(np.abs(weight * plant.response(w)))


def _deviation(plant: LoopPlant, Wu: Any, w: Array, gain: float) -> Array:
    found = _uncertain(plant, Wu, w)
    if found[0] >= gain:
        raise InputError(
            f"Wu is {found[0] / gain:.4g} at low frequencies, so the static gain may have either "
            "sign and no integral controller is safe; give a Wu below 1 there"
        )
    return found


def _candidate_times(plant: LoopPlant) -> Array:
    """From what is fastest in the loop to a few times what is slowest."""
    sizes = np.abs(as_rates(plant.system))
    sizes = sizes[sizes > 0.0]
    known = [1.0 / each for each in sizes] + [each for each in (plant.dt, plant.dead_time) if each]
    if not known:
        known = [1.0]
    fast = max(0.1 * min(known), 0.2 * plant.dt)
    return np.geomspace(fast, max(4.0 * max(known), 10.0 * fast), _TIMES)


@dataclass(frozen=True, eq=False)
class _Promised:
    """What a design says that it keeps, at all frequencies."""

    peak: float
    gain_margin: float | None
    phase_margin: float | None
    noise_gain: float
    Wu: Any


def _tried(
    kind: str,
    shape: Shape,
    ki: float,
    plants: tuple[LoopPlant, ...],
    demands: Demands,
    promised: _Promised,
) -> Tried | None:
    """Hold a candidate to its demands between the points of the grid, and lower its gain if not."""
    dt = plants[0].dt
    response = shape.response(demands.s, dt)
    for k in range(_SHRINKS):
        continuous = shape.system(ki, dt)
        system = discretize(continuous, dt) if dt else continuous
        found = [margins_of(each, system) for each in plants]
        gains = demands.noise_gains(abs(ki) * response)
        if all(_kept(each, promised) for each in found) and _quiet(
            plants, system, gains, demands, promised
        ):
            return Tried(kind, shape, ki, continuous, system, found[0], _worst(found))
        ki *= _SHRINK ** (1 + k // 2)
    return None


def _kept(found: LoopMargins, promised: _Promised) -> bool:
    gain, phase = promised.gain_margin, promised.phase_margin
    return (
        found.stable
        and found.peak_sensitivity <= promised.peak
        and (gain is None or found.gain_margin >= gain * (1 - 1e-6))
        and (phase is None or found.phase_margin >= phase - 1e-4)
    )


def _quiet(
    plants: tuple[LoopPlant, ...],
    system: LinearSystem,
    gains: Array,
    demands: Demands,
    promised: _Promised,
) -> bool:
    """Tell whether ``|C S|`` stays within what noise and Wu allow, the latter for the plant.

    ``gains`` are those on the grid: where they are far from the bound, so is what lies between.
    """
    for plant, gain in zip(plants, gains, strict=True):
        near = gain.max() > _NEAR * promised.noise_gain
        if near and largest_noise_gain(plant, system) > promised.noise_gain:
            return False
    if demands.deviation is None or (demands.deviation * gains[0]).max() < _NEAR:
        return True

    def weight(w: Array) -> Array:
        return _uncertain(plants[0], promised.Wu, w)

    return largest_noise_gain(plants[0], system, weight) < 1.0


def _worst(found: list[LoopMargins]) -> LoopMargins:
    return min(found, key=lambda each: each.modulus_margin)


def _result(
    best: Tried,
    tried: tuple[Tried, ...],
    plant: LoopPlant,
    others: tuple[LoopPlant, ...],
    mismatch: float,
    found: tuple[Resonance, ...],
) -> ControllerDesign:
    return ControllerDesign(
        kind=best.kind,
        ki=best.ki,
        shape=best.shape,
        continuous=best.continuous,
        sampled=best.system if plant.dt else None,
        margins=best.margins,
        worst=best.worst,
        mismatch=mismatch if others else 0.0,
        resonances=found,
        tried=tried,
        static_gain=plant.static_gain(),
    )
