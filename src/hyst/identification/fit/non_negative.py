"""Non-negative least squares that ends."""

from __future__ import annotations

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst.errors import SolverError

Array = NDArray[np.float64]


def non_negative(matrix: Array, target: Array) -> tuple[Array, float]:
    """Minimise ``|matrix x - target|`` over ``x >= 0``.

    Parameters
    ----------
    matrix
        Shape (m, n).
    target
        Shape (m,).

    Returns
    -------
    x : numpy.ndarray
        Shape (n,).
    norm : float
        Of what is left.

    Raises
    ------
    SolverError
        If neither method ends.

    Notes
    -----
    Lawson and Hanson's active set first; where it meets a singular set or does not end, as SciPy's
    does on rare well-posed problems (its issue 22884), a bounded method that keeps its own.
    """
    try:
        x, norm = scipy.optimize.nnls(matrix, target, maxiter=10 * matrix.shape[1] + 100)
        return np.asarray(x), float(norm)
    except (RuntimeError, np.linalg.LinAlgError):
        pass
    found = scipy.optimize.lsq_linear(matrix, target, (0.0, np.inf), method="bvls", tol=1e-12)
    if not found.success or not np.isfinite(found.x).all():
        raise SolverError(
            f"non-negative least squares for {matrix.shape[1]} weights did not end; give fewer "
            "plays, or radii further apart"
        )
    x = np.maximum(found.x, 0.0)
    return x, float(np.linalg.norm(matrix @ x - target))
