"""How records are evaluated: which engine is taken and why, and many parameter sets at once.

The algorithms, and the proof that time lanes are exact, are in docs/engine.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_constants, as_signal, as_state, one_record, refuse_sample
from hyst.checks.thresholds import as_ascending_thresholds
from hyst.errors import InputError
from hyst.operators.base import Operator
from hyst.operators.engine_name import EngineName, as_engine, as_threads

Array = NDArray[np.float64]


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


def run_parameter_sets(
    p0: ArrayLike, p: ArrayLike, r: ArrayLike, u: ArrayLike, *, threads: int = 1
) -> Array:
    """Give the outputs of many Prandtl-Ishlinskii models, all without memory, for one record.

    ``y[s] = p0[s] u + sum_i p[s, i] F_i[u]``, F_i the play of threshold ``r[s, i]``.

    Parameters
    ----------
    p0
        Shape (sets,), finite.
    p
        Shape (sets, n), finite.
    r
        Shape (sets, n), each row ascending from zero or more.
    u
        Shape (N,), finite, N >= 1.
    threads
        How many threads may work on it, at least 1.

    Returns
    -------
    numpy.ndarray
        Shape (sets, N).

    Raises
    ------
    InputError
        If shapes do not fit each other, a number is not finite, a row of ``r`` does not ascend from
        zero, the output of a set overflows, or ``threads`` is not a positive integer.

    Examples
    --------
    >>> run_parameter_sets([1.0, 0.0], [[0.5], [2.0]], [[0.1], [0.2]], [0.0, 1.0])
    array([[0.  , 1.45],
           [0.  , 1.6 ]])
    """
    linear, signal = as_constants(p0, "p0"), one_record(u)
    weights, thresholds = as_signal(p, "p"), as_signal(r, "r")
    if weights.ndim != 2 or weights.shape[0] != linear.size or weights.shape != thresholds.shape:
        raise InputError(
            f"p0 has shape {linear.shape}, p {weights.shape} and r {thresholds.shape}; "
            "give (sets,), (sets, n) and (sets, n)"
        )
    for s, row in enumerate(thresholds):
        as_ascending_thresholds(row, f"r[{s}]")
    y = np.empty((linear.size, signal.size))
    bad = _engine.run_parameter_sets(linear, weights, thresholds, signal, y, as_threads(threads))
    if bad >= 0:
        raise InputError(
            f"the output of parameter set {bad} overflows; choose units in which signals and "
            "constants are of moderate size"
        )
    return y


def _possible(loop: float, lanes: float, memory_curve: float) -> dict[str, float]:
    """Give the costs of the engines that can take the stage."""
    costs = {"loop": loop, "lanes": lanes, "memory-curve": memory_curve}
    return {name: cost for name, cost in costs.items() if not np.isnan(cost)}
