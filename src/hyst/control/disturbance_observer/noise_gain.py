"""What an observer makes of the sensor's noise in the drive, as a function of the poles of Q.

Noise on y reaches the drive through the observer as ``Q / Pn = l a / x``, with the polynomials of
``stacked_gain``. It falls off at high frequencies, for Q has a higher relative degree than Pn.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.peaks import find_peaks
from hyst.control.zeros_and_poles import Points

if TYPE_CHECKING:
    from hyst.control.disturbance_observer.stacked_gain import StackedGain

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class NoiseFrequencies:
    """Frequencies ``w``, with ``powers`` of s and the plant's ``denominator`` over its gain."""

    w: Array
    powers: ComplexArray
    denominator: Points


class NoiseGain:
    """Square of |Q / Pn|, and its gradient, for the same parameters as the stacked gain."""

    def __init__(self, gain: StackedGain) -> None:
        self._gain = gain
        self.lowest, self.highest = gain.lowest, gain.highest
        self.grid = self.at(gain.grid.w)

    def at(self, w: Array) -> NoiseFrequencies:
        """Collect what does not depend on the gain at the frequencies w, rad/s."""
        unit = 1j * w / self._gain.scale
        poles = self._gain.plant.poles / self._gain.scale
        a = np.prod(unit[:, None] - poles, axis=1) / self._gain.size
        return NoiseFrequencies(w, self._gain.powers(unit), a)

    def inside(self, parameters: Array) -> Array:
        """Take the parameters where they may be."""
        return self._gain.inside(parameters)

    def values(self, parameters: Array, at: NoiseFrequencies) -> Array:
        """Square of |Q / Pn| for the parameters, at each frequency of at."""
        solved = self._gain.solved(parameters)
        above = at.powers[:, -solved.l.size :] @ solved.l * at.denominator
        return np.asarray(np.abs(above / self._gain.below(solved, at.powers)) ** 2)

    def values_and_slopes(self, parameters: Array, at: NoiseFrequencies) -> tuple[Array, Array]:
        """Square of |Q / Pn| at each frequency of at, and its derivatives by the parameters."""
        solved = self._gain.solved(parameters)
        below = self._gain.below(solved, at.powers)
        V = at.powers[:, -solved.l.size :] @ solved.l * at.denominator / below
        of_l = at.powers[:, -solved.l.size :] @ solved.l_slopes.T
        slopes = of_l * at.denominator[:, None] - (at.powers @ solved.x_slopes.T) * V[:, None]
        with np.errstate(over="ignore", invalid="ignore"):
            derivatives = 2.0 * np.real((np.conj(V) / below)[:, None] * slopes)
        return np.asarray(np.abs(V) ** 2), np.asarray(derivatives)

    def peaks(self, parameters: Array, share: float = 0.9, rounds: int = 4) -> Array:
        """Frequencies of maxima for the parameters, as ``find_peaks`` gives them: share, rounds."""
        return find_peaks(self, parameters, self._gain.poles(parameters), share, rounds)
