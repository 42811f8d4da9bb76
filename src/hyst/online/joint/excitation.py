"""What the present input can tell about the radii, and what it cannot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PlayExcitation:
    """Whether a play is excited.

    Parameters
    ----------
    r
        Its estimated radius, input units of the plays.
    frozen
        Whether nothing new is learnt about it.
    reason
        Why, in a sentence; empty if it is excited.
    """

    r: float
    frozen: bool
    reason: str


@dataclass(frozen=True)
class Excitation:
    """What the recent input tells about the radii.

    Parameters
    ----------
    swing
        Range of the recent input of the plays.
    loop_width
        Width of the widest loop the estimate has, ``2 sum(p r) / sum(p)``.
    swing_needed
        Twice the largest radius: the input must span more (S2 lemma 1).
    swing_sufficient
        ``sum(p) / p_n`` times the loop width, which is more than twice the largest radius whatever
        the radii are (S2 lemma 2, eq. 26); infinite if the last weight is not positive.
    plays
        One entry for each play.

    Notes
    -----
    S2 lemma 2: ``2 r_1 <= loop width <= 2 r_n < sum(p) / p_n loop width``.
    """

    swing: float
    loop_width: float
    swing_needed: float
    swing_sufficient: float
    plays: tuple[PlayExcitation, ...]

    @property
    def persistent(self) -> bool:
        """Whether no play is frozen; whether samples determine its radius is in ``knowledge``."""
        return not any(play.frozen for play in self.plays)

    def __str__(self) -> str:
        frozen = [
            f"r[{i}] = {play.r:.4g}: {play.reason}"
            for i, play in enumerate(self.plays, 1)
            if play.frozen
        ]
        head = f"input spans {self.swing:.4g} of the {self.swing_needed:.4g} needed"
        return (
            "; ".join([head, *frozen])
            if frozen
            else f"{head}; every play goes from envelope to envelope"
        )


def watch(p0: float, p: Array, r: Array, age: Array, patience: float, swing: float) -> Excitation:
    """Say what is excited.

    Parameters
    ----------
    p0, p, r
        The estimate.
    age
        Shape (n,), samples since each play last went from one envelope to the other.
    patience
        Samples after which a play without that is frozen.
    swing
        Range of the recent input of the plays.

    Returns
    -------
    Excitation

    Examples
    --------
    >>> str(watch(1.0, np.ones(1), np.ones(1), np.array([9.0]), 9.0, 1.5))
    'input spans 1.5 of the 2 needed; r[1] = 1: the input spans 1.5, less than twice the radius'
    """
    total = p0 + float(p.sum())
    width = 2.0 * float(p @ r) / total if total > 0.0 else 0.0
    last = float(p[-1]) if p.size else 0.0
    return Excitation(
        swing=swing,
        loop_width=width,
        swing_needed=2.0 * float(r[-1]) if r.size else 0.0,
        swing_sufficient=total / last * width if last > 0.0 else np.inf,
        plays=tuple(
            _of_one(float(p[i]), float(r[i]), bool(age[i] >= patience), swing)
            for i in range(r.size)
        ),
    )


def excitation_of(theta: Array, age: Array, patience: float, swing: float) -> Excitation:
    """Say what is excited of an estimate.

    Parameters
    ----------
    theta
        The estimate, shape (m,), in the core's order.
    age, patience, swing
        As for ``watch``.

    Returns
    -------
    Excitation
    """
    n = age.size
    p0, p, r = float(theta[0]), theta[1 : n + 1], theta[n + 1 : 2 * n + 1]
    return watch(p0, p, r, age, patience, swing)


def _of_one(p: float, r: float, is_idle: bool, swing: float) -> PlayExcitation:
    if p == 0.0:
        return PlayExcitation(r, True, "its weight is 0, so its radius does not show")
    if swing <= 2.0 * r:
        return PlayExcitation(r, True, f"the input spans {swing:.4g}, less than twice the radius")
    if is_idle:
        why = "it has not gone from one envelope to the other for as long as the estimator waits"
        return PlayExcitation(r, True, why)
    return PlayExcitation(r, False, "")
