"""Plays whose thresholds are given functions of time: the case in which the inverse is exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_constants, as_signal, refuse_overflow
from hyst.checks.numbers import as_number
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.cumulative_weights import cumulative, rounding_of_cumulative

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False, init=False)
class GivenThresholds:
    """Prandtl-Ishlinskii model over one stretch of time, its thresholds known for every sample.

        y_k = p0 u_k + sum_i p_i z_i,   z_i: play of threshold r[k, i]

    It is no operator: it ends with its thresholds. Its inverse, with the thresholds that belong to
    them, undoes it to rounding.

    Parameters
    ----------
    p
        Shape (n,), weights of the plays, output units per input unit.
    r
        Shape (N, n), thresholds, ``0 <= r[k, 0] <= ... <= r[k, n - 1]``, input units.
    p0
        Weight of the input itself, output units per input unit.

    Raises
    ------
    InputError
        If shapes do not fit, thresholds are negative or unsorted (the sample is named), or a
        constant is not finite.

    Notes
    -----
    S4 eqs. 6-16. Initially all plays are at 0.

    Examples
    --------
    >>> import numpy as np
    >>> wide = np.array([[1.0], [2.0], [4.0], [4.0]])
    >>> model = GivenThresholds([1.0], wide, p0=0.5)
    >>> model([0.0, 3.0, 4.0, 9.0])
    array([0. , 2.5, 3. , 9.5])
    >>> model.inverse()(model([0.0, 3.0, 4.0, 9.0]))
    array([0., 3., 4., 9.])
    """

    p: Array
    r: Array
    p0: float

    def __init__(self, p: ArrayLike, r: ArrayLike, p0: float = 0.0) -> None:
        weights = as_constants(p, "p")
        thresholds = np.array(as_signal(r, "r"))
        if thresholds.ndim != 2 or thresholds.shape[1] != weights.size:
            raise InputError(
                f"r has shape {thresholds.shape}; give a row of {weights.size} for every sample"
            )
        falls = np.argwhere(np.diff(thresholds, axis=1, prepend=0.0) < 0.0)
        if falls.size:
            k, i = (int(each) for each in falls[0])
            raise InputError(
                f"r[{k}, {i}] = {thresholds[k, i]} is negative or below its left neighbour; sort "
                "the thresholds of every sample in ascending order"
            )
        thresholds.flags.writeable = False
        object.__setattr__(self, "p", weights)
        object.__setattr__(self, "r", thresholds)
        object.__setattr__(self, "p0", as_number(p0, "p0"))

    def __call__(self, u: ArrayLike) -> Array:
        """Give the output for inputs at the samples the thresholds are given for.

        Parameters
        ----------
        u
            Shape (N,), finite, input units.

        Returns
        -------
        numpy.ndarray
            Shape (N,), output units.

        Raises
        ------
        InputError
            If ``u`` has another length or is not finite.
        """
        signal = as_signal(u)
        if signal.shape != (len(self.r),):
            raise InputError(
                f"u has shape {signal.shape}, but thresholds are given for {len(self.r)} samples"
            )
        y = np.empty_like(signal)
        memory = np.zeros(self.p.size)
        _engine.run_with_thresholds(self.p0, self.p.tolist(), self.r, memory, signal, y)
        return y

    def inverse(self) -> GivenThresholds:
        """Give the inverse, exact to rounding.

        Returns
        -------
        GivenThresholds

        Raises
        ------
        NotInvertibleError
            If p0 or a cumulative weight is not positive; if the distance of two neighbouring
            thresholds shrinks in time (the first place is named); if a constant overflows.

        Notes
        -----
        S4 eqs. 11, 14 and 15.
        """
        slopes = cumulative(self.p0, self.p)
        if (slopes <= rounding_of_cumulative(self.p0, self.p)).any():
            raise NotInvertibleError(
                f"the cumulative weights from p0 on are {slopes.tolist()}; all must be positive"
            )
        distances = np.diff(self.r, axis=1)
        # Thresholds that grow alike differ in their distances by rounding.
        slack = 1e-12 * float(np.abs(self.r).max(initial=0.0))
        shrinks = np.argwhere(np.diff(distances, axis=0) < -slack)
        if shrinks.size:
            k, i = (int(each) for each in shrinks[0])
            raise NotInvertibleError(
                f"the distance of thresholds {i + 1} and {i + 2} shrinks from "
                f"{distances[k, i]:.6g} to {distances[k + 1, i]:.6g} at sample {k + 1}; "
                "the inverse is exact only while distances do not shrink"
            )
        with np.errstate(all="ignore"):
            thresholds = np.cumsum(slopes[:-1] * np.diff(self.r, axis=1, prepend=0.0), axis=1)
            weights = -(self.p / slopes[1:]) / slopes[:-1]
            g0 = 1.0 / np.float64(self.p0)
        refuse_overflow(g0, weights, thresholds)
        return GivenThresholds(weights, thresholds, float(g0))
