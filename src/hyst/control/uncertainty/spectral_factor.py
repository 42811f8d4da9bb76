"""From ``|W|^2`` to W: the factor with all zeros and poles on the stable side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem, balanced
from hyst.control.uncertainty.cover import Cover
from hyst.models.realizations import cascade, sections_of

Complex = NDArray[np.complex128]

_LEAST_ANGLE = 1e-3  # of a root in x: half of it is the damping of the zero or pole it becomes


def spectral_factor(cover: Cover, dt: float) -> LinearSystem:
    """Give the stable W of minimum phase whose squared gain a cover is.

    Parameters
    ----------
    cover
        In ``x = w^2``, or ``x = tan(w dt/2)^2``.
    dt
        Sample time, s; 0 of a continuous system.

    Returns
    -------
    LinearSystem
        Of the order of the cover.
    """
    zeros, poles = (_stable(cover.roots(each)) for each in (cover.above, cover.below))
    gain = float(np.sqrt(cover.above[0] / cover.below[0]))
    if dt > 0.0:
        # s = (z - 1)/(z + 1) is j tan(w dt/2) on the unit circle.
        gain *= float((np.prod(1.0 - zeros) / np.prod(1.0 - poles)).real)
        zeros, poles = (1.0 + zeros) / (1.0 - zeros), (1.0 + poles) / (1.0 - poles)
        return _realized(zeros, poles, gain, 1.0, dt)
    scale = float(np.exp(np.mean(np.log(np.abs(poles))))) if poles.size else 1.0
    return _realized(zeros / scale, poles / scale, gain, scale, 0.0)


def _stable(roots: Complex) -> Complex:
    """Give the roots in s, of those in ``x = -s^2``, with negative real part, in exact pairs."""
    on_axis = (roots.real > 0.0) & (np.abs(np.angle(roots)) < _LEAST_ANGLE)
    moved = list(roots[~on_axis])
    touching = np.sort(np.abs(roots[on_axis]))
    # Rounding parts a double root on the axis, where |W|^2 only touches 0, into two.
    for first, second in zip(touching[::2], touching[1::2], strict=False):
        middle = np.sqrt(first * second)
        angle = max(_LEAST_ANGLE, 0.5 * (second - first) / middle)
        moved += [middle * np.exp(1j * angle), middle * np.exp(-1j * angle)]
    if touching.size % 2:
        moved.append(complex(-touching[-1]))
    upper = [-np.sqrt(-each) for each in moved if each.imag > 0.0]
    real = [complex(-np.sqrt(-each.real)) for each in moved if each.imag == 0.0]
    return np.array([*upper, *np.conj(upper), *real], dtype=np.complex128)


def _realized(zeros: Complex, poles: Complex, gain: float, scale: float, dt: float) -> LinearSystem:
    if not poles.size:
        return LinearSystem(
            np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.array([[gain]]), dt
        )
    A, B, C, D = cascade(sections_of(zeros, poles, gain))
    B, C = B.reshape(-1, 1) * scale, C.reshape(1, -1)
    return balanced(LinearSystem(A * scale, B, C, np.array([[D]]), dt))
