"""How an operator is best drawn. It says what there is to see; the report has the brush."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Panel = Literal["weights", "curve", "map", "loop", "relays"]


@dataclass(frozen=True, eq=False)
class Portrait:
    """What shows an operator best.

    Parameters
    ----------
    panels
        One picture each: ``"weights"`` over radii; the ``"curve"`` along which the output rises
        while the input first rises from rest; a ``"map"``, how the output bends over the input; or
        the ``"loop"``, the output over the input it is given; or the ``"relays"``, their density
        over their thresholds. None for what shows nothing by itself, as a gain.
    curve
        Rise of the output over the rise of the input, both shape (N,).
    p, r
        Shape (n,): weights, output units per input unit, and radii, input units.
    p0
        Weight of the part without memory, output units per input unit.
    thresholds
        Shape (n + 1,), edges of the cells that relays are in, input units.
    density
        Shape (n, n), mass of relays over the square of an input unit, rows for alpha and columns
        for beta, NaN where there are none.
    """

    panels: tuple[Panel, ...]
    curve: Callable[[Array], Array] | None = None
    p: Array = field(default_factory=lambda: np.empty(0))
    r: Array = field(default_factory=lambda: np.empty(0))
    p0: float = 0.0
    thresholds: Array = field(default_factory=lambda: np.empty(0))
    density: Array = field(default_factory=lambda: np.empty((0, 0)))


LOOP = Portrait(("loop",))
MAP = Portrait(("map",))
NOTHING = Portrait(())
