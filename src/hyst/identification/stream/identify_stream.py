"""Identification from a record that stays in its file.

Everything but the constants is found on the part of it that shows most of the input's range, in
memory; then the constants are fitted to every sample. What was judged on which samples is said.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Fit
from hyst.identification.fit.bounded_least_squares import (
    CONVERGED,
    LEAST_DAMPING,
    minimize,
    projected_step,
)
from hyst.identification.fit.curvature import Curvature
from hyst.identification.progress import Progress
from hyst.identification.record_use.used_samples import UsedSamples
from hyst.identification.result.fit_spread import FitSpread, spread_from_sums
from hyst.identification.result.identified import Identified
from hyst.identification.result.part_of_file import PartOfFile
from hyst.identification.stream.fit_of_all import ErrorsOfAll, FitOfAll
from hyst.identification.stream.settling import TOLERANCE, Settled, settle
from hyst.identification.stream.survey import Survey, data_hash, part_of, survey
from hyst.operators import Verdict
from hyst.operators.description import errors_of
from hyst.signals import Record
from hyst.signals.record_stream import RecordStream

Array = NDArray[np.float64]

MOST_STEPS = 60

SECANTS = (8.0, 24.0, 72.0)
"""Standard errors that secants by radii reach to either side, the widest last: where the first lead
to an end no other is asked, for what they pass over biases the weights of small plays."""

WORTH_SAYING = 0.3
"""Standard errors by which constants may be off without a word."""

WORSE = 1.1
"""Times the rms over the part: more over all samples is said, and makes the model fair at best."""

COVERS = 0.95

UNTIL_FIT_OF_ALL = 0.5
"""Share of the way that identification from the part in memory is said to be."""


def identify_stream(
    stream: RecordStream, identify: Callable[[Record], Identified], say: Progress
) -> Identified:
    """Identify a model from a record in a file.

    Parameters
    ----------
    stream
        The record.
    identify
        Identifies from a record in memory.
    say
        Told when the fit to all samples begins.

    Raises
    ------
    InputError
        If a sample is not finite; its index is named.
    NotIdentifiableError
        If the record is constant, or holds what cannot be fitted sample by sample from a file, as
        drift or a delay by parts of a sample.
    SolverError
        If the fit to the part did not converge. That to all samples is ended after so many ways
        through them, and what is then left to go is part of the standard errors.
    """
    found = survey(stream)
    before = identify(part_of(stream, found.part))
    if found.part.stop - found.part.start == found.samples:
        return before
    fit = before.bands.fit
    _require_servable(before, fit)
    say(f"fit to all {found.samples} samples", UNTIL_FIT_OF_ALL)
    late = round(before.delay)
    across, own = _across(before, found.samples), fit.parametrization
    ways = [FitOfAll(stream, found, own, late)]
    if across.any():
        ways += [FitOfAll(stream, found, own, late, each * across) for each in SECANTS]
    ended = _fitted(fit, ways, tuple(np.flatnonzero(across).tolist()))
    fit = replace(fit, solution=ended.solution)
    return _with_fit(before, fit, ways[1 + ended.by], found, stream, ended.left)


def _across(before: Identified, samples: int) -> Array:
    """Give the standard errors that radii will have in a fit to all samples; 0 for the others."""
    bands = before.bands
    parametrization, spread = bands.fit.parametrization, bands.spread
    errors, across = np.zeros(parametrization.size), np.zeros(parametrization.size)
    own = np.eye(parametrization.size)[spread.inside]
    errors[spread.inside] = spread.of_what_is_determined(own)
    radii = list(parametrization.radii)
    part = before.metrics["training"].samples
    across[radii] = errors[radii] * math.sqrt(part / samples)
    return across


def _fitted(fit: Fit, ways: Sequence[FitOfAll], rough: tuple[int, ...]) -> Settled:
    """Fit to all samples, beginning at the fit to a part."""
    posed, theta, back = fit.family.in_own_coordinates(ways[0].problem(), fit.solution.theta)
    if rough:
        secants = [each.problem() for each in ways[1:]]
        return settle(posed, secants, theta, rough, MOST_STEPS)
    found, left = minimize(posed, theta, MOST_STEPS, TOLERANCE, curvature=Curvature()), 0.0 * theta
    if found.status != CONVERGED:
        normal = posed.normal_equations(found.theta)
        left = projected_step(posed, found.theta, normal, LEAST_DAMPING)[0]
    left = back(found.theta + left) - back(found.theta)
    return Settled(replace(found, theta=back(found.theta)), left, by=-1)


def _require_servable(before: Identified, fit: Fit) -> None:
    if fit.family.depends_on_rate:
        raise NotIdentifiableError(
            f"{before.family!r} depends on the rate and is not fitted over a file; load a part of "
            "the record and identify from that"
        )
    if fit.parametrization.nuisances is not None:
        raise NotIdentifiableError(
            "the record holds drift or what settles beside the model, which is not fitted over a "
            "file; load a part of it and identify from that, or give creep=None and drift=False"
        )
    if any(each.left_out for each in before.used):
        raise NotIdentifiableError(
            "the record holds samples that are no measurements, which a fit over a file would "
            "count; leave them out of the file, or load a part of it and identify from that"
        )
    if "training, disturbances left in" in before.metrics:
        raise NotIdentifiableError(
            "the record holds drift or sines that are none of its drive, which are not taken out "
            "over a file; give drift=False, or load a part of it and identify from that"
        )
    if before.delay != round(before.delay):
        raise NotIdentifiableError(
            f"the output lags by {before.delay:.3g} samples, and a record in a file is fitted with "
            "whole samples only; give delay"
        )


def _with_fit(
    before: Identified,
    fit: Fit,
    whole: FitOfAll,
    found: Survey,
    stream: RecordStream,
    step: Array,
) -> Identified:
    """Put the fit to all samples in the place of that to a part."""
    theta, estimates = fit.solution.theta, fit.family.estimates(fit)
    left = ErrorsOfAll(whole.errors(theta))
    sums = whole.sums(theta, fit.parametrization.inside(theta), left)
    spread = spread_from_sums(sums, fit, found.y_spread)
    notes = (*_about(found), *_unfinished(fit, step, spread))
    spread = replace(spread, moves=step[spread.inside, None])
    errors, apart = np.full(len(estimates.names), np.nan), tuple[str, ...]()
    if fit.family.estimates_noise:
        errors, apart = spread.of(estimates.by_theta), spread.not_told_apart(estimates)
    span = found.y_high - found.y_low
    metrics = dict(before.metrics) | {
        "training": left.metrics(found.y_spread, span, found.samples, free=False),
        "training, free offset": left.metrics(found.y_spread, span, found.samples, free=True),
    }
    late = round(before.delay)
    stop = found.samples + min(late, 0)
    used = UsedSamples(stop - whole.samples, stop, found.samples)
    notes = tuple(dict.fromkeys((*notes, *before.undetermined, *apart)))
    verdict = _verdict(before, metrics["training"].rms, found, fit.solution.status == CONVERGED)
    about = replace(
        before.description,
        input_low=found.u_low,
        input_high=found.u_high,
        output_low=found.y_low,
        output_high=found.y_high,
        verdict=verdict,
        errors=errors_of(metrics),
    )
    if about.provenance is not None:
        about = replace(about, provenance=replace(about.provenance, data_sha256=data_hash(stream)))
    return replace(
        before,
        model=fit.operator.with_description(about),
        parameter_names=estimates.names,
        parameter_values=estimates.values,
        standard_errors=errors,
        undetermined=notes,
        metrics=metrics,
        status=fit.solution.status,
        iterations=fit.solution.iterations,
        used=(used,),
        part=PartOfFile(found.part.start, found.part.stop, before.used[0]),
        description=about,
        verdict=verdict,
        bands=replace(before.bands, fit=fit, spread=spread),
        per_record=(
            replace(before.per_record[0], samples=whole.samples, metrics=metrics["training"]),
        ),
    )


def _about(found: Survey) -> tuple[str, ...]:
    part = found.part
    return (
        f"family, size, delay and what else is told were found on samples {part.start} to "
        f"{part.stop - 1}, which cover {100.0 * found.part_covers:.0f} % of the input's range; the "
        f"constants, their standard errors and the training errors are of all {found.samples}; "
        "errors over other records are those of the fit to that part",
    )


def _unfinished(fit: Fit, step: Array, spread: FitSpread) -> tuple[str, ...]:
    """Say by how much a further step would move the constants, where it is worth saying."""
    own = np.eye(step.size)[spread.inside]
    errors, move = spread.of_what_is_determined(own), np.abs(step[spread.inside])
    most = float(np.max(move / np.where(errors > 0.0, errors, np.inf), initial=0.0))
    if fit.solution.status == CONVERGED and most < WORTH_SAYING:
        return ()
    return (
        f"the fit to all samples ended ({fit.solution.status}) after {fit.solution.iterations} "
        f"steps where a further one moves constants by up to {most:.2g} of the standard errors of "
        "their noise; the standard errors told count that move",
    )


def _verdict(before: Identified, rms: float, found: Survey, converged: bool) -> Verdict:
    """Lower the verdict where all samples are described worse than the part, or not to the end."""
    part = before.metrics["training"].rms
    level, sentences = before.verdict.level, before.verdict.sentences
    judged = (
        f"Judged on {found.part.stop - found.part.start} of {found.samples} samples, fitted to all."
    )
    if not converged:
        level = "unfit" if level == "unfit" else "fair"
        sentences = ("The fit to all samples has not settled.", *sentences)
    if rms > WORSE * part or found.part_covers < COVERS:
        level = "unfit" if level == "unfit" else "fair"
        return Verdict(
            level,
            (
                f"Over all samples the model leaves {rms:.3g} rms, over those it was judged on "
                f"{part:.3g}, which cover {100.0 * found.part_covers:.0f} % of the input's range.",
                *sentences,
                judged,
            ),
        )
    return Verdict(level, (*sentences, judged))
