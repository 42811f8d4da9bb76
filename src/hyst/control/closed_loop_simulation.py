"""Simulation of the loop around a hysteresis, S1 Fig. 2."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import one_record
from hyst.checks.numbers import (
    as_not_negative,
    as_number,
    as_positive,
    as_sample_time,
    whole_number,
)
from hyst.control.closed_loop import ClosedLoop
from hyst.control.controller_parts import disturbance_observer_of, feedback_controller, joined
from hyst.control.feedback.settled_start import simulate_settled
from hyst.control.loop_system import continuous_loop, held_step, plant_of
from hyst.control.repetitive.controller import RepetitiveController
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError, SolverError
from hyst.operators import Operator

Array = NDArray[np.float64]

Place: TypeAlias = Literal["hysteresis", "plant"]
AlgebraicLoop: TypeAlias = Literal["solve", "delay"]
Start: TypeAlias = Literal["rest", "settled"]

# An output this many times larger than the reference has left for good.
_FAR = 1e6

_NOTHING = np.zeros(1)


def simulate_closed_loop(
    reference: ArrayLike,
    dt: float,
    *,
    plant: Any,
    controller: Any,
    hysteresis: Operator | None = None,
    inverse: Operator | None = None,
    observer: Any = None,
    noise: ArrayLike = 0.0,
    disturbance: ArrayLike = 0.0,
    disturbance_at: Place = "hysteresis",
    seed: int = 0,
    settle: float = 0.0,
    algebraic_loop: AlgebraicLoop = "solve",
    limit: float | None = None,
    delay: float = 0.0,
    start: Start = "rest",
) -> ClosedLoop:
    """Simulate reference, controller, observer, inverse, hysteresis and plant, from rest.

    ``v = C (r - y - noise) - d_hat``, ``d_hat = observer(v, y + noise)``, ``u = inverse(v)``,
    ``eta = hysteresis(u + d)``, ``y = P eta``, or ``eta = hysteresis(u)``, ``y = P (eta + d)``.

    With continuous blocks, the controller's included, the linear part of the loop is one system,
    stepped exactly with reference, noise and output of the hysteresis held between samples: only
    this holding, half a sample of delay, is not exact, and errors fall like dt. With a
    TrackingController the controller is what a target runs, and the plant is stepped in this way.

    Parameters
    ----------
    reference
        Wanted output r, shape (N,), finite.
    dt
        Sample time, s, > 0.
    plant
        True P(s), which need not be the nominal one: a system of python-control, a LinearSystem, a
        pair (num, den), matrices (A, B, C, D) or a number; with a TrackingController also
        LinearDynamics of the same dt.
    controller
        C(s) in one of these forms, or a TrackingController, which has its own observer and inverse;
        or a RepetitiveController, which goes with the same kinds of plant and delay.
    hysteresis
        True hysteresis, from u to eta; the identity if left out.
    inverse
        Operator from v to u: exact, scaled, reduced, any; the identity if left out.
    observer
        Disturbance observer with inputs (v, y) and output d_hat, continuous, or a design that has
        it as ``observer``; none if left out.
    noise
        Standard deviation of independent normal noise of the measurement, or its samples, (N,).
    disturbance
        A constant, or samples, shape (N,).
    disturbance_at
        ``"hysteresis"``: added to u (S1 eq. 18); ``"plant"``: added to eta (S1 eq. 40).
    seed
        Of the noise; the same seed gives the same noise.
    settle
        Seconds at the start that the metrics leave out, less than N dt.
    algebraic_loop
        Where plant and controller both have feedthrough, v depends on eta of the same instant.
        ``"solve"`` solves for it at each sample; ``"delay"`` takes eta of the sample before. A
        TrackingController always acts on y as it is before its new drive.
    limit
        The loop has diverged once abs(y) is above it; a million times the largest reference and
        noise if left out.
    delay
        s, >= 0, from reading y to the drive that follows from it: with a TrackingController only,
        whole samples or not, as ``sampled_plant`` takes it.
    start
        ``"rest"``: all states are 0, or what the operators say. ``"settled"``, with a
        TrackingController only: the loop has come to rest at the first value of the reference.

    Returns
    -------
    ClosedLoop
        Signals and metrics. A loop that diverges is no error; ``diverged_at`` tells.

    Raises
    ------
    InputError
        If a signal is not finite or has another length, a block cannot be read, is improper or
        unstable, sample times differ, the hysteresis or the inverse is no operator, a
        TrackingController is given together with an observer or an inverse, or an option is none of
        those above.
    SolverError
        If the algebraic loop has no solution at a sample.

    Source
    ------
    S1 secs. 3 and 5.

    Examples
    --------
    >>> from hyst import PrandtlIshlinskii
    >>> stage = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    >>> loop = simulate_closed_loop(
    ...     np.ones(5000), 1e-3, plant=([50.0], [1.0, 50.0]), controller=([10.0], [1.0, 0.0]),
    ...     hysteresis=stage, inverse=stage.inverse(), settle=2.0,
    ... )
    >>> loop.rms_error < 1e-6
    True
    """
    time, r = as_sample_time(dt), one_record(reference, "reference")
    settled = _settling(settle, r.size, time)
    _refuse_other(start, get_args(Start), "start")
    _refuse_other(disturbance_at, get_args(Place), "disturbance_at")
    _refuse_other(algebraic_loop, get_args(AlgebraicLoop), "algebraic_loop")
    spread, d = _noise(noise, r.size, seed), _signal(disturbance, r.size, "disturbance")
    if start == "settled":
        return simulate_settled(
            simulate_closed_loop, r, time, controller, plant, hysteresis,
            _record(spread, r.size), delay,
            inverse=inverse, observer=observer, disturbance=_record(d, r.size),
            disturbance_at=disturbance_at,
            settle=settled, limit=limit,
        )  # fmt: skip
    before, behind = (d, _NOTHING) if disturbance_at == "hysteresis" else (_NOTHING, d)
    outputs = np.empty((5, r.size))
    actuator = _chain(hysteresis, "hysteresis", time), _start(hysteresis)
    signals = r, spread, before, behind, outputs, _limit(limit, r, spread)
    if isinstance(controller, TrackingController | RepetitiveController):
        if inverse is not None or observer is not None:
            raise InputError(
                f"a {type(controller).__name__} has its own inverse and observer; leave them out"
            )
        end, good, held = _sampled(controller, sampled_plant(plant, time, delay), actuator, signals)
    else:
        _refuse_late(delay)
        part = joined(feedback_controller(controller), disturbance_observer_of(observer))
        step = held_step(continuous_loop(plant_of(plant), part), time)
        first, late = _chain(inverse, "inverse", time), algebraic_loop == "delay"
        end, good, held = _engine.run_continuous_loop(
            step, late, first, actuator[0], _start(inverse), actuator[1], *signals
        )
    _refuse_unsolved(end, good * time)
    r, spread, d = (_record(each, r.size)[:good] for each in (r, spread, d))
    v, u, eta, y, d_hat = outputs[:, :good]
    if isinstance(controller, TrackingController | RepetitiveController):
        d_hat = _estimated(controller, d_hat, r, y, spread)
    diverged_at = good * time if end == "diverged" else None
    return ClosedLoop(time, r, y, spread, v, u, eta, d_hat, d, settled, diverged_at, held)


def _refuse_late(delay: float) -> None:
    if delay != 0.0:
        raise InputError(
            f"delay is {delay:.6g} s of a controller in continuous time, which takes none to "
            "compute; give a TrackingController"
        )


def _refuse_unsolved(end: str, at: float) -> None:
    if end == "no-solution":
        raise SolverError(
            f"the algebraic loop through plant and controller has no solution at {at:.6g} "
            "s; give algebraic_loop='delay', or add a pole to the plant"
        )


def _sampled(
    controller: TrackingController | RepetitiveController,
    plant: SampledPlant,
    actuator: tuple[_engine.Chain, Array],
    signals: tuple[Array, Array, Array, Array, Array, float],
) -> tuple[str, int, bool]:
    if abs(controller.dt - plant.dt) > 1e-6 * plant.dt:
        raise InputError(
            f"the controller has dt = {controller.dt:.6g} s, the loop {plant.dt:.6g} s; "
            "give the same for both"
        )
    step, (chain, state) = held_step(plant.system, plant.dt), actuator
    after = chain, controller.initial_state(), state, *signals
    if isinstance(controller, RepetitiveController):
        return _engine.run_repetitive_loop(step, controller.compiled, *after)
    E = np.zeros(0) if controller.E is None else controller.E
    F = np.zeros(2) if controller.F is None else controller.F
    return _engine.run_sampled_loop(
        step, controller.compiled, E.tolist(), float(F[0]), float(F[1]), *after
    )


def _estimated(
    controller: TrackingController | RepetitiveController,
    in_loop: Array,
    r: Array,
    y: Array,
    noise: Array,
) -> Array:
    """Give the estimates; with a drive that is limited they are not told in the loop."""
    if isinstance(controller, RepetitiveController) or controller.E is None or not r.size:
        return np.zeros(r.size)
    return in_loop if controller.W is None else controller.estimate(r, y + noise)


def _settling(settle: float, samples: int, dt: float) -> float:
    settled = as_number(settle, "settle")
    if not 0.0 <= settled < (samples - 1 + 1e-9) * dt:
        raise InputError(f"settle is {settled} s of {samples * dt:.6g} s; leave some to measure")
    return settled


def _refuse_other(given: str, allowed: tuple[str, ...], name: str) -> None:
    if given not in allowed:
        raise InputError(f"{name} is {given!r}; give one of {', '.join(allowed)}")


def _signal(values: ArrayLike, samples: int, name: str) -> Array:
    """Check samples, or a number for all of them, which stays a single one."""
    if np.ndim(values) == 0:
        return np.array([as_number(values, name)])
    record = one_record(values, name)
    if record.size != samples:
        raise InputError(f"{name} has {record.size} samples, the reference {samples}; give as many")
    return record


def _record(signal: Array, samples: int) -> Array:
    if signal.size == samples:
        return signal
    return np.full(samples, signal[0]) if signal[0] else np.zeros(samples)  # whose pages are free


def _noise(noise: ArrayLike, samples: int, seed: int) -> Array:
    if np.ndim(noise) != 0:
        return _signal(noise, samples, "noise")
    deviation = as_not_negative(noise, "noise", "a standard deviation")
    draw = whole_number(seed, "seed", 0)
    if deviation == 0.0:
        return _NOTHING
    return deviation * np.random.default_rng(draw).standard_normal(samples)


def _limit(limit: float | None, r: Array, noise: Array) -> float:
    if limit is None:
        largest = float(np.abs(r).max() + np.abs(noise).max())
        return _FAR * largest if largest > 0.0 else np.inf
    return as_positive(limit, "limit", "a bound of the output")


def _chain(operator: Operator | None, name: str, dt: float) -> _engine.Chain:
    if operator is None:
        return _engine.Chain(())
    if not isinstance(operator, Operator):
        raise InputError(f"{name} is {type(operator).__name__}; give an operator or None")
    operator.require_sample_time(dt, "the loop")
    return _engine.Chain(operator.stages())


def _start(operator: Operator | None) -> Array:
    return np.zeros(0) if operator is None else operator.initial_state()
