"""Words for rate-dependent plays whose radii follow another law, or that have a map."""

from __future__ import annotations

from dataclasses import replace

from hyst.identification.families.family import Words
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import DeadZone, Operator
from hyst.operators.composition import leaves_of

_GROWTH = (
    "The faster the input moves, the wider the plays: g is the growth of their radii with the rate "
    "of the input; the figure shows them at rest."
)
_SLOPES = (
    "In the table below the map is called dead_zone: each of its weights is the change of slope at "
    "a threshold; the thresholds are in the model file."
)
_AFTER = (
    "\u039b is a piecewise linear map after the plays; it bends the loop over the output, so that "
    "it may be asymmetric."
)
_BEFORE = (
    "\u03b3 is a piecewise linear map of the input before the plays; it bends the loop over the "
    "input, so that it may be asymmetric, and the rate is that of what comes out of it."
)


def words_of(words: Words, model: Operator) -> Words:
    """Give the words of the family for a model of it.

    Parameters
    ----------
    words
        For plays without a map whose radii grow in proportion to the rate.
    model
        What was found.
    """
    leaves = leaves_of(model)
    kinds = [type(each) for each in leaves]
    if RateDependentPrandtlIshlinskii not in kinds:
        return words
    at = kinds.index(RateDependentPrandtlIshlinskii)
    plays = leaves[at]
    assert isinstance(plays, RateDependentPrandtlIshlinskii), "just found"
    first, second = words.equations
    told = list(words.explanations)
    if not plays.rate_curve.is_linear:
        second = second.replace("\u03b2 |du/dt|", "g(|du/dt|)")
        told[-1] = _GROWTH
    if DeadZone in kinds[:at]:
        first = first.replace("P[u](t)", "P[\u03b3(u)](t)")
        told += [_BEFORE, _SLOPES]
    elif DeadZone in kinds[at:]:
        first = first.replace("P[u](t)", "\u039b(P[u](t))")
        told += [_AFTER, _SLOPES]
    return replace(words, equations=(first, second), explanations=tuple(told))
