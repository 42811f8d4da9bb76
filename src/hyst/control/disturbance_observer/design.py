"""Design of a disturbance observer: the gain of least H-infinity norm, certified."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from hyst.control.discretization import Method
from hyst.control.disturbance_observer.assumptions import check_assumptions
from hyst.control.disturbance_observer.certificate import certify, weighted_loop
from hyst.control.disturbance_observer.descent import descend_from_many, usual_parameters
from hyst.control.disturbance_observer.discrete.design import (
    design_sampled_observer,
    evaluate_sampled_gain,
    is_discrete,
    sampled_observer_problem,
)
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.internal_model import as_internal_model
from hyst.control.disturbance_observer.lower_bound import lower_bound
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.result import DisturbanceObserver
from hyst.control.disturbance_observer.slpmm import slpmm
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError, SolverError

Array = NDArray[np.float64]

METHODS = ("slpmm+descent", "slpmm", "descent")
# Iterations of SLPMM: all of them, as many as the paper's, or a few where each takes long and the
# descent that follows needs no more than a start.
_FULL, _FEW, _LARGE = 14, 2, 5


def design_disturbance_observer(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    internal_model: Any = "integrator",
    *,
    dt: float | None = None,
    delay: float = 0.0,
    discretization: Method = "tustin",
    perturbed_plant: Any = None,
    method: str = "slpmm+descent",
    starts: int | None = None,
    seed: int = 0,
    progress: Callable[[str, int, float], None] | None = None,
) -> DisturbanceObserver:
    r"""Find the gain of a disturbance observer that rejects most within a given uncertainty.

    ``min over L of || [Wu T; Wp (1 - Q)] ||_inf``

    Systems are transfer functions or state spaces of python-control, pairs (num, den), matrices
    (A, B, C, D) or numbers, in continuous time, with one input and one output.

    With a sample time the design is in discrete time: ``observer`` is then the sampled observer
    that runs, its estimate already corrected by the y at hand; the norm is that of the sampled loop
    with hold, delay and all aliases; no pole of Q is faster than half of Nyquist.

    Parameters
    ----------
    plant
        Nominal plant Pn: strictly proper, stable, minimum phase, observable. With a sample time any
        stable one; also one that is sampled, or LinearDynamics, whose dt is then that of the
        design.
    controller
        C, in u = C (y_ref - y); stabilizes Pn. Sampled as it is, or continuous.
    Wu
        Weight of the multiplicative uncertainty, P = Pn (1 + Delta), |Delta| <= |Wu|; stable.
    Wp
        Weight of 1 - Q, what is left of the disturbance; stable.
    internal_model
        InternalModel, pair (A_d, C_d), ``"integrator"`` or ``"ramp"``; an eigenvalue at 0.
    dt
        Sample time of the observer, s; in continuous time if left out and the plant is continuous.
    delay
        From the sample of y to the drive that follows from it, s, at least 0: whole and fractional
        samples; whole ones if the plant is sampled.
    discretization
        How a continuous controller is sampled: ``"tustin"`` or ``"zoh"``.
    perturbed_plant
        A plant around which the certificate also closes the loop.
    method
        ``"slpmm"`` (the appendix's), ``"descent"`` or ``"slpmm+descent"``.
    starts
        Number of random starts of the descent; by the order if left out.
    seed
        Of those starts: the same seed gives the same gain.
    progress
        Called with the stage, the step in it and the best value so far.

    Returns
    -------
    DisturbanceObserver
        Also when gamma is above 1: ``feasible`` and ``message`` say so.

    Raises
    ------
    InputError
        If an assumption does not hold, or method is unknown.
    SolverError
        If the semidefinite program of the method "slpmm" fails.

    Source
    ------
    El-Shaer, Al Janaideh, Krejci and Tomizuka 2013, sec. 4 and appendix.

    Examples
    --------
    >>> w = 565.5
    >>> plant = ([w * w], [1.0, 1.6 * w, w * w])
    >>> Wu = ([1.0, 960.0, 0.0], [1.0, 960.0, 5.76e6])
    >>> Wp = ([0.5, 201.1], [1.0, 0.2])
    >>> found = design_disturbance_observer(plant, ([4.0, 8.0], [1.0, 0.0]), Wu, Wp)
    >>> found.feasible, round(found.gamma, 2)
    (True, 0.92)
    """
    if method not in METHODS:
        raise InputError(f"method is {method!r}; give one of {', '.join(METHODS)}")
    if is_discrete(plant, dt, delay):
        return design_sampled_observer(
            sampled_observer_problem(
                *(plant, controller, Wu, Wp, internal_model),
                dt=dt,
                delay=delay,
                discretization=discretization,
            ),
            perturbed_plant=perturbed_plant,
            starts=starts,
            seed=seed,
            progress=progress,
        )
    problem = observer_problem(plant, controller, Wu, Wp, internal_model)
    perturbed = _perturbed(perturbed_plant)
    # Matrices of ten rows: more threads would only wait for one another.
    with threadpool_limits(1, user_api="blas"):
        return _search(problem, perturbed, method, starts, seed, progress)


def _search(
    problem: ObserverProblem,
    perturbed: LinearSystem | None,
    method: str,
    starts: int | None,
    seed: int,
    progress: Callable[[str, int, float], None] | None,
) -> DisturbanceObserver:
    gain = StackedGain(problem)
    steps: list[str] = []
    given: list[Array] = []
    found = gain.gain_of(usual_parameters(gain, 1)[0])
    if "slpmm" in method:
        try:
            iterations = _FULL if method == "slpmm" or problem.order < _LARGE else _FEW
            linear = slpmm(problem, found, iterations, progress=_reported(progress, "slpmm"))
            steps.append(
                f"SLPMM          {linear.norm:.4f} after {linear.iterations} iterations, "
                f"trace(P R) - n = {linear.distances[-1]:.2g}"
            )
            found = linear.gain
            given = [gain.parameters_of(problem.q_filter(found).poles())]
        except SolverError as reason:
            if method == "slpmm":
                raise
            steps.append(f"SLPMM          failed: {reason}")
    if "descent" in method:
        best = descend_from_many(gain, given, starts, seed, _reported(progress, "descent"))
        steps.append(f"descent        {best.norm:.4f} after {best.evaluations} evaluations")
        lower = gain.gain_of(best.parameters)
        found = min(found, lower, key=lambda L: hinf_norm(weighted_loop(problem, L))[0])
    certificate = certify(problem, found, perturbed)
    bound = lower_bound(gain, certificate.stacked_norm)
    return DisturbanceObserver(problem, found, certificate, bound, method, tuple(steps))


def observer_problem(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    internal_model: Any = "integrator",
    *,
    dt: float | None = None,
    delay: float = 0.0,
    discretization: Method = "tustin",
) -> ObserverProblem:
    """Read and check what an observer is designed for.

    Parameters
    ----------
    plant, controller, Wu, Wp, internal_model, dt, delay, discretization
        As for ``design_disturbance_observer``.

    Raises
    ------
    InputError
        If one cannot be read or an assumption does not hold.
    """
    if is_discrete(plant, dt, delay):
        return sampled_observer_problem(
            *(plant, controller, Wu, Wp, internal_model),
            dt=dt,
            delay=delay,
            discretization=discretization,
        )
    problem = ObserverProblem(
        _nominal(plant),
        as_linear_system(controller, "the controller"),
        as_linear_system(Wu, "Wu"),
        as_linear_system(Wp, "Wp"),
        as_internal_model(internal_model),
    )
    check_assumptions(problem)
    return problem


def evaluate_gain(
    problem: ObserverProblem, gain: ArrayLike, perturbed_plant: Any = None
) -> DisturbanceObserver:
    """Certify a given gain, for instance one from a paper.

    Parameters
    ----------
    problem
        Of ``observer_problem``.
    gain
        L, one number for each state of plant and internal model; which states those are is in
        ``problem.plant``.
    perturbed_plant
        A plant around which the certificate also closes the loop.

    Raises
    ------
    InputError
        If the gain has another size or is not finite, or the perturbed plant cannot be read.

    Examples
    --------
    The printed gain of the paper, with the printed controller, does not do what is printed.

    >>> w = 2 * np.pi * 90
    >>> plant, controller = ([w * w], [1.0, 1.6 * w, w * w]), ([8.0, 4.0], [1.0, 0.0])
    >>> Wu, Wp = ([-1.0, -960.0, 0.0], [1.0, 960.0, 5.76e6]), ([0.5, 64 * np.pi], [1.0, 0.2])
    >>> problem = observer_problem(plant, controller, Wu, Wp)
    >>> round(evaluate_gain(problem, [-117.381, 0.197, 17113.1]).gamma, 3)
    2.234
    """
    if isinstance(problem, SampledObserverProblem):
        return evaluate_sampled_gain(problem, gain, perturbed_plant)
    L = np.array(gain, dtype=np.float64).ravel()
    if L.size != problem.order or not np.isfinite(L).all():
        raise InputError(
            f"the gain has {L.size} numbers; give {problem.order} finite ones, for "
            f"{problem.plant.order} states of the plant and {problem.internal_model.order} of the "
            "internal model"
        )
    perturbed = _perturbed(perturbed_plant)
    with threadpool_limits(1, user_api="blas"):
        certificate = certify(problem, L, perturbed)
        reached = certificate.stacked_norm
        bound = lower_bound(StackedGain(problem), reached if np.isfinite(reached) else 1e3)
    return DisturbanceObserver(problem, L, certificate, bound, "given")


def _nominal(plant: Any) -> LinearSystem:
    """Read the plant; one without states of its own gets those in which L keeps its digits.

    That is the companion form whose output is the first state, where L adds to the denominator
    directly. The paper's example, order 2, is in the other one.
    """
    read = as_linear_system(plant, "the plant")
    has_states = hasattr(plant, "A") or (isinstance(plant, tuple | list) and len(plant) == 4)
    if has_states or read.order <= 2 or (read.inputs, read.outputs) != (1, 1):
        return read
    return LinearSystem(read.A.T, read.C.T, read.B.T, read.D, read.dt)


def _perturbed(plant: Any) -> LinearSystem | None:
    if plant is None:
        return None
    read = as_linear_system(plant, "the perturbed plant")
    if (read.inputs, read.outputs, read.dt) != (1, 1, 0.0):
        raise InputError(
            f"the perturbed plant has {read.inputs} inputs, {read.outputs} outputs and dt = "
            f"{read.dt:g} s; give one of each, in continuous time"
        )
    return read


def _reported(
    progress: Callable[[str, int, float], None] | None, stage: str
) -> Callable[..., None] | None:
    if progress is None:
        return None
    return lambda step, *values: progress(stage, step, values[-1])
