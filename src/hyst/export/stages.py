"""What the core needs to know of one stage: the constants of its C structure, and its memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final


@final
@dataclass(frozen=True)
class Stage:
    """One stage as the core takes it.

    Parameters
    ----------
    kind
        As in ``core/include/hyst/chain.h``: "affine", "play", "stop", "dead_zone",
        "direction_dead_zone", "pi", "rate_dependent_pi", "state_space", "sections", "masing" or
        "memory_element"; or "tracking_controller" for the linear part of one.
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
    dt
        Sample time the constants are made for, seconds; None if any will do.
    """

    kind: str
    numbers: Mapping[str, float] = field(default_factory=dict)
    tables: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    choices: Mapping[str, int] = field(default_factory=dict)
    form: str = ""
    state_length: int = 0
    dt: float | None = None
