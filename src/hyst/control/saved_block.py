"""How a sampled block is written to a model file, compared and copied."""

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

KIND = "tracking-controller"


class SavedBlock(Described, ABC):
    """What ``TrackingController`` has of its constants; the names are explained there."""

    A: Array
    B: Array
    C: Array
    D: Array
    dt: float
    inverse: Operator | None
    E: Array | None
    F: Array | None
    x0: Array
    u0: float
    limits: tuple[float, float] | None
    rate: float | None
    hysteresis: Operator | None
    W: Array | None
    G: float

    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""
        data: dict[str, Any] = {"kind": KIND, "dt": self.dt}
        data |= {name: getattr(self, name).tolist() for name in ("A", "B", "C", "D")}
        if self.E is not None and self.F is not None:
            data |= {"E": self.E.tolist(), "F": self.F.tolist()}
        if self.x0.any():
            data["x0"] = self.x0.tolist()
        if self.u0:
            data["u0"] = self.u0
        if self.inverse is not None:
            data["inverse"] = self.inverse.to_dict()
        if self.limits is not None:
            data["limits"] = list(self.limits)
        if self.rate is not None:
            data["rate"] = self.rate
        if self.W is not None:
            data |= {"W": self.W.tolist()} | ({"G": self.G} if self.G else {})
        if self.hysteresis is not None:
            data["hysteresis"] = self.hysteresis.to_dict()
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
        if not isinstance(data, dict) or data.get("kind") != KIND:
            kind = data.get("kind") if isinstance(data, dict) else data
            raise InputError(f"the kind is {kind!r}; give the dictionary of a {KIND}")
        optional = ("E", "F", "x0", "u0", "inverse", "limits", "rate", "hysteresis", "W", "G")
        given = entries(data, ("dt", "A", "B", "C", "D"), optional)
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
        return hash((KIND, self.dt, *self.A.ravel().tolist(), *self.C.tolist()))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self).from_dict, (self.to_dict(),), self._carried()
