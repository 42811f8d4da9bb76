"""Records under diagnosis, and what is found out about them once for all findings."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TypeVar

from hyst.signals import Record

Found = TypeVar("Found")


@dataclass(frozen=True, eq=False)
class Evidence:
    """The records, and a store for what several findings need.

    Parameters
    ----------
    records
        One or more, all of one actuator as their user believes.
    """

    records: tuple[Record, ...]
    _found: dict[Hashable, object] = field(default_factory=dict, init=False, repr=False)

    def once(self, key: Hashable, find: Callable[[], Found]) -> Found:
        """Give what ``find`` finds, and find it only the first time this key is asked for."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]  # type: ignore[return-value]
