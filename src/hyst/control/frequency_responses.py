"""Frequency responses that tell what a disturbance observer does to a loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer import DisturbanceObserver
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem
from hyst.control.sampled.plant import sampled_plant
from hyst.control.zeros_and_poles import zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]

_PER_DECADE = 100
_STEP = 1.1  # to what is beside a frequency
_BESIDE = np.array([-3.0, -1.0, -0.3, 0.0, 0.3, 1.0, 3.0])


@final
@dataclass(frozen=True, eq=False)
class LoopResponses:
    """Absolute values over frequency.

    Parameters
    ----------
    w
        Frequencies, rad/s, shape (K,).
    left
        ``|1 - Q|``, what is left of a disturbance.
    Q
        ``|Q|``.
    Wp_inverse
        ``1 / |Wp|``, which it must stay below.
    Wu_T
        ``|Wu T|`` around the nominal plant; robustly stable below 1.
    S, S_without
        ``|y / d|`` of the loop with and without the observer.
    """

    w: Array
    left: Array
    Q: Array
    Wp_inverse: Array
    Wu_T: Array
    S: Array
    S_without: Array


def loop_responses(
    design: DisturbanceObserver, plant: LinearSystem | None = None, w: Array | None = None
) -> LoopResponses:
    """Compute the responses of S1 Fig. 5.

    ``S = P (1 - Q) / (1 - Q + P C + Q P / Pn)``, which for P = Pn is eq. 25a.

    Parameters
    ----------
    design
        Observer with its plant, controller and weights.
    plant
        The plant P that S is of; the nominal one if left out. For a sampled design a continuous
        one is sampled with its delay, and Wu T is without aliases.
    w
        Frequencies, rad/s, above 0; a grid around all poles if left out.

    Returns
    -------
    LoopResponses
    """
    problem = design.problem
    at = _grid(design) if w is None else np.asarray(w, dtype=np.float64)
    true = problem.plant if plant is None else plant
    if isinstance(problem, SampledObserverProblem):
        true = sampled_plant(
            true, problem.dt, problem.sampled.delay if true.dt == 0.0 else 0.0
        ).system
    Pn, C, Q, Wu, Wp, P = (
        _values(each, at)
        for each in (
            *(problem.plant, problem.controller, problem.q_filter(design.gain)),
            *(problem.Wu, problem.Wp, true),
        )
    )
    with np.errstate(divide="ignore"):
        return LoopResponses(
            w=at,
            left=np.abs(1.0 - Q),
            Q=np.abs(Q),
            Wp_inverse=1.0 / np.abs(Wp),
            Wu_T=np.abs(Wu * (Pn * C + Q) / (1.0 + Pn * C)),
            S=np.abs(P * (1.0 - Q) / (1.0 - Q + P * C + Q * P / Pn)),
            S_without=np.abs(P / (1.0 + P * C)),
        )


def uncertainty_used(
    plant: LinearSystem, Wu: LinearSystem, true: LinearSystem
) -> tuple[float, float]:
    """Compare a plant with what Wu allows: the largest ``|P / Pn - 1| / |Wu|``, and where.

    Parameters
    ----------
    plant, Wu
        Nominal plant Pn and weight.
    true
        The plant P; both plants continuous, or both sampled with one dt.

    Returns
    -------
    ratio : float
        At most 1, and a little rounding, if the plant is within Wu; closed in on around all poles,
        and zeros of Pn and Wu.
    frequency : float
        rad/s.

    Raises
    ------
    InputError
        If one plant is sampled and the other is not, or their sample times differ.

    Notes
    -----
    S1 eq. 22: stability for every plant within Wu says nothing of one that is not.
    """
    if abs(plant.dt - true.dt) > 1e-6 * plant.dt:
        raise InputError(
            f"the plant has dt = {plant.dt:g} s, the true plant {true.dt:g} s (0 is continuous); "
            "give both in the same time"
        )

    def used(w: Array) -> Array:
        P, Pn, weight, above, below = (
            _values(each, at)
            for each, at in (
                *((true, w), (plant, w), (Wu, w)),
                *((plant, w * _STEP), (plant, w / _STEP)),
            )
        )
        # At a zero on the axis both are rounding of what they are beside it.
        nothing = 1e-9 * np.minimum(np.abs(above), np.abs(below))
        off = np.abs(P - Pn) / np.maximum(np.maximum(np.abs(Pn), nothing), 1e-300)
        # What both round to zero is no deviation.
        return np.where(off > 1e-9, off / np.maximum(np.abs(weight), 1e-300), 0.0)

    grid = _around(plant, Wu, true, zeros_of=(plant, Wu), beyond=1e3)
    return largest(used, grid)


def _values(system: LinearSystem, w: Array) -> NDArray[np.complex128]:
    points = np.exp(1j * w * system.dt) if system.dt > 0.0 else 1j * w
    return np.asarray(system.response(points)[:, 0, 0])


def _around(
    *systems: LinearSystem, zeros_of: tuple[LinearSystem, ...] = (), beyond: float = 10.0
) -> Array:
    """Frequencies around poles, and zeros of some, so far beyond; of samples up to pi/dt."""
    poles = np.concatenate([_rates(each.poles(), each.dt) for each in systems])
    zeros = [_rates(zeros_and_poles(each).zeros, each.dt) for each in zeros_of]
    size = np.abs(poles)
    size = size[size > 1e-9 * size.max(initial=1.0)]
    low, high = np.log10(size.min(initial=1.0) / beyond), np.log10(size.max(initial=1.0) * beyond)
    even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 2)
    # A resonance that is narrower than the grid peaks near its poles.
    features = np.concatenate([poles, *zeros])
    sharp = np.abs(features.imag)[:, None] + np.abs(features.real)[:, None] * _BESIDE
    w = np.union1d(np.concatenate([even, sharp.ravel()]), size)
    highest = min([np.pi / each.dt for each in systems if each.dt > 0.0], default=np.inf)
    return np.asarray(w[(w > 0.0) & (w <= highest)])


def _rates(roots: NDArray[np.complex128], dt: float) -> NDArray[np.complex128]:
    """Give roots in the plane of s; of samples, those at 0 die within one."""
    if dt == 0.0:
        return roots
    return np.asarray(np.log(roots[np.abs(roots) > 1e-12].astype(complex)) / dt)


def _grid(design: DisturbanceObserver) -> Array:
    """From a decade below the slowest pole of interest to a decade above the fastest."""
    problem = design.problem
    systems = (problem.plant, problem.controller, problem.Wu, problem.Wp)
    if problem.plant.dt > 0.0:
        return _around(*systems)
    poles = np.abs(np.concatenate([each.poles() for each in systems]))
    poles = poles[poles > 1e-9 * poles.max(initial=1.0)]
    low, high = np.log10(poles.min() / 10.0), np.log10(poles.max() * 10.0)
    return np.logspace(low, high, int(_PER_DECADE * (high - low)) + 2)
