"""From a fit of hysteresis and dynamics to the result: parts, impulse response, poles, loop."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Family, Fit
from hyst.identification.families.hammerstein.coefficients import poles_as_numbers, poles_by_theta
from hyst.identification.families.hammerstein.first_dynamics import inverse_of, realized
from hyst.identification.families.hammerstein.identified_hammerstein import (
    IdentifiedHammerstein,
    Loop,
)
from hyst.identification.families.hammerstein.joint import dynamics_of, joint_of
from hyst.identification.families.hammerstein.markov import choose_markov
from hyst.identification.families.hammerstein.yardstick import yardstick_of
from hyst.identification.families.hammerstein.yardstick_told import lowered
from hyst.identification.record_use.overview import Overview
from hyst.identification.result.fit_spread import FitSpread, spread_of_fit
from hyst.identification.result.identified import Identified
from hyst.models import LinearDynamics, StableInverse
from hyst.signals import Record

Array = NDArray[np.float64]


def identified_with_dynamics(
    identified: Identified, fit: Fit, front: Family, overview: Overview, fir_order: int | str
) -> IdentifiedHammerstein:
    """Add to a result what only hysteresis with dynamics has.

    Parameters
    ----------
    identified
        The result as every family has it.
    fit
        The final fit, in the user's units.
    front
        Family of the hysteresis.
    overview
        The records.
    fir_order
        Last lag of the impulse response, or ``"auto"``.
    """
    records = overview.data.records
    dynamics = dynamics_of(fit)
    markov, _ = choose_markov(records, fir_order)
    first = realized(markov, dynamics.delay, dynamics.dt, dynamics.order)
    inverse, reason = inverse_of(dynamics)
    if first.stabilized:
        reason += ("the realization was not stable and was replaced by a stable one",)
    spread = spread_of_fit(overview.data, fit)
    poles, pole_errors = _poles(dynamics, fit, spread)
    yardstick = yardstick_of(fit, overview.data)
    known = vars(identified) | {
        "undetermined": identified.undetermined + reason,
        "verdict": lowered(identified.verdict, yardstick, records[0].output_unit),
    }
    return IdentifiedHammerstein(
        **known,
        hysteresis=joint_of(fit).hysteresis(fit.solution.theta),
        dynamics=dynamics,
        first_dynamics=first.dynamics,
        markov=markov,
        singular_values=first.singular_values,
        hankel_noise=first.noise_level,
        poles=poles,
        pole_standard_errors=pole_errors,
        inverse_of_dynamics=inverse,
        loop=_loop(records[0], inverse, spread.noise_rms),
        front=front,
        noise_rms=spread.noise_rms,
        yardstick=yardstick,
    )


def _poles(
    dynamics: LinearDynamics, fit: Fit, spread: FitSpread
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    parametrization, n = joint_of(fit), dynamics.order
    by_theta = np.zeros((2 * n, parametrization.size))
    by_theta[:, parametrization.front.size :] = poles_by_theta(
        dynamics, parametrization.feedthrough
    )
    values, errors = poles_as_numbers(dynamics), spread.of(by_theta)
    errors[~by_theta.any(axis=1)] = 0.0  # a real pole stays real
    return values[:n] + 1j * values[n:], errors[:n] + 1j * errors[n:]


def _loop(record: Record, inverse: StableInverse | None, noise_rms: float) -> Loop:
    """Give the loop without a model of it, with the band in which noise keeps it."""
    if inverse is None:
        return Loop(record.u, record.y, slice(0, 0), float("nan"))
    band = 2.0 * noise_rms * inverse.noise_gain
    return Loop(record.u, inverse(record.y), inverse.valid(len(record)), band)
