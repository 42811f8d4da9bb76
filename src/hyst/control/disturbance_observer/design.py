"""Design of a disturbance observer: the gain of least H-infinity norm, certified."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from hyst.checks.numbers import as_not_negative, as_positive, whole_number
from hyst.control.discretization import Method
from hyst.control.disturbance_observer.assumptions import check_assumptions, check_noise_weight
from hyst.control.disturbance_observer.certificate import certify
from hyst.control.disturbance_observer.discrete.design import (
    design_sampled_observer,
    evaluate_sampled_gain,
    is_discrete,
    sampled_observer_problem,
)
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.internal_model import as_internal_model
from hyst.control.disturbance_observer.lower_bound import lower_bound, lower_bound_at_noise
from hyst.control.disturbance_observer.noise_weight import noise_weight
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.result import DisturbanceObserver
from hyst.control.disturbance_observer.search import MOST_MORE, Search, search
from hyst.control.disturbance_observer.shortfall import shortfall
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError

Array = NDArray[np.float64]

METHODS = ("slpmm+descent", "slpmm", "descent")


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
    noise: Any = None,
    jitter: float | None = None,
    order: int | Literal["auto"] | None = None,
    fastest_pole: float | None = None,
    flat: float = 0.01,
    perturbed_plant: Any = None,
    method: str = "slpmm+descent",
    starts: int | None = None,
    seed: int = 0,
    progress: Callable[[str, int, float], None] | None = None,
) -> DisturbanceObserver:
    r"""Find the gain of a disturbance observer that rejects most within a given uncertainty.

    ``min over L of || [Wu T; Wp (1 - Q); Wn K S] ||_inf``, the last row only where noise is given.

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
    noise
        Standard deviation of the sensor's noise, in the unit of y, or a system as the weight Wn of
        ``K S``, the gain from that noise to v. A standard deviation gives the constant weight
        ``noise / jitter``, for noise of any spectrum makes at most ``noise sup |K S|`` of v.
    jitter
        Standard deviation that the noise may have in v. Left out it is ten times what no observer
        avoids: ``noise / |Pn(0)|``, or ``noise sup |C / (1 + Pn C)|`` if that is more.
    order
        Of the observer; more than the states of plant and internal model add stable eigenvalues to
        the internal model, searched for the least norm at no more of ``sup |Q / Pn|``. ``"auto"``
        adds them while each lowers the norm by 5 %. Left out it is the paper's, none.
    fastest_pole
        Limit of the poles of Q, rad/s; a block at sample time dt cannot hold any beyond pi/dt. With
        a sample time half of that is the limit anyway.
    flat
        Share of the norm given up for the least ``sup |Q / Pn|``, where that at least halves it
        and the norm stays below 1; 1e-4 are always given. 0 is the least norm and nothing else.
    perturbed_plant
        A plant around which the certificate also closes the loop.
    method
        ``"slpmm"`` (the appendix's, which knows neither noise nor order), ``"descent"`` or
        ``"slpmm+descent"``.
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
        If an assumption does not hold, method is unknown, or an option cannot be met.
    SolverError
        If the semidefinite program of the method "slpmm" fails, or a sampled observer of high order
        has no digits left.

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
    problem = observer_problem(
        *(plant, controller, Wu, Wp, internal_model),
        dt=dt,
        delay=delay,
        discretization=discretization,
        noise=noise,
        jitter=jitter,
    )
    how = Search(method, starts, seed, order, fastest_pole, flat, progress)
    _check(problem, how)
    if isinstance(problem, SampledObserverProblem):
        return design_sampled_observer(problem, how, perturbed_plant, _deviation(noise))
    perturbed = _perturbed(perturbed_plant)
    # Matrices of ten rows: more threads would only wait for one another.
    with threadpool_limits(1, user_api="blas"):
        found = search(problem, how)
        return _certified(
            found.problem, found.gain, perturbed, _deviation(noise), method, found.steps
        )


def _check(problem: ObserverProblem, how: Search) -> None:
    """Refuse options that cannot be met."""
    if how.method not in METHODS:
        raise InputError(f"method is {how.method!r}; give one of {', '.join(METHODS)}")
    as_not_negative(how.flat, "flat", "a share of the norm that may be given up")
    if how.fastest_pole is not None:
        as_positive(how.fastest_pole, "fastest_pole", "a limit of the poles in rad/s")
    if how.order not in (None, "auto"):
        least = problem.order
        whole_number(how.order, "order", least, least + MOST_MORE, ", or 'auto'")
    asked = {"noise": problem.Wn, "fastest_pole": how.fastest_pole, "order": how.order}
    named = [name for name, value in asked.items() if value is not None]
    if how.method == "slpmm" and named:
        raise InputError(f"method 'slpmm' knows no {' and no '.join(named)}; use 'slpmm+descent'")


def _certified(
    problem: ObserverProblem,
    gain: Array,
    perturbed: LinearSystem | None,
    noise: float | None,
    method: str,
    steps: tuple[str, ...] = (),
) -> DisturbanceObserver:
    certificate = certify(problem, gain, perturbed)
    stacked = StackedGain(problem)
    finite = np.isfinite(certificate.stacked_norm)
    reached = certificate.stacked_norm if finite else 1e3
    bound = lower_bound(stacked, reached)
    at_noise = None
    if finite:
        at_noise = lower_bound_at_noise(stacked, reached, certificate.observer_noise_gain)
        at_noise = max(bound, at_noise)
    why = shortfall(stacked, certificate, bound) if finite else ""
    return DisturbanceObserver(
        problem, gain, certificate, bound, method, steps, at_noise, noise, why
    )


def _deviation(noise: Any) -> float | None:
    is_number = isinstance(noise, int | float | np.number)
    return float(noise) if is_number else None


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
    noise: Any = None,
    jitter: float | None = None,
) -> ObserverProblem:
    """Read and check what an observer is designed for.

    Parameters
    ----------
    plant, controller, Wu, Wp, internal_model, dt, delay, discretization, noise, jitter
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
            noise=noise,
            jitter=jitter,
        )
    problem = ObserverProblem(
        _nominal(plant),
        as_linear_system(controller, "the controller"),
        as_linear_system(Wu, "Wu"),
        as_linear_system(Wp, "Wp"),
        as_internal_model(internal_model),
    )
    check_assumptions(problem)
    if noise is None and jitter is None:
        return problem
    problem = replace(problem, Wn=noise_weight(problem, noise, jitter))
    check_noise_weight(problem.Wn)
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
        return _certified(problem, L, perturbed, None, "given")


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
