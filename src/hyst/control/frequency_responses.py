"""Frequency responses that tell what a disturbance observer does to a loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer import DisturbanceObserver
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.linear_system import LinearSystem
from hyst.control.sampled.plant import sampled_plant
from hyst.errors import InputError

Array = NDArray[np.float64]

_PER_DECADE = 100
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
        At most 1, and a little rounding, if the plant is within Wu; on a grid around all poles.
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
    w = _around(plant, Wu, true)
    P, Pn, weight = (_values(each, w) for each in (true, plant, Wu))
    off = np.abs(P / Pn - 1.0)
    # What both round to zero is no deviation.
    ratio = np.where(off > 1e-9, off / np.maximum(np.abs(weight), 1e-300), 0.0)
    worst = int(ratio.argmax())
    return float(ratio[worst]), float(w[worst])


def _values(system: LinearSystem, w: Array) -> NDArray[np.complex128]:
    points = np.exp(1j * w * system.dt) if system.dt > 0.0 else 1j * w
    return np.asarray(system.response(points)[:, 0, 0])


def _around(*systems: LinearSystem) -> Array:
    """Frequencies around the poles of systems; of sampled ones up to half the rate."""
    continuous = []
    for each in systems:
        poles = each.poles()
        if each.dt > 0.0:
            poles = np.log(poles[np.abs(poles) > 1e-12].astype(complex)) / each.dt
        continuous.append(poles)
    poles = np.concatenate(continuous)
    size = np.abs(poles)
    size = size[size > 1e-9 * size.max(initial=1.0)]
    low, high = np.log10(size.min(initial=1.0) / 10.0), np.log10(size.max(initial=1.0) * 10.0)
    even = np.logspace(low, high, int(_PER_DECADE * (high - low)) + 2)
    # A resonance that is narrower than the grid peaks near its poles.
    sharp = np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * _BESIDE
    w = np.union1d(np.concatenate([even, sharp.ravel()]), size)
    highest = min([np.pi / each.dt for each in systems if each.dt > 0.0], default=np.inf)
    return np.asarray(w[(w > 0.0) & (w <= highest)])


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
