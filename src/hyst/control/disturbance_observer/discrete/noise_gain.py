"""What the sampled block makes of the sensor's noise in the drive: the square of |Q / Pd|."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.peaks import find_peaks

if TYPE_CHECKING:
    from hyst.control.disturbance_observer.discrete.stacked_gain import (
        SampledFrequencies,
        SampledStackedGain,
    )

Array = NDArray[np.float64]


class SampledNoiseGain:
    """Square of |Q / Pd|, and its gradient, for the same parameters as the stacked gain."""

    def __init__(self, gain: SampledStackedGain) -> None:
        self._gain = gain
        self.lowest, self.highest, self.grid = gain.lowest, gain.highest, gain.grid

    def at(self, w: Array) -> SampledFrequencies:
        """Collect what does not depend on the gain at the frequencies w of the w-plane."""
        return self._gain.at(w)

    def inside(self, parameters: Array) -> Array:
        """Take the parameters where they may be."""
        return self._gain.inside(parameters)

    def values(self, parameters: Array, at: SampledFrequencies) -> Array:
        """Square of |Q / Pd| for the parameters, at each frequency of at."""
        solved = self._gain.solved(parameters)
        above = at.powers[:, -solved.l.size :] @ solved.l * at.over
        return np.asarray(np.abs(above / self._gain.below(solved, at.powers)) ** 2)

    def values_and_slopes(self, parameters: Array, at: SampledFrequencies) -> tuple[Array, Array]:
        """Square of |Q / Pd| at each frequency of at, and its derivatives by the parameters."""
        solved = self._gain.solved(parameters)
        below = self._gain.below(solved, at.powers)
        V = at.powers[:, -solved.l.size :] @ solved.l * at.over / below
        of_l, of_x = np.conj(V) * at.over / below, np.abs(V) ** 2 / below
        return np.asarray(np.abs(V) ** 2), self._gain.derivatives(solved, at, of_l, of_x)

    def peaks(self, parameters: Array, share: float = 0.9, rounds: int = 4) -> Array:
        """Frequencies of maxima for the parameters, as ``find_peaks`` gives them: share, rounds."""
        return find_peaks(self, parameters, self._gain.poles(parameters), share, rounds)
