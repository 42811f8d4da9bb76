"""How a sampled block is written to a model file, compared and copied."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hyst.control.block_file import InModelFile
from hyst.operators import Operator

Array = NDArray[np.float64]

KIND = "tracking-controller"


class SavedBlock(InModelFile):
    """What ``TrackingController`` has of its constants; the names are explained there."""

    file_kind: ClassVar[str] = KIND
    needed: ClassVar[tuple[str, ...]] = ("dt", "A", "B", "C", "D")
    optional: ClassVar[tuple[str, ...]] = (
        "E",
        "F",
        "x0",
        "u0",
        "inverse",
        "limits",
        "rate",
        "hysteresis",
        "W",
        "G",
    )

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

    def __hash__(self) -> int:
        return hash((KIND, self.dt, *self.A.ravel().tolist(), *self.C.tolist()))
