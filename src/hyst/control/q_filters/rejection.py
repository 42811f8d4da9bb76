"""Whether a disturbance is rejected as Wp asks for every plant within Wu."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.control.largest_value import largest
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.problem import QFilterProblem
from hyst.control.q_filters.responses import grid_of, responses_of
from hyst.control.zeros_and_poles import ZerosAndPoles
from hyst.errors import InputError

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class RobustPerformance:
    """How a disturbance is rejected over all plants within Wu; frequencies in rad/s.

    Parameters
    ----------
    value, frequency
        Largest |Wp (1 - Q)| + |Wu T|, and where: below 1 what Wp asks holds for every plant.
    worst, worst_frequency
        Largest |Wp (1 - Q)| / (1 - |Wu T|): how much more than 1/|Wp| the worst plant leaves of a
        disturbance; inf if a plant within Wu makes the loop unstable.
    """

    value: float
    frequency: float
    worst: float
    worst_frequency: float

    @property
    def holds(self) -> bool:
        """Whether it is below 1."""
        return self.value < 1.0


def robust_performance(design: Any) -> RobustPerformance:
    r"""Say whether a design rejects disturbances as asked for every plant within its Wu.

    ``sup over w of |Wp (1 - Q)| + |Wu T| < 1``

    Around P = Pn (1 + Delta) the plant is given ``w = S0 (1 - Q) / (1 + T Delta) d`` of a
    disturbance d at its input, S0 that of the controller alone around Pn. The largest of
    |Wp (1 - Q) / (1 + T Delta)| over |Delta| <= |Wu| is |Wp (1 - Q)| / (1 - |Wu T|), and it is
    below 1 exactly where the sum is. A stacked norm below 1 says less: the sum may be 1.41 times
    as large.

    Parameters
    ----------
    design
        Of ``design_disturbance_observer`` or ``design_q_filter``, in continuous time.

    Returns
    -------
    RobustPerformance
        On a grid around all poles and zeros, closed in on at every peak.

    Raises
    ------
    InputError
        If the design is sampled, or no design.

    Source
    ------
    J.C. Doyle, B.A. Francis and A.R. Tannenbaum, Feedback Control Theory, 1992, sec. 4.3, for the
    sensitivity that the observer leaves.

    Examples
    --------
    >>> from hyst.control import design_q_filter
    >>> Wu, Wp = ([1.0, 1.0], [1.0, 30.0]), ([0.3, 0.6], [1.0, 0.01])
    >>> found = design_q_filter(([10.0], [1.0, 10.0]), ([1.0], [1.0, 0.0]), Wu, Wp)
    >>> robust_performance(found).holds
    True
    """
    problem, Q = parts_of(design)
    return robust_performance_of(problem, Q, grid_of(problem, Q))


def robust_performance_of(
    problem: QFilterProblem, Q: QFilter | None, w: Array
) -> RobustPerformance:
    """Compute it from a grid of frequencies.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    Q
        The filter; None for no observer.
    w
        Grid, rad/s, ascending.
    """

    def total(at: Array) -> Array:
        return responses_of(problem, Q, at).robust_performance

    def worst(at: Array) -> Array:
        seen = responses_of(problem, Q, at)
        with np.errstate(divide="ignore"):
            left = seen.Wp_E / np.maximum(1.0 - seen.Wu_T, 0.0)
        # Beyond the border every frequency is as bad.
        return np.where(np.isnan(left), 0.0, np.minimum(left, 1e300))

    value, frequency = largest(total, w)
    most, at_most = largest(worst, w)
    return RobustPerformance(value, frequency, most if most < 1e299 else np.inf, at_most)


def parts_of(design: Any) -> tuple[QFilterProblem, QFilter]:
    """Give what a design is for, and its Q in factors.

    Parameters
    ----------
    design
        Of ``design_disturbance_observer`` or ``design_q_filter``.

    Raises
    ------
    InputError
        If it is neither, or sampled.
    """
    problem, certificate = getattr(design, "problem", None), getattr(design, "certificate", None)
    if problem is None or certificate is None:
        raise InputError(
            f"the design is {type(design).__name__}; give what design_disturbance_observer or "
            "design_q_filter gave"
        )
    dt = design.observer.dt
    if dt != 0.0:
        raise InputError(
            f"the design is sampled, dt = {dt:g} s; this is for designs in continuous time"
        )
    if isinstance(problem, QFilterProblem):
        return problem, design.filter
    numerator = certificate.Q_numerator
    zeros = np.roots(numerator).astype(complex)
    factors = ZerosAndPoles(zeros, certificate.observer_poles, float(numerator[0]))
    return QFilterProblem(problem.plant, problem.controller, problem.Wu, problem.Wp), QFilter(
        factors
    )
