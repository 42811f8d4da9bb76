"""Stages as the core has them: derived constants, memory, and how C writes them.

What the core derives from an operator's constants is derived once, in ``engine/kinds``, and read
back from there; so an export has the engine's bits.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, final

from hyst import _engine
from hyst.operators.base import Operator
from hyst.operators.stage import Stage


@final
@dataclass(frozen=True)
class CoreStage:
    """One stage as the core takes it.

    Parameters
    ----------
    kind
        A row of ``engine/kinds/kinds.cpp``; or "tracking_controller" for the linear part of one.
    numbers
        Constants by the name of their place in the C structure.
    tables
        Rows of constants by the name of their place.
    choices
        Whole numbers: sizes that no table has, and what is switched on (1) or off (0).
    form
        Which curve or function: the enumerator of the core, or "".
    state_length
        Numbers of memory.
    offers
        For each constant who may change it, by the numbers of ``hyst_fmu.h``, and what it is.
    feeds_through
        Whether the output of a sample depends on its input.
    header
        Of the core, that the call needs; or "".
    structure
        C that makes the structure of constants, as ``engine/kinds/kind.hpp`` explains; or "".
    call
        C that takes one sample through the stage.
    inside
        How many of the stages before it are inside it: what they make of its input is its signal.
    """

    kind: str
    numbers: Mapping[str, float]
    tables: Mapping[str, tuple[float, ...]]
    choices: Mapping[str, int]
    form: str
    state_length: int
    offers: Mapping[str, tuple[int, str]]
    feeds_through: bool
    header: str
    structure: str
    call: str
    inside: int = 0


def core_stages(operator: Operator) -> tuple[CoreStage, ...]:
    """Give the stages of an operator in the order the signal passes them.

    Stages inside another one stand before it.

    Parameters
    ----------
    operator
        Any operator.

    Returns
    -------
    tuple of CoreStage

    Examples
    --------
    >>> from hyst import Affine, Play
    >>> [stage.kind for stage in core_stages(Affine(2.0) @ Play(0.5))]
    ['play', 'affine']
    """
    return stages_as_core(operator.stages())


def stages_as_core(stages: Sequence[Stage]) -> tuple[CoreStage, ...]:
    """Give stages as the core takes them; those inside another one stand before it.

    Parameters
    ----------
    stages
        In the order the signal passes them.
    """
    chain = _engine.Chain(stages)
    return tuple(stage for i in range(len(chain)) for stage in _with_inside(chain.constants(i)))


def _with_inside(told: dict[str, Any]) -> Iterator[CoreStage]:
    """Give the stages inside one, and the one around them with what memory is its own."""
    inside = told["inside"]
    for each in inside:
        yield from _with_inside(each)
    own = told["state_length"] - sum(each["state_length"] for each in inside)
    yield CoreStage(**(told | {"inside": len(inside), "state_length": own}))
