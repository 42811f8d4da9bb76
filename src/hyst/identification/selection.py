"""Choose family and number of plays."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from hyst.errors import NotIdentifiableError
from hyst.identification.cross_validation import cross_validate, fewest_left
from hyst.identification.families import KNOWN, WITHOUT_PLAYS
from hyst.identification.fitting import Fitter
from hyst.identification.identified import Candidate

SIZES = (1, 2, 3, 4, 6, 8, 10)
SMALLEST_GAIN = 1e-3
"""A larger model of the same family must lower the score by this share to be worth going on."""

ROUNDING = 1e-6
"""Scores below this share of the output range are equal: no sensor tells them apart."""


def compare(
    fitter: Fitter,
    families: Sequence[str],
    sizes: Sequence[int],
    progress: Callable[[str], None],
) -> tuple[Candidate, ...]:
    """Score families and sizes by blocked cross-validation.

    Sizes of a family are tried upwards until two in a row have not lowered the score, or until
    there are as many parameters as samples to fit them to.

    Parameters
    ----------
    fitter
        Fits families to the records.
    families
        Which families.
    sizes
        Which numbers of plays, ascending.
    progress
        Told what is being fitted.

    Returns
    -------
    tuple of Candidate
        From the simplest family to the richest, none of them chosen yet.

    Raises
    ------
    NotIdentifiableError
        If there are too few samples to judge any.
    """
    candidates: list[Candidate] = []
    refusals: list[NotIdentifiableError] = []
    for family in families:
        sizes_tried = (0,) if family in WITHOUT_PLAYS else sizes
        try:
            candidates += _grow(fitter, family, sizes_tried, progress)
        except NotIdentifiableError as refusal:  # one family less to compare
            refusals.append(refusal)
    if not candidates and refusals:
        raise refusals[0]
    if not candidates:
        raise NotIdentifiableError(
            f"{fitter.data.measured().size} samples can be used, too few to choose the number of "
            "plays by cross-validation; give a longer record or the number of plays"
        )
    return tuple(candidates)


def simplest_good(candidates: Sequence[Candidate], output_range: float) -> Candidate:
    """Give the simplest candidate within one standard error of the best.

    Simple means few free parameters; between equals the order of ``KNOWN`` decides.

    Parameters
    ----------
    candidates
        At least one.
    output_range
        Of the records, output units.

    Returns
    -------
    Candidate

    Notes
    -----
    Breiman et al., Classification and Regression Trees (1984), sec. 3.4.3: the one standard error
    rule.
    """
    best = min(candidates, key=lambda each: each.score)
    limit = max(best.score + best.standard_error, ROUNDING * output_range)
    good = [each for each in candidates if each.score <= limit]
    return min(good, key=lambda each: (each.parameters, KNOWN.index(each.family)))


def _grow(
    fitter: Fitter,
    family: str,
    sizes: Sequence[int],
    progress: Callable[[str], None],
) -> list[Candidate]:
    candidates: list[Candidate] = []
    best, idle = float("inf"), 0
    for plays in sizes:
        progress(f"{family} with {plays} plays" if plays else family)
        fit = fitter.fit(family, plays)
        size = fit.parametrization.size
        if size >= fewest_left(fitter.data.measured().size):
            break
        score = cross_validate(fitter.data, fit)
        candidates.append(
            Candidate(family, plays, size, score.rms, score.standard_error, chosen=False)
        )
        idle = 0 if score.rms < best * (1.0 - SMALLEST_GAIN) else idle + 1
        best = min(best, score.rms)
        if idle == 2:
            break
    return candidates
