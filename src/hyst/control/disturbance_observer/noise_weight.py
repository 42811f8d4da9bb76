"""The weight of the gain from sensor noise to the drive."""

from __future__ import annotations

from typing import Any

import numpy as np

from hyst.checks.numbers import as_positive
from hyst.control.disturbance_observer.noise_loop import noise_without_observer
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError

_TIMES = 10.0  # what cannot be avoided may be passed by so much where no jitter is stated


def noise_weight(problem: ObserverProblem, noise: Any, jitter: float | None) -> LinearSystem | None:
    """Give the weight Wn; None without noise.

    Noise of standard deviation s makes at most ``s sup |K S|`` in the drive, whatever its
    spectrum. So the weight is constant, s over the jitter that is allowed. Where none is stated it
    is ten times what no observer avoids: ``s / |Pn(0)|`` at low frequencies, where Q = 1, or what
    the controller alone makes, ``s sup |C S0|``, whichever is more.

    Parameters
    ----------
    problem
        Plant and controller.
    noise
        A system, which is the weight; a number, the standard deviation of the noise; or None.
    jitter
        Standard deviation that noise may have in the drive v; only with a number for noise.

    Raises
    ------
    InputError
        If a number is not positive, a system cannot be read, or a jitter has no noise.
    """
    is_number = isinstance(noise, int | float | np.number) and not isinstance(noise, bool)
    if jitter is not None:
        as_positive(jitter, "jitter", "the standard deviation that noise may have in the drive")
        if not is_number:
            raise InputError(
                "jitter is what the noise may make in the drive; give noise as the standard "
                "deviation of the sensor, not as a weight or none"
            )
    if noise is None:
        return None
    if not is_number:
        return as_linear_system(noise, "the noise weight")
    deviation = float(noise)
    as_positive(deviation, "noise", "the standard deviation of the sensor's noise, or a weight")
    if jitter is None:
        unavoidable = max(
            1.0 / _gain_at_zero(problem), hinf_norm(noise_without_observer(problem))[0]
        )
        jitter = _TIMES * unavoidable * deviation
    return as_linear_system(deviation / float(jitter), "the noise weight")


def _gain_at_zero(problem: ObserverProblem) -> float:
    still = np.full(1, 1.0 if problem.plant.dt > 0.0 else 0.0, complex)
    return float(abs(problem.plant.response(still)[0, 0, 0]))
