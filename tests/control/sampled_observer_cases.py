"""Random sampled problems, and the whole loop in matrices, for tests of sampled observers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from observer_cases import random_problem

from hyst.control import observer_problem
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.stacked_gain import SampledStackedGain
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def sampled_random_problem(seed: int) -> SampledObserverProblem:
    """A random plant at a rate that suits it, with a delay of 0 to 3 samples."""
    p, rng = random_problem(seed), np.random.default_rng(seed)
    dt = rng.uniform(0.02, 0.3) / float(np.abs(p.plant.poles()).max())
    delay = [0.0, 0.3, 1.0, 2.6][seed % 4] * dt
    C = p.controller
    for _ in range(8):
        try:
            found = observer_problem(p.plant, C, p.Wu, p.Wp, p.internal_model, dt=dt, delay=delay)
        except InputError:
            C = replace(C, B=0.5 * C.B, D=0.5 * C.D)
        else:
            assert isinstance(found, SampledObserverProblem)
            return found
    raise AssertionError(f"no controller stabilizes the plant of seed {seed}")


def some_parameters(stack: SampledStackedGain, seed: int) -> Array:
    """Poles of Q, and free eigenvalues, that are about as fast as those of the plant."""
    rng = np.random.default_rng(seed)
    size = float(np.median(np.abs(stack.plant.poles)))
    rates = np.minimum(size * 10.0 ** rng.uniform(-0.3, 0.7, stack.order), 0.9)
    pairs = stack.order // 2
    turned = rates[:pairs] * np.exp(1j * rng.uniform(0.0, 1.2, pairs))
    poles = -np.concatenate([turned, np.conj(turned), rates[2 * pairs :]])
    free = -np.minimum(size * 10.0 ** rng.uniform(-0.3, 0.7, stack.free), 0.4)
    return stack.inside(stack.parameters_of(poles, free.astype(complex) if stack.free else None))


def whole_loop(p: SampledObserverProblem, gain: Array) -> tuple[Array, Array, Array]:
    """Plant, controller and observer of eq. 32 with the sample at hand: from d to [y; d_hat]."""
    P, C = p.plant, p.controller
    model = scipy.linalg.expm(p.internal_model.A_d * p.dt)
    row = p.internal_model.C_d
    n, m, q = P.order, C.order, len(model)
    A_o = np.block([[P.A, P.B @ row], [np.zeros((q, n)), model]])
    L = gain[:, None]
    c_o = np.hstack([P.C, np.zeros((1, q))])
    correct = (row @ np.linalg.inv(model) @ L[n:])[0, 0]
    # States: plant x, controller c, observer o. y = C x; e = y - c_o o; d_hat; v.
    y = np.hstack([P.C, np.zeros((1, m + n + q))])
    e = y - np.hstack([np.zeros((1, n + m)), c_o])
    d_hat = np.hstack([np.zeros((1, n + m + n)), row]) + correct * e
    v = -C.D @ y + np.hstack([np.zeros((1, n)), C.C, np.zeros((1, n + q))]) - d_hat
    A = np.zeros((n + m + n + q, n + m + n + q))
    A[:n, :n] = P.A
    A[:n] += P.B @ v
    A[n : n + m, n : n + m] = C.A
    A[n : n + m] -= C.B @ y
    A[n + m :, n + m :] = A_o
    A[n + m :] += np.vstack([P.B, np.zeros((q, 1))]) @ v + L @ e
    return A, np.vstack([P.B, np.zeros((m + n + q, 1))]), np.vstack([y, d_hat])


def left_of_disturbance(p: SampledObserverProblem, gain: Array, w: Array) -> tuple[Array, Array]:
    """E and K S from the whole loop: y with the observer over y without, and v per noise."""
    A, B, rows = whole_loop(p, gain)
    # Canonical forms have states of very different size, which would cost this check its digits.
    A, (scale, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
    B, rows = B / scale[:, None], rows * scale
    z = np.exp(1j * w * p.dt)
    eye = np.eye(len(A))
    y = np.array([(rows[:1] @ np.linalg.solve(each * eye - A, B))[0, 0] for each in z])
    Pd, C = p.plant.response(z)[:, 0, 0], p.controller.response(z)[:, 0, 0]
    # y = Pd S d, so S is y / Pd, and K S = (1 - S) / Pd.
    S = y / Pd
    return S * (1.0 + C * Pd), (1.0 - S) / Pd
