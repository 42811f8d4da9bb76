"""Types of the core compiled in single precision."""

from collections.abc import Mapping, Sequence
from typing import overload

Description = tuple[
    str, str, Mapping[str, float], Mapping[str, Sequence[float]], Mapping[str, int]
]

class Stepper:
    def __init__(self, stages: Sequence[Description], start: Sequence[float]) -> None: ...
    @property
    def state(self) -> list[float]: ...
    @property
    def fault(self) -> bool: ...
    def clear_fault(self) -> None: ...
    @overload
    def __call__(self, u: float, /) -> float: ...
    @overload
    def __call__(self, y_ref: float, y: float, /) -> float: ...
