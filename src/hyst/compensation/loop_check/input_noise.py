"""What noise of a measured input may have done to the modelled loop."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.compensation.loop_check.harmonics import harmonics_of, signal_of
from hyst.compensation.loop_check.repeated_cycles import RepeatedCycles
from hyst.operators import Operator

Array = NDArray[np.float64]

_MOST_HARMONICS = 12


def doubt_by_input_noise(front: Operator, u: Array, cycles: RepeatedCycles) -> Array:
    """Give how the loop of a sine changes if what does not repeat of the input was never there.

    Noise that only the sensor of the input has turns the plays of the model and not those of the
    actuator; noise of the drive turns both. Nobody knows which it is, so this is left in doubt.

    Parameters
    ----------
    front
        The hysteresis.
    u
        The input, shape (N,).
    cycles
        A stretch of it; of anything but a sine nothing is said.

    Returns
    -------
    numpy.ndarray
        Shape (samples of the stretch,), units of v.
    """
    given = u[cycles.window]
    if not cycles.is_sine:
        return np.zeros(given.size)
    before = min(given.size // cycles.cycles, cycles.start)
    rate = float(cycles.weight[0])
    phase = cycles.phase[0] + rate * np.arange(-before, given.size)
    a_cycle = given.size / cycles.cycles
    count = int(np.clip(a_cycle / 6.0, 1, _MOST_HARMONICS))
    own = signal_of(harmonics_of(given, cycles.phase, cycles.weight, count), phase)
    repeats = own + float(np.mean(given - own[before:]))
    noise = given - repeats[before:]
    if float(np.abs(noise).max()) <= 1e-9 * (cycles.high - cycles.low):
        return np.zeros(given.size)
    noisy = np.concatenate([repeats[:before], given])
    return np.asarray((front(repeats) - front(noisy))[before:])
