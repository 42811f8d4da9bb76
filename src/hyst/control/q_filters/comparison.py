"""The classical filter beside other designs: one row each, all columns computed the same way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, final

import numpy as np
from threadpoolctl import threadpool_limits

from hyst.control.linear_system import LinearSystem
from hyst.control.q_filters.certificate import certify_filter, exact_norm
from hyst.control.q_filters.design import design_q_filter
from hyst.control.q_filters.loops import disturbed_loop, weighted_stack
from hyst.control.q_filters.problem import QFilterProblem, q_filter_problem
from hyst.control.q_filters.rejection import parts_of, robust_performance_of
from hyst.control.q_filters.responses import grid_of, responses_of
from hyst.errors import InputError

NO_OBSERVER = "no observer"


@final
@dataclass(frozen=True)
class DesignRow:
    """What one design achieves; norms are exact, from Q alone.

    Parameters
    ----------
    name
        What the row is called.
    order
        Order of Q.
    stacked_norm, uncertainty_norm, performance_norm
        Of [Wu T; Wp (1 - Q)], Wu T and Wp (1 - Q).
    robust_performance
        Largest |Wp (1 - Q)| + |Wu T|; below 1 the rejection holds for every plant within Wu.
    worst_performance
        Largest |Wp (1 - Q)| / (1 - |Wu T|).
    observer_noise_gain
        Largest |Q/Pn|, from sensor noise to the estimate.
    noise_gain
        Largest |T/Pn|, from sensor noise to v in the loop.
    bandwidth
        Where |1 - Q| first reaches 0.707, rad/s; 0 without observer.
    fastest_pole
        Largest modulus of a pole of Q, rad/s; 0 without observer.
    """

    name: str
    order: int
    stacked_norm: float
    uncertainty_norm: float
    performance_norm: float
    robust_performance: float
    worst_performance: float
    observer_noise_gain: float
    noise_gain: float
    bandwidth: float
    fastest_pole: float

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and texts, inf as text."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {
            name: "inf" if isinstance(value, float) and np.isinf(value) else value
            for name, value in values.items()
        }


def compare_designs(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    designs: Mapping[str, Any] | None = None,
    *,
    order: int | None = None,
) -> tuple[DesignRow, ...]:
    """Set designs beside the loop without observer and beside the classical filter.

    Parameters
    ----------
    plant, controller, Wu, Wp
        As for ``design_q_filter``.
    designs
        By the name of their row, each of ``design_disturbance_observer`` or ``design_q_filter``
        for this problem, in continuous time.
    order
        Of the classical filter; one above the least if left out.

    Returns
    -------
    tuple of DesignRow
        ``"no observer"``, the classical 1/(tau s + 1)^n of this and of one order more, then the
        designs.

    Raises
    ------
    InputError
        As ``design_q_filter``, or if one of designs is no design in continuous time.

    Examples
    --------
    >>> Wu, Wp = ([1.0, 1.0], [1.0, 30.0]), ([0.3, 0.6], [1.0, 0.01])
    >>> rows = compare_designs(([10.0], [1.0, 10.0]), ([1.0], [1.0, 0.0]), Wu, Wp)
    >>> [row.name for row in rows]
    ['no observer', '1/(tau s + 1)^2', '1/(tau s + 1)^3']
    """
    problem = q_filter_problem(plant, controller, Wu, Wp)
    systems = (problem.plant, problem.controller, problem.Wu, problem.Wp)
    first = design_q_filter(*systems, order)
    more = design_q_filter(*systems, first.filter.order + 1)
    named = {first.name: first, more.name: more} | dict(designs or {})
    return without_observer(problem), *(row_of(name, each) for name, each in named.items())


def row_of(name: str, design: Any) -> DesignRow:
    """Compute the row of a design, of either kind.

    Parameters
    ----------
    name
        What the row is called.
    design
        Of ``design_disturbance_observer`` or ``design_q_filter``, in continuous time.

    Raises
    ------
    InputError
        If it is no design, or sampled.
    """
    problem, Q = parts_of(design)
    known = isinstance(getattr(design, "problem", None), QFilterProblem)
    with threadpool_limits(1, user_api="blas"):
        c = design.certificate if known else certify_filter(problem, Q)
    return DesignRow(
        name,
        Q.order,
        c.stacked_norm,
        c.uncertainty_norm,
        c.performance_norm,
        c.robust_performance,
        c.worst_performance,
        c.observer_noise_gain,
        c.noise_gain,
        c.bandwidth,
        float(np.abs(Q.factors.poles).max()),
    )


def without_observer(problem: QFilterProblem) -> DesignRow:
    """Compute the row of the controller alone: Q = 0.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    """
    w = grid_of(problem)
    seen = responses_of(problem, None, w)
    nothing = LinearSystem(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.zeros((1, 1)))
    stack = weighted_stack(problem, nothing)
    loop = disturbed_loop(problem)
    from_noise = LinearSystem(loop.A, loop.B[:, 1:], loop.C, loop.D[:, 1:])
    robust = robust_performance_of(problem, None, w)
    with threadpool_limits(1, user_api="blas"):
        return DesignRow(
            NO_OBSERVER,
            0,
            exact_norm(stack, seen.stacked, w)[0],
            exact_norm(LinearSystem(stack.A, stack.B, stack.C[:1], stack.D[:1]), seen.Wu_T, w)[0],
            exact_norm(LinearSystem(stack.A, stack.B, stack.C[1:], stack.D[1:]), seen.Wp_E, w)[0],
            robust.value,
            robust.worst,
            0.0,
            exact_norm(from_noise, seen.T_over_plant, w)[0],
            0.0,
            0.0,
        )


def table_of(rows: tuple[DesignRow, ...]) -> str:
    """Write rows as a table of plain text, bandwidth in Hz.

    Parameters
    ----------
    rows
        Of ``compare_designs``.

    Raises
    ------
    InputError
        If there are none.
    """
    if not rows:
        raise InputError("there are no rows; give those of compare_designs")
    head = ("stacked", "Wu T", "Wp (1-Q)", "robust", "worst", "|Q/Pn|", "noise to v", "Hz")
    width = max(len(row.name) for row in rows)
    lines = [" " * width + "".join(f"{each:>11}" for each in head)]
    for row in rows:
        values = (
            row.stacked_norm,
            row.uncertainty_norm,
            row.performance_norm,
            row.robust_performance,
            row.worst_performance,
            row.observer_noise_gain,
            row.noise_gain,
            row.bandwidth / (2.0 * np.pi),
        )
        lines.append(f"{row.name:<{width}}" + "".join(f"{each:>11.4g}" for each in values))
    return "\n".join(lines)
