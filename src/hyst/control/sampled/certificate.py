"""What a sampled block achieves around a sampled plant: the numbers that SAFE hangs on."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, final

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem, as_linear_system, balanced
from hyst.control.sampled.block_loop import BlockLoop
from hyst.control.sampled.folding import folded_uncertainty, weight_response
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_LEFT = math.sqrt(0.5)


@final
@dataclass(frozen=True, eq=False)
class SampledCertificate:
    """What a block achieves around the plant that it samples, for every plant within Wu.

    Frequencies in rad/s, at most pi/dt. Norms are infinite if the loop is not stable.

    Parameters
    ----------
    dt, delay
        Sample time and delay of computation, s.
    uncertainty_norm, uncertainty_frequency
        Largest ``a |K S|``, eq. 26 of the sampled loop with all aliases: below 1 if and only if the
        loop is stable for every plant within Wu.
    baseband_norm
        The same without aliases, ``|Wu T|`` up to pi/dt.
    performance_norm, performance_frequency
        Largest ``|Wp E|``, eq. 27 of the sampled loop, E what the observer leaves of a disturbance
        at the plant's input.
    stacked_norm, stacked_frequency
        Largest root of the sum of both squares.
    robust_performance, robust_performance_frequency
        Largest ``|Wp E| + a |K S|``: below 1, what Wp asks for holds for every plant within Wu.
    rejection_bandwidth
        Where ``|E|`` first is 0.707, rad/s; 0 if it is at all frequencies, infinite if at none.
    noise_gain, noise_frequency
        Largest ``|K S|``, from noise of the sensor to v, units of v for one of y.
    noise_rms, noise_jitter
        Standard deviations of v, and of its change from sample to sample, for white noise of the
        sensor of standard deviation 1.
    poles
        Of the loop around the nominal plant, the largest modulus first.
    fastest_pole
        Largest ``|log z| / dt`` of the block's own poles, rad/s; pi/dt is half the sample rate.
    """

    dt: float
    delay: float
    uncertainty_norm: float
    uncertainty_frequency: float
    baseband_norm: float
    performance_norm: float
    performance_frequency: float
    stacked_norm: float
    stacked_frequency: float
    robust_performance: float
    robust_performance_frequency: float
    rejection_bandwidth: float
    noise_gain: float
    noise_frequency: float
    noise_rms: float
    noise_jitter: float
    poles: ComplexArray
    fastest_pole: float

    @property
    def nominal_stable(self) -> bool:
        """Whether the loop around the nominal plant is stable."""
        return bool(np.abs(self.poles).max(initial=0.0) < 1.0)

    @property
    def robustly_stable(self) -> bool:
        """Whether the loop is stable for every plant within Wu."""
        return self.nominal_stable and self.uncertainty_norm < 1.0

    @property
    def robust_stability_margin(self) -> float:
        """Factor by which Wu may grow before stability is no longer sure."""
        return math.inf if self.uncertainty_norm == 0.0 else 1.0 / self.uncertainty_norm

    @property
    def nyquist(self) -> float:
        """Half the sample rate, rad/s."""
        return math.pi / self.dt

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and lists; poles as pairs of real and imaginary part, inf as text."""
        given: dict[str, Any] = {}
        for each in fields(self):
            value = getattr(self, each.name)
            if each.name == "poles":
                given["poles"] = [[float(p.real), float(p.imag)] for p in value]
            else:
                given[each.name] = "inf" if math.isinf(value) else float(value)
        given["nominal_stable"], given["robustly_stable"] = (
            self.nominal_stable,
            self.robustly_stable,
        )
        return given


def sampled_certificate(
    block: TrackingController, plant: Any, Wu: Any, Wp: Any = 0.0, *, delay: float = 0.0
) -> SampledCertificate:
    r"""Certify a block as it runs: sampled, with hold, delay and all that folds down.

    With ``v = -K y``, the plant Pd that the block samples, ``S = 1 / (1 + K Pd)`` and the bound a
    of ``folded_uncertainty``, the loop is stable for every plant within Wu if and only if it is
    for the nominal one and ``a |K S| < 1`` at all frequencies up to pi/dt. The inverse is taken as
    perfect here; ``sampled_slope_proof`` is for one that is not.

    Parameters
    ----------
    block
        What the target runs.
    plant
        Nominal: as ``sampled_plant`` takes it.
    Wu
        Weight of the multiplicative uncertainty of the continuous plant; stable. Of the sampled
        plant where that is all that is known, or if Wu is itself sampled.
    Wp
        Weight of what the observer leaves of a disturbance; nothing is asked if left out.
    delay
        As in ``sampled_plant``.

    Returns
    -------
    SampledCertificate

    Raises
    ------
    InputError
        If a system cannot be read, sample times differ, a weight is unstable, or the plant's
        uncertainty does not fall off with frequency.

    Source
    ------
    S1 eqs. 26, 27 and 36, on the unit circle.

    Examples
    --------
    >>> slow = TrackingController.from_continuous(([20.0], [1.0, 0.0]), dt=1e-3)
    >>> stage = ([4e5], [1.0, 40.0, 4e5])
    >>> found = sampled_certificate(slow, stage, Wu=0.3)
    >>> found.robustly_stable, round(found.uncertainty_norm, 2)
    (True, 0.3)
    """
    loop = BlockLoop(block, plant_of_block(plant, block, delay))
    weights = stable_weight(Wu, "Wu"), stable_weight(Wp, "Wp")
    return _certified(loop, *weights)


