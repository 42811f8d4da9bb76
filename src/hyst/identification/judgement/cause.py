"""A cause of what a fit leaves: its columns, and how it is told with its size."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.judgement.remainder import Remainder

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class Contribution:
    """What one cause explains of what a fit leaves.

    Parameters
    ----------
    remainder
        What the fit leaves.
    coefficients
        Shape (k,), of the cause's columns, beside general loops and the other causes.
    rms
        Of what it explains, in units of the remainder.
    share
        Of the squared error, 0 to 1.
    """

    remainder: Remainder
    coefficients: Array
    rms: float
    share: float

    @property
    def size(self) -> str:
        """Its rms, in the user's unit and in percent."""
        return self.remainder.said(self.rms)


@final
@dataclass(frozen=True, eq=False)
class Cause:
    """One thing that a fit may leave and that has a name.

    Parameters
    ----------
    name
        In the registry of causes.
    columns
        Shape (rows, k): what it would look like; k = 0 where the records could not show it.
    sentence
        What is there, with its size.
    advice
        What to do about it.
    beyond_loops
        Whether it counts only where general loops do not explain as much: what follows the rate of
        one frequency is also a loop of another shape.
    disturbs
        Whether it comes to the output from elsewhere: no model of the input could describe it.
    counts
        Factor at most 1 for what it explains where it is compared with other causes: a cause of
        many columns resembles much.
    """

    name: str
    columns: Callable[[Remainder], Array]
    sentence: Callable[[Contribution], str]
    advice: str
    beyond_loops: bool = False
    disturbs: bool = False
    counts: float = 1.0
