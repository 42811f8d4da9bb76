"""The gain by sequential linear programming with matrices (SLPMM), the appendix of the paper.

A gain with norm below gamma exists if positive definite P and R satisfy two linear matrix
inequalities, eqs. 38a and 38b, and P R = I. The last is relaxed to [P I; I R] >= 0, and
trace(P R) + gamma is minimized by linear programs in turn; trace(P R) = n is what is wanted.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.disturbance_observer.certificate import weighted_loop
from hyst.control.disturbance_observer.generalized_plant import GeneralizedPlant, generalized_plant
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.semidefinite import (
    SemidefiniteProgram,
    symmetric,
    upper_triangle,
)
from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem
from hyst.errors import SolverError

Array = NDArray[np.float64]

_EACH = 4  # iterations between two gains
_STRICT = 1e-6  # what "negative definite" means, in coordinates where P is near 1


@dataclass(frozen=True)
class SlpmmResult:
    """What the iteration found.

    ``gain``, its exact ``norm``, the number of ``iterations``, and ``distances``, trace(P R) - n
    after each.
    """

    gain: Array
    norm: float
    iterations: int
    distances: tuple[float, ...]


def slpmm(
    problem: ObserverProblem,
    start: Array,
    iterations: int = 14,
    tolerance: float = 1e-4,
    progress: Callable[[int, float, float], None] | None = None,
) -> SlpmmResult:
    """Iterate the appendix's steps 1 to 5, and take the best of the gains met.

    Parameters
    ----------
    problem
        Plant, controller, weights and internal model.
    start
        A stabilizing gain, (order,). It gives the coordinates in which P and R are near 1, and the
        bound on gamma: 1 as in the paper if its norm is below, else 1.2 times its norm, so that
        the inequalities can be met.
    iterations
        At most so many.
    tolerance
        Ends when trace(P R) - n is below this share of n and trace(P R) + gamma falls by less.
    progress
        Called after each with its number, trace(P R) - n and the best norm so far.

    Raises
    ------
    SolverError
        If a semidefinite program fails, or no gain that stabilizes was found.
    """
    plant, norm = in_coordinates_of(generalized_plant(problem), start)
    n = plant.order
    cap = 1.0 if norm < 1.0 else 1.2 * norm
    matrices = [*inequalities(plant), lambda x: cap - x[-1:, None]]
    program = SemidefiniteProgram(n * (n + 1) + 1, matrices)
    # Any P and R that meet the inequalities will do; those of least trace are away from infinity.
    diagonal = upper_triangle(np.eye(n))
    point = program.solve(np.concatenate([diagonal, diagonal, [1.0]]), "the start").point
    best_gain, best_norm = np.zeros(0), np.inf
    distances: list[float] = []
    for k in range(iterations):
        P, R, gamma = _parts(point, n)
        before = float(np.sum(P * R)) + gamma
        cost = np.concatenate([_trace_with(R), _trace_with(P), [1.0]])
        try:
            towards = program.solve(cost, f"iteration {k + 1}").point
        except SolverError:
            if np.isfinite(best_norm):
                break  # what was found stays found
            raise
        alpha = _exact_step(point, towards, n)
        point = point + alpha * (towards - point)
        P, R, gamma = _parts(point, n)
        distances.append(float(np.sum(P * R)) - n)
        ended = before - distances[-1] - n - gamma < tolerance * n or k + 1 == iterations
        for L in _gains(plant, P, R, gamma) if k % _EACH == 0 or ended else ():
            norm = hinf_norm(weighted_loop(problem, L))[0]
            if norm < best_norm:
                best_gain, best_norm = L, norm
        if progress is not None:
            progress(k + 1, distances[-1], best_norm)
        if ended:
            break
    if not np.isfinite(best_norm):
        raise SolverError(
            f"no stabilizing gain in {len(distances)} iterations, trace(P R) - n is "
            f"{distances[-1]:.3g}; allow more iterations or use method='descent'"
        )
    return SlpmmResult(best_gain, best_norm, len(distances), tuple(distances))


def in_coordinates_of(plant: GeneralizedPlant, gain: Array) -> tuple[GeneralizedPlant, float]:
    """Choose states in which P = R = 1 proves a norm 1.5 times that of a stabilizing gain.

    Without it P and R have entries from 1e-5 to 1e5 and no solver gets far.

    Parameters
    ----------
    plant
        In any states.
    gain
        L, (order of the observer,), in the units of the problem.

    Raises
    ------
    SolverError
        If the gain does not stabilize the plant.
    """
    A = plant.A + plant.B2 @ (gain / plant.gain_units)[:, None] @ plant.C2
    B, C, D = plant.B1, plant.C1, plant.D11
    norm = hinf_norm(LinearSystem(A, B, C, D))[0]
    if not np.isfinite(norm):
        raise SolverError("the start does not stabilize the observer; give another, or none")
    T = np.eye(plant.order)
    for _ in range(3):  # each round in the coordinates of the one before, so the last is accurate
        inverse = np.linalg.inv(T)
        T = _root_of_proof(T @ A @ inverse, T @ B, C @ inverse, D, norm) @ T
    inverse = np.linalg.inv(T)
    B2, C2 = T @ plant.B2, plant.C2 @ inverse
    columns, row = np.linalg.norm(B2, axis=0), float(np.linalg.norm(C2))
    moved = replace(
        plant,
        A=T @ plant.A @ inverse,
        B1=T @ B,
        B2=B2 / columns,
        C1=C @ inverse,
        C2=C2 / row,
        gain_units=plant.gain_units / (columns * row),
    )
    return moved, norm


def _root_of_proof(A: Array, B: Array, C: Array, D: Array, norm: float) -> Array:
    """Find T with P = T'T a proof of the bounded real lemma, for a norm a little above."""
    # A little is added to C'C so that P is definite; slow states bear only very little.
    for above, added in ((1.5, 1e-4), (1.5, 1e-7), (3.0, 1e-9), (10.0, 1e-10)):
        gamma = above * norm
        try:
            P = scipy.linalg.solve_continuous_are(
                A, B, C.T @ C + added * np.eye(len(A)), D.T @ D - gamma**2 * np.eye(1), s=C.T @ D
            )
        except np.linalg.LinAlgError:
            continue
        sizes, vectors = np.linalg.eigh(0.5 * (P + P.T) / gamma)
        if sizes[-1] > 0.0:
            return np.asarray(np.sqrt(np.maximum(sizes, 1e-9 * sizes[-1]))[:, None] * vectors.T)
    return np.eye(len(A))  # balanced states are all that is left to try


