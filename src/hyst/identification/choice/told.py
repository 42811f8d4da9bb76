"""Sentences about a choice: where it is none, and what would settle it."""

from __future__ import annotations

from collections.abc import Sequence

from hyst.identification.choice.rivals import Rivals
from hyst.identification.choice.selection import Contender, as_good_as_best
from hyst.identification.families.family import Family

NOTABLE = 0.01
"""Of the output's range: differences that are worth a sentence."""

BEYOND_ERROR = 2.0
"""Times the error on left-out blocks, from which on a difference is worth a sentence."""

MORE = 1.4
"""Times the largest size that was tried, as a next one to try."""


def about_the_choice(
    chosen: Contender, contenders: Sequence[Contender], rivals: Rivals, scale: float
) -> tuple[str, ...]:
    """Say what a user should know of a choice.

    Parameters
    ----------
    chosen
        What was chosen.
    contenders
        All that were compared; none if there was nothing to choose.
    rivals
        What describes the records about as well.
    scale
        Output units of the user in one of the contenders.

    Returns
    -------
    tuple of str
    """
    apart = _apart(chosen, rivals)
    if len(contenders) < 2:
        return tuple(apart)
    alone = _one_amplitude(chosen) if not apart else []
    return (*_edge(chosen, contenders, scale), *apart, *alone, *_tie(chosen, contenders))


def _edge(chosen: Contender, contenders: Sequence[Contender], scale: float) -> list[str]:
    """Say that the largest size tried was chosen, while the error still fell."""
    sizes, size = chosen.family.sizes(), chosen.candidate.plays
    smaller = [
        each for each in contenders if each.family is chosen.family and each.candidate.plays < size
    ]
    if size != sizes[-1] or not smaller or "plays" not in chosen.family.options():
        return []
    before, more = smaller[-1], round(MORE * size)
    if chosen.score.rms >= before.score.rms:
        return []
    return [
        f"the error on left-out blocks still fell at the largest number of plays tried, from "
        f"{scale * before.score.rms:.4g} with {before.candidate.plays} plays to "
        f"{scale * chosen.score.rms:.4g} with {size}; more may do better: plays={more} "
        f"(--plays {more})"
    ]


def _apart(chosen: Contender, rivals: Rivals) -> list[str]:
    """Say that models of other kinds differ on minor loops, and what record would settle it."""
    error = chosen.score.rms / chosen.overview.output_range
    if rivals.apart <= max(NOTABLE, BEYOND_ERROR * error):
        return []
    *most, last = dict.fromkeys(kind_of(each.family) for each in rivals.fits)
    kinds = f"{', '.join(most)} and {last}" if most else last
    shown = (
        "these records do not settle it"
        if chosen.overview.shows_minor_loops
        else "records of one amplitude do not determine minor loops"
    )
    return [
        f"{kind_of(chosen.family)} was taken, but {kinds} could be right as well, and on minor "
        f"loops inside the range of the records they differ from it by up to "
        f"{100.0 * rivals.apart:.2g} % of the output's range (rms); {shown}, so record a drive of "
        "decaying amplitude (hyst excite --kind reversals) and give it as well"
    ]


def _one_amplitude(chosen: Contender) -> list[str]:
    """Say that blocks of a record of one amplitude are no independent witnesses."""
    if chosen.overview.shows_minor_loops or not chosen.family.has_memory:
        return []
    equal = "the strokes of the records are about equally long, so "
    if chosen.family.judged_in_sample:
        return [f"{equal}the errors by which sizes were compared say nothing of minor loops"]
    return [
        f"{equal}left-out blocks repeat what others show; the errors on them say nothing of minor "
        "loops"
    ]


def _tie(chosen: Contender, contenders: Sequence[Contender]) -> list[str]:
    """Say that another family predicts left-out blocks as well or better."""
    tied = [
        each
        for each in as_good_as_best(contenders)
        if each.family.name != chosen.family.name and each.score.rms <= chosen.score.rms
    ]
    names = list(dict.fromkeys(each.family.name for each in tied))
    if not names:
        return []
    verb = "predict" if len(names) > 1 else "predicts"
    return [
        f"{' and '.join(names)} {verb} left-out blocks as well as {chosen.family.name}; the one "
        "with fewer parameters was taken"
    ]


def kind_of(family: Family) -> str:
    """Name a family and the signs of its weights.

    Parameters
    ----------
    family
        The family.
    """
    name, signs = family.name, getattr(family, "weights", "")
    return f"{name} with {_SIGNS[signs]}" if signs in _SIGNS else name


_SIGNS = {
    "non-negative": "non-negative weights",
    "invertible": "weights of either sign",
}
