"""How records are evaluated: which engine is taken, and why.

The algorithms, and the proof that time lanes are exact, are in docs/engine.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hyst import _engine
from hyst.checks.arrays import as_state, one_record, refuse_sample
from hyst.operators.base import Operator
from hyst.operators.engine_name import EngineName, as_engine


@dataclass(frozen=True)
class StageEvaluation:
    """How one stage of an operator is evaluated.

    Parameters
    ----------
    stage
        Its place in the order the signal passes the stages, from 0.
    engine
        ``"loop"``, ``"lanes"`` or ``"memory-curve"``.
    reason
        Why this engine.
    reversals
        Turning points per sample, estimated; what the memory curve pays for.
    expected_ns
        Expected cost of each engine that can take the stage, nanoseconds per sample.
    """

    stage: int
    engine: str
    reason: str
    reversals: float
    expected_ns: dict[str, float]


def explain(
    operator: Operator,
    u: ArrayLike,
    state: ArrayLike | None = None,
    *,
    engine: EngineName = "auto",
) -> tuple[StageEvaluation, ...]:
    """Tell how ``operator.run(u, state, engine=engine)`` evaluates each stage, and why.

    Parameters
    ----------
    operator
        Any operator.
    u
        Shape (N,), finite, N >= 1. The record is run, for later stages see what earlier ones give.
    state
        Shape (n,), float64; the initial state if left out.
    engine
        As in ``run``.

    Returns
    -------
    tuple of StageEvaluation
        One for each stage, in the order the signal passes them.

    Raises
    ------
    InputError
        If ``u`` is not one record, a sample overflows on its way through the operator, ``state``
        cannot be used or there is no such engine.

    Examples
    --------
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5, 0.25], r=[0.1, 0.4], p0=1.0)
    >>> explain(model, [0.0, 1.0, 0.2])[0].engine
    'loop'
    """
    signal = one_record(u)
    chain = _engine.Chain(operator.stages())
    start = operator.initial_state() if state is None else state
    memory = as_state(start, chain.state_length, None)
    rows = signal.reshape(1, -1)
    bad, told = chain.explain(memory, rows, np.empty_like(rows), as_engine(engine))
    if bad >= 0:
        refuse_sample(signal, bad, "u")
    return tuple(
        StageEvaluation(i, taken, reason, reversals, _possible(*costs))
        for i, (taken, reason, reversals, *costs) in enumerate(told)
    )


def _possible(loop: float, lanes: float, memory_curve: float) -> dict[str, float]:
    """Give the costs of the engines that can take the stage."""
    costs = {"loop": loop, "lanes": lanes, "memory-curve": memory_curve}
    return {name: cost for name, cost in costs.items() if not np.isnan(cost)}