def inequalities(
    plant: GeneralizedPlant, strict: float = _STRICT
) -> list[Callable[[Array], Array]]:
    """Give eqs. 38a and 38b for the plant, signs turned and at least ``strict``, and A1."""
    n = plant.order
    A, B1, C1, D11 = plant.A, plant.B1, plant.C1, plant.D11
    # D12 = D21 = 0: the gain acts on the observer's states and sees no disturbance directly.
    N1 = scipy.linalg.block_diag(scipy.linalg.null_space(plant.B2.T), np.eye(2))
    N2 = scipy.linalg.block_diag(scipy.linalg.null_space(plant.C2), np.eye(1))
    N1, N2 = scipy.linalg.block_diag(N1, np.eye(1)), scipy.linalg.block_diag(N2, np.eye(2))

    def of_r(x: Array) -> Array:
        _, R, gamma = _parts(x, n)
        full = np.block(
            [
                [A @ R + R @ A.T, R @ C1.T, B1],
                [C1 @ R, -gamma * np.eye(2), D11],
                [B1.T, D11.T, -gamma * np.eye(1)],
            ]
        )
        return np.asarray(-N1.T @ full @ N1 - strict * np.eye(N1.shape[1]))

    def of_p(x: Array) -> Array:
        P, _, gamma = _parts(x, n)
        proof = bounded_real(A, B1, C1, D11, P, gamma)
        return np.asarray(-N2.T @ proof @ N2 - strict * np.eye(N2.shape[1]))

    def coupling(x: Array) -> Array:
        P, R, _ = _parts(x, n)
        return np.block([[P, np.eye(n)], [np.eye(n), R]])

    return [of_r, of_p, coupling]


def bounded_real(A: Array, B: Array, C: Array, D: Array, P: Array, gamma: float) -> Array:
    """Matrix of the bounded real lemma: negative if P proves ``|C (sI - A)^-1 B + D| < gamma``."""
    return np.block(
        [
            [A.T @ P + P @ A, P @ B, C.T],
            [B.T @ P, -gamma * np.eye(B.shape[1]), D.T],
            [C, D, -gamma * np.eye(C.shape[0])],
        ]
    )


def _gains(plant: GeneralizedPlant, P: Array, R: Array, gamma: float) -> list[Array]:
    """Gains that meet eq. 39 best, with P and with R inverted in its place.

    The inequality is as good as an equation once P R = I; so the largest eigenvalue of its left
    side is minimized, and the exact norm decides.
    """
    found = []
    count = plant.B2.shape[1]
    for shape in (P, np.linalg.inv(R)):
        lyapunov = 0.5 * (shape + shape.T)

        def closed(x: Array, P: Array = lyapunov) -> Array:
            A = plant.A + plant.B2 @ x[:count, None] @ plant.C2
            proof = bounded_real(A, plant.B1, plant.C1, plant.D11, P, gamma)
            return x[count] * np.eye(proof.shape[0]) - proof

        program = SemidefiniteProgram(count + 1, [closed])
        with contextlib.suppress(SolverError):  # the other one, or a later one, may do
            point = program.solve(np.eye(count + 1)[-1], "the gain").point
            found.append(np.asarray(plant.gain_units * point[:count]))
    return found


def _exact_step(point: Array, towards: Array, n: int) -> float:
    """Least of trace(P R) + gamma on the way, a parabola in alpha (A3)."""
    P, R, gamma = _parts(point, n)
    P_1, R_1, gamma_1 = _parts(towards, n)
    bend = float(np.sum((P_1 - P) * (R_1 - R)))
    slope = float(np.sum((P_1 - P) * R) + np.sum(P * (R_1 - R))) + gamma_1 - gamma
    if slope >= 0.0:
        return 0.0
    return 1.0 if bend <= 0.0 else min(1.0, -0.5 * slope / bend)


def _parts(x: Array, n: int) -> tuple[Array, Array, float]:
    half = n * (n + 1) // 2
    return symmetric(x[:half], n), symmetric(x[half : 2 * half], n), float(x[-1])


def _trace_with(matrix: Array) -> Array:
    """Give the linear function X -> trace(X matrix) of the upper triangle of X."""
    return upper_triangle(2.0 * matrix - np.diag(np.diag(matrix)))
