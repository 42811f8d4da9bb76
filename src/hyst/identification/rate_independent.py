"""Identify a rate-independent model: delay, family, size and constants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, SolverError
from hyst.identification.assembly import assemble
from hyst.identification.bounded_least_squares import CONVERGED
from hyst.identification.data import Data, prepare
from hyst.identification.delay import refine_delay
from hyst.identification.families import WITHOUT_PLAYS
from hyst.identification.fitting import AUTO, MOST_STARTS, Fit, Fitter
from hyst.identification.identified import Candidate, Identified
from hyst.identification.options import (
    Options,
    as_delay,
    as_families,
    as_knots,
    as_radii,
    as_rule,
    as_sizes,
    require_samples,
    within_reach,
)
from hyst.identification.selection import compare, simplest_good
from hyst.identification.thinning import thinned
from hyst.signals import Record

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Found:
    """A final fit to thinned records, and what it was chosen from.

    Parameters
    ----------
    fit
        The fit.
    plays
        Plays asked for or chosen; the fit may have fewer.
    candidates
        What was compared; empty if there was nothing to choose.
    """

    fit: Fit
    plays: int
    candidates: tuple[Candidate, ...]


def identify_rate_independent(
    records: tuple[Record, ...], family: str, options: Options
) -> Identified:
    """Identify ``linear``, ``pi``, ``gpi``, ``mpi`` or ``ramberg-osgood``, or choose among them.

    Long records are searched in thinned form; the last fit takes every sample. An automatic delay
    is estimated before the family is known, and judged again by the family.

    Parameters
    ----------
    records
        The training records.
    family
        As of ``identify``.
    options
        Its other arguments.

    Returns
    -------
    Identified

    Raises
    ------
    InputError, NotIdentifiableError, SolverError
        As ``identify``.
    """
    radii = None if options.radii is None else as_radii(options.radii)
    families, sizes = as_families(family, radii), as_sizes(options.plays, radii)
    data = prepare(records, options.start, 0)
    options.say("delay")
    data = data.delayed(as_delay(options.delay, data))
    radii, left_out = within_reach(radii, data)
    sizes = sizes if radii is None else (radii.size,)
    fitter = Fitter(
        data, as_knots(options.knots), radii, as_rule(options.weights), options.power_law
    )
    require_samples(data, families, sizes, options.knots)
    found = _search(fitter, families, sizes, options)
    if options.delay == AUTO and found.fit.family not in WITHOUT_PLAYS:
        delay = refine_delay(data, found.fit)
        if delay != data.delay:
            options.say("delay, judged by the family")
            fitter = replace(fitter, data=data.delayed(delay))
            found = _search(fitter, families, sizes, options)
    _require_sample_time(options.validation, fitter.data)
    fit = found.fit
    if thinned(fitter.data) is not fitter.data:
        options.say("final fit: all samples")
        polished = fitter.polish(fit, options.max_iterations)
        fit = _converged(_without_idle_plays(fitter, polished, options), found.plays, options)
    return assemble(fitter, fit, found.plays, found.candidates, options.validation, left_out)


def _search(
    fitter: Fitter, families: Sequence[str], sizes: Sequence[int], options: Options
) -> Found:
    """Choose family and size and fit it; the next best one if that fit does not converge."""
    thin = replace(fitter, data=thinned(fitter.data))
    if len(families) == 1 and (len(sizes) == 1 or families[0] in WITHOUT_PLAYS):
        plays = 0 if families[0] in WITHOUT_PLAYS else sizes[0]
        fit = _final_fit(thin, families[0], plays, options)
        return Found(_converged(fit, plays, options), plays, ())
    candidates = compare(thin, families, sizes, options.say)
    remaining = list(candidates)
    while True:
        chosen = simplest_good(remaining, float(np.ptp(thin.data.measured())))
        fit = _final_fit(thin, chosen.family, chosen.plays, options)
        if fit.solution.status == CONVERGED or len(remaining) == 1:
            marked = tuple(replace(each, chosen=each is chosen) for each in candidates)
            return Found(_converged(fit, chosen.plays, options), chosen.plays, marked)
        remaining.remove(chosen)


def _final_fit(fitter: Fitter, family: str, plays: int, options: Options) -> Fit:
    """Fit from all starts, across the kinks, and without plays that are idle."""
    options.say(f"final fit: {family} with {plays} plays" if plays else f"final fit: {family}")
    most = options.max_iterations
    fit = fitter.improve(fitter.fit(family, plays, MOST_STARTS, most), most)
    return _without_idle_plays(fitter, fit, options)


def _without_idle_plays(fitter: Fitter, fit: Fit, options: Options) -> Fit:
    """Fit again without the plays that came out idle, until none is."""
    while fitter.radii is None:
        working = _working_plays(fit, fitter.data)
        if working.all():
            break
        fit = fitter.refit(fit, working, options.max_iterations)
    return fit


def _converged(fit: Fit, plays: int, options: Options) -> Fit:
    if fit.solution.status != CONVERGED and not options.allow_unconverged:
        raise SolverError(
            f"the fit of {fit.family} with {plays} plays did not converge in "
            f"{fit.solution.iterations} iterations; raise max_iterations, give fewer plays, or "
            "accept it with allow_unconverged"
        )
    return fit


def _working_plays(fit: Fit, data: Data) -> NDArray[np.bool_]:
    """Tell which plays have a weight, and a radius of their own."""
    weights = fit.parametrization.weights(fit.solution.theta)
    r = fit.parametrization.radii(fit.solution.theta)
    apart = np.diff(r, prepend=-np.inf) > 1e-4 * data.half_range
    return np.asarray((np.abs(weights[1:]) > 1e-6 * np.abs(weights).max()) & apart)


def _require_sample_time(validation: Sequence[Record], data: Data) -> None:
    """Refuse to apply a delay in samples to records of another sample time."""
    dt = data.records[0].dt
    for number, record in enumerate(validation, 1):
        if data.delay and not np.isclose(record.dt, dt, rtol=1e-6, atol=0.0):
            raise InputError(
                f"validation record {number} has dt = {record.dt:.6g} s, the training records "
                f"{dt:.6g} s; the delay of {data.delay} samples means another time there, so give "
                "records of one sample time"
            )
