"""A stage is data: what an operator says of itself to the engine and to exports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final


@final
@dataclass(frozen=True)
class Stage:
    """One stage, by the constants of the operator and in their units.

    What the core needs is derived from them in one place, ``engine/kinds``.

    Parameters
    ----------
    kind
        A row of ``engine/kinds/kinds.cpp``, as "pi".
    constants
        In the order of the operator's ``parameters()``.
    fixed
        Constants that are no parameters, by name, as the knots of a table.
    choices
        Whole numbers: sizes that the constants do not show, and what is switched on (1) or off (0).
    form
        Which curve or function, as "power-law", or "".
    dt
        Sample time the constants are made for, seconds; None if any will do.
    inside
        Stages inside this one, in the order the signal passes them; their constants come first
        among those of this one.
    """

    kind: str
    constants: tuple[float, ...]
    fixed: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    choices: Mapping[str, int] = field(default_factory=dict)
    form: str = ""
    dt: float | None = None
    inside: tuple[Stage, ...] = ()
