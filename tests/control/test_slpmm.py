"""SLPMM: its programs against CVXPY, its lemma, its gains."""

from __future__ import annotations

import warnings

import cvxpy
import numpy as np
import pytest
import scipy.linalg
from observer_cases import PLANT, PRINTED_C, REPAIRED_C, WP, WU

from hyst.control import (
    LinearSystem,
    ObserverProblem,
    design_disturbance_observer,
    hinf_norm,
    observer_problem,
)
from hyst.control.disturbance_observer import slpmm as slpmm_module
from hyst.control.disturbance_observer.descent import usual_parameters
from hyst.control.disturbance_observer.generalized_plant import GeneralizedPlant, generalized_plant
from hyst.control.disturbance_observer.semidefinite import (
    SemidefiniteProgram,
    symmetric,
    upper_triangle,
)
from hyst.control.disturbance_observer.slpmm import in_coordinates_of, inequalities, slpmm
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.errors import SolverError


def start_of(problem: ObserverProblem) -> np.ndarray:
    gain = StackedGain(problem)
    return gain.gain_of(usual_parameters(gain, 1)[0])


@pytest.fixture(scope="module")
def repaired() -> ObserverProblem:
    return observer_problem(PLANT, REPAIRED_C, WU, WP)


@pytest.fixture(scope="module")
def plant(repaired: ObserverProblem) -> GeneralizedPlant:
    return in_coordinates_of(generalized_plant(repaired), start_of(repaired))[0]


def test_norm_of_slpmm_alone_on_the_printed_data() -> None:
    result = design_disturbance_observer(PLANT, PRINTED_C, WU, WP, method="slpmm")
    assert result.gamma <= 2.4
    assert result.method == "slpmm"


def test_iterations_and_distances_are_told(repaired: ObserverProblem) -> None:
    told: list[tuple[int, float, float]] = []
    result = slpmm(repaired, start_of(repaired), progress=lambda *each: told.append(each))
    assert [k for k, _, _ in told] == list(range(1, result.iterations + 1))
    assert tuple(distance for _, distance, _ in told) == result.distances
    assert abs(result.distances[-1]) < 1e-4  # P R = I is reached, of trace 9
    assert result.norm < 0.98


