"""The part of the Hessian that Gauss-Newton leaves out, learned from the gradients along the steps.

Where a model leaves more than noise, the residual times its second derivative slows Gauss-Newton to
linear convergence. A secant of that part costs no look at the record.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.normal_equations import NormalEquations

Array = NDArray[np.float64]


class Curvature:
    """A symmetric secant of the sum of residual times second derivative.

    Notes
    -----
    Dennis, Gay and Welsch, An adaptive nonlinear least-squares algorithm, ACM TOMS 7 (1981), with
    their sizing.
    """

    def __init__(self) -> None:
        self._matrix: Array | None = None

    def added_to(self, normal: NormalEquations) -> NormalEquations:
        """Give normal equations with what was learned; their own where that would not be convex.

        Parameters
        ----------
        normal
            Of the sum of squares.
        """
        if self._matrix is None:
            return normal
        matrix = normal.matrix + self._matrix
        scale = np.sqrt(np.maximum(normal.matrix.diagonal(), 1e-300))
        lowest = np.linalg.eigvalsh(matrix / scale[:, None] / scale)[0]
        own = np.linalg.eigvalsh(normal.matrix / scale[:, None] / scale)[0]
        return replace(normal, matrix=matrix) if lowest > 0.1 * own else normal

    def learn(self, step: Array, before: NormalEquations, after: NormalEquations) -> None:
        """Take up how the gradient changed over a step.

        Parameters
        ----------
        step
            Shape (m,).
        before, after
            Normal equations at its ends.
        """
        change = after.gradient - before.gradient
        along = float(change @ step)
        if along <= 0.0:
            return
        missed = change - after.matrix @ step
        own = np.zeros_like(after.matrix) if self._matrix is None else self._matrix
        size = abs(float(step @ own @ step))
        own = own * (min(1.0, abs(float(step @ missed)) / size) if size > 0.0 else 1.0)
        left = missed - own @ step
        both = np.outer(left, change) / along
        twice = float(left @ step) / along**2
        self._matrix = own + both + both.T - twice * np.outer(change, change)
