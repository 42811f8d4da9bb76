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

    @property
    def consistent(self) -> bool:
        """Whether errors are as noise, or below a ten-thousandth of the loop's height."""
        negligible = self.rms <= _NEGLIGIBLE * self.loop_height
        return negligible or abs(self.correlation) < _MOST_CORRELATION

    def __str__(self) -> str:
        if not self.consistent:
            return (
                f"errors of {self.rms:.4g} rms follow each other (correlation "
                f"{self.correlation:.2f}), so model or estimate are wrong"
            )
        return f"errors of {self.rms:.4g} rms, as noise (correlation {self.correlation:.2f})"


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
