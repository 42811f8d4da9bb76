"""Frequency responses that tell what a disturbance observer does to a loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer import DisturbanceObserver
from hyst.control.linear_system import LinearSystem

Array = NDArray[np.float64]

_PER_DECADE = 100


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
        The plant P that S is of; the nominal one if left out.
    w
        Frequencies, rad/s, above 0; a grid around all poles if left out.

    Returns
    -------
    LoopResponses
    """
    problem = design.problem
    at = _grid(design) if w is None else np.asarray(w, dtype=np.float64)
    s = np.asarray(1j * at, dtype=np.complex128)
    Pn, C = problem.plant.response(s)[:, 0, 0], problem.controller.response(s)[:, 0, 0]
    Q = problem.q_filter(design.gain).response(s)[:, 0, 0]
    Wu, Wp = problem.Wu.response(s)[:, 0, 0], problem.Wp.response(s)[:, 0, 0]
    P = Pn if plant is None else plant.response(s)[:, 0, 0]
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


def uncertainty_used(design: DisturbanceObserver, plant: LinearSystem) -> tuple[float, float]:
    """Compare a plant with what Wu allows: the largest ``|P / Pn - 1| / |Wu|``, and where.

    Parameters
    ----------
    design
        Observer with its nominal plant and weights.
    plant
        The plant P.

    Returns
    -------
    ratio : float
        At most 1, and a little rounding, if the plant is within Wu; on a grid around all poles.
    frequency : float
        rad/s.

    Notes
    -----
    S1 eq. 22: stability for every plant within Wu says nothing of one that is not.
    """
    problem = design.problem
    # A resonance that is narrower than the grid peaks near its poles.
    own = np.abs(plant.poles())
    w = np.union1d(_grid(design), own[own > 0.0])
    s = np.asarray(1j * w, dtype=np.complex128)
    P, Pn, Wu = (each.response(s)[:, 0, 0] for each in (plant, problem.plant, problem.Wu))
    off = np.abs(P / Pn - 1.0)
    # What both round to zero is no deviation.
    ratio = np.where(off > 1e-9, off / np.maximum(np.abs(Wu), 1e-300), 0.0)
    worst = int(ratio.argmax())
    return float(ratio[worst]), float(w[worst])


def _grid(design: DisturbanceObserver) -> Array:
    """From a decade below the slowest pole of interest to a decade above the fastest."""
    problem = design.problem
    systems = (problem.plant, problem.controller, problem.Wu, problem.Wp)
    poles = np.abs(np.concatenate([each.poles() for each in systems]))
    poles = poles[poles > 1e-9 * poles.max(initial=1.0)]
    low, high = np.log10(poles.min() / 10.0), np.log10(poles.max() * 10.0)
    return np.logspace(low, high, int(_PER_DECADE * (high - low)) + 2)
