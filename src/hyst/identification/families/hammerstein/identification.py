"""Hysteresis and dynamics from input and output alone, in five steps.

1. Markov parameters by least squares on a long FIR model; 2. a state space from them; 3. its stable
noncausal inverse; 4. the signal behind the hysteresis; 5. a parametric hysteresis, refined together
with the dynamics on the simulated output.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError, NotInvertibleError, SolverError
from hyst.identification.families import RAMBERG_OSGOOD, at_limit_of_power
from hyst.identification.families.hammerstein.front import FrontOptions, first_front
from hyst.identification.families.hammerstein.identified_hammerstein import (
    IdentifiedHammerstein,
    Loop,
)
from hyst.identification.families.hammerstein.joint import (
    MOST_SAMPLES,
    Joint,
    refine,
    refined_coarsely,
    shortened,
)
from hyst.identification.families.hammerstein.markov import MarkovParameters, choose_markov
from hyst.identification.families.hammerstein.realization import (
    Realization,
    as_state_order,
    realize,
)
from hyst.identification.families.hammerstein.record_checks import check_records, check_sample_time
from hyst.identification.families.hammerstein.results import parameter_table
from hyst.identification.families.hammerstein.uncertainty import (
    Uncertainty,
    poles_as_numbers,
    spread_of,
    uncertainty,
)
from hyst.identification.families.hammerstein.without_dynamics import dynamics_doubts
from hyst.identification.fit.bounded_least_squares import CONVERGED, Solution
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.identification.result.identified_from_fit import describe, metrics_by_record
from hyst.models import LinearDynamics, StableInverse
from hyst.signals import Record

Array = NDArray[np.float64]

_SIGNIFICANT = 4.0  # standard errors
_NEGLIGIBLE = 0.02  # of the largest Markov parameter
_WORTH_A_STATE = 0.8  # to what share of the squared error a further state must lower it
_TRIAL_ITERATIONS = 30
_ROUNDING = 1e-16  # share of the output's power: nothing is left to explain


@dataclass(frozen=True, eq=False)
class HammersteinOptions:
    """What the user wants.

    Parameters
    ----------
    fir_order, state_order, delay
        Numbers or ``"auto"``.
    front
        The hysteresis.
    start
        First sample to use, or ``"auto"``.
    max_iterations
        Of the refinement.
    allow_unconverged
        Whether a refinement that did not converge is given back.
    """

    fir_order: int | str
    state_order: int | str
    delay: int | str
    front: FrontOptions
    start: int | Literal["auto"]
    max_iterations: int = 60
    allow_unconverged: bool = False


def identify_hammerstein(
    records: Record | Sequence[Record],
    options: HammersteinOptions,
    validation: Sequence[Record],
    say: Callable[[str], None],
) -> IdentifiedHammerstein:
    """Identify hysteresis and dynamics from records.

    Parameters
    ----------
    records
        One or more, of one sample time, each starting from rest or long enough to forget how it
        started.
    options
        What is wanted.
    validation
        Records to judge by.
    say
        Told what is being done.

    Returns
    -------
    IdentifiedHammerstein

    Raises
    ------
    InputError
        If a record or an option cannot be used.
    NotIdentifiableError
        If the input does not excite, the output rests, or the dynamics are not stable.
    SolverError
        If the refinement did not converge and that is not allowed.
    """
    data = prepare(records, options.start, 0)
    notes = check_records(data.records)
    check_sample_time(validation, data.records[0].dt)
    say("Markov parameters")
    markov, doubts = choose_markov(data.records, options.fir_order)
    notes += doubts
    delay = _delay(markov, options.delay)
    data = _settled(data, markov.order, options.start)
    refined_on = shortened(data, MOST_SAMPLES // len(data.records))
    realized, joint, reason = _first_guess(data, markov, delay, options, say)
    say("refinement")
    solution = refine(joint, refined_on, options.max_iterations)
    if solution.status != CONVERGED and not options.allow_unconverged:
        raise SolverError(
            f"the refinement of hysteresis and dynamics did not converge in {solution.iterations} "
            "iterations; give fewer plays, knots or states, or accept it with allow_unconverged"
        )
    sure = uncertainty(joint, refined_on, solution.theta)
    lag = int(np.abs(markov.values).argmax())
    notes += dynamics_doubts(joint, refined_on, solution.theta, lag, options.front)
    return _result(joint, solution, sure, data, markov, realized, notes + reason, validation)


def _first_guess(
    data: Data,
    markov: MarkovParameters,
    delay: int,
    options: HammersteinOptions,
    say: Callable[[str], None],
) -> tuple[Realization, Joint, tuple[str, ...]]:
    """Realize, invert and fit the hysteresis; choose the order by the refined output error.

    Hysteresis itself looks like slow dynamics to the first step, so the singular values only bound
    the order from above.
    """
    record, dt = data.records[0], data.records[0].dt
    best, least, power = None, np.inf, float(data.measured() @ data.measured())
    for order in _orders(markov, delay, dt, options.state_order):
        say(f"realization of order {order}")
        realized = _realized(markov, delay, dt, order)
        realized = replace(realized, dynamics=_normalized(realized.dynamics))
        v, valid, reason = _estimated_v(record, realized.dynamics)
        front = first_front(record.u[: valid.stop], v[: valid.stop], dt, options.front)
        joint = Joint(front, realized.dynamics, realized.dynamics.D != 0.0)
        joint, cost = refined_coarsely(joint, data, _TRIAL_ITERATIONS)
        guess = (realized, joint, reason)
        if best is None or cost < _WORTH_A_STATE * least:
            best, least = guess, cost
            if cost <= _ROUNDING * power:
                break
        elif order > 1 and cost > _WORTH_A_STATE * least:
            break
    if best is None:
        raise NotIdentifiableError("no order can be realized; raise fir_order")
    return best


def _orders(
    markov: MarkovParameters, delay: int, dt: float, state_order: int | str
) -> Sequence[int]:
    if state_order != "auto":
        return (as_state_order(state_order),)
    largest = _realized(markov, delay, dt, "auto").dynamics.order
    return range(1, largest + 1)


def _delay(markov: MarkovParameters, wanted: int | str) -> int:
    """Whole samples before the response begins; one is left to a strictly proper system."""
    if wanted != "auto":
        return int(wanted)
    size = np.abs(markov.values)
    floor = np.maximum(_SIGNIFICANT * markov.standard_errors, _NEGLIGIBLE * size.max())
    begun = np.flatnonzero(size > floor)
    return max(int(begun[0]) - 1, 0) if begun.size else 0


def _realized(
    markov: MarkovParameters, delay: int, dt: float, state_order: int | str
) -> Realization:
    values, errors = markov.values[delay:], markov.standard_errors[delay:]
    feedthrough = abs(values[0]) > max(
        _SIGNIFICANT * errors[0], _NEGLIGIBLE * float(np.abs(values).max())
    )
    found = realize(values, dt, state_order, float(np.median(errors)), bool(feedthrough))
    G = found.dynamics
    return replace(found, dynamics=LinearDynamics(G.A, G.B, G.C, G.D, dt, delay))


def _normalized(dynamics: LinearDynamics) -> LinearDynamics:
    gain = dynamics.dc_gain()
    peak = float(np.abs(dynamics.impulse_response(64)).sum())
    if abs(gain) < 1e-3 * peak:
        raise NotIdentifiableError(
            f"the gain of the dynamics at rest is {gain:.3g}, next to nothing beside "
            f"{peak:.3g} in all; an actuator or sensor that does not pass constant values cannot "
            "be split into hysteresis and dynamics of DC gain 1"
        )
    return dynamics.in_units(1.0, 1.0 / gain)


def _inverse(dynamics: LinearDynamics) -> tuple[StableInverse | None, tuple[str, ...]]:
    """Give the stable inverse, of a band only if a zero at high frequency forbids it for all."""
    try:
        return StableInverse.of(dynamics, tolerance=1e-9), ()
    except NotInvertibleError as error:
        zeros = dynamics.zeros()
        near = zeros[np.abs(np.abs(zeros) - 1.0) < 1e-2]
        frequency = float(np.abs(np.angle(near)).min(initial=np.pi)) / (2 * np.pi * dynamics.dt)
        if frequency > 0.02 / dynamics.dt:
            band = 0.7 * frequency
            return StableInverse.of(dynamics, tolerance=1e-9, band=band), (
                f"{error}; the loop was estimated below {band:.4g} Hz only",
            )
        return None, (f"{error}; so the loop could not be estimated without a model",)


def _estimated_v(record: Record, dynamics: LinearDynamics) -> tuple[Array, slice, tuple[str, ...]]:
    inverse, reason = _inverse(dynamics)
    if inverse is None:
        # Without an inverse the delayed output itself serves as a first guess.
        return record.y, slice(0, len(record)), reason
    v, valid = inverse(record.y), inverse.valid(len(record))
    if valid.stop - valid.start < 4:
        raise NotIdentifiableError(
            f"the record has {len(record)} samples but the inverse of the dynamics needs "
            f"{inverse.h.size}; give a longer record"
        )
    return v, valid, reason


def _settled(data: Data, order: int, start: int | str) -> Data:
    """Leave out what the unknown initial state of the dynamics may have disturbed."""
    if start != "auto":
        return data
    starts = tuple(
        max(each, min(order, len(record) // 4))
        for each, record in zip(data.starts, data.records, strict=True)
    )
    return replace(data, starts=starts)


def _result(
    joint: Joint,
    solution: Solution,
    sure: Uncertainty,
    data: Data,
    markov: MarkovParameters,
    realized: Realization,
    notes: tuple[str, ...],
    validation: Sequence[Record],
) -> IdentifiedHammerstein:
    theta = solution.theta
    hysteresis, dynamics = joint.hysteresis(theta), joint.dynamics(theta)
    model = dynamics @ hysteresis
    names, values, errors, undetermined = parameter_table(joint, theta, sure)
    order = dynamics.order
    poles = poles_as_numbers(dynamics)
    pole_errors = spread_of(joint, theta, sure.covariance, poles_as_numbers)
    inverse, _ = _inverse(dynamics)
    first = data.records[0]
    loop = Loop(first.u, first.y, slice(0, 0), float("nan"))
    if inverse is not None:
        band = 2.0 * sure.noise_rms * inverse.noise_gain
        loop = Loop(first.u, inverse(first.y), inverse.valid(len(first)), band)
    if realized.stabilized:
        notes += ("the realization was not stable and was replaced by a stable one",)
    if joint.front.family == RAMBERG_OSGOOD:
        notes += at_limit_of_power(joint.front.parametrization, theta[: joint.front_size])
    return IdentifiedHammerstein(
        model=model,
        family="hammerstein",
        delay=0,
        parameter_names=names,
        parameter_values=values,
        standard_errors=errors,
        undetermined=notes + undetermined,
        metrics=metrics_by_record(data, model, validation),
        candidates=(),
        status=solution.status,
        iterations=solution.iterations,
        used=data.used(),
        description=describe(data, "hammerstein"),
        hysteresis=hysteresis,
        dynamics=dynamics,
        first_dynamics=realized.dynamics,
        markov=markov,
        singular_values=realized.singular_values,
        hankel_noise=realized.noise_level,
        poles=poles[:order] + 1j * poles[order:],
        pole_standard_errors=pole_errors[:order] + 1j * pole_errors[order:],
        inverse_of_dynamics=inverse,
        loop=loop,
        hysteresis_family=joint.front.family,
        noise_rms=sure.noise_rms,
    )
