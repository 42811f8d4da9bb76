"""Design of a disturbance observer in discrete time, straight from a sampled plant."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from hyst.control.discretization import Method, discretize
from hyst.control.disturbance_observer.discrete.assumptions import (
    check_controller,
    check_plant,
    check_problem,
    check_weight,
    read_controller,
)
from hyst.control.disturbance_observer.discrete.certificate import certify_sampled
from hyst.control.disturbance_observer.discrete.lower_bound import sampled_lower_bound
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.result import SampledDisturbanceObserver
from hyst.control.disturbance_observer.discrete.search import search_sampled
from hyst.control.disturbance_observer.discrete.shortfall import sampled_shortfall
from hyst.control.disturbance_observer.discrete.stacked_gain import SampledStackedGain
from hyst.control.disturbance_observer.internal_model import as_internal_model
from hyst.control.disturbance_observer.noise_weight import noise_weight
from hyst.control.disturbance_observer.search import Search
from hyst.control.sampled.certificate import stable_weight
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.errors import InputError

Array = NDArray[np.float64]


def is_discrete(plant: Any, dt: float | None, delay: float) -> bool:
    """Whether a design is in discrete time: dt is given, or the plant has a sample time.

    A delay is taken into such a design only.

    Raises
    ------
    InputError
        If there is a delay and no sample time.
    """
    own = getattr(plant, "dt", None)
    if dt is not None or (isinstance(own, int | float) and own is not True and own > 0.0):
        return True
    if delay != 0.0:
        raise InputError(
            f"delay is {delay!r} s with a plant in continuous time; give dt, the sample time, too: "
            "a delay is taken into a design in discrete time"
        )
    return False


def sampled_observer_problem(
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
) -> SampledObserverProblem:
    """Read and check what a sampled observer is designed for.

    Parameters
    ----------
    plant, controller, Wu, Wp, internal_model, dt, delay, discretization, noise, jitter
        As for ``design_disturbance_observer``.

    Raises
    ------
    InputError
        If one cannot be read or an assumption does not hold.
    """
    sampled = sampled_plant(plant, dt, delay)
    check_plant(sampled)
    given = read_controller(controller, sampled.dt)
    runs = discretize(given, sampled.dt, discretization)
    weights = {name: stable_weight(each, name) for name, each in (("Wu", Wu), ("Wp", Wp))}
    for name, weight in weights.items():
        check_weight(name, weight, sampled.dt)
    problem = SampledObserverProblem(
        sampled.system,
        runs,
        weights["Wu"],
        weights["Wp"],
        as_internal_model(internal_model),
        sampled=sampled,
    )
    check_problem(problem)
    check_controller(sampled, runs, given, discretization)
    if noise is None and jitter is None:
        return problem
    Wn = stable_weight(noise_weight(problem, noise, jitter), "the noise weight")
    check_weight("the noise weight", Wn, sampled.dt)
    return replace(problem, Wn=Wn)


def design_sampled_observer(
    problem: SampledObserverProblem,
    how: Search,
    perturbed_plant: Any = None,
    noise: float | None = None,
) -> SampledDisturbanceObserver:
    """Find the gain of least norm of a sampled observer, and certify it.

    Parameters
    ----------
    problem
        Of ``sampled_observer_problem``.
    how
        How to search; SLPMM is of the continuous design, its method is left out here.
    perturbed_plant
        A plant around which the certificate also closes the loop, sampled in the same way.
    noise
        Standard deviation of the sensor's noise, for the summary.

    Raises
    ------
    InputError
        If SLPMM alone is asked for, or the perturbed plant cannot be read.
    SolverError
        If the gain that was found cannot be held in doubles.
    """
    if how.method == "slpmm":
        raise InputError(
            "method 'slpmm' is of the design in continuous time; use 'descent', or leave dt out"
        )
    perturbed = _perturbed(perturbed_plant, problem)
    # Matrices of ten rows: more threads would only wait for one another.
    with threadpool_limits(1, user_api="blas"):
        found = search_sampled(problem, how)
        whole = found.problem
        assert isinstance(whole, SampledObserverProblem)
        return _certified(whole, found.gain, perturbed, "descent", found.steps, noise)


def evaluate_sampled_gain(
    problem: SampledObserverProblem, gain: ArrayLike, perturbed_plant: Any = None
) -> SampledDisturbanceObserver:
    """Certify a given gain of a sampled observer.

    Parameters
    ----------
    problem
        Of ``sampled_observer_problem``.
    gain
        L, one number for each state of the sampled plant, its delay included, and of the internal
        model.
    perturbed_plant
        A plant around which the certificate also closes the loop.

    Raises
    ------
    InputError
        If the gain has another size or is not finite, or the perturbed plant cannot be read.
    """
    L = np.array(gain, dtype=np.float64).ravel()
    if L.size != problem.order or not np.isfinite(L).all():
        raise InputError(
            f"the gain has {L.size} numbers; give {problem.order} finite ones, for "
            f"{problem.plant.order} states of the sampled plant and "
            f"{problem.internal_model.order} of the internal model"
        )
    perturbed = _perturbed(perturbed_plant, problem)
    with threadpool_limits(1, user_api="blas"):
        return _certified(problem, L, perturbed, "given")


def _certified(
    problem: SampledObserverProblem,
    L: Array,
    perturbed: SampledPlant | None,
    method: str,
    steps: tuple[str, ...] = (),
    noise: float | None = None,
) -> SampledDisturbanceObserver:
    certificate = certify_sampled(problem, L, perturbed)
    reached = certificate.stacked_norm
    # The bound is of both rows; noise only adds to them.
    gain = SampledStackedGain(replace(problem, Wn=None))
    bound = sampled_lower_bound(gain, reached if np.isfinite(reached) else 1e3)
    return SampledDisturbanceObserver(
        *(problem, L, certificate, bound.value, method, steps),
        noise=noise,
        shortfall=sampled_shortfall(certificate, bound),
    )


def _perturbed(plant: Any, problem: SampledObserverProblem) -> SampledPlant | None:
    if plant is None:
        return None
    return sampled_plant(plant, problem.dt, problem.sampled.delay)
