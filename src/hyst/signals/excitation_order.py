"""Whether an input excites a system enough to determine its impulse response."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hyst.checks.arrays import finite_vector
from hyst.errors import InputError
from hyst.signals.lagged import lagged_factor, lagged_gram

# Up to this condition the normal equations still tell it, above only a QR factor does.
_TOLD_BY_GRAM = 1e6
LARGEST_CONDITION = 1e10


@dataclass(frozen=True)
class Persistence:
    """Rank and condition of the regressors ``u_k .. u_{k-mu}``, and what follows.

    Parameters
    ----------
    fir_order
        mu, the last lag.
    rank
        Numerical rank; mu + 1 if the input is persistently exciting.
    condition
        2-norm condition of the regressors; infinity if the rank is too low even in exact
        arithmetic.
    samples
        Rows, N - mu.

    Examples
    --------
    >>> wave = np.sin(0.3 * np.arange(200))
    >>> persistence(wave, 4).rank
    2
    """

    fir_order: int
    rank: int
    condition: float
    samples: int

    @property
    def sufficient(self) -> bool:
        """Whether all mu + 1 coefficients are determined, with digits to spare."""
        return self.rank == self.fir_order + 1 and self.condition < LARGEST_CONDITION

    def advice(self) -> str:
        """Say in one sentence what it means and what to change.

        Returns
        -------
        str
        """
        wanted = self.fir_order + 1
        if self.sufficient:
            return (
                f"persistently exciting: rank {self.rank} of {wanted}, condition "
                f"{self.condition:.3g}; errors grow by up to that factor"
            )
        return (
            f"not persistently exciting for order {self.fir_order}: rank {self.rank} of {wanted}, "
            f"condition {self.condition:.3g}; give the input more frequencies up to half the "
            "sample rate, sample more slowly, or lower fir_order"
        )


def persistence(u: ArrayLike, fir_order: int) -> Persistence:
    """Find rank and condition of the regressors of an FIR model.

    Parameters
    ----------
    u
        Input, shape (N,).
    fir_order
        mu, the last lag, 0 <= mu < N.

    Returns
    -------
    Persistence

    Raises
    ------
    InputError
        If the input is shorter than the order, or not a finite vector.

    Notes
    -----
    S0 sec. III asks for persistent excitation of sufficient order; singular values below
    ``max(N, mu) eps`` of the largest count as zero.

    Examples
    --------
    >>> persistence([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 1).sufficient
    True
    """
    signal = finite_vector(u, "u")
    if not 0 <= fir_order < signal.size:
        raise InputError(
            f"fir_order is {fir_order} and the input has {signal.size} samples; give more samples "
            "than the order"
        )
    rows = signal.size - fir_order
    gram = lagged_gram(signal, signal, fir_order)[0][:-1, :-1]
    eigenvalues = np.linalg.eigvalsh(gram)
    if rows > fir_order and eigenvalues[0] > eigenvalues[-1] / _TOLD_BY_GRAM**2:
        condition = math.sqrt(float(eigenvalues[-1] / eigenvalues[0]))
        return Persistence(fir_order, fir_order + 1, condition, rows)
    factor = lagged_factor(signal, signal, fir_order)[: fir_order + 1, : fir_order + 1]
    values = np.linalg.svd(factor, compute_uv=False)
    floor = max(rows, fir_order + 1) * np.finfo(np.float64).eps * values[0]
    smallest = float(values[-1])
    condition = float(values[0]) / smallest if smallest > 0.0 else math.inf
    return Persistence(fir_order, int((values > floor).sum()), condition, rows)
