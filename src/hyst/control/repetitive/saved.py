"""How a repetitive controller is written to a model file, compared and copied."""

from __future__ import annotations

import os
from abc import ABC
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.description import Described, ModelDescription
from hyst.operators.model_file import MODEL, write_file
from hyst.operators.registry import entries, operator_from_dict

Array = NDArray[np.float64]

REPETITIVE_KIND = "repetitive-controller"


class SavedRepetitive(Described, ABC):
    """What ``RepetitiveController`` has of its constants; the names are explained there."""

    period: int
    smooth: Array
    learn: Array
    lead: int
    dt: float
    inverse: Operator | None
    u0: float
    limits: tuple[float, float] | None
    rate: float | None
    hysteresis: Operator | None
    tolerance: float | None
    wait: int

    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""
        data: dict[str, Any] = {"kind": REPETITIVE_KIND, "dt": self.dt, "period": self.period}
        data |= {"smooth": self.smooth.tolist(), "learn": self.learn.tolist(), "lead": self.lead}
        if self.u0:
            data["u0"] = self.u0
        if self.limits is not None:
            data["limits"] = list(self.limits)
        for name in ("rate", "tolerance"):
            if getattr(self, name) is not None:
                data[name] = getattr(self, name)
        if self.wait != self.period:
            data["wait"] = self.wait
        for name in ("inverse", "hysteresis"):
            if getattr(self, name) is not None:
                data[name] = getattr(self, name).to_dict()
        return data

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
        if not isinstance(data, dict) or data.get("kind") != REPETITIVE_KIND:
            kind = data.get("kind") if isinstance(data, dict) else data
            raise InputError(f"the kind is {kind!r}; give the dictionary of a {REPETITIVE_KIND}")
        optional = ("u0", "limits", "rate", "tolerance", "wait", "inverse", "hysteresis")
        given = entries(data, ("dt", "period", "smooth", "learn", "lead"), optional)
        for name in ("inverse", "hysteresis"):
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
            What the numbers mean; that of the controller itself if left out.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        about = self.description if description is None else description
        write_file(path, MODEL, {"model": self.to_dict()}, about)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, type(self)) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash((REPETITIVE_KIND, self.dt, self.period, *self.learn.tolist()))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_dict, (self.to_dict(),), self._carried()
