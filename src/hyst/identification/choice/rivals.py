"""Models of other kinds that describe the records about as well as the one that is taken.

Models of one kind agree with each other whatever the truth is, so each kind counts once: a family
with one rule for the signs of its weights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hyst.identification.choice.cross_validation import fewest_left
from hyst.identification.choice.disagreement import disagreement
from hyst.identification.choice.selection import Contender, as_good_as_best, contender_of
from hyst.identification.choice.sign_of_weights import Ruling, rms_left, tried
from hyst.identification.families.family import Fit

CREDIBLE = 0.25
"""Of what a line leaves beyond the best model: with less, other signs are still a model of it."""


@dataclass(frozen=True, eq=False)
class Rivals:
    """What else describes the records about as well.

    Parameters
    ----------
    contenders
        One of each kind.
    apart
        How far they are from the model taken on nested minor loops, as a share of the range of the
        output.
    """

    contenders: tuple[Contender, ...]
    apart: float


def rivals_of(
    chosen: Contender, fit: Fit, contenders: Sequence[Contender], others: Sequence[Contender]
) -> Rivals:
    """Give what else describes the records about as well as what was chosen.

    Parameters
    ----------
    chosen
        What was chosen.
    fit
        Its final fit.
    contenders
        All that were compared.
    others
        With the other signs of weights, as of ``other_signs``.

    Returns
    -------
    Rivals
    """
    overview = chosen.overview
    if fit.family.depends_on_rate:
        return Rivals((), 0.0)
    same = [each for each in contenders if each.overview is overview]
    tied = [each for each in as_good_as_best(same) if each.family is not chosen.family]
    likely = [each for each in others if each is not chosen and credible(each, chosen)]
    kinds: dict[int, Contender] = {}
    for each in sorted([*tied, *likely], key=lambda one: one.score.rms):
        kinds.setdefault(id(each.family), each)
    found = tuple(kinds.values())
    apart = disagreement(fit, [each.fit for each in found], overview.data)
    return Rivals(found, apart / overview.output_range)


def safer(chosen: Contender, others: Sequence[Contender]) -> Contender:
    """Give the best with non-negative weights, if nothing speaks for the negative ones chosen.

    Parameters
    ----------
    chosen
        What was chosen.
    others
        With the other signs of weights.

    Returns
    -------
    Contender
    """
    good = [each for each in others if each.equals(chosen)]
    return min(good, key=lambda each: each.score.rms, default=chosen)


def other_signs(ruling: Ruling, chosen: Contender) -> list[Contender]:
    """Give the families with the other signs of weights, each in the better of few sizes.

    Parameters
    ----------
    ruling
        The signs that were settled, and the others.
    chosen
        What was chosen: only families on the same records can be rivals of it.
    """
    found = []
    for family, overview in ruling.others:
        if overview is not chosen.overview:
            continue
        fit = min(tried(family, overview), key=lambda each: each.solution.cost)
        if fit.parametrization.free_count >= fewest_left(overview):
            continue
        if rms_left(fit, overview) < CREDIBLE * line_leaves(chosen):
            found.append(contender_of(family, overview, fit))
    return found


def line_leaves(contender: Contender) -> float:
    """Give what a straight line leaves of the output, root mean square."""
    u, y = contender.overview.input, contender.overview.data.measured()
    u, y = u - u.mean(), y - y.mean()
    rest = y - u * float(u @ y) / float(u @ u)
    return float(np.sqrt(rest @ rest / rest.size))


def credible(rival: Contender, chosen: Contender) -> bool:
    """Tell whether other signs leave little of what a line leaves beyond the model chosen."""
    least = chosen.score.rms
    return rival.score.rms <= least + CREDIBLE * max(line_leaves(chosen) - least, 0.0)
