"""Choose family and size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from hyst.errors import NotIdentifiableError, SolverError
from hyst.identification.choice.cross_validation import (
    Score,
    cross_validate,
    fewest_left,
    leaves_white_noise,
    score_in_sample,
)
from hyst.identification.choice.fewer_samples import for_a_look, look_at
from hyst.identification.choice.fits_from_starts import first_fit
from hyst.identification.families.family import Family, Fit
from hyst.identification.progress import Progress
from hyst.identification.record_use.overview import Overview
from hyst.identification.result.identified import Candidate

SMALLEST_GAIN = 1e-3
"""A larger model of the same family must lower the score by this share to be worth going on."""

EQUAL = 0.02
"""Scores that differ by this share are equal, however sure the difference is."""

REPEATED, NEGLIGIBLE = 0.15, 1e-3
"""On one amplitude left-out blocks repeat others, which makes the least difference sure and says
nothing of another drive: mean squares are equal, too, that differ by less than this share, and by
less than the square of this share of the output's range."""

ROUNDING = 1e-6
"""Scores below this share of the output range are equal: no sensor tells them apart."""

NEAR = 1.2
"""Times the rms of the best so far: what leaves more from its best guess is not scored."""

CLEARLY = 1.2
"""Times that, from which on few samples tell that it is not near."""


@dataclass(frozen=True, eq=False)
class Contender:
    """A family, the records it is fitted to, and one of its sizes with its score.

    Parameters
    ----------
    family, overview
        The family and its records.
    candidate
        Size and score.
    fit
        Of all samples, from one start.
    score
        On left-out blocks.
    """

    family: Family
    overview: Overview
    candidate: Candidate
    fit: Fit
    score: Score

    def equals(self, other: Contender) -> bool:
        """Tell whether the left-out blocks do not show that it is worse than another one.

        Parameters
        ----------
        other
            A better one, of the same records.
        """
        if self.family.judged_in_sample and other.family.judged_in_sample:
            return self.score.rms <= other.score.rms  # every number has earned its place
        output_range, least = self.overview.output_range, other.score.rms
        negligible = 0.0
        if not self.overview.shows_minor_loops:
            negligible = min(REPEATED * least**2, (NEGLIGIBLE * output_range) ** 2)
        equal = max((1.0 + EQUAL) * least, ROUNDING * output_range)
        return self.score.rms <= equal or not self.score.seems_worse(other.score, negligible)


def compare(
    families: Sequence[tuple[Family, Overview]], progress: Progress
) -> tuple[tuple[Contender, ...], tuple[str, ...]]:
    """Score families and sizes by cross-validation.

    Sizes of a family are tried upwards until two in a row have not lowered the score, or until
    there are as many parameters as samples to fit them to.

    Parameters
    ----------
    families
        Each with its records.
    progress
        Told what is being fitted.

    Returns
    -------
    tuple of Contender
        From the simplest family to the richest, none of them chosen yet.
    tuple of str
        Sentences about families that cannot be fitted.

    Raises
    ------
    NotIdentifiableError
        If there are too few samples to judge any, or no family can be fitted.
    """
    contenders: list[Contender] = []
    refusals: dict[str, NotIdentifiableError] = {}
    for k, (family, overview) in enumerate(families):
        try:
            contenders += _grow(family, overview, _share(progress, k, len(families)))
        except NotIdentifiableError as refusal:  # one family less to compare
            refusals[family.name] = refusal
    if not contenders and refusals:
        raise next(iter(refusals.values()))
    if not contenders:
        samples = families[0][1].data.measured().size
        raise NotIdentifiableError(
            f"{samples} samples can be used, too few to choose the number of plays by "
            "cross-validation; give a longer record or the number of plays"
        )
    return tuple(contenders), not_compared(refusals)


def in_reserve(
    families: Sequence[tuple[Family, Overview]], chosen: Contender, progress: Progress
) -> tuple[Contender, ...]:
    """Score families that come near to what was chosen so far.

    Parameters
    ----------
    families
        Each with its records.
    chosen
        The best so far: what leaves far more of the records from its best guess than it, or than
        a family scored before, is no candidate, and is not scored.
    progress
        Told what is being fitted.

    Returns
    -------
    tuple of Contender
        From the simplest family to the richest; those that cannot be fitted are left out.
    """
    contenders: list[Contender] = []
    for k, (family, overview) in enumerate(families):
        largest = family.sizes()[-1]
        own = _share(progress, k, len(families))
        own(family.named_size(largest), 0.0)
        try:
            if _comes_near(family, overview, largest, _most(chosen, contenders)):
                contenders += _grow(family, overview, own)
        except (NotIdentifiableError, SolverError):
            continue
    return tuple(contenders)


