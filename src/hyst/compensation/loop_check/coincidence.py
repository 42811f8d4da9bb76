"""Whether loops coincide beyond what noise explains: means with scatters of their own, compared.

Each part of each harmonic has a mean and a variance in every stretch. Welch's analysis of variance
tests whether the means are one number, though the variances differ and rest on few cycles; the
smallest of the p-values, times their number (Bonferroni), is that of all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import special

from hyst.compensation.loop_check.loop_shape import distance

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Coincidence:
    """How well loops coincide.

    Parameters
    ----------
    p_value
        Of all parts together: the chance of as large a difference by noise alone, at most.
    p_values
        Shape (harmonics, 2), of each part alone.
    distance
        Between the two loops that are furthest apart, at most, units of v.
    """

    p_value: float
    p_values: Array
    distance: float


def coincidence(
    means: Sequence[Array], variances: Sequence[Array], freedoms: Sequence[int]
) -> Coincidence:
    """Compare loops by their harmonics.

    Parameters
    ----------
    means
        Of each loop, shape (harmonics, 2).
    variances
        Of the means, shape (harmonics,).
    freedoms
        Degrees of freedom of the variances.

    Returns
    -------
    Coincidence

    Notes
    -----
    Welch, Biometrika 38 (1951) 330-336, with the degrees of freedom of variances that two parts of
    a harmonic share.
    """
    m = np.array(means)
    weight = np.broadcast_to(1.0 / np.array(variances)[:, :, None], m.shape)
    freedom = np.array(freedoms, dtype=np.float64)[:, None, None]
    count = len(means)
    total = weight.sum(axis=0)
    centre = (weight * m).sum(axis=0) / total
    between = (weight * np.square(m - centre)).sum(axis=0) / (count - 1)
    loss = (np.square(1.0 - weight / total) / freedom).sum(axis=0) / (count**2 - 1)
    statistic = between / (1.0 + 2.0 * (count - 2) * loss)
    p = special.fdtrc(count - 1.0, 1.0 / (3.0 * loss), statistic)
    furthest = max(distance(one, other) for k, one in enumerate(m) for other in m[:k])
    return Coincidence(
        p_value=float(min(1.0, p.size * p.min())),
        p_values=np.asarray(p),
        distance=furthest,
    )
