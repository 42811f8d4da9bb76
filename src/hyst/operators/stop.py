"""The stop operator: elastic-perfectly plastic element."""

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
class Stop(ThresholdOperator):
    """Stop of yield limit r, what the play of threshold r leaves: ``y_k = u_k - z_k``.

    Parameters
    ----------
    r
        Threshold, zero or positive, in units of the input; the output stays in [-r, r].
    z0
        Output of the play before the first sample (the plastic part); 0 is no memory.

    Raises
    ------
    InputError
        If ``r`` is negative or a constant is not a finite number.

    Notes
    -----
    An elastic-perfectly plastic spring of unit stiffness; sums of stops are the Maxwell slip and
    Iwan models.

    Examples
    --------
    >>> Stop(0.5)([0.0, 1.0, 2.0, 1.5, 0.5])
    array([ 0. ,  0.5,  0.5,  0. , -0.5])
    """

    kind = "stop"

    def traits(self) -> Traits:
        """Give the traits of a stop."""
        return Traits(
            memoryless=False,
            rate_independent=Degree.EXACTLY,
            return_point_memory=True,
            congruent_loops=True,
            monotone=True,
            invertible=False,
        )

    def exact_inverse(self) -> NoReturn:
        """Refuse: on its limit the output does not tell where the input is.

        Raises
        ------
        NotInvertibleError
            Always.
        """
        raise NotInvertibleError(
            "a stop is flat on its limit (cumulative weight p0 + p1 = 1 - 1 = 0): the output does "
            "not show the input; add a linear part"
        )

    def lipschitz_constant(self) -> float:
        """Give 2: the input's own part and the play's."""
        return 2.0

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        return (Stage("stop", (self.r,)),)
