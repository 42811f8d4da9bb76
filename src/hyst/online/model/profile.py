"""How far a constant can go while the others make up for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.online.model.window import Window

Array = NDArray[np.float64]

_WIDER = 1.6
_PASSES = 3
_DAMPING = 1e-9


@final
@dataclass(frozen=True, eq=False)
class Profile:
    """Outputs near an estimate, as far apart as they are along the window.

    Parameters
    ----------
    window
        The samples.
    weights
        Shape (N,).
    theta
        The estimate, shape (m,).
    free, scale
        Which constants are estimated, and their spreads: ``theta[free] = scale x``.
    lower, upper
        Bounds, shape (m,).
    most
        Weighted squares by which outputs may differ and the constants still be as likely.
    """

    window: Window
    weights: Array
    theta: Array
    free: NDArray[np.intp]
    scale: Array
    lower: Array
    upper: Array
    most: float

    def reach(self, k: int, step: Array, farthest: float) -> float:
        """Give how far a constant goes until outputs differ by too much, whatever the others do.

        Parameters
        ----------
        k
            Its place among those that are estimated.
        step
            Shape (f,), where to begin, in x: what it reaches at least.
        farthest
            Where to stop, in x.

        Returns
        -------
        float
            In its own units, from the estimate.
        """
        with np.errstate(all="ignore"):
            y0 = self.window.outputs(self.theta)[0]
            before = abs(float(step[k]))
            while True:
                step = self._eased(k, step, y0)
                size = abs(float(step[k]))
                apart = self._apart(self._at(step), y0)
                if not apart < self.most or size >= farthest:
                    break
                before, step = size, _WIDER * step
        if apart > self.most and size > before:
            size = min(max(size * float(np.sqrt(self.most / apart)), before), size)
        return min(size, max(farthest, before)) * float(self.scale[k])

    def _at(self, step: Array) -> Array:
        theta = self.theta.copy()
        theta[self.free] += self.scale * step
        return np.clip(theta, self.lower, self.upper)

    def _apart(self, theta: Array, y0: Array) -> float:
        apart = self.window.outputs(theta)[0] - y0
        return float(self.weights @ apart**2)

    def _eased(self, k: int, step: Array, y0: Array) -> Array:
        """Move the other constants to where outputs differ least."""
        others = np.delete(np.arange(step.size), k)
        best, least = step, self._apart(self._at(step), y0)
        for _ in range(_PASSES if others.size else 0):
            y, jacobian = self.window.sensitivity(self._at(best))
            columns = jacobian[:, self.free[others]] * self.scale[others]
            matrix = columns.T @ (columns * self.weights[:, None])
            force = columns.T @ (self.weights * (y0 - y))
            if not (np.isfinite(matrix).all() and np.isfinite(force).all()):
                break
            damping = _DAMPING * float(np.trace(matrix)) + np.finfo(float).tiny
            trial = best.copy()
            trial[others] += np.linalg.solve(matrix + damping * np.eye(others.size), force)
            apart = self._apart(self._at(trial), y0)
            if not apart < least:
                break
            best, least = trial, apart
        return best