def test_first_program_is_that_of_cvxpy(plant: GeneralizedPlant) -> None:
    """Least trace(P) + trace(R) + gamma subject to eqs. 38a, 38b, A1 and gamma <= 1."""
    n = plant.order
    size = n * (n + 1) + 1
    cost = np.concatenate([upper_triangle(np.eye(n))] * 2 + [[1.0]])
    matrices = [*inequalities(plant), lambda x: 1.0 - x[-1:, None]]
    ours = SemidefiniteProgram(size, matrices).solve(cost, "the test").cost

    P, R = cvxpy.Variable((n, n), symmetric=True), cvxpy.Variable((n, n), symmetric=True)
    gamma = cvxpy.Variable()
    N1 = scipy.linalg.block_diag(scipy.linalg.null_space(plant.B2.T), np.eye(3))
    N2 = scipy.linalg.block_diag(scipy.linalg.null_space(plant.C2), np.eye(3))
    I1, I2 = np.eye(1), np.eye(2)
    of_r = cvxpy.bmat(
        [
            [plant.A @ R + R @ plant.A.T, R @ plant.C1.T, plant.B1],
            [plant.C1 @ R, -gamma * I2, plant.D11],
            [plant.B1.T, plant.D11.T, -gamma * I1],
        ]
    )
    of_p = cvxpy.bmat(
        [
            [plant.A.T @ P + P @ plant.A, P @ plant.B1, plant.C1.T],
            [plant.B1.T @ P, -gamma * I1, plant.D11.T],
            [plant.C1, plant.D11, -gamma * I2],
        ]
    )
    problem = cvxpy.Problem(
        cvxpy.Minimize(cvxpy.trace(P) + cvxpy.trace(R) + gamma),
        [
            N1.T @ of_r @ N1 << -1e-6 * np.eye(N1.shape[1]),
            N2.T @ of_p @ N2 << -1e-6 * np.eye(N2.shape[1]),
            cvxpy.bmat([[P, np.eye(n)], [np.eye(n), R]]) >> 0,
            gamma <= 1.0,
        ],
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of CVXPY, about its own future
        theirs = problem.solve(solver=cvxpy.CLARABEL)
    # Clarabel's gap is 1e-8; the two scale the program differently
    assert ours == pytest.approx(theirs, rel=1e-5)


def test_bounded_real_lemma_proves_the_norm(repaired: ObserverProblem) -> None:
    """P of the coordinates, the identity, proves 1.5 times the norm of the start."""
    start = start_of(repaired)
    plant, norm = in_coordinates_of(generalized_plant(repaired), start)
    A = plant.A + plant.B2 @ (start / plant.gain_units)[:, None] @ plant.C2
    proof = slpmm_module.bounded_real(
        A, plant.B1, plant.C1, plant.D11, np.eye(plant.order), 1.5 * norm
    )
    assert np.linalg.eigvalsh(proof).max() < 1e-9
    assert hinf_norm(LinearSystem(A, plant.B1, plant.C1, plant.D11))[0] == pytest.approx(norm)


def test_generalized_plant_closed_by_the_gain_is_the_loop(repaired: ObserverProblem) -> None:
    gain = start_of(repaired)
    plant = generalized_plant(repaired)
    closed = plant.A + plant.B2 @ (gain / plant.gain_units)[:, None] @ plant.C2
    Q = repaired.q_filter(gain)
    ours = np.linalg.eigvals(closed) * plant.scale
    for pole in Q.poles():
        assert np.abs(ours - pole).min() < 1e-6 * abs(pole)


def test_states_nothing_reaches_are_removed(repaired: ObserverProblem) -> None:
    # A weight with a pole and a zero at the same place shows a state to nobody.
    A, B = np.diag([-0.2, -7.0]), np.array([[1.0], [0.0]])
    weight = LinearSystem(A, B, np.array([[0.4, 1.0]]), np.array([[0.5]]))
    problem = ObserverProblem(
        repaired.plant, repaired.controller, repaired.Wu, weight, repaired.internal_model
    )
    assert generalized_plant(problem).removed == 1


def test_exact_step_is_the_minimum_of_the_parabola() -> None:
    rng = np.random.default_rng(0)
    n = 3
    size = n * (n + 1) + 1
    for _ in range(20):
        a, b = rng.normal(size=size), rng.normal(size=size)

        def cost(alpha: float, a: np.ndarray = a, b: np.ndarray = b) -> float:
            x = a + alpha * (b - a)
            half = n * (n + 1) // 2
            return float(np.trace(symmetric(x[:half], n) @ symmetric(x[half:-1], n)) + x[-1])

        alpha = slpmm_module._exact_step(a, b, n)
        assert 0.0 <= alpha <= 1.0
        if cost(1e-6) < cost(0.0):  # downhill, as the linear programs see to
            # 1e-12: the grid holds the ends, and the parabola is flat at its minimum
            assert cost(alpha) <= min(cost(x) for x in np.linspace(0, 1, 101)) + 1e-12


def test_infeasible_program_says_its_status() -> None:
    program = SemidefiniteProgram(1, [lambda x: x[:, None] - 1.0, lambda x: -x[:, None]])
    with pytest.raises(
        SolverError, match=r"the test ended as PrimalInfeasible; .* method='descent'"
    ):
        program.solve(np.ones(1), "the test")


def test_a_start_that_does_not_stabilize_is_refused(repaired: ObserverProblem) -> None:
    with pytest.raises(SolverError, match="does not stabilize"):
        slpmm(repaired, -start_of(repaired))
