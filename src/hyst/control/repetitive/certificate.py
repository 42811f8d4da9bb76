"""What is proven of a repetitive controller around a sampled plant."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number
from hyst.control.largest_value import largest
from hyst.control.linear_system import LinearSystem
from hyst.control.repetitive.filters import RepetitiveFilters
from hyst.control.sampled.certificate import stable_weight
from hyst.control.sampled.folding import folded_uncertainty
from hyst.control.sampled.plant import SampledPlant, sampled_plant
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_PER_TAP, _FEWEST, _LOG = 8, 512, 200
_AROUND = np.array([-8.0, -4.0, -2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0])


@final
@dataclass(frozen=True, eq=False)
class RepetitiveCertificate:
    r"""Whether what is left shrinks from period to period, for every plant within Wu.

    With P the plant as the block samples it, delay of computation included, a the bound of
    ``folded_uncertainty``, and slopes of hysteresis after inverse from c - rho to c + rho,

        ``contraction = sup |Q| (|1 - c L P| + |L| (rho |P| + (c + rho) a))``

    on the unit circle. Below 1, this is proven, for filters as they run and any period:

    * Inverse and actuator leave one gain in the range, as the exact inverse does with slopes 1
      and 1, or a static curve with slopes in it: for every linear plant within Wu the loop is
      stable, and of a reference and disturbance that repeat, what is left to learn dies out, in l2;
      from one period to the next by this factor, where periods are long against the plant's own
      transients.
    * Slopes that change in time, as those of plays that move or rest: the changes of all signals
      from sample to sample are bounded in l2 by those of reference and disturbance (circle
      criterion on differences), so that no oscillation keeps itself up. That the error then shrinks
      from period to period is not proven, because memories of two periods may differ.

    Not proven: anything of a plant outside Wu, of noise beyond its gain, and between the samples.

    Parameters
    ----------
    contraction, frequency
        The largest value, and where, rad/s.
    nominal
        ``sup |Q| |1 - L P|`` of the nominal plant and the exact inverse.
    noise_rms
        Standard deviation of v that white noise of the sensor with standard deviation 1 leaves
        there, of the nominal plant and for periods that are long against both filters.
    filters, plant
        What it is of.
    """

    contraction: float
    frequency: float
    nominal: float
    noise_rms: float
    filters: RepetitiveFilters
    plant: SampledPlant

    @property
    def holds(self) -> bool:
        """Whether the condition holds."""
        return self.contraction < 1.0

    def periods(self, share: float) -> float:
        """Tell after how many periods at most this share is left of what can be learned.

        Parameters
        ----------
        share
            Above 0, below 1.

        Raises
        ------
        InputError
            If it is not between.
        """
        if not 0.0 < as_number(share, "share") < 1.0:
            raise InputError(f"share is {share:.6g}; give one between 0 and 1")
        if not self.holds:
            return math.inf
        return math.ceil(math.log(share) / math.log(max(self.contraction, 1e-300)))

    def left(self, harmonics: Any) -> Array:
        """Give what is left at last of the error of the inverse alone, nominal plant.

        ``|1 - Q| / |1 - Q (1 - L P)|``

        Parameters
        ----------
        harmonics
            Of the period: whole numbers from 1 to N/2, shape (K,).
        """
        number = np.asarray(harmonics, dtype=np.float64)
        angle = 2.0 * np.pi * number / self.filters.period
        Q, P = self.filters.Q(angle), _response(self.plant, angle)
        return np.asarray(np.abs(1.0 - Q) / np.abs(1.0 - Q * (1.0 - self.filters.L(angle) * P)))

    def sentence(self) -> str:
        """Say what is proven."""
        if not self.holds:
            return (
                f"not proven: at {self.frequency:.4g} rad/s a period may leave "
                f"{self.contraction:.4g} times the error of the one before"
            )
        return (
            f"proven: what is left to learn shrinks by {self.contraction:.4g} a period or more, "
            f"to 1 % within {self.periods(0.01):.0f} periods"
        )

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers."""
        names = [each.name for each in fields(self) if each.name not in ("filters", "plant")]
        told: dict[str, Any] = {name: float(getattr(self, name)) for name in names}
        return told | {"holds": self.holds}


def certified(
    filters: RepetitiveFilters,
    plant: Any,
    dt: float,
    uncertainty: Any = 0.0,
    slopes: tuple[float, float] = (1.0, 1.0),
    delay: float = 0.0,
) -> RepetitiveCertificate:
    """Certify filters around a plant.

    Parameters
    ----------
    filters
        As they run.
    plant, dt, uncertainty, slopes, delay
        As ``RepetitiveController.certificate`` takes them; the slopes checked.

    Raises
    ------
    InputError
        As there.
    """
    sampled = sampled_plant(plant, dt, delay)
    refuse_lasting(sampled)
    values = ConditionValues(filters, sampled, stable_weight(uncertainty, "uncertainty"), slopes)
    w = values.grid()
    worst, at = largest(values.condition, w)
    return RepetitiveCertificate(
        worst, at, largest(values.nominal, w)[0], values.noise_rms(), filters, sampled
    )


