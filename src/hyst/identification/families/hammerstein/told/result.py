"""From a fit of hysteresis and dynamics to the result: parts, impulse response, poles, loop."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.family import Family, Fit
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import (
    inverse_of,
    realized,
)
from hyst.identification.families.hammerstein.impulse_response.markov import (
    MarkovParameters,
    markov_if_excited,
)
from hyst.identification.families.hammerstein.impulse_response.realization import Realization
from hyst.identification.families.hammerstein.joint import dynamics_of, joint_of
from hyst.identification.families.hammerstein.told.dynamics_words import not_determined, verdict_on
from hyst.identification.families.hammerstein.told.identified_hammerstein import (
    IdentifiedHammerstein,
    Loop,
)
from hyst.identification.families.hammerstein.told.kept_errors import kept_errors
from hyst.identification.families.hammerstein.told.known_dynamics import (
    KnownDynamics,
    known_dynamics,
)
from hyst.identification.families.hammerstein.told.marginal import without_marginal
from hyst.identification.families.hammerstein.told.slope_error import slope_error_of
from hyst.identification.families.hammerstein.yardstick.yardstick import (
    stretches_of,
    yardstick,
)
from hyst.identification.families.hammerstein.yardstick.yardstick_told import lowered
from hyst.identification.families.option import AUTO
from hyst.identification.record_use.overview import Overview
from hyst.identification.result.fit_spread import spread_of_fit
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
    inverse, reason = inverse_of(dynamics)
    markov = None if joint_of(fit).held else markov_if_excited(records, fir_order)
    first = _realization(markov, dynamics)
    if first is not None and first.stabilized and fir_order != AUTO:
        reason += ("the realization was not stable and was replaced by a stable one",)
    spread = spread_of_fit(overview.data, fit)
    known = known_dynamics(fit, overview.data, spread)
    poles, pole_errors = _poles(known)
    stretches = stretches_of(fit, overview.data)
    left = yardstick(stretches, dynamics)
    verdict = lowered(identified.verdict, left, records[0].output_unit)
    errors = kept_errors(known, stretches, slope_error_of(fit, overview.data, spread))
    about = replace(identified.description, dynamics_errors=errors)
    taken = vars(identified) | {
        "description": about,
        "undetermined": identified.undetermined + reason + not_determined(known),
        "verdict": without_marginal(verdict_on(verdict, known), dynamics, records),
    }
    return IdentifiedHammerstein(
        **taken,
        hysteresis=joint_of(fit).hysteresis(fit.solution.theta),
        dynamics=dynamics,
        first_dynamics=None if first is None else first.dynamics,
        markov=markov,
        singular_values=np.zeros(0) if first is None else first.singular_values,
        hankel_noise=float("nan") if first is None else first.noise_level,
        poles=poles,
        pole_standard_errors=pole_errors,
        dynamics_are_given=joint_of(fit).held,
        inverse_of_dynamics=inverse,
        loop=_loop(records[0], inverse, spread.noise_rms),
        front=front,
        noise_rms=spread.noise_rms,
        known=known,
        yardstick=left,
    )


def _realization(markov: MarkovParameters | None, dynamics: LinearDynamics) -> Realization | None:
    """Give the paper's first dynamics of the order that was found, where there are any."""
    if markov is None:
        return None
    try:
        return realized(markov, dynamics.delay, dynamics.dt, dynamics.order)
    except (InputError, NotIdentifiableError):
        return None


def _poles(known: KnownDynamics) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Give all poles, of pairs both, with standard errors of real and imaginary parts."""
    values: list[complex] = []
    errors: list[complex] = []
    for each in known.poles:
        both = (each.value, each.value.conjugate()) if each.is_pair else (each.value,)
        values += both
        errors += [each.standard_error] * len(both)
    found = np.array(values, dtype=np.complex128)
    order = np.lexsort((found.imag, found.real))
    return found[order], np.array(errors, dtype=np.complex128)[order]


def _loop(record: Record, inverse: StableInverse | None, noise_rms: float) -> Loop:
    """Give the loop without a model of it, with the band in which noise keeps it."""
    if inverse is None:
        return Loop(record.u, record.y, slice(0, 0), float("nan"))
    band = 2.0 * noise_rms * inverse.noise_gain
    return Loop(record.u, inverse(record.y), inverse.valid(len(record)), band)
