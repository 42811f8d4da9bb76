"""What may be relied on of an operator."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import cast, final

Asked = bool | Callable[[], bool]


@final
class Degree(IntEnum):
    """How far the speed of the input is without effect; true unless it is ``NO``."""

    NO = 0
    # A step taken in parts rounds differently, as where an exponential lies between two samples.
    TO_ROUNDING = 1
    EXACTLY = 2


@final
class Traits:
    """Properties an operator declares; contract tests hold every operator to them.

    They are worked out when they are first asked for: an operator may hand over a function instead
    of what it gives.

    Parameters
    ----------
    memoryless
        The output depends on the present input alone.
    rate_independent
        Passing the same values at another speed, or repeating samples, changes nothing else: the
        same bits come out, or the same numbers to rounding. A composition of exact operators
        repeats bits for repeated samples; samples between others change it by rounding.
    return_point_memory
        An input that returns to an earlier extremum finds the output it left there, and goes on as
        if the excursion had not been (wiping out).
    congruent_loops
        Loops between the same two input values have the same shape wherever they start.
    monotone
        While the input rises, from any state an input can have left, the output does not fall.
    invertible
        ``inverse()`` gives an exact inverse.
    """

    def __init__(
        self,
        *,
        memoryless: Asked,
        rate_independent: Degree,
        return_point_memory: Asked,
        congruent_loops: Asked,
        monotone: Asked,
        invertible: Asked,
    ) -> None:
        self._known: dict[str, Asked | Degree] = {
            "memoryless": memoryless,
            "rate_independent": rate_independent,
            "return_point_memory": return_point_memory,
            "congruent_loops": congruent_loops,
            "monotone": monotone,
            "invertible": invertible,
        }

    @property
    def memoryless(self) -> bool:
        """Whether the output depends on the present input alone."""
        return self._ask("memoryless")

    @property
    def rate_independent(self) -> Degree:
        """How far the speed of the input is without effect."""
        return cast("Degree", self._known["rate_independent"])

    @property
    def return_point_memory(self) -> bool:
        """Whether minor loops close and are forgotten."""
        return self._ask("return_point_memory")

    @property
    def congruent_loops(self) -> bool:
        """Whether loops between the same inputs have one shape."""
        return self._ask("congruent_loops")

    @property
    def monotone(self) -> bool:
        """Whether the output never falls while the input rises."""
        return self._ask("monotone")

    @property
    def invertible(self) -> bool:
        """Whether there is an exact inverse."""
        return self._ask("invertible")

    def held(self) -> dict[str, bool | Degree]:
        """Give all traits by name."""
        return {name: getattr(self, name) for name in self._known}

    def _ask(self, name: str) -> bool:
        known = self._known[name]
        if callable(known):
            known = self._known[name] = known()
        return bool(known)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Traits) and self.held() == other.held()

    def __hash__(self) -> int:
        return hash(tuple(self.held().values()))

    def __repr__(self) -> str:
        return f"Traits({', '.join(f'{name}={value}' for name, value in self.held().items())})"
