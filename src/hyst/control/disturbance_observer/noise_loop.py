"""The loop as the sensor's noise sees it, in states: for norms of what noise does to the drive."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.linear_system import LinearSystem

Array = NDArray[np.float64]


def noise_to_drive(problem: ObserverProblem, gain: Array) -> LinearSystem:
    """K S, from noise on y to -v, in the loop of the problem with this gain."""
    loop = _noise_loop(problem, gain)
    return LinearSystem(loop.A, loop.B, loop.C[3:], loop.D[3:])


def noise_through_observer(problem: ObserverProblem, gain: Array) -> LinearSystem:
    """Q/Pn, from y to the estimate of d while v is held, with this gain of the problem."""
    observer = problem.observer(gain)
    return LinearSystem(observer.A, observer.B[:, 1:], observer.C, observer.D[:, 1:])


def noise_without_observer(problem: ObserverProblem) -> LinearSystem:
    """C S0, from noise on y to -v in the loop of the problem's controller alone."""
    plant, controller = problem.plant, problem.controller
    n, n_c = plant.order, controller.order
    # -v = C (y + n), in the loop y = Pn v of a plant without feedthrough.
    v = np.hstack([-controller.D @ plant.C, controller.C])
    A = scipy.linalg.block_diag(plant.A, controller.A)
    A[:n] += plant.B @ v
    A[n:, :n] -= controller.B @ plant.C
    B = np.zeros((n + n_c, 1))
    B[:n], B[n:] = -plant.B @ controller.D, -controller.B
    return LinearSystem(A, B, -v, controller.D, plant.dt)


def all_rows(problem: ObserverProblem, gain: Array) -> LinearSystem:
    """Give [Wu T; Wp (1 - Q); Wn K S] of a problem with a weight of noise and a gain, input n."""
    assert problem.Wn is not None
    plant, Wp = problem.plant, problem.Wp
    # 1 - Q = S (1 + Pn C), from y + n = S n and u = -C S n.
    error = LinearSystem(
        plant.A, np.hstack([np.zeros((plant.order, 1)), plant.B]), -plant.C, np.array([[1.0, 0.0]])
    )
    rows = [problem.Wu, _cascade(error, Wp), problem.Wn]
    joined = LinearSystem(
        *(scipy.linalg.block_diag(*(getattr(each, k) for each in rows)) for k in "ABCD")
    )
    return _cascade(_noise_loop(problem, gain), joined)


def _noise_loop(problem: ObserverProblem, gain: Array) -> LinearSystem:
    """From noise n on y: outputs T n, y + n, u = C (-y - n), and -v = K S n."""
    plant, controller, observer = problem.plant, problem.controller, problem.observer(gain)
    n, n_c = plant.order, controller.order
    size = n + n_c + observer.order
    y = np.zeros((1, size))
    y[:, :n] = plant.C
    u = np.zeros((1, size))
    u[:, :n], u[:, n : n + n_c] = -controller.D @ plant.C, controller.C
    v = u.copy()
    v[:, n + n_c :] = -observer.C
    A = scipy.linalg.block_diag(plant.A, controller.A, observer.A)
    into_v = np.vstack([plant.B, np.zeros((n_c, 1)), observer.B[:, :1]])
    into_y = np.vstack([np.zeros((n, 1)), -controller.B, observer.B[:, 1:]])
    D = controller.D
    return LinearSystem(
        A + into_v @ v + into_y @ y,
        into_y - into_v @ D,
        np.vstack([-y, y, u, -v]),
        np.vstack([np.zeros((1, 1)), np.ones((1, 1)), -D, D]),
    )


def _cascade(first: LinearSystem, second: LinearSystem) -> LinearSystem:
    """Feed the outputs of the first into the second."""
    A = scipy.linalg.block_diag(first.A, second.A)
    A[first.order :, : first.order] = second.B @ first.C
    return LinearSystem(
        A,
        np.vstack([first.B, second.B @ first.D]),
        np.hstack([second.D @ first.C, second.C]),
        second.D @ first.D,
    )
