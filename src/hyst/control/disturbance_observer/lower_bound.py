"""What no observer can go below, of whatever order.

Any observer gives some stable ``E = 1 - Q``, and the stack is ``[Wu (1 - S0 E); Wp E]``. With
Pn stable and minimum phase nothing else holds inside the right half plane, so the least norm over
all stable E is that of full information: one Riccati equation, and bisection.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.stacked_gain import StackedGain, feedback_matrix
from hyst.control.linear_system import LinearSystem, balanced

Array = NDArray[np.float64]

_ACCURACY = 1e-4


def lower_bound(gain: StackedGain, reached: float) -> float:
    """Give a number below the stacked norm of every observer.

    Parameters
    ----------
    gain
        The problem, ready for frequencies.
    reached
        A norm that some gain reaches.
    """
    low, high = _at_single_frequencies(gain), reached
    system = balanced(_model_matching(gain.problem, gain.scale))
    if np.linalg.norm(system.D[:, 1:]) < 1e-6:
        return low  # both weights vanish at high frequencies, and with them the equation
    while high - low > _ACCURACY * high:
        middle = 0.5 * (low + high)
        if _reachable(system, middle):
            high = middle
        else:
            low = middle
    return low


def _at_single_frequencies(gain: StackedGain) -> float:
    """Least over complex E of |Wu (1 - S0 E)|^2 + |Wp E|^2, the largest over frequency.

    E = 0 where the internal model has a pole, and E = 1 at infinity.
    """
    at = gain.grid
    size = np.sqrt(at.Wu2 * np.abs(at.S0) ** 2 + at.Wp2)
    free = np.sqrt(at.Wu2 * at.Wp2) / np.maximum(size, 1e-300)
    poles = gain.model_poles[np.abs(gain.model_poles.real) <= 1e-9 * gain.scale]
    held = np.abs(gain.Wu.response(1j * poles.imag))
    at_infinity = abs(gain.problem.Wp.D[0, 0])
    return float(max(free.max(), held.max(initial=0.0), at_infinity))


def _model_matching(problem: ObserverProblem, scale: float) -> LinearSystem:
    """Build inputs d and e = E d, outputs Wu (d - S0 e) and Wp e, time in units of 1/scale."""
    plant, controller, Wu, Wp = problem.plant, problem.controller, problem.Wu, problem.Wp
    inner = feedback_matrix(plant, controller)
    n, n_u, n_w = inner.shape[0], Wu.order, Wp.order
    # S0: from e to e + u, with u = C (-y) and y = Pn (e + u).
    S0_row = np.hstack([-controller.D @ plant.C, controller.C])
    A = scipy.linalg.block_diag(inner, Wu.A, Wp.A)
    A[n : n + n_u, :n] = -Wu.B @ S0_row
    B = np.zeros((n + n_u + n_w, 2))
    B[: plant.order, 1:] = plant.B
    B[n : n + n_u] = Wu.B @ [[1.0, -1.0]]
    B[n + n_u :, 1:] = Wp.B
    C = np.zeros((2, n + n_u + n_w))
    C[:1, :n], C[:1, n : n + n_u], C[1:, n + n_u :] = -Wu.D @ S0_row, Wu.C, Wp.C
    D = np.array([[Wu.D[0, 0], -Wu.D[0, 0]], [0.0, Wp.D[0, 0]]])
    root = np.sqrt(scale)
    return LinearSystem(A / scale, B / root, C / root, D)


def _reachable(system: LinearSystem, gamma: float) -> bool:
    """Whether some stable E has norm below gamma: whether the Riccati equation has X >= 0."""
    weight = system.D.T @ system.D - np.diag([gamma**2, 0.0])
    try:
        X = scipy.linalg.solve_continuous_are(
            system.A, system.B, system.C.T @ system.C, weight, s=system.C.T @ system.D
        )
    except np.linalg.LinAlgError:
        return False
    return bool(np.linalg.eigvalsh(0.5 * (X + X.T)).min() > -1e-6 * np.abs(X).max())
