"""Margins of a loop: how much gain, phase and delay it bears, and what it rejects."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.control.controller_parts import feedback_controller
from hyst.control.discretization import Method, discretize
from hyst.control.feedback.frequencies import crossings, frequencies_around
from hyst.control.feedback.loop_plant import (
    LoopPlant,
    as_rates,
    loop_plant,
    points,
    rates_of,
    static_gain,
)
from hyst.control.feedback.stability import is_stable, loop_poles
from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_LEFT = math.sqrt(0.5)
_MOST_TURN = 1500.0  # rad of dead time that are followed
_FAR = 1e3  # 1 / |L| up to which the turns of a dead time are followed


@final
@dataclass(frozen=True, eq=False)
class LoopMargins:
    """Margins of the loop ``L = P C``; frequencies in rad/s, times in s.

    Parameters
    ----------
    stable
        Whether the loop is. If it is not, the margins are only distances on the Nyquist curve.
    gain_margin
        Least factor above 1 on the gain at which the curve meets -1; infinite if there is none.
    gain_reduction
        Largest factor below 1 at which it does; 0 if there is none.
    phase_margin
        Least angle, degrees, that turns the curve into -1; infinite without a crossover.
    delay_margin
        Least further dead time at which the curve meets -1, s; infinite without a crossover.
    modulus_margin
        ``min |1 + L| = 1 / Ms``, the distance of the curve from -1, and where it is.
    modulus_frequency
        rad/s.
    bandwidth
        Lowest frequency at which ``|T|``, T = L / (1 + L), is 0.707 of what it is at 0.
    rejection
        Lowest frequency at which ``|S|``, S = 1 / (1 + L), is 0.707: disturbances below it are
        reduced. 0 if nothing is, infinite if everything is.
    crossovers
        All frequencies at which |L| is 1, rad/s, and the phase margin at each, degrees.
    phase_margins
        Of ``crossovers``, -180 to 180.
    phase_crossovers
        All frequencies at which L is real and negative, and the factor to -1 at each.
    gain_margins
        Of ``phase_crossovers``.
    dt
        Sample time of the loop, s; 0 in continuous time.
    dead_time
        That was counted, s: of computing and of the plant.
    """

    stable: bool
    gain_margin: float
    gain_reduction: float
    phase_margin: float
    delay_margin: float
    modulus_margin: float
    modulus_frequency: float
    bandwidth: float
    rejection: float
    crossovers: Array
    phase_margins: Array
    phase_crossovers: Array
    gain_margins: Array
    dt: float
    dead_time: float

    @property
    def peak_sensitivity(self) -> float:
        """``Ms = max |S|``."""
        return math.inf if self.modulus_margin == 0.0 else 1.0 / self.modulus_margin

    def rows(self) -> tuple[tuple[str, str], ...]:
        """Give each margin in words: what it is, and its value."""
        loop = f"sampled at {self.dt:g} s" if self.dt else "in continuous time"
        at = f" at {_hertz(self.modulus_frequency)}"
        return (
            ("loop is stable", ("yes" if self.stable else "NO") + f", {loop}"),
            ("gain margin", _factor(self.gain_margin)),
            ("gain may fall to", "0" if not self.gain_reduction else f"{self.gain_reduction:.4g}"),
            ("phase margin", _or_none(self.phase_margin, "deg")),
            ("delay margin", _or_none(self.delay_margin, "s")),
            ("modulus margin", f"{self.modulus_margin:.4g}, Ms {self.peak_sensitivity:.4g}{at}"),
            ("gain crossovers", ", ".join(map(_hertz, self.crossovers)) or "none"),
            ("bandwidth of y_ref to y, without feedforward", _hertz(self.bandwidth)),
            ("disturbances are reduced below", _hertz(self.rejection)),
        )

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers, lists and truth; frequencies in rad/s, infinity as text."""
        given: dict[str, Any] = {"peak_sensitivity": self.peak_sensitivity, **vars(self)}
        plain = {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in given.items()
        }
        return {
            name: "inf" if isinstance(value, float) and math.isinf(value) else value
            for name, value in plain.items()
        }

    def summary(self) -> str:
        """Give the margins as lines of text."""
        return "\n".join(f"{what}: {value}" for what, value in self.rows())


