"""What every family may ask of the records before it makes a first guess."""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hyst.identification.record_use.outlying import Rows, rows_to_fit
from hyst.identification.record_use.strokes import shows_minor_loops, stroke_lengths
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Found = TypeVar("Found")


@dataclass(frozen=True, eq=False)
class Overview:
    """Records, and what was found out about them once for all families.

    Parameters
    ----------
    data
        The records.
    delay
        What the user says of the delay: samples, or ``"auto"``. It is for families whose models
        answer late by themselves; of the others the data know it.
    rates_matter
        Whether it is for families of which no rate-independent model says what is far off.
    """

    data: Data
    delay: float | str = "auto"
    rates_matter: bool = False
    _found: dict[Hashable, object] = field(default_factory=dict, init=False, repr=False)

    @functools.cached_property
    def input(self) -> Array:
        """Inputs over the samples used, all records one after the other, shape (samples,)."""
        return self.data.inputs()

    @functools.cached_property
    def sign(self) -> float:
        """+1 where the output rises with the input, -1 where it falls."""
        u = self.input
        return 1.0 if float(np.dot(u - u.mean(), self.data.measured())) >= 0.0 else -1.0

    @functools.cached_property
    def output_range(self) -> float:
        """Of the samples used, output units."""
        return float(np.ptp(self.data.measured()))

    @property
    def mean_slope(self) -> float:
        """Output range over input range, output units per input unit."""
        return self.output_range / (2.0 * self.data.half_range)

    @functools.cached_property
    def kept(self) -> Rows | None:
        """Which samples used are to be fitted and judged by; None if all are."""
        return None if self.rates_matter else rows_to_fit(self.data)

    @functools.cached_property
    def stroke_lengths(self) -> Array:
        """Length of the stroke each sample used belongs to, shape (samples,), input units."""
        return stroke_lengths(self.data)

    @functools.cached_property
    def shows_minor_loops(self) -> bool:
        """Whether enough of the records runs inside the largest loop to judge minor loops by."""
        return shows_minor_loops(self.stroke_lengths)

    def once(self, key: Hashable, find: Callable[[], Found]) -> Found:
        """Give what ``find`` finds, and find it only the first time this key is asked for."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]  # type: ignore[return-value]

    def found(self, key: Hashable) -> object | None:
        """Give what was found for a key; None if nobody has asked yet."""
        return self._found.get(key)
