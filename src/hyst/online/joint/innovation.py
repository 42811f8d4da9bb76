"""Whether what an estimate leaves unexplained can be noise."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine

# Places of the scalars in the state, from "scalars" on, as joint_search.h has them.
_TRIALS, _REPLACEMENTS, _SQUARE = 5, 6, 15

_MOST_CORRELATION = 0.5
_NEGLIGIBLE = 1e-4


@dataclass(frozen=True)
class Innovation:
    """Errors of prediction, and whether they can be noise.

    Noise has no memory; errors of an estimate in a false minimum, or of a model that is not the
    plant's, follow the input and so each other.

    Parameters
    ----------
    rms
        Root mean square of the last errors (some 150), output units.
    correlation
        Of each error with the one before, from -1 to 1.
    loop_height
        Height of the widest loop the estimate has, output units.
    rivals, replacements
        Estimates that were started elsewhere and tried, and those that became the estimate.
    over
        Over how many samples sums of errors show that they follow each other, where neighbours need
        not; 0 where they do not, or where nothing sums them.

    Examples
    --------
    >>> Innovation(0.1, 0.02, 5.0, 3, 1).consistent
    True
    >>> str(Innovation(0.1, 0.98, 5.0, 3, 0))
    'errors of 0.1 rms follow each other (correlation 0.98), so model or estimate are wrong'
    """

    rms: float
    correlation: float
    loop_height: float
    rivals: int = 0
    replacements: int = 0
    over: int = 0

    @property
    def consistent(self) -> bool:
        """Whether errors are as noise, or below a ten-thousandth of the loop's height."""
        return self._is_negligible or not (self._is_correlated or self.over)

    @property
    def _is_negligible(self) -> bool:
        return self.rms <= _NEGLIGIBLE * self.loop_height

    @property
    def _is_correlated(self) -> bool:
        return abs(self.correlation) >= _MOST_CORRELATION

    def __str__(self) -> str:
        errors, found = f"errors of {self.rms:.4g} rms", f"(correlation {self.correlation:.2f})"
        if not (self._is_correlated or self.over):
            # Of neighbours alone: what else is known of them may be told beside it.
            return f"{errors}, neighbours as in noise {found}"
        if self._is_negligible:
            return f"{errors}, negligible beside a loop of height {self.loop_height:.4g}"
        if self.over:
            found = f"over some {self.over} samples"
        return f"{errors} follow each other {found}, so model or estimate are wrong"


def innovation_of(
    core: _engine.JointEstimation, state: NDArray[np.float64], loop_height: float, gain: float
) -> Innovation:
    """Say what an estimate leaves unexplained.

    Parameters
    ----------
    core, state
        The engine and its state.
    loop_height
        Height of the widest loop the estimate has, output units of the plays.
    gain
        Output units in one of the plays, above 0.

    Returns
    -------
    Innovation
    """
    scalars = state[core.places()["scalars"] :]
    return Innovation(
        rms=gain * math.sqrt(float(scalars[_SQUARE])),
        correlation=core.correlation(state),
        loop_height=gain * loop_height,
        rivals=int(scalars[_TRIALS]),
        replacements=int(scalars[_REPLACEMENTS]),
    )
