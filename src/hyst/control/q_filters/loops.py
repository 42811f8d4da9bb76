"""The systems whose norms say what a Q-filter does, each built from the filter alone."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from hyst.control.disturbance_observer.stacked_gain import feedback_matrix
from hyst.control.linear_system import LinearSystem, in_series
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.problem import QFilterProblem
from hyst.control.q_filters.realization import Channel, shared_realization


def weighted_stack(problem: QFilterProblem, Q: LinearSystem) -> LinearSystem:
    """Give [Wu T; Wp (1 - Q)] as a system from d, with T = 1 - S0 (1 - Q), S1 eq. 36.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    Q
        The filter.
    """
    left = LinearSystem(Q.A, Q.B, -Q.C, 1.0 - Q.D)
    loop = disturbed_loop(problem)
    S0 = LinearSystem(loop.A, loop.B[:, :1], loop.C, loop.D[:, :1])
    after = in_series(left, S0)
    n = left.order
    T = LinearSystem(after.A, after.B, -after.C, 1.0 - after.D)
    both = LinearSystem(
        T.A,
        T.B,
        np.vstack([T.C, np.hstack([left.C, np.zeros((1, T.order - n))])]),
        np.vstack([T.D, left.D]),
    )
    return in_series(both, _side_by_side(problem.Wu, problem.Wp))


def disturbed_loop(problem: QFilterProblem) -> LinearSystem:
    """Close plant and controller: inputs at the plant's input and at the sensor, output S0 of both.

    The output is what the plant is given: ``w = e - C (Pn w + n)``.
    """
    plant, controller = problem.plant, problem.controller
    share = 1.0 / (1.0 + float(plant.D[0, 0] * controller.D[0, 0]))
    w_x = share * np.hstack([-controller.D @ plant.C, controller.C])
    w_in = share * np.array([[1.0, -controller.D[0, 0]]])
    y_in = plant.D @ w_in + np.array([[0.0, 1.0]])
    B = np.vstack([plant.B @ w_in, -controller.B @ y_in])
    return LinearSystem(feedback_matrix(plant, controller), B, w_x, w_in)


def filtered_inverse(problem: QFilterProblem, Q: QFilter) -> LinearSystem:
    """Give Q/Pn, from y to what the observer takes the plant's input for.

    Parameters
    ----------
    problem, Q
        As for ``q_observer``.
    """
    observer = q_observer(problem, Q)
    return LinearSystem(observer.A, observer.B[:, 1:], observer.C, observer.D[:, 1:])


def noise_loop(problem: QFilterProblem, Q: QFilter) -> LinearSystem:
    """Give the loop from sensor noise to v, -T/Pn: noise times -(C + Q/Pn) S0.

    Parameters
    ----------
    problem, Q
        As for ``q_observer``.
    """
    inverse = filtered_inverse(problem, Q)
    both = LinearSystem(
        inverse.A,
        inverse.B,
        np.vstack([-inverse.C, np.zeros((1, inverse.order))]),
        np.vstack([-inverse.D, [[1.0]]]),
    )
    return in_series(both, disturbed_loop(problem))


def q_observer(problem: QFilterProblem, Q: QFilter) -> LinearSystem:
    """Give the observer ``d_hat = Q (y / Pn - v)``: inputs v and y, S1 eq. 35.

    Its poles are those of Q and the zeros of the plant that Q does not have; what Q has of the
    plant's zeros is cancelled here, in the factors.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    Q
        Of at least the plant's relative degree, with the zeros of ``kept_zeros``.
    """
    plant, factors = problem.plant_factors, Q.factors
    poles = np.concatenate([factors.poles, problem.inverted_zeros])
    own = _without(factors.zeros, problem.kept_zeros)
    from_v = np.concatenate([factors.zeros, problem.inverted_zeros])
    from_y = np.concatenate([own, plant.poles])
    channels = [Channel(-factors.gain, from_v), Channel(factors.gain / plant.gain, from_y)]
    return shared_realization(poles, channels, Q.dt)


def _without(values: np.ndarray, taken: np.ndarray) -> np.ndarray:
    """Leave out the value nearest to each of those taken."""
    left = list(values)
    for each in taken:
        left.pop(int(np.argmin(np.abs(np.array(left) - each))))
    return np.array(left, dtype=complex)


def _side_by_side(first: LinearSystem, second: LinearSystem) -> LinearSystem:
    n, m = first.order, second.order
    A = np.zeros((n + m, n + m))
    A[:n, :n], A[n:, n:] = first.A, second.A
    B, C = np.zeros((n + m, 2)), np.zeros((2, n + m))
    B[:n, :1], B[n:, 1:], C[:1, :n], C[1:, n:] = first.B, second.B, first.C, second.C
    return LinearSystem(A, B, C, scipy.linalg.block_diag(first.D, second.D))
