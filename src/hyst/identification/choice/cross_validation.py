"""Blocked cross-validation: how well a family predicts stretches of record it was not fitted to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.problem import Evaluation
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

MOST_BLOCKS = 8
FEWEST_BLOCKS = 2
SMALLEST_BLOCK = 5
"""Samples; each block is scored with a free offset, so one alone would always fit."""

REFIT_ITERATIONS = 6


@dataclass(frozen=True)
class Score:
    """Prediction error on left-out blocks.

    Parameters
    ----------
    rms
        Root of the mean over blocks of the mean squared error, output units.
    standard_error
        Of ``rms``, from the scatter over the blocks.
    """

    rms: float
    standard_error: float


def fewest_left(samples: int) -> int:
    """Give how many samples are left to fit to while the largest block is hidden.

    A candidate with as many parameters cannot be judged.

    Parameters
    ----------
    samples
        Number of samples used.

    Returns
    -------
    int
    """
    return samples - -(-samples // _blocks(samples))


def cross_validate(data: Data, fit: Fit) -> Score:
    """Score a fitted family on contiguous blocks left out one after the other.

    The input is known everywhere, so the model's memory runs through the left-out block; only the
    output there is hidden from the refit, which starts at the fit of all samples. Each block is
    scored with a free offset: slow drift is no property of the hysteresis.

    Parameters
    ----------
    data
        The records.
    fit
        The family fitted to all samples.

    Returns
    -------
    Score
    """
    y = data.measured()
    blocks = _blocks(y.size)
    block_of = np.arange(y.size) * blocks // y.size
    errors = np.empty(blocks)
    evaluation = Evaluation(data, fit.parametrization)
    for block in range(blocks):
        left_out = block_of == block
        problem = fit.problem(data, ~left_out)
        theta = minimize(problem, fit.solution.theta, REFIT_ITERATIONS).theta
        residual = (evaluation.output(theta) - y)[left_out]
        errors[block] = residual.var()
    rms = float(np.sqrt(errors.mean()))
    scatter = float(errors.std(ddof=1) / np.sqrt(blocks))
    return Score(rms, scatter / (2.0 * rms) if rms > 0.0 else 0.0)


def _blocks(samples: int) -> int:
    return max(FEWEST_BLOCKS, min(MOST_BLOCKS, samples // SMALLEST_BLOCK))