def _most(chosen: Contender, contenders: Sequence[Contender]) -> float:
    """Give the mean square up to which a family is scored.

    Of records with minor loops a family whose best fit leaves more than another one misses of what
    it has not seen is no tie with that one. Of strokes of one amplitude it may be a rival.
    """
    most = _left(chosen.fit, chosen.overview)
    if chosen.overview.shows_minor_loops:
        missed = (max(each.score.rms**2, _left(each.fit, each.overview)) for each in contenders)
        most = min([most, *missed])
    return NEAR**2 * most


def _comes_near(family: Family, overview: Overview, size: int, most: float) -> bool:
    """Tell whether a family leaves hardly more than a mean square."""
    fewer = for_a_look(overview)
    if family.is_linear or fewer is overview:
        return _left(first_fit(family, overview, size), overview) <= most
    look = look_at(family, fewer, size, CLEARLY**2 * most)
    near = _left(look, fewer)
    if size or near > CLEARLY**2 * most:
        return near <= most

    def to_all() -> Fit:
        problem = look.problem(overview.data, overview.kept)
        return replace(look, solution=family.solve(problem, look.solution.theta, 100))

    return _left(overview.once(("first fit", family, size), to_all), overview) <= most


def _left(fit: Fit, overview: Overview) -> float:
    kept = overview.kept
    return fit.solution.cost / (overview.input.size if kept is None else int(kept.sum()))


def not_compared(refusals: Mapping[str, NotIdentifiableError]) -> tuple[str, ...]:
    """Say which families are left out of a comparison, and why."""
    return tuple(f"{name} is not compared: {why}" for name, why in refusals.items())


def as_good_as_best(contenders: Sequence[Contender]) -> list[Contender]:
    """Give those that the left-out blocks do not tell from the best: a tie.

    Parameters
    ----------
    contenders
        At least one.

    Returns
    -------
    list of Contender
        In their order, the best among them.
    """
    best = min(contenders, key=lambda each: each.score.rms)
    return [each for each in contenders if each is best or each.equals(best)]


def simplest_good(contenders: Sequence[Contender]) -> Contender:
    """Give the simplest contender within one standard error of its difference to the best.

    Simple means few free parameters; between equals the earlier is taken, so families must come
    from the simplest to the richest. Of records of one amplitude the simplest family is taken and
    then its size: a map that such records do not ask for bends the smaller loops all the same.

    Parameters
    ----------
    contenders
        At least one.

    Returns
    -------
    Contender

    Notes
    -----
    Breiman et al., Classification and Regression Trees (1984), sec. 3.4.3: the one standard error
    rule, here of paired differences.
    """
    tied = as_good_as_best(contenders)
    if not tied[0].overview.shows_minor_loops:
        tied = [each for each in tied if each.candidate.family == tied[0].candidate.family]
    return min(tied, key=lambda each: each.candidate.parameters)


def first_contender(family: Family, overview: Overview, size: int) -> Contender:
    """Score the first fit of a size on left-out blocks, once for all who ask.

    Parameters
    ----------
    family, overview
        The family and its records.
    size
        One of its sizes.
    """
    return overview.once(
        ("first contender", family, size),
        lambda: contender_of(family, overview, first_fit(family, overview, size)),
    )


def contender_of(family: Family, overview: Overview, fit: Fit) -> Contender:
    """Score a fit on left-out blocks.

    Parameters
    ----------
    family, overview
        The family and its records.
    fit
        Of all samples.
    """
    score_of = score_in_sample if family.judged_in_sample else cross_validate
    score = score_of(overview, fit)
    candidate = Candidate(
        family.name,
        fit.size,
        fit.parametrization.free_count,
        score.rms,
        score.standard_error,
        chosen=False,
    )
    return Contender(family, overview, candidate, fit, score)


def _grow(family: Family, overview: Overview, progress: Progress) -> list[Contender]:
    found: list[Contender] = []
    best, idle = float("inf"), 0
    sizes = family.sizes()
    for k, size in enumerate(sizes):
        progress(family.named_size(size), k / len(sizes))
        fit = first_fit(family, overview, size)
        if fit.parametrization.free_count >= fewest_left(overview):
            break
        contender = first_contender(family, overview, size)
        found.append(contender)
        score = contender.score.rms
        gain = 0.0 if family.judged_in_sample else SMALLEST_GAIN
        idle = 0 if score < best * (1.0 - gain) else idle + 1
        best = min(best, score)
        if idle == 2 or (idle == 1 and _nothing_is_left(family, overview, fit)):
            break
    return found


def _share(progress: Progress, k: int, count: int) -> Progress:
    return progress.part(k / count, (k + 1) / count)


def _nothing_is_left(family: Family, overview: Overview, fit: Fit) -> bool:
    """Tell whether a fit behind dynamics leaves white noise, and the record could show more.

    Drives of one amplitude hardly show one play more, or less, than there are.
    """
    if not family.judged_in_sample or not overview.shows_minor_loops:
        return False
    return leaves_white_noise(overview, fit)
