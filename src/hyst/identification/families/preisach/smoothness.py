"""How smooth a density is: the strength of the prior, chosen on left-out parts of the records.

The best one is taken of records that show minor loops. Blocks of one amplitude repeat each other
and say nothing of what is inside: of those the largest strength is taken that predicts no worse.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.identification.choice.blocks import Block
from hyst.identification.choice.cross_validation import Score
from hyst.identification.fit.bounded_quadratic import least_within
from hyst.identification.record_use.outlying import winsorised

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

MIDDLE = 1e-4
STEP = float(np.sqrt(10.0))
MOST_STEPS = 10
"""Steps either way from the middle: from 1e-9 to 10."""

BORNE = 1.1
"""Residual under a prior over that under a weak one, each allowed for its constants, up to which
the samples bear it."""

IDLE = 2
"""Steps in a row that predict worse, until no other is tried."""


@dataclass(frozen=True, eq=False)
class LinearFit:
    """Weights of columns, and what is needed to find them again without some samples.

    Parameters
    ----------
    columns
        Shape (N, m), what the output is made of.
    y
        Shape (N,), measured.
    lower, upper
        Shape (m,).
    prior
        Shape (q, m), rows that are small, over the norm of the centred output, at a strength of 1.
    """

    columns: Array
    y: Array
    lower: Array
    upper: Array
    prior: Array

    @property
    def spread(self) -> float:
        """Norm of the centred output."""
        return float(np.linalg.norm(self.y - self.y.mean()))

    def held(self, strength: float) -> Array:
        """Give what the prior adds to the normal matrix.

        Parameters
        ----------
        strength
            Of the prior.
        """
        rows = (strength * self.spread) * self.prior
        return np.asarray(rows.T @ rows)

    def gram(self, rows: Rows) -> tuple[Array, Array]:
        """Give normal matrix and moment of some samples.

        Parameters
        ----------
        rows
            Shape (N,), which.
        """
        part = self.columns[rows]
        return part.T @ part, part.T @ self.y[rows]

    def solve(self, normal: Array, moment: Array, first: Array) -> Array:
        """Solve for the weights.

        Parameters
        ----------
        normal, moment
            Of samples, the prior's part included.
        first
            Shape (m,): what lies on a bound there is held at first.
        """
        return least_within(normal, moment, self.lower, self.upper, first)


def effective_count(normal: Array, held: Array, free: Rows) -> float:
    """Give how many free parameters the samples determine, those that the prior holds left out.

    Parameters
    ----------
    normal, held
        Shape (m, m), of the samples and of the prior.
    free
        Shape (m,), which parameters lie on no bound.

    Notes
    -----
    Trace of ``(A + P)^-1 A``: Craven and Wahba, Numerische Mathematik 31 (1979), 377-403.
    """
    inner = np.ix_(free, free)
    both = normal[inner] + held[inner]
    scale = np.sqrt(np.maximum(np.diag(both), np.finfo(float).tiny))
    scaled = both / np.outer(scale, scale) + 1e-12 * np.eye(scale.size)
    share = np.linalg.solve(scaled, normal[inner] / np.outer(scale, scale))
    return float(np.trace(share))


def chosen_strength(
    fit: LinearFit, blocks: Sequence[Block], kept: Rows | None, *, smoothest: bool
) -> float:
    """Choose the strength of the prior.

    Parameters
    ----------
    fit
        Columns and measured output.
    blocks
        What is left out together.
    kept
        Shape (N,), which samples are fitted and judged by; None for all.
    smoothest
        Whether to take the largest that does not predict worse, and not the best.
    """
    counts = np.ones(fit.y.size, dtype=bool) if kept is None else kept
    scores = _Scores(fit, blocks, counts)
    best = _walk(scores, 0)
    step = best
    while smoothest and step < MOST_STEPS and not scores.of(step + 1).seems_worse(scores.of(best)):
        step += 1
    return _strength(step)


def borne_strength(
    fit: LinearFit, rows: Rows, strength: float, start: Array, least: float
) -> float:
    """Lower a strength until it leaves no more of the samples than a weak prior does.

    What left-out parts choose may be a valley among several: a prior that bends the fit away from
    what was measured would give its constants far outside their errors.

    Parameters
    ----------
    fit
        Columns and measured output.
    rows
        Shape (N,), which samples are fitted.
    strength
        As chosen.
    start
        Shape (m,), within its bounds.
    least
        A residual that is none, output units.
    """
    normal, moment = fit.gram(rows)

    def left(tried: float) -> float:
        held = fit.held(tried)
        theta = fit.solve(normal + held, moment, start + 1.0)
        free = (theta > fit.lower) & (theta < fit.upper)
        residual = (fit.columns @ theta - fit.y)[rows]
        freedom = max(residual.size - effective_count(normal, held, free), 1.0)
        return float(np.sqrt(residual @ residual / freedom))

    most = max(BORNE * left(_strength(-MOST_STEPS)), least)
    while strength > _strength(-MOST_STEPS) and left(strength) > most:
        strength /= STEP
    return strength


def _strength(step: int) -> float:
    return MIDDLE * STEP**step


def _walk(scores: _Scores, start: int) -> int:
    """Go downhill from a strength, either way, and a little on."""
    best = start
    for way in (1, -1):
        idle, step = 0, start
        while idle < IDLE and abs(step + way) <= MOST_STEPS:
            step += way
            better = scores.of(step).rms < scores.of(best).rms
            idle = 0 if better else idle + 1
            best = step if better else best
        if best != start:
            break
    return best


class _Scores:
    """Prediction errors of strengths, each worked out once."""

    def __init__(self, fit: LinearFit, blocks: Sequence[Block], kept: Rows) -> None:
        self._fit, self._kept, self._blocks = fit, kept, blocks
        normal, moment = fit.gram(kept)
        self._left = []
        for block in blocks:
            part = fit.gram(kept & block.rows)
            self._left.append((normal - part[0], moment - part[1]))
        self._found: dict[int, Score] = {}
        self._first = [np.ones(fit.lower.size)] * len(blocks)

    def of(self, step: int) -> Score:
        """Give the score of a strength."""
        if step not in self._found:
            held = self._fit.held(_strength(step))
            self._found[step] = Score(
                np.array([self._error(i, held) for i in range(len(self._blocks))])
            )
        return self._found[step]

    def _error(self, number: int, held: Array) -> float:
        fit, block = self._fit, self._blocks[number]
        normal, moment = self._left[number]
        weights = fit.solve(normal + held, moment, self._first[number])
        self._first[number] = weights
        judged = self._kept[block.rows]
        if not judged.any():
            return 0.0
        left = (fit.columns[block.rows] @ weights - fit.y[block.rows])[judged]
        # Every stretch with a free offset: slow drift is no property of the hysteresis.
        _, place = np.unique(block.stretch[judged], return_inverse=True)
        offsets = np.bincount(place, left) / np.bincount(place)
        return float(winsorised(left - offsets[place]).mean())
