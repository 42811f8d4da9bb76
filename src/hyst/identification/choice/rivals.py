"""Models of other kinds that describe the records about as well as the one that is taken.

Models of one kind agree with each other whatever the truth is, so each kind counts once: a family
with one rule for the signs of its weights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from hyst.identification.choice.disagreement import disagreement
from hyst.identification.choice.selection import Contender, as_good_as_best
from hyst.identification.choice.sign_of_weights import Ruling, line_leaves, rms_left, tried
from hyst.identification.families.family import Fit

CREDIBLE = 0.25
"""Of what a line leaves beyond the model chosen: a model that leaves less of it describes the
records, and on one amplitude nothing speaks against what it says of others."""


ABOUT_AS_WELL = 1.2
"""Times what the model chosen leaves of a record with minor loops: so much may other signs."""


@dataclass(frozen=True, eq=False)
class Rivals:
    """What else describes the records about as well.

    Parameters
    ----------
    fits
        One of each kind, the best first.
    apart
        How far they are from the model taken on nested minor loops, as a share of the range of the
        output.
    """

    fits: tuple[Fit, ...]
    apart: float


def rivals_of(
    chosen: Contender, fit: Fit, contenders: Sequence[Contender], others: Sequence[Fit]
) -> Rivals:
    """Give what else describes the records about as well as what was chosen.

    Of records that show minor loops these are ties; of one amplitude all that describe it.

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
    if overview.shows_minor_loops:
        most = ABOUT_AS_WELL * rms_left(chosen.fit, overview)
        found = [each.fit for each in as_good_as_best(same)]
        found += [each for each in others if rms_left(each, overview) <= most]
    else:
        fits = [each.fit for each in same] + list(others)
        found = [each for each in fits if _describes(each, chosen)]
    kinds: dict[object, Fit] = {}
    for each in sorted(found, key=lambda one: rms_left(one, overview)):
        if each.family != chosen.family:
            kinds.setdefault(each.family, each)
    apart = disagreement(fit, list(kinds.values()), overview.data)
    return Rivals(tuple(kinds.values()), apart / overview.output_range)


def other_signs(ruling: Ruling, chosen: Contender) -> list[Fit]:
    """Give the families with the other signs of weights, each in the better of few sizes.

    Parameters
    ----------
    ruling
        The signs that were settled, and the others.
    chosen
        What was chosen: only families on the same records can be rivals of it.
    """
    same = [family for family, overview in ruling.others if overview is chosen.overview]
    return [
        min(tried(family, chosen.overview), key=lambda each: each.solution.cost) for family in same
    ]


def _describes(fit: Fit, chosen: Contender) -> bool:
    """Tell whether a fit leaves little of what a line leaves beyond the model chosen."""
    overview = chosen.overview
    least = rms_left(chosen.fit, overview)
    line = line_leaves(overview)
    return rms_left(fit, overview) <= least + CREDIBLE * max(line - least, 0.0)
