"""Fit hysteresis and the dynamics around it, from values that are only near.

While the dynamics are wrong, radii would run to where they make up for it, and stay there: plays
whose radius nothing reaches have no way back. So first the dynamics and the weights are fitted with
the radii held (of a hysteresis without plays: the dynamics alone), of dynamics on both sides those
behind first; then everything; then plays are put where they do more. Weights that were not negative
in the start stay so until the last step, which frees them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.bounded_least_squares import Solution, minimize
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
    lower = parametrization.lower.copy()
    lower[weights] = np.maximum(lower[weights], 0.0)
    signed = replace(parametrization, lower=lower)
    total = 0
    for held in (*_first_held(parametrization), ()):
        ends = signed.lower.copy(), signed.upper.copy()
        for end in ends:
            end[list(held)] = theta[list(held)]
        problem = problem_of(beginning, replace(signed, lower=ends[0], upper=ends[1]))
        found = minimize(problem, theta, most)
        total, theta = total + found.iterations, found.theta
    banks = [_in_chain(parametrization, bank, beginning) for bank in parametrization.banks]
    theta = with_plays_moved(problem, found, banks, most).theta
    last = minimize(problem_of(data, parametrization), theta, max_iterations)
    return replace(last, iterations=total + last.iterations)


def _first_held(parametrization: ChainParametrization) -> Iterator[tuple[int, ...]]:
    """Give what is held in the first steps: radii or all of the hysteresis, dynamics before it.

    Dynamics on both sides at once would each make up for what the other, and the hysteresis, miss.
    """
    dynamics, banks = parametrization.dynamics, parametrization.banks
    if not parametrization.single:
        return
    hysteresis = banks[0].constant if banks else parametrization.single[0]
    before = [each for each in dynamics if each.constant < hysteresis]
    places = range(parametrization.size)
    front = tuple(i for each in before for i in places[each.own])
    if len(before) == len(dynamics):
        front = ()
    radii = tuple(i for bank in banks for i in bank.radii)
    yield front + (radii or tuple(places[: len(parametrization.single)]))
    if front:
        yield front


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
