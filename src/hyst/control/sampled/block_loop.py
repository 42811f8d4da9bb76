"""Frequency responses of the loop that a sampled block closes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem
from hyst.control.sampled.plant import SampledPlant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_DECADE, _EVEN = 60, 400
_SLOWER = 1e4  # than all poles: what is largest at frequency 0 is found to 1e-8 of itself
_AROUND = np.array([-8.0, -4.0, -2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0])


@dataclass(frozen=True)
class BlockLoop:
    """A block around the plant it samples, with a perfect inverse in between.

    ``v = -K y`` is what the block does with the output; ``d_hat`` is its observer's estimate.
    """

    block: TrackingController
    plant: SampledPlant

    def __post_init__(self) -> None:
        if abs(self.block.dt - self.plant.dt) > 1e-6 * self.plant.dt:
            raise InputError(
                f"the block has dt = {self.block.dt:.6g} s, the plant {self.plant.dt:.6g} s; give "
                "the same for both"
            )

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self.block.dt

    @property
    def feedback(self) -> LinearSystem:
        """From y to v, which is -K."""
        b = self.block
        return LinearSystem(b.A, b.B[:, 1:], b.C[None, :], np.array([[b.D[1]]]), b.dt)

    @property
    def controller(self) -> LinearSystem:
        """From y to v + d_hat: minus the controller alone, as if there were no observer."""
        b = self.block
        if b.E is None or b.F is None:
            return self.feedback
        return LinearSystem(
            b.A, b.B[:, 1:], (b.C + b.E)[None, :], np.array([[b.D[1] + b.F[1]]]), b.dt
        )

    def closed(self, slope: float = 1.0) -> LinearSystem:
        """Close the loop; from noise at y to v, states those of the block, then of the plant.

        Parameters
        ----------
        slope
            Of hysteresis after inverse: a gain at the plant's input.
        """
        K, P = self.feedback, self.plant.system
        m, n = K.order, P.order
        A = np.zeros((m + n, m + n))
        A[:m, :m], A[:m, m:] = K.A, K.B @ P.C
        A[m:, :m], A[m:, m:] = slope * P.B @ K.C, P.A + slope * P.B @ K.D @ P.C
        B = np.vstack([K.B, slope * P.B @ K.D])
        return LinearSystem(A, B, np.hstack([K.C, K.D @ P.C]), K.D, self.dt)

    def poles(self, slope: float = 1.0) -> ComplexArray:
        """Give the poles of the closed loop, the largest modulus first.

        Parameters
        ----------
        slope
            As in ``closed``.
        """
        poles = self.closed(slope).poles()
        return poles[np.argsort(-np.abs(poles))]

    def at(self, w: Array, slope: float = 1.0) -> LoopValues:
        """Evaluate the loop over frequency.

        Parameters
        ----------
        w
            rad/s, above 0 and at most pi/dt, shape (K,).
        slope
            As in ``closed``.
        """
        z = np.exp(1j * w * self.dt)
        K, Pd = self.open(w)
        alone = -self.controller.response(z)[:, 0, 0]
        below = 1.0 + slope * K * Pd
        return LoopValues(w, Pd, K / below, 1.0 / below, (1.0 + slope * alone * Pd) / below)

    def open(self, w: Array) -> tuple[ComplexArray, ComplexArray]:
        """Evaluate block and plant over frequency.

        Parameters
        ----------
        w
            As in ``at``.

        Returns
        -------
        K, Pd : numpy.ndarray
        """
        z = np.exp(1j * w * self.dt)
        return -self.feedback.response(z)[:, 0, 0], self.plant.system.response(z)[:, 0, 0]

    def beside_poles(self, slope: float) -> Array:
        """Give frequencies at and beside the poles of the closed loop, folded below pi/dt.

        Parameters
        ----------
        slope
            As in ``closed``.
        """
        nyquist = np.pi / self.dt
        poles = _continuous(self.closed(slope).poles(), self.dt)
        sharp = poles.imag[:, None] + np.abs(poles.real)[:, None] * _AROUND
        w = np.abs(_folded(sharp.ravel(), nyquist))
        return np.asarray(np.unique(w[(w > 0.0) & (w <= nyquist)]))

    def grid(self, *weights: LinearSystem, slope: float = 1.0) -> Array:
        """Give frequencies that show all poles of loop, plant and weights, folded below pi/dt.

        Parameters
        ----------
        weights
            Continuous or sampled.
        slope
            As in ``closed``: peaks are where the loop with this gain has them.
        """
        nyquist = np.pi / self.dt
        sampled = [self.closed(slope).poles(), self.plant.system.poles(), self.feedback.poles()]
        # Of samples an integrator is only known to rounding, and nothing slower than that.
        poles = [_known(_continuous(each, self.dt), 1e-9 * nyquist) for each in sampled]
        systems = [*weights] if self.plant.continuous is None else [self.plant.continuous, *weights]
        for each in systems:
            if each.dt > 0.0:
                poles.append(_known(_continuous(each.poles(), each.dt), 1e-9 * nyquist))
            else:
                poles.append(_known(each.poles(), 1e-12 * np.abs(each.poles()).max(initial=0.0)))
        features = np.concatenate(poles)
        sharp = features.imag[:, None] + np.abs(features.real)[:, None] * _AROUND
        size = np.abs(features)
        folded = np.abs(_folded(np.concatenate([sharp.ravel(), size]), nyquist))
        slow = min(float(size.min(initial=nyquist)) / _SLOWER, 1e-3 * nyquist)
        even = np.linspace(0.0, nyquist, _EVEN + 1)[1:]
        decades = np.log10(nyquist / slow)
        log = np.geomspace(slow, nyquist, int(_PER_DECADE * decades) + 2)
        w = np.unique(np.concatenate([even, log, folded]))
        return np.asarray(w[(w >= slow) & (w <= nyquist)])


@dataclass(frozen=True)
class LoopValues:
    """Values over frequency ``w``: ``Pd``, ``N = K S``, ``S``, and what is left, ``E``."""

    w: Array
    Pd: ComplexArray
    N: ComplexArray
    S: ComplexArray
    E: ComplexArray


def _continuous(poles: ComplexArray, dt: float) -> ComplexArray:
    """Give the continuous poles that samples at dt show at z; those at 0 die within a sample."""
    away = poles[np.abs(poles) > 1e-12]
    return np.asarray(np.log(away.astype(complex)) / dt)


def _known(poles: ComplexArray, least: float) -> ComplexArray:
    """Leave out integrators, and what is no number."""
    return np.asarray(poles[np.isfinite(poles) & (np.abs(poles) > least)])


def _folded(w: Array, nyquist: float) -> Array:
    return np.asarray((w + nyquist) % (2.0 * nyquist) - nyquist)