def refuse_lasting(plant: SampledPlant) -> None:
    """Refuse a plant that integrates: no FIR inverts it, and nothing holds it between periods.

    Parameters
    ----------
    plant
        As sampled.

    Raises
    ------
    InputError
        If it has a pole on the unit circle.
    """
    poles = plant.system.poles()
    if poles.size and float(np.abs(poles).max()) > 1.0 - 1e-9:
        raise InputError(
            f"the plant has the pole {complex(poles[np.abs(poles).argmax()]):.6g} and does not "
            "come to rest; close a loop around it first"
        )


@dataclass(frozen=True)
class ConditionValues:
    """The condition over frequency.

    Parameters
    ----------
    filters, plant
        What it is of.
    weight
        Of the uncertainty.
    slopes
        Checked.
    """

    filters: RepetitiveFilters
    plant: SampledPlant
    weight: LinearSystem
    slopes: tuple[float, float]

    @property
    def middle(self) -> float:
        """Of the slopes, c."""
        return 0.5 * (self.slopes[0] + self.slopes[1])

    def doubt(self, w: Array) -> Array:
        """By how much ``c P`` may be off."""
        half = 0.5 * (self.slopes[1] - self.slopes[0])
        a = folded_uncertainty(self.plant, self.weight, w)
        P = np.abs(_response(self.plant, w * self.plant.dt))
        return np.asarray(half * P + (abs(self.middle) + half) * a)

    def condition(self, w: Array) -> Array:
        """``|Q| (|1 - c L P| + |L| doubt)``."""
        angle = w * self.plant.dt
        L = self.filters.L(angle)
        left = np.abs(1.0 - self.middle * L * _response(self.plant, angle))
        return np.asarray(np.abs(self.filters.Q(angle)) * (left + np.abs(L) * self.doubt(w)))

    def nominal(self, w: Array) -> Array:
        """``|Q| |1 - L P|``."""
        angle = w * self.plant.dt
        left = np.abs(1.0 - self.filters.L(angle) * _response(self.plant, angle))
        return np.asarray(np.abs(self.filters.Q(angle)) * left)

    def noise_rms(self) -> float:
        """Root of the mean of ``|Q L|^2 / (1 - |Q (1 - L P)|^2)`` on the unit circle."""
        w = self.grid()
        shrunk = self.nominal(w)
        if shrunk.max() >= 1.0:
            return math.inf
        angle = w * self.plant.dt
        gain = np.abs(self.filters.Q(angle) * self.filters.L(angle)) ** 2 / (1.0 - shrunk**2)
        area = 0.5 * (gain[1:] + gain[:-1]) @ np.diff(angle)
        return math.sqrt(float(area) / math.pi)

    def grid(self) -> Array:
        """Give frequencies that show all of filters, plant and weight, rad/s."""
        return shown_by(self.plant, self.weight, self.filters.smooth.size + self.filters.learn.size)


def shown_by(plant: SampledPlant, weight: LinearSystem, taps: int) -> Array:
    """Give frequencies that show a plant, a weight and FIR filters of so many taps, rad/s."""
    nyquist = math.pi / plant.dt
    poles = [_continuous(plant.system.poles(), plant.dt)]
    if plant.continuous is not None:
        poles.append(plant.continuous.poles())
    poles.append(_continuous(weight.poles(), weight.dt) if weight.dt > 0.0 else weight.poles())
    each = np.concatenate(poles).astype(complex)
    sharp = (each.imag[:, None] + np.abs(each.real)[:, None] * _AROUND).ravel()
    folded = np.abs((sharp + nyquist) % (2.0 * nyquist) - nyquist)
    even = np.linspace(0.0, nyquist, max(_FEWEST, _PER_TAP * taps) + 1)[1:]
    w = np.unique(np.concatenate([np.geomspace(1e-6 * nyquist, nyquist, _LOG), even, folded]))
    return np.asarray(w[(w >= 1e-6 * nyquist) & (w <= nyquist)])


def ordered_slopes(slopes: Any) -> tuple[float, float]:
    """Check slopes of hysteresis after inverse.

    Parameters
    ----------
    slopes
        Least and largest, above 0.

    Raises
    ------
    InputError
        If they are not.
    """
    try:
        low, high = slopes
    except (TypeError, ValueError):
        raise InputError(f"slopes is {slopes!r}; give the least and the largest slope") from None
    low, high = as_number(low, "slopes"), as_number(high, "slopes")
    if not 0.0 < low <= high:
        raise InputError(
            f"slopes are {low:.6g} and {high:.6g}; give the smaller one first, both above 0"
        )
    return low, high


def _response(plant: SampledPlant, angle: Array) -> ComplexArray:
    return np.asarray(plant.system.response(np.exp(1j * angle))[:, 0, 0])


def _continuous(poles: ComplexArray, dt: float) -> ComplexArray:
    """Give the continuous poles that samples at dt show; those at 0 die within a sample."""
    away = poles[np.abs(poles) > 1e-12]
    return np.asarray(np.log(away.astype(complex)) / dt)
