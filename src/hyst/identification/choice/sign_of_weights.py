"""What the signs of the weights of plays may be, settled for all families before they compete.

Negative weights can imitate the loop of almost anything that was driven over one amplitude only,
and then say what they like about the loops inside it. So of a record that shows no minor loops
they must explain what nothing else does. Where they pay at all (``negative_weights_pay``), what
they explain beyond non-negative ones is compared with what maps of input or output explain of it:

    share = (plain - mapped) / (plain - free)

with what a fine bank with non-negative weights leaves (plain), the best family with non-negative
weights (mapped) and a fine bank with weights of either sign (free). Loops that bend, saturate or
switch are explained by maps as well (0.8 to 1 on simulated ones), loops that are stiff after a
reversal, as friction's, by negative weights alone (0 to 0.1); see ``benchmarks.choice``. A record
that shows minor loops judges by left-out ones, and keeps non-negative weights if they do as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hyst.identification.choice.cross_validation import fewest_left
from hyst.identification.choice.fits_from_starts import first_fit
from hyst.identification.choice.selection import first_contender
from hyst.identification.families.family import Family, Fit
from hyst.identification.families.plays import fine_weights, negative_weights_pay
from hyst.identification.fit.weight_rules import INVERTIBLE, NON_NEGATIVE
from hyst.identification.record_use.overview import Overview

SAID_BY_MAPS = 0.5
"""Where maps explain this share of what negative weights do, non-negative ones are kept."""

NEXT_TO_NOTHING = 0.05
"""Of what a line leaves and negative weights explain: not worth them."""

WORTH_IT = 0.8
"""Negative weights must lower the error on left-out minor loops below this share of it."""

MOST_OF_IT = 0.5
"""Or non-negative ones explain less than this share of what a line leaves and these explain."""

TRIED = (4, 8)
"""Sizes of the families that are tried."""


@dataclass(frozen=True, eq=False)
class Ruling:
    """Families with the signs of their weights settled.

    Parameters
    ----------
    families
        As they compete.
    others
        The same with the other signs, as far as these were worth a thought; none otherwise.
    """

    families: tuple[tuple[Family, Overview], ...]
    others: tuple[tuple[Family, Overview], ...]


def ruled(families: Sequence[tuple[Family, Overview]]) -> Ruling:
    """Settle what the signs of weights may be, the same for all families where it is open.

    Parameters
    ----------
    families
        Each with its records.

    Returns
    -------
    Ruling
    """
    asked = [each for each in families if each[0].rules()]
    if not asked:
        return Ruling(tuple(families), ())
    overview = asked[0][1]
    if not negative_weights_pay(overview):
        return Ruling(_under(families, NON_NEGATIVE), ())
    if overview.shows_minor_loops:
        free = _missed(asked, overview)
    else:
        free = not _described(overview) and _said_by_maps(asked, overview) < SAID_BY_MAPS
    rule, other = (INVERTIBLE, NON_NEGATIVE) if free else (NON_NEGATIVE, INVERTIBLE)
    return Ruling(_under(families, rule), _under(asked, other))


def _under(
    families: Sequence[tuple[Family, Overview]], rule: str
) -> tuple[tuple[Family, Overview], ...]:
    return tuple(
        (family.under(rule) if family.rules() else family, overview)
        for family, overview in families
    )


def _missed(families: Sequence[tuple[Family, Overview]], overview: Overview) -> bool:
    """Tell whether left-out parts of the records miss negative weights."""
    safe, free = (
        min(
            (fit for family, _ in families for fit in tried(family.under(rule), overview)),
            key=lambda each: each.solution.cost,
        )
        for rule in (NON_NEGATIVE, INVERTIBLE)
    )
    if max(each.parametrization.free_count for each in (safe, free)) >= fewest_left(overview):
        return True
    judged = [first_contender(each.family, overview, each.size) for each in (safe, free)]
    if judged[0].equals(judged[1]):
        return False
    line = line_leaves(overview)
    explained, could_be = line - rms_left(safe, overview), line - rms_left(free, overview)
    pays = judged[1].score.rms < WORTH_IT * judged[0].score.rms
    return pays or explained < MOST_OF_IT * could_be


def _described(overview: Overview) -> bool:
    """Tell whether plays with non-negative weights leave next to nothing of the loop."""
    plain, free = (fine_weights(overview, rule).rms for rule in (NON_NEGATIVE, INVERTIBLE))
    return plain - free < NEXT_TO_NOTHING * (line_leaves(overview) - free)


def _said_by_maps(families: Sequence[tuple[Family, Overview]], overview: Overview) -> float:
    """Give which share of what negative weights explain is explained without them."""
    plain, free = (fine_weights(overview, rule).rms for rule in (NON_NEGATIVE, INVERTIBLE))
    by_maps = [
        rms_left(fit, overview)
        for family, _ in families
        if "knots" in family.options()  # the fine bank is as good as any plays alone
        for fit in tried(family.under(NON_NEGATIVE), overview)
    ]
    mapped = min([plain, *by_maps])
    return (plain - mapped) / (plain - min(free, mapped))


def tried(family: Family, overview: Overview) -> list[Fit]:
    """Fit a family in a small and a large size, or in the one that is asked for.

    Parameters
    ----------
    family
        The family.
    overview
        The records.

    Returns
    -------
    list of Fit
        Sizes with as many parameters as samples are left out, unless there are no others.
    """
    known = family.sizes()
    sizes = [size for size in TRIED if size in known] or [known[0]]
    samples = overview.input.size
    sizes = [size for size in sizes if 2 * family.least_parameters(size) < samples] or sizes[:1]
    return [first_fit(family, overview, size) for size in sizes]


def rms_left(fit: Fit, overview: Overview) -> float:
    """Give the root mean square residual of a fit, output units.

    Parameters
    ----------
    fit
        The fit.
    overview
        Its records.
    """
    samples = overview.input.size if overview.kept is None else int(overview.kept.sum())
    return float(np.sqrt(fit.solution.cost / samples))


def line_leaves(overview: Overview) -> float:
    """Give what a straight line leaves of the output, root mean square, output units.

    Parameters
    ----------
    overview
        The records.
    """
    rows = slice(None) if overview.kept is None else overview.kept
    u, y = overview.input[rows], overview.data.measured()[rows]
    u, y = u - u.mean(), y - y.mean()
    rest = y - u * float(u @ y) / float(u @ u)
    return float(np.sqrt(rest @ rest / rest.size))
