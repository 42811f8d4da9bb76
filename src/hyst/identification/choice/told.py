"""Sentences about a choice: where it is none, and what would settle it."""

from __future__ import annotations

from collections.abc import Sequence

from hyst.identification.choice.rivals import Rivals
from hyst.identification.choice.selection import Contender, as_good_as_best

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
    sentences = [*_edge(chosen, contenders, scale), *_apart(chosen, rivals)]
    if len(contenders) > 1 and not sentences:
        sentences += _tie(chosen, contenders)
    return tuple(sentences)


def _edge(chosen: Contender, contenders: Sequence[Contender], scale: float) -> list[str]:
    """Say that the largest size tried was chosen, while the error still fell."""
    sizes, size = chosen.family.sizes(), chosen.candidate.plays
    smaller = [
        each
        for each in contenders
        if each.family is chosen.family and each.candidate.plays < size
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
    kinds = ", ".join(dict.fromkeys(_kind(each) for each in rivals.contenders))
    shown = (
        "the records do not settle which of them is right"
        if chosen.overview.shows_minor_loops
        else "the records show one amplitude, which does not determine minor loops"
    )
    return [
        f"{_kind(chosen)} was taken, but {kinds} describes the records about as well, and on minor "
        f"loops inside their range the models differ by {100.0 * rivals.apart:.2g} % of the "
        f"output's range (rms); {shown}: record a drive of decaying amplitude (hyst excite --kind "
        "reversals) and give it as well"
    ]


def _tie(chosen: Contender, contenders: Sequence[Contender]) -> list[str]:
    """Say that another family predicts left-out blocks as well."""
    tied = [
        each
        for each in as_good_as_best(contenders)
        if each.family is not chosen.family and each.score.rms <= chosen.score.rms
    ]
    names = dict.fromkeys(each.family.name for each in tied)
    if not names:
        return []
    return [
        f"{' and '.join(names)} predicts left-out blocks as well as {chosen.family.name}; the "
        "simpler one was taken"
    ]


def _kind(contender: Contender) -> str:
    signs = getattr(contender.family, "weights", "")
    return f"{contender.family.name} with {_SIGNS[signs]}" if signs in _SIGNS else (
        contender.family.name
    )


_SIGNS = {
    "non-negative": "non-negative weights",
    "invertible": "weights of either sign",
}