def _certified(loop: BlockLoop, Wu: LinearSystem, Wp: LinearSystem) -> SampledCertificate:
    poles = loop.poles()
    stable = bool(np.abs(poles).max(initial=0.0) < 1.0)
    w, rows = loop.grid(Wu, Wp), _Rows(loop, Wu, Wp)

    def norm(row: Callable[[Array], Array]) -> tuple[float, float]:
        return largest(row, w) if stable else (math.inf, 0.0)

    uncertain, at_uncertain = norm(rows.uncertainty)
    performance, at_performance = norm(rows.performance)
    stacked, at_stacked = norm(rows.stacked)
    robust, at_robust = norm(rows.robust_performance)
    noise, at_noise = norm(rows.noise)
    rms, jitter = _spread(loop) if stable else (math.inf, math.inf)
    return SampledCertificate(
        dt=loop.dt,
        delay=loop.plant.delay,
        uncertainty_norm=uncertain,
        uncertainty_frequency=at_uncertain,
        baseband_norm=norm(rows.baseband)[0],
        performance_norm=performance,
        performance_frequency=at_performance,
        stacked_norm=stacked,
        stacked_frequency=at_stacked,
        robust_performance=robust,
        robust_performance_frequency=at_robust,
        rejection_bandwidth=_bandwidth(rows, w) if stable else 0.0,
        noise_gain=noise,
        noise_frequency=at_noise,
        noise_rms=rms,
        noise_jitter=jitter,
        poles=poles,
        fastest_pole=_fastest(loop.block),
    )


class _Rows:
    """Rows of the stack as functions of frequency."""

    def __init__(self, loop: BlockLoop, Wu: LinearSystem, Wp: LinearSystem) -> None:
        self.loop, self.Wu, self.Wp = loop, Wu, Wp

    def uncertainty(self, w: Array) -> Array:
        a = folded_uncertainty(self.loop.plant, self.Wu, w)
        return np.asarray(a * np.abs(self.loop.at(w).N))

    def baseband(self, w: Array) -> Array:
        values = self.loop.at(w)
        return np.asarray(np.abs(weight_response(self.Wu, w) * values.Pd * values.N))

    def performance(self, w: Array) -> Array:
        return np.asarray(np.abs(weight_response(self.Wp, w) * self.loop.at(w).E))

    def stacked(self, w: Array) -> Array:
        return np.hypot(self.uncertainty(w), self.performance(w))

    def robust_performance(self, w: Array) -> Array:
        return self.uncertainty(w) + self.performance(w)

    def noise(self, w: Array) -> Array:
        return np.asarray(np.abs(self.loop.at(w).N))


def _bandwidth(rows: _Rows, w: Array) -> float:
    reached = np.flatnonzero(np.abs(rows.loop.at(w).E) >= _LEFT)
    if reached.size == 0:
        return math.inf
    if reached[0] == 0:
        return 0.0
    low, high = float(w[reached[0] - 1]), float(w[reached[0]])
    for _ in range(50):
        middle = 0.5 * (low + high)
        above = abs(rows.loop.at(np.array([middle])).E[0]) >= _LEFT
        low, high = (low, middle) if above else (middle, high)
    return high


def _spread(loop: BlockLoop) -> tuple[float, float]:
    """Give standard deviations of v and of its change in a sample, for white noise of 1 at y."""
    plain = loop.closed()
    # In units of v in which y makes about as much v: else states of both differ by the gain.
    unit = float(np.linalg.norm(plain.B) * np.linalg.norm(plain.C)) or 1.0
    closed = balanced(LinearSystem(plain.A, plain.B, plain.C / unit, plain.D, loop.dt))
    A, b, c, d = closed.A, closed.B, unit * closed.C, float(closed.D[0, 0])
    X = scipy.linalg.solve_discrete_lyapunov(A, b @ b.T)
    rms = (c @ X @ c.T).item() + d**2
    change = c @ A - c
    jitter = (change @ X @ change.T).item() + ((c @ b).item() - d) ** 2 + d**2
    return math.sqrt(max(rms, 0.0)), math.sqrt(max(jitter, 0.0))


def plant_of_block(plant: Any, block: TrackingController, delay: float) -> SampledPlant:
    """Sample a plant at the block's rate; anything but a block is refused.

    Parameters
    ----------
    plant, delay
        As in ``sampled_plant``.
    block
        A TrackingController.

    Raises
    ------
    InputError
        If it is none, or as ``sampled_plant``.
    """
    if not isinstance(block, TrackingController):
        raise InputError(f"the block is {type(block).__name__}; give a TrackingController")
    return sampled_plant(plant, block.dt, delay)


def stable_weight(weight: Any, name: str) -> LinearSystem:
    """Read a weight; one that is not stable is refused.

    Parameters
    ----------
    weight
        As ``as_linear_system`` takes it.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it cannot be read, has several inputs or outputs, or is not stable.
    """
    read = as_linear_system(weight, name)
    if (read.inputs, read.outputs) != (1, 1):
        raise InputError(
            f"{name} has {read.inputs} inputs and {read.outputs} outputs; give one of each"
        )
    poles = read.poles()
    if read.order and (np.abs(poles).max() >= 1.0 if read.dt > 0.0 else poles.real.max() >= 0.0):
        raise InputError(f"{name} is not stable; move its poles to where they decay")
    return read


def _fastest(block: TrackingController) -> float:
    """Speed of the block's fastest pole, of those that do not die within a sample."""
    poles = np.linalg.eigvals(block.A).astype(complex) if block.order else np.zeros(0, complex)
    away = poles[np.abs(poles) > 1e-12]
    return float(np.abs(np.log(away) / block.dt).max(initial=0.0))
