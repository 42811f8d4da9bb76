"""How a repetitive controller is written to a model file, compared and copied."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hyst.control.block_file import InModelFile
from hyst.operators import Operator

Array = NDArray[np.float64]

REPETITIVE_KIND = "repetitive-controller"


class SavedRepetitive(InModelFile):
    """What ``RepetitiveController`` has of its constants; the names are explained there."""

    file_kind: ClassVar[str] = REPETITIVE_KIND
    needed: ClassVar[tuple[str, ...]] = ("dt", "period", "smooth", "learn", "lead")
    optional: ClassVar[tuple[str, ...]] = (
        "u0",
        "limits",
        "rate",
        "tolerance",
        "wait",
        "inverse",
        "hysteresis",
    )

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

    def __hash__(self) -> int:
        return hash((REPETITIVE_KIND, self.dt, self.period, *self.learn.tolist()))
