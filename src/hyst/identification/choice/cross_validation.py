"""Cross-validation: how well a family predicts what of a record it was not fitted to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.choice.blocks import Block, blocks_of
from hyst.identification.families.family import Fit
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.left_out import normal_equations_without, refitted
from hyst.identification.fit.normal_equations import NormalEquations
from hyst.identification.fit.whiteness import is_white
from hyst.identification.record_use.outlying import winsorised
from hyst.identification.record_use.overview import Overview

Array = NDArray[np.float64]

REFIT_ITERATIONS = 6

TO_EARN = 4.0
"""Squared error, in residual variances, that a number must save in the samples it is fitted to."""


@dataclass(frozen=True, eq=False)
class Score:
    """Prediction error on left-out blocks.

    Parameters
    ----------
    errors
        Shape (blocks,), mean squared error of each, output units squared.
    """

    errors: Array

    @property
    def rms(self) -> float:
        """Root of the mean over the blocks, output units."""
        return float(np.sqrt(self.errors.mean()))

    @property
    def standard_error(self) -> float:
        """Of ``rms``, from the scatter over the blocks."""
        rms = self.rms
        return _error_of_mean(self.errors) / (2.0 * rms) if rms > 0.0 else 0.0

    def seems_worse(self, other: Score, negligible: float = 0.0) -> bool:
        """Tell whether it is worse than another by more than one standard error of the difference.

        Blocks that are hard for one are hard for the other, so the difference is known better than
        either. Where some blocks are much harder than others, their differences scatter as much,
        but the ratios do not; so either may show it.

        Parameters
        ----------
        other
            Of the same records, or its blocks could not be paired.
        negligible
            Difference of mean squared errors that is none, output units squared.
        """
        excess = float(self.errors.mean() - other.errors.mean())
        if excess <= negligible:
            return False
        if self.errors.size != other.errors.size:  # averages of other blocks
            alone = np.hypot(_error_of_mean(self.errors), _error_of_mean(other.errors))
            return excess > float(alone)
        if excess > _error_of_mean(self.errors - other.errors):
            return True
        both = (self.errors > 0.0) & (other.errors > 0.0)
        ratios = np.log(self.errors[both] / other.errors[both])
        return ratios.size > 1 and float(ratios.mean()) > _error_of_mean(ratios)


def fewest_left(overview: Overview) -> int:
    """Give how many samples are left to fit to while the largest block is hidden.

    A candidate with as many parameters cannot be judged.

    Parameters
    ----------
    overview
        The records.

    Returns
    -------
    int
    """
    blocks = overview.once("blocks", lambda: blocks_of(overview))
    return overview.input.size - max(int(each.rows.sum()) for each in blocks)


def cross_validate(overview: Overview, fit: Fit) -> Score:
    """Score a fitted family on blocks left out one after the other.

    The input is known everywhere, so the model's memory runs through the left-out block; only the
    output there is hidden from the refit, which starts at the fit of all samples. Every stretch of
    a block is scored with a free offset: slow drift is no property of the hysteresis. Samples that
    are far from every model are neither fitted nor judged by.

    Parameters
    ----------
    overview
        The records.
    fit
        The family fitted to all samples.

    Returns
    -------
    Score
    """
    data, kept = overview.data, overview.kept
    y = data.measured()
    blocks = overview.once("blocks", lambda: blocks_of(overview))
    evaluation = Evaluation(data, fit.parametrization)
    errors = np.empty(len(blocks))
    for number, (block, theta) in enumerate(
        zip(blocks, _refits(overview, fit, blocks), strict=True)
    ):
        residual = (evaluation.output(theta) - y)[block.rows]
        judged = np.ones(residual.size, dtype=bool) if kept is None else kept[block.rows]
        errors[number] = _mean_square(residual[judged], Block(block.rows, block.stretch[judged]))
    return Score(errors)


def _refits(overview: Overview, fit: Fit, blocks: list[Block]) -> Iterator[Array]:
    """Give theta of the fit without each of the blocks."""
    data, kept, theta = overview.data, overview.kept, fit.solution.theta
    shared: list[NormalEquations] = []
    if fit.parametrization.nuisances is None:  # columns beside the model differ in every block
        shared = normal_equations_without(
            data,
            fit.parametrization,
            theta,
            [each.rows for each in blocks],
            kept,
            fit.family.root_weights(data),
        )
    for number, block in enumerate(blocks):
        problem = fit.problem(data, ~block.rows if kept is None else kept & ~block.rows)
        if shared:
            yield refitted(problem, theta, shared[number], REFIT_ITERATIONS)
        else:
            yield minimize(problem, theta, REFIT_ITERATIONS).theta


def score_in_sample(overview: Overview, fit: Fit) -> Score:
    """Score a fit on the samples it was fitted to, dearer the more numbers it has.

    Behind dynamics a block that is left out takes a part of the frequencies with it, and the rest
    says little of it. So every block has its error in the fit of all, times what each number has to
    earn: twice what Akaike's criterion asks, so that one of them in twenty is taken by chance.

    Parameters
    ----------
    overview
        The records.
    fit
        The family fitted to all samples.
    """
    residual = residual_of(overview, fit)
    blocks = overview.once("blocks", lambda: blocks_of(overview))
    errors = np.array([float(np.mean(np.square(residual[each.rows]))) for each in blocks])
    count = residual.size
    return Score(errors * np.exp(TO_EARN * fit.parametrization.free_count / count))


def residual_of(overview: Overview, fit: Fit) -> Array:
    """Give what a fit leaves of its samples, beside what it takes for no part of the model.

    Parameters
    ----------
    overview
        The records.
    fit
        The family fitted to all samples.
    """
    data = overview.data
    return fit.problem(data).residual(fit.solution.theta)[: data.measured().size]


def leaves_white_noise(overview: Overview, fit: Fit) -> bool:
    """Tell whether no sample of what a fit leaves is like another near it, so nothing is missing.

    Parameters
    ----------
    overview
        The records.
    fit
        The family fitted to all samples.
    """
    return is_white(residual_of(overview, fit))


def _mean_square(residual: Array, block: Block) -> float:
    if residual.size == 0:
        return 0.0
    _, place = np.unique(block.stretch, return_inverse=True)
    offsets = np.bincount(place, residual) / np.bincount(place)
    return float(winsorised(residual - offsets[place]).mean())


def _error_of_mean(values: Array) -> float:
    return float(values.std(ddof=1) / np.sqrt(values.size)) if values.size > 1 else 0.0
