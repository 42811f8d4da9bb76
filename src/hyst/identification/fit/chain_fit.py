"""Fit hysteresis and the dynamics around it, from values that are only near.

While the dynamics are wrong, radii would run to where they make up for it, and stay there: plays
that meet, or whose radius nothing reaches, have no way back. So first the dynamics and the weights
are fitted with the radii held, then everything; then plays that do little are put where they do
more. Weights that were not negative in the start stay so until the last step, which frees them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Problem, Solution, minimize
from hyst.identification.fit.chain_parametrization import ChainParametrization, PlayBank
from hyst.identification.fit.play_moves import PlaysInChain, with_plays_moved
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.used_samples import Data
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]

MOST_OF_A_STEP = 60
"""Iterations of each step before the last."""


def fit_chain(
    parametrization: ChainParametrization,
    theta: Array,
    data: Data,
    max_iterations: int,
    beginning: Data,
) -> Solution:
    """Fit a chain with linear dynamics that are free as a whole.

    Parameters
    ----------
    parametrization, theta
        What is free, and the start.
    data
        The records.
    max_iterations
        Of each step.
    beginning
        What of the records all steps but the last take.

    Returns
    -------
    Solution
        Of the last step, with the iterations of all.
    """
    most = min(max_iterations, MOST_OF_A_STEP)
    weights = [i for bank in parametrization.banks for i in bank.weights if theta[i] >= 0.0]
    radii = [i for bank in parametrization.banks for i in bank.radii]
    lower = parametrization.lower.copy()
    lower[weights] = np.maximum(lower[weights], 0.0)
    total = 0
    if radii:
        fixed = lower.copy(), parametrization.upper.copy()
        for ends in fixed:
            ends[radii] = theta[radii]
        held = replace(parametrization, lower=fixed[0], upper=fixed[1])
        found = minimize(problem_of(beginning, held), theta, most)
        total, theta = found.iterations, found.theta
    signed: Problem = problem_of(beginning, replace(parametrization, lower=lower))
    found = minimize(signed, theta, most)
    banks = [_in_chain(parametrization, bank, beginning) for bank in parametrization.banks]
    moved = with_plays_moved(signed, found, banks, most)
    total += found.iterations + (moved.iterations if moved is not found else 0)
    last = minimize(problem_of(data, parametrization), moved.theta, max_iterations)
    return replace(last, iterations=total + last.iterations)


def _in_chain(parametrization: ChainParametrization, bank: PlayBank, data: Data) -> PlaysInChain:
    def reach(theta: Array) -> float:
        before = leaves_of(parametrization.as_template(theta))[: bank.stage]
        largest = 0.0
        for record in data.records:
            signal = record.u
            for stage in before:
                signal = stage.at_sample_time(record.dt)(signal)
            largest = max(largest, float(np.abs(signal).max()))
        return largest

    return PlaysInChain(bank.weights, bank.radii, reach)
