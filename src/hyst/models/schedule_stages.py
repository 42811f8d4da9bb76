"""Which constants may follow a second signal while the memory is kept, and which may not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.composition import leaves_of
from hyst.operators.stage import Stage
from hyst.signals import units_differ

Array = NDArray[np.float64]

KEEPS_ITS_MEANING = {
    "affine": "no memory",
    "creep": "states of lags, in the unit of the signal",
    "dead_zone": "no memory",
    "maxwell_slip": "outputs of plays, which the next sample moves into the band of now",
    "pi": "outputs of plays, which the next sample moves into the band of now",
    "play": "the output, which the next sample moves into the band of now",
    "rate_dependent_pi": "outputs of plays, whose bands move as it is",
    "stop": "the output of the play, which the next sample moves into the band of now",
}
"""Kinds of stages whose constants may move, and what their memory then is."""

STRAIGHT = 1e-12
"""Share of a constant by which rounding may keep the kernel's from a straight line."""


def as_models(models: Sequence[Operator]) -> tuple[Operator, ...]:
    """Give models that differ in nothing but their constants.

    Parameters
    ----------
    models
        At least two.

    Raises
    ------
    InputError
        If they are something else, or differ in structure, size, sample time, initial memory, what
        is no parameter, or units.
    """
    if isinstance(models, Operator) or not isinstance(models, Sequence):
        raise InputError("models is no list; give one operator for each value of the schedule")
    for number, each in enumerate(models, 1):
        if not isinstance(each, Operator):
            raise InputError(f"model {number} is a {type(each).__name__}; give an operator")
    given = tuple(models)
    if len(given) < 2:
        raise InputError(
            f"a schedule of {len(given)} model(s) has nothing to follow; give at least two values, "
            "or use the model itself"
        )
    for number, each in enumerate(given[1:], 2):
        difference = _difference(given[0], each)
        if difference:
            raise InputError(
                f"model {number} differs from the first in {difference}; models of a schedule have "
                "one structure and differ in their constants alone"
            )
    return given


def _difference(first: Operator, other: Operator) -> str:
    kinds = [[leaf.kind for leaf in leaves_of(each)] for each in (first, other)]
    if kinds[0] != kinds[1] or type(first) is not type(other):
        return f"its stages ({', '.join(kinds[1])}, not {', '.join(kinds[0])})"
    sizes = [len(each.parameters()) for each in (first, other)]
    if sizes[0] != sizes[1] or first.parameters().names != other.parameters().names:
        return f"its size ({sizes[1]} constants, not {sizes[0]})"
    if first.dt != other.dt:
        return f"its sample time ({other.dt} s, not {first.dt} s)"
    if not np.array_equal(first.initial_state(), other.initial_state()):
        return "its initial memory"
    about, about_other = first.description, other.description
    for signal in ("input", "output"):
        own, another = (getattr(each, f"{signal}_unit") for each in (about, about_other))
        if units_differ(own, another):
            return f"the unit of its {signal} ({another!r}, not {own!r})"
    bare = [[replace(stage, constants=()) for stage in each.stages()] for each in (first, other)]
    if bare[0] != bare[1]:
        return "what is no parameter, as knots, forms or options of its stages"
    return ""


def moving_places(models: Sequence[Operator]) -> NDArray[np.bool_]:
    """Tell which constants are not the same in all models, shape (constants,)."""
    table = np.array([each.parameters().values for each in models])
    return np.asarray((table != table[0]).any(axis=0))


def require_that_memory_is_kept(models: Sequence[Operator], between: Sequence[Operator]) -> None:
    """Refuse stages whose memory means nothing, or another thing, with other constants.

    Parameters
    ----------
    models
        Those of the schedule.
    between
        For each two neighbours the model half way, by straight lines of the operator's constants.

    Raises
    ------
    InputError
        If a constant moves in such a stage, or the kernel's constants are no straight lines.
    """
    stages = [each.stages() for each in models]
    for i, of_first in enumerate(stages[0]):
        if all(each[i] == of_first for each in stages):
            continue
        if of_first.kind not in KEEPS_ITS_MEANING:
            raise InputError(
                f"constants of a stage of kind {of_first.kind!r} differ between the models, and "
                "its memory does not tell what it would be with other constants; use at(value), or "
                "models that differ in plays, maps, gains and offsets alone"
            )
        if not all(_is_straight(models, between, i, k) for k in range(len(between))):
            raise InputError(
                f"constants of a stage of kind {of_first.kind!r} differ between the models, and "
                "the kernel's own constants would be no straight lines between; use at(value), "
                "or keep times, stiffnesses and exponents the same in all models"
            )


def _is_straight(
    models: Sequence[Operator], between: Sequence[Operator], stage: int, knot: int
) -> bool:
    low, middle, high = (
        np.array(list(_kernel_constants(each, stage)))
        for each in (models[knot], between[knot], models[knot + 1])
    )
    size = np.maximum(np.abs(low), np.abs(high))
    return bool((np.abs(low + 0.5 * (high - low) - middle) <= STRAIGHT * size).all())


def _kernel_constants(model: Operator, stage: int) -> Iterator[float]:
    told = _engine.Chain(model.stages()).constants(stage)
    yield from told["numbers"].values()
    for values in told["tables"].values():
        yield from values


def with_kind(stage: Stage, kind: str) -> Stage:
    """Give a stage of another kind that takes the same constants."""
    return replace(stage, kind=kind)
