"""Design of a disturbance observer: the gain of least H-infinity norm, certified."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.control.disturbance_observer.certificate import certify
from hyst.control.disturbance_observer.descent import descend_from_many
from hyst.control.disturbance_observer.internal_model import as_internal_model
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.result import DisturbanceObserver
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.control.linear_system import as_linear_system
from hyst.errors import InputError

Array = NDArray[np.float64]


def design_disturbance_observer(
    plant: Any,
    controller: Any,
    Wu: Any,
    Wp: Any,
    internal_model: Any = "integrator",
    *,
    perturbed_plant: Any = None,
    method: str = "slpmm+descent",
    starts: int = 8,
    seed: int = 0,
    progress: Callable[[str, int, float], None] | None = None,
) -> DisturbanceObserver:
    r"""Find the gain of a disturbance observer that rejects most within a given uncertainty.

    ``min over L of || [Wu T; Wp (1 - Q)] ||_inf``

    Systems are transfer functions or state spaces of python-control, pairs (num, den), matrices
    (A, B, C, D) or numbers, in continuous time, with one input and one output.

    Parameters
    ----------
    plant
        Nominal plant Pn: strictly proper, stable, minimum phase, observable.
    controller
        C, in u = C (y_ref - y); stabilizes Pn.
    Wu
        Weight of the multiplicative uncertainty, P = Pn (1 + Delta), |Delta| <= |Wu|; stable.
    Wp
        Weight of 1 - Q, what is left of the disturbance; stable.
    internal_model
        InternalModel, pair (A_d, C_d), ``"integrator"`` or ``"ramp"``; an eigenvalue at 0.
    perturbed_plant
        A plant around which the certificate also closes the loop.
    method
        ``"slpmm"`` (the appendix's), ``"descent"`` or ``"slpmm+descent"``.
    starts
        Number of random starts of the descent.
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
    problem = ObserverProblem(
        as_linear_system(plant, "the plant"),
        as_linear_system(controller, "the controller"),
        as_linear_system(Wu, "Wu"),
        as_linear_system(Wp, "Wp"),
        as_internal_model(internal_model),
    )
    gain = StackedGain(problem)
    found = descend_from_many(gain, [], starts, seed)
    return evaluate_gain(problem, gain.gain_of(found.parameters), perturbed_plant)


def evaluate_gain(
    problem: ObserverProblem, gain: ArrayLike, perturbed_plant: Any = None
) -> DisturbanceObserver:
    """Certify a given gain, for instance one from a paper."""
    L = np.array(gain, dtype=np.float64).ravel()
    if L.size != problem.order:
        raise InputError(f"the gain has {L.size} numbers, not {problem.order}, one for each state")
    perturbed = None
    if perturbed_plant is not None:
        perturbed = as_linear_system(perturbed_plant, "the perturbed plant")
    return DisturbanceObserver(problem, L, certify(problem, L, perturbed), 0.0, "given")