def loop_margins(
    plant: Any,
    controller: Any,
    dt: float | None = None,
    delay: float = 0.0,
    *,
    method: Method = "tustin",
) -> LoopMargins:
    """Give the margins of a loop, with the inverse taken as exact.

    ``L = P C exp(-s delay)``, or with dt ``L(z) = Pd(z) C(z)``, Pd the plant behind hold and delay.

    Parameters
    ----------
    plant
        As ``simulate_closed_loop`` takes it: continuous, sampled, LinearDynamics with its delay.
    controller
        C, from the tracking error to the plant's input, continuous or sampled; or a
        TrackingController, of which all that y goes through counts, the observer too.
    dt
        Sample time of the block that runs, s; left out: of the plant, or continuous time.
    delay
        Computing time, s: from the measurement to the change of the drive it leads to.
    method
        How a continuous controller is sampled, as in ``TrackingController.from_continuous``.

    Returns
    -------
    LoopMargins

    Raises
    ------
    InputError
        If a block cannot be used, the plant is unstable or sample times differ.

    Notes
    -----
    Where L crosses 1 or the negative real axis more than once, all crossings are told and the worst
    counts. A loop may be stable at gains between two of them; ``stable`` is decided by poles, or by
    Nyquist's criterion where a continuous loop has dead time. The delay margin of a sampled loop is
    of a dead time that is not sampled, ``exp(-jw delay)`` on the circle.

    Examples
    --------
    >>> found = loop_margins(([1.0], [1.0, 2.0, 1.0]), ([1.0], [1.0, 0.0]))
    >>> round(found.gain_margin, 9), found.stable
    (2.0, True)
    >>> round(loop_margins(([1.0], [1.0, 2.0, 1.0]), ([1.0], [1.0, 0.0]), 0.5).gain_margin, 3)
    1.384
    """
    met = loop_plant(plant, dt, delay)
    if isinstance(controller, TrackingController):
        return margins_of(loop_plant(plant, controller.dt, delay), _from_output(controller))
    read = feedback_controller(controller)
    if met.dt:
        read = discretize(read, met.dt, method)
    elif read.dt:
        raise InputError(
            f"the controller is sampled at {read.dt:g} s; give dt, or a continuous one"
        )
    return margins_of(met, read)


def _from_output(block: TrackingController) -> LinearSystem:
    """Give K of ``v = -K y``."""
    y = block.B[:, 1:], block.D[1:].reshape(1, 1)
    return LinearSystem(block.A, -y[0], block.C.reshape(1, -1), -y[1], block.dt)


def margins_of(plant: LoopPlant, controller: LinearSystem) -> LoopMargins:
    """Give the margins of a plant with its dead time and a controller of the same time."""

    def loop(w: Array) -> ComplexArray:
        of_controller = controller.response(points(w, plant.dt))[:, 0, 0]
        return np.asarray(plant.response(w) * of_controller, dtype=np.complex128)

    stable = is_stable(plant, controller)
    w = _grid(plant, controller)
    over = crossings(w, lambda at: np.abs(loop(at)) - 1.0)
    angles = np.degrees(np.angle(-loop(over)))
    turned = crossings(w, lambda at: loop(at).imag)
    real = loop(turned)
    keep = (real.real < 0.0) & (np.abs(real.imag) < 1e-6 * np.abs(real))
    turned, factors = turned[keep], -1.0 / real.real[keep]
    if plant.delay:  # crosses for ever, ever smaller
        counted = (factors < _FAR) | (np.arange(turned.size) == 0)
        turned, factors = turned[counted], factors[counted]
    turned, factors = _with_ends(plant, controller, turned, factors)
    peak, place = largest(lambda at: 1.0 / np.maximum(np.abs(1.0 + loop(at)), 1e-300), w)
    at_rest = static_gain(plant.system) * static_gain(controller)
    whole = 1.0 if math.isinf(at_rest) or math.isnan(at_rest) else math.inf
    if math.isfinite(at_rest) and at_rest != -1.0:  # at -1 the loop integrates
        whole = _closed(at_rest)
    return LoopMargins(
        stable=stable,
        gain_margin=float(factors[factors > 1.0].min(initial=math.inf)),
        gain_reduction=float(factors[factors <= 1.0].max(initial=0.0)),
        phase_margin=float(np.abs(angles).min(initial=math.inf)),
        delay_margin=float((np.radians(angles % 360.0) / over).min(initial=math.inf)),
        modulus_margin=1.0 / peak,
        modulus_frequency=place,
        bandwidth=_first(w, lambda at: np.abs(_closed(loop(at))) - _LEFT * abs(whole)),
        rejection=_first(w, lambda at: _LEFT - 1.0 / np.maximum(np.abs(1.0 + loop(at)), 1e-300)),
        crossovers=over,
        phase_margins=angles,
        phase_crossovers=turned,
        gain_margins=factors,
        dt=plant.dt,
        dead_time=plant.dead_time,
    )


