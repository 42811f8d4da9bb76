"""What an uncertain continuous plant can do to its samples: aliases fold onto each other."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.control.sampled.plant import SampledPlant
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]

# Aliases that are summed one by one reach so many times past the fastest pole or zero, and no
# further than this many; beyond, a bound of what decays takes their place.
_BEYOND, _FEWEST, _MOST = 8.0, 12, 400


def folded_uncertainty(plant: SampledPlant, Wu: Any, w: Array) -> Array:
    r"""Bound what all plants within Wu can add to the sampled plant.

    ``a(w) = 1/dt sum over k of |Pn Wu H|(j w + 2 pi j k / dt)``, ``H(s) = (1 - e^{-s dt}) / s``.

    A deviation Delta of ``P = Pn (1 + Delta)``, ``|Delta| <= |Wu|``, is continuous: sampling adds
    up what it does at a frequency and at all aliases of it. Their phases are free, so some plant
    within Wu comes as close to a(w) as one likes.

    Parameters
    ----------
    plant
        Nominal, as ``sampled_plant`` gives it.
    Wu
        Weight; as ``as_linear_system`` takes it, continuous or sampled.
    w
        Frequencies, rad/s, shape (K,), above 0 and at most pi/dt.

    Returns
    -------
    numpy.ndarray
        Shape (K,), in units of the output for each of the input. The sum past the last alias is
        bounded, so this is never below a(w). Where the plant is known at its samples only, or Wu is
        sampled, Wu is of the sampled plant and ``a = |Pd Wu|``.

    Raises
    ------
    InputError
        If Wu cannot be read, or Pn Wu does not fall off with frequency: then no sample time helps.
    """
    weight = as_linear_system(Wu, "Wu")
    at = np.asarray(w, dtype=np.float64)
    if plant.continuous is None or weight.dt > 0.0:
        Pd = plant.system.response(np.exp(1j * at * plant.dt))[:, 0, 0]
        return np.asarray(np.abs(Pd * weight_response(weight, at)))
    if float(plant.continuous.D[0, 0]) != 0.0 and float(weight.D[0, 0]) != 0.0:
        raise InputError(
            "the plant has a direct feedthrough, so what folds down from above half the sample "
            "rate has no bound; give the pole of the sensor or of the filter before it"
        )
    return _summed(plant, zeros_and_poles(plant.continuous), zeros_and_poles(weight), at)


def weight_response(weight: LinearSystem, w: Array) -> NDArray[np.complex128]:
    """Give the values of a weight over frequency.

    Parameters
    ----------
    weight
        Continuous or sampled.
    w
        rad/s, shape (K,).
    """
    points = np.exp(1j * w * weight.dt) if weight.dt > 0.0 else 1j * w
    return np.asarray(weight.response(points)[:, 0, 0])


def _summed(plant: SampledPlant, P: ZerosAndPoles, Wu: ZerosAndPoles, w: Array) -> Array:
    dt = plant.dt
    rate = 2.0 * np.pi / dt
    features = np.concatenate([P.zeros, P.poles, Wu.zeros, Wu.poles])
    fastest = float(np.abs(features).max(initial=0.0))
    last = int(np.clip(np.ceil(_BEYOND * fastest / rate), _FEWEST, _MOST))
    k = np.arange(-last, last + 1)
    at = w[:, None] + rate * k
    # |1 - e^{-s dt}| is the same at all aliases.
    hold = 2.0 * np.abs(np.sin(0.5 * w * dt))[:, None] / np.abs(at)
    values = _product(P, Wu, np.abs(at).ravel()).reshape(at.shape) * hold
    # Past the last alias |P Wu| is below M / w, hence each pair of terms below 2 M / w_k^2.
    edge = (last + 0.5) * rate
    beyond = np.geomspace(edge, max(1e3 * fastest, 10.0 * edge), 200)
    M = 1.02 * float((_product(P, Wu, beyond) * beyond).max())
    tail = 2.0 * M * 2.0 / (rate**2 * (last - 0.5))
    return np.asarray((values.sum(axis=1) + tail * np.abs(np.sin(0.5 * w * dt))) / dt)


def _product(P: ZerosAndPoles, Wu: ZerosAndPoles, w: Array) -> Array:
    """Magnitude of P Wu; zeros and poles alternate, so that nothing overflows on the way."""
    s = 1j * w
    total = np.full(w.shape, abs(P.gain * Wu.gain))
    zeros = np.concatenate([P.zeros, Wu.zeros])
    poles = np.concatenate([P.poles, Wu.poles])
    for i in range(max(zeros.size, poles.size)):
        if i < zeros.size:
            total = total * np.abs(s - zeros[i])
        if i < poles.size:
            total = total / np.abs(s - poles[i])
    return total
