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
    edge = (last + 0.5) * rate
    poles = np.concatenate([P.poles, Wu.poles])
    far = poles[np.abs(poles) > edge]
    shown = far.imag[np.abs(far.imag) > edge]
    at = w[:, None] + rate * np.concatenate(
        [np.tile(np.arange(-last, last + 1.0), (w.size, 1)), _next_to(shown, w, rate)], axis=1
    )
    # |1 - e^{-s dt}| is the same at all aliases.
    hold = 2.0 * np.abs(np.sin(0.5 * w * dt))[:, None]
    values = _product(P, Wu, np.abs(at).ravel()).reshape(at.shape) / np.abs(at)
    rest = 2.0 * _beyond(P, Wu, edge, far, rate)
    return np.asarray((values.sum(axis=1) + rest) * hold[:, 0] / dt)


def _next_to(resonances: Array, w: Array, rate: float) -> Array:
    """Numbers of the aliases closest to resonances that are past the last one, (K, p)."""
    nearest = np.round((resonances - w[:, None]) / rate)
    return np.concatenate([nearest - 1.0, nearest, nearest + 1.0], axis=1)


def _beyond(
    P: ZerosAndPoles, Wu: ZerosAndPoles, edge: float, far: NDArray[np.complex128], rate: float
) -> float:
    """Bound the sum of ``|P Wu| / w`` over all aliases past the edge on one side.

    What rises and falls once adds up to no more than its integral over the rate, and its largest
    value; the aliases next to resonances are summed by themselves.
    """
    size = np.abs(far.imag)
    skirt = np.geomspace(0.1 * np.maximum(np.abs(far.real), rate), 0.1 * np.abs(far) + rate, 40)
    end = max(1e3 * float(np.abs(far).max(initial=0.0)), 1e3 * edge)
    around = np.maximum(np.concatenate([np.abs(size - rate), size + rate]), edge)
    parts = [np.geomspace(edge, end, 400), (size - skirt).ravel(), (size + skirt).ravel()]
    grid = np.concatenate([*parts, np.abs(far), size, around])
    grid = np.unique(grid[(grid >= edge) & (grid <= end)])
    f = _product(P, Wu, grid) / grid
    higher = np.maximum(f[1:], f[:-1])
    middles = 0.5 * (grid[1:] + grid[:-1])
    for each in size[size > edge]:
        higher[np.abs(middles - each) < rate] = 0.0
    # Past the end |P Wu| w is at most what it is there, and a little.
    area = float((higher * np.diff(grid)).sum()) + 1.02 * float(f[-1]) * end
    tops = np.concatenate([_product(P, Wu, around) / around, f[:1]])
    return area / rate + float(tops.sum())


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