def largest_noise_gain(
    plant: LoopPlant, controller: LinearSystem, weight: Callable[[Array], Array] | None = None
) -> float:
    """Give ``max |C S|``, or that of its product with a weight of frequency.

    Parameters
    ----------
    plant, controller
        As ``margins_of`` takes them.
    weight
        Of frequencies, rad/s, below half the sample rate; 1 if left out.
    """
    w = _grid(plant, controller)
    # At the highest frequency of samples itself a weight that folds need not be known.
    w = w[w < plant.nyquist * (1.0 - 1e-9)]

    def size(at: Array) -> Array:
        of_controller = controller.response(points(at, plant.dt))[:, 0, 0]
        gain = np.abs(of_controller / (1.0 + plant.response(at) * of_controller))
        return gain if weight is None else gain * weight(at)

    return largest(size, w)[0]


def _closed(loop: Any) -> Any:
    return loop / (1.0 + loop)


def _grid(plant: LoopPlant, controller: LinearSystem) -> Array:
    """Near all poles, those of the closed loop included, and fine enough for what delay turns."""
    rates = [as_rates(plant.system), as_rates(controller)]
    # What is slow does not feel a dead time, and may be slower than all poles of the open loop.
    if abs(1.0 + float(plant.system.D[0, 0] * controller.D[0, 0])) > 1e-9:
        poles = loop_poles(plant.system, controller)
        rates.append(rates_of(poles, plant.dt))
    w = frequencies_around(np.concatenate(rates), plant.nyquist)
    late = plant.dead_time
    if not late:
        return w
    # Up to where |L| no longer matters no half turn may be missed.
    of_controller = controller.response(points(w, plant.dt))[:, 0, 0]
    loud = w[np.abs(plant.response(w) * of_controller) * _FAR > 1.0]
    end = max(float(loud[-1]) if loud.size else 0.0, 2.0 * math.pi / late)
    end = min(end, plant.nyquist)
    end = min(end, _MOST_TURN / late)  # what is as loud beyond, turns as it did before
    turns = int(end * late / 0.2) + 2
    return np.union1d(w, np.linspace(0.0, end, turns)[1:])


def _with_ends(
    plant: LoopPlant, controller: LinearSystem, turned: Array, factors: Array
) -> tuple[Array, Array]:
    """At 0 and at the highest frequency of samples L is real, which no change of sign shows."""
    ends = [0.0] + ([plant.nyquist] if plant.dt else [])
    for w in ends:
        s = points(np.array([w]), plant.dt)
        if np.abs(controller.poles() - s).min(initial=1.0) < 1e-9:
            continue
        if np.abs(plant.system.poles() - s).min(initial=1.0) < 1e-9:
            continue
        value = (plant.response(np.array([w])) * controller.response(s)[:, 0, 0])[0]
        if value.real < 0.0:
            turned, factors = np.append(turned, w), np.append(factors, -1.0 / value.real)
    order = np.argsort(turned)
    return turned[order], factors[order]


def _first(w: Array, above: Callable[[Array], Array]) -> float:
    """Give the first frequency from which a function is no longer above 0; 0 or infinity."""
    values = above(w)
    if values[0] <= 0.0:
        return 0.0
    below = np.flatnonzero(values <= 0.0)
    if below.size == 0:
        return math.inf
    return float(crossings(w[: int(below[0]) + 1], above)[0])


def _hertz(w: float) -> str:
    if w == 0.0:
        return "0"
    return "all frequencies" if math.isinf(w) else f"{w / (2.0 * math.pi):.4g} Hz"


def _factor(value: float) -> str:
    if math.isinf(value):
        return "unlimited"
    return f"{value:.4g} ({20.0 * math.log10(value):.3g} dB)"


def _or_none(value: float, unit: str) -> str:
    return "no crossover" if math.isinf(value) else f"{value:.4g} {unit}"
