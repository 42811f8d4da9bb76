"""What no observer can go below, of whatever order.

Any observer gives some stable ``E = 1 - Q``, and the stack is ``[Wu (1 - S0 E); Wp E]``. With
Pn stable and minimum phase nothing else holds inside the right half plane, so the least norm over
all stable E is that of full information: one Riccati equation, and bisection.

Gains near this bound may need a noise gain without bound. So there is another for those whose
``|Q / Pn|`` is at most nu: their stack with a third row ``mu Q / Pn`` has a norm of at most
``sqrt(norm^2 + mu^2 nu^2)``, and the least norm of three rows bounds the norm of two for every mu.
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
_ROUGH = 1e-3  # where the best of several bounds is taken
_SHARES = (0.03, 0.08, 0.15, 0.22, 0.3, 0.42)  # of mu nu in the norm reached


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
    return _least(system, low, high, _ACCURACY)


def lower_bound_at_noise(gain: StackedGain, reached: float, noise: float) -> float:
    """Give a number below the stacked norm of every observer with at most this noise gain.

    Parameters
    ----------
    gain
        The problem, ready for frequencies.
    reached
        A norm that some gain of this noise gain reaches.
    noise
        Limit of sup |Q / Pn|.
    """
    alone = _at_single_frequencies(gain)
    best = alone
    for share in _SHARES:
        row = share * reached
        system = balanced(_with_noise(gain.problem, gain.scale, noise, row))
        three = _least(system, alone, np.hypot(reached, row), _ROUGH)
        best = max(best, float(np.sqrt(max(three**2 - row**2, 0.0))))
    return best


def _least(system: LinearSystem, low: float, high: float, accuracy: float) -> float:
    """Bisect for the least norm, and give the end below it."""
    while high - low > accuracy * high:
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


def _with_noise(problem: ObserverProblem, scale: float, noise: float, row: float) -> LinearSystem:
    """Build inputs d and e, outputs Wu T d, Wp (d - noise Pn e) and row e, time in 1/scale.

    e is Q/Pn d in units of the noise gain, so that mu is row / noise. T d is -v in the loop with
    the estimate; its states are those of the loop of plant and
    controller, of a second plant that makes the estimate, and of the weights.
    """
    plant, controller, Wu, Wp = problem.plant, problem.controller, problem.Wu, problem.Wp
    inner = feedback_matrix(plant, controller)
    n, n_p, n_u = inner.shape[0], plant.order, Wu.order
    A = scipy.linalg.block_diag(inner, plant.A, Wu.A, Wp.A)
    second, of_u, of_w = (
        slice(n, n + n_p),
        slice(n + n_p, n + n_p + n_u),
        slice(n + n_p + n_u, None),
    )
    estimate, T_row = np.zeros((1, len(A))), np.zeros((1, len(A)))
    estimate[:, second] = T_row[:, second] = plant.C
    T_row[:, :n] = np.hstack([controller.D @ plant.C, -controller.C])
    A[:n_p] -= plant.B @ estimate
    A[of_u] += Wu.B @ T_row
    A[of_w] -= Wp.B @ estimate
    B = np.zeros((len(A), 2))
    B[:n_p, :1], B[second, 1:], B[of_w, :1] = plant.B, noise * plant.B, Wp.B
    C = np.vstack([Wu.D @ T_row, -Wp.D @ estimate, np.zeros((1, len(A)))])
    C[:1, of_u] += Wu.C
    C[1:2, of_w] += Wp.C
    D = np.array([[0.0, 0.0], [Wp.D[0, 0], 0.0], [0.0, row]])
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
