"""How any sampled block is read from a model file, written to one, compared and copied."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from typing import Any, ClassVar, Self

from hyst.errors import InputError
from hyst.operators.description import Described, ModelDescription
from hyst.operators.model_file import MODEL, write_file
from hyst.operators.registry import entries, operator_from_dict


class InModelFile(Described, ABC):
    """What blocks have in common whose constants ``to_dict`` gives."""

    file_kind: ClassVar[str]
    needed: ClassVar[tuple[str, ...]]
    optional: ClassVar[tuple[str, ...]]

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Parameters
        ----------
        data
            What ``to_dict()`` gave, or the same read from a model file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        if not isinstance(data, dict) or data.get("kind") != cls.file_kind:
            kind = data.get("kind") if isinstance(data, dict) else data
            raise InputError(f"the kind is {kind!r}; give the dictionary of a {cls.file_kind}")
        given = entries(data, cls.needed, cls.optional)
        for name in ("operator", "inverse", "hysteresis", "forward"):
            if name in given:
                given[name] = operator_from_dict(given[name])
        return cls(**given)

    def save(
        self, path: str | os.PathLike[str], description: ModelDescription | None = None
    ) -> None:
        """Write a model file, every double exact; ``hyst.load`` reads it.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.
        description
            What the numbers mean; that of the block itself if left out.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        about = self.description if description is None else description
        write_file(path, MODEL, {"model": self.to_dict()}, about)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, type(self)) and self.to_dict() == other.to_dict()

    @abstractmethod
    def __hash__(self) -> int: ...

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_dict, (self.to_dict(),), self._carried()
