"""The play operator: backlash."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn, final

from hyst.errors import NotInvertibleError
from hyst.operators.registry import register
from hyst.operators.stage import Stage
from hyst.operators.threshold import ThresholdOperator
from hyst.operators.traits import Degree, Traits


@register
@final
@dataclass(frozen=True, eq=False)
class Play(ThresholdOperator):
    """Play (backlash) of half-width r: ``z_k = max(u_k - r, min(u_k + r, z_{k-1}))``.

    Parameters
    ----------
    r
        Threshold, zero or positive, in units of the input.
    z0
        Output before the first sample; 0 is no memory.

    Raises
    ------
    InputError
        If ``r`` is negative or a constant is not a finite number.

    Notes
    -----
    S1 eq. 2 (whose first ``v`` must read ``u``), S0 eq. 7, S4 eqs. 3-4.

    Examples
    --------
    >>> Play(0.5)([0.0, 1.0, 2.0, 1.5, 0.5])
    array([0. , 0.5, 1.5, 1.5, 1. ])
    """

    kind = "play"

    def traits(self) -> Traits:
        """Give the traits of a play."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=True,
            congruent_loops=True,
            monotone=True,
            invertible=False,
        )

    def exact_inverse(self) -> NoReturn:
        """Refuse: while the play rests, the output does not tell where the input is.

        Raises
        ------
        NotInvertibleError
            Always.
        """
        raise NotInvertibleError(
            "a play has no linear part (p0 = 0): while it rests the output does not show the "
            "input; add a linear part, as PrandtlIshlinskii(p=[1], r=[r], p0=...) does"
        )

    def lipschitz_constant(self) -> float:
        """Give 1: clamping does not stretch distances."""
        return 1.0

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("play", (self.r,)),)
