"""Lightly damped resonances of a plant, and the plant with them elsewhere."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.feedback.loop_plant import LoopPlant, as_rates, points, static_gain
from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem, in_series
from hyst.models.realizations import companion

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_LIGHTLY = 0.35  # damping below which a peak above the static gain is worth a notch
_HEARD = 0.05  # of the static gain, below which a resonance is left alone


@dataclass(frozen=True)
class Resonance:
    """A lightly damped pair of poles.

    Parameters
    ----------
    frequency
        Natural frequency, rad/s.
    damping
        Share of the critical one.
    peak
        Largest gain near it, over the static gain.
    pole
        The upper one of the pair, 1/s.
    """

    frequency: float
    damping: float
    peak: float
    pole: complex


def resonances(plant: LoopPlant) -> tuple[Resonance, ...]:
    """Give the lightly damped resonances that are heard at the output, the loudest first.

    Parameters
    ----------
    plant
        As the loop meets it. Those of a known continuous plant are found beyond Nyquist too.

    Returns
    -------
    tuple of Resonance
    """
    source = plant.system if plant.continuous is None else plant.continuous
    at_rest = abs(static_gain(source))
    found = []
    for pole in as_rates(source):
        natural = abs(pole)
        damping = -pole.real / natural if natural else 1.0
        if pole.imag <= 0.0 or damping > _LIGHTLY:
            continue
        near = natural + np.linspace(-3.0, 3.0, 61) * max(damping, 1e-6) * natural
        top = math.pi / source.dt if source.dt else math.inf
        near = near[(near > 0.0) & (near <= top)]
        if near.size == 0:
            continue

        def gain(w: Array) -> Array:
            return np.abs(source.response(points(w, source.dt))[:, 0, 0])

        peak = largest(gain, near)[0] / at_rest
        if peak > _HEARD:
            found.append(Resonance(natural, float(damping), peak, complex(pole)))
    return tuple(sorted(found, key=lambda each: -each.peak))


def with_resonances_elsewhere(
    plant: LinearSystem, found: tuple[Resonance, ...], factor: float
) -> LinearSystem:
    """Multiply the frequencies of resonances; damping and static gain stay.

    ``P'(s) = P(s) prod (s^2 + 2 d w s + w^2) / (s^2 + 2 d w' s + w'^2) (w' / w)^2``

    Parameters
    ----------
    plant
        Continuous or sampled; of a sampled one the logarithms of the poles are moved.
    found
        Resonances.
    factor
        On the frequencies.

    Returns
    -------
    LinearSystem
    """
    for each in found:
        above, below = _quadratic(each.pole, plant.dt), _quadratic(factor * each.pole, plant.dt)
        one = 1.0 if plant.dt else 0.0
        above = above * np.polyval(below, one) / np.polyval(above, one)
        A, B, C, D = companion(above, below)
        moved = LinearSystem(A, B.reshape(-1, 1), C.reshape(1, -1), np.array([[D]]), plant.dt)
        plant = in_series(plant, moved)
    return plant


def _quadratic(pole: complex, dt: float) -> Array:
    root = complex(np.exp(pole * dt)) if dt else pole
    return np.array([1.0, -2.0 * root.real, abs(root) ** 2])
