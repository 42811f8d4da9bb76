"""A pole or zero of identified dynamics as an engineer knows it, and whether it is determined."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.told.drive_band import OCTAVE, DriveBand
from hyst.identification.result.fit_spread import FitSpread

Complex = NDArray[np.complex128]
Role = Literal["pole", "zero"]

UNSURE = 0.1
"""Standard error of a frequency, as a share of it, above which it is not determined."""

TO_THE_CIRCLE = 2.0
"""Standard errors within which a pole that reaches the unit circle is not determined."""

_ON_THE_AXIS = 1e-9  # radians from the negative real axis


@final
@dataclass(frozen=True)
class FoundRoot:
    """A pole or zero of G, a complex pair as one, with standard errors of noise alone.

    With ``s = ln(z) / dt``, natural frequency ``|s| / 2 pi``, damping ratio ``-Re(s) / |s|`` and
    time constant ``-1 / s``.

    Parameters
    ----------
    role
        ``"pole"`` or ``"zero"``.
    value, standard_error
        In the plane of z, of a pair the one with positive imaginary part; the errors of real and
        imaginary part.
    modulus_error
        Standard error of its modulus.
    frequency, frequency_error
        Hz: natural frequency of a pair, corner frequency of a real one. NaN where a sampled value
        has none: on the negative real axis and at 0.
    damping, damping_error
        Damping ratio; negative outside the unit circle, NaN for real ones.
    time_constant, time_constant_error
        s, of a real one; negative outside the unit circle; NaN for pairs, and where there is none.
    undetermined
        Why its value must not be relied on; empty where it is determined.
    is_shown
        Whether the drive had power within an octave of its frequency.
    """

    role: Role
    value: complex
    standard_error: complex
    modulus_error: float
    frequency: float
    frequency_error: float
    damping: float
    damping_error: float
    time_constant: float
    time_constant_error: float
    undetermined: tuple[str, ...] = ()
    is_shown: bool = True

    @property
    def is_pair(self) -> bool:
        """Whether it stands for a complex pair."""
        return self.value.imag != 0.0

    @property
    def is_determined(self) -> bool:
        """Whether the records determine it."""
        return not self.undetermined

    @property
    def angular_frequency(self) -> float:
        """Natural or corner frequency, rad/s."""
        return 2.0 * math.pi * self.frequency

    @property
    def side(self) -> Literal["inside", "outside", "open"]:
        """Side of the unit circle; open within two standard errors. A zero outside has delay."""
        away = abs(self.value) - 1.0
        if not abs(away) > TO_THE_CIRCLE * self.modulus_error:
            return "open"
        return "outside" if away > 0.0 else "inside"

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and text; None for what has no value."""
        z, error = self.value, self.standard_error
        return {
            "value": [float(z.real), float(z.imag)],
            "standard_error": [plain_number(error.real), plain_number(error.imag)],
            "frequency_hz": plain_number(self.frequency),
            "frequency_standard_error": plain_number(self.frequency_error),
            "damping": plain_number(self.damping),
            "damping_standard_error": plain_number(self.damping_error),
            "time_constant_s": plain_number(self.time_constant),
            "time_constant_standard_error": plain_number(self.time_constant_error),
            "unit_circle": self.side,
            "undetermined": list(self.undetermined),
        }


def plain_number(value: float) -> float | None:
    """Give a number for a file; None for what is not finite."""
    return float(value) if math.isfinite(value) else None


def roots_found(
    role: Role,
    values: Complex,
    by_theta: Complex,
    dt: float,
    spread: FitSpread,
    band: DriveBand,
) -> tuple[FoundRoot, ...]:
    """Tell poles or zeros in physical units, with standard errors.

    Parameters
    ----------
    role
        What they are.
    values, by_theta
        Shapes (q,) and (q, m): in the plane of z, and their derivative.
    dt
        Sample time, s.
    spread
        How sure theta is.
    band
        Where the drive had power.

    Returns
    -------
    tuple of FoundRoot
        By rising frequency; those without one last.
    """
    kept = values.imag >= 0.0
    found = [
        _found(role, complex(value), row, dt, spread, band)
        for value, row in zip(values[kept], by_theta[kept], strict=True)
    ]
    found.sort(key=lambda each: each.frequency if math.isfinite(each.frequency) else math.inf)
    return tuple(found)


def _found(
    role: Role, z: complex, row: Complex, dt: float, spread: FitSpread, band: DriveBand
) -> FoundRoot:
    missing = math.nan
    rows = [row.real, row.imag, (np.conj(z) * row).real / (abs(z) or missing)]
    physical = [missing] * 3
    if z != 0.0 and math.pi - abs(math.atan2(z.imag, z.real)) > _ON_THE_AXIS:
        s, by_s = complex(np.log(z)) / dt, row / (z * dt)
        size = abs(s) or missing
        by_size = (np.conj(s) * by_s).real / size
        pair = z.imag != 0.0
        physical = [size / (2.0 * math.pi), -s.real / size if pair else missing]
        physical.append(missing if pair else -1.0 / (s.real or missing))
        rows += [
            by_size / (2.0 * math.pi),
            -by_s.real / size + s.real * by_size / size**2,
            by_s.real / (s.real**2 or missing),
        ]
    errors = _errors(spread, np.array(rows + [np.full(row.size, missing)] * (6 - len(rows))))
    sizes = [missing if math.isnan(x) else e for x, e in zip(physical, errors[3:], strict=True)]
    (frequency, damping, time_constant), (of_frequency, of_damping, of_time) = physical, sizes
    modulus_error = errors[2]
    root = FoundRoot(
        role,
        z,
        complex(errors[0], errors[1]),
        modulus_error,
        frequency,
        of_frequency,
        damping,
        of_damping,
        time_constant,
        of_time,
    )
    # The response at half the sample rate is all that is seen of what is faster.
    place = min(frequency, band.nyquist)
    shown = math.isnan(place) or bool(band.excites(place)[0])
    root = replace(root, is_shown=shown or not modulus_error > 0.0)
    return replace(root, undetermined=_why_not(root) + _taken_for_hysteresis(root, band))


def _taken_for_hysteresis(root: FoundRoot, band: DriveBand) -> tuple[str, ...]:
    """Tell a resonance that is as near as nothing to the only frequency that drives."""
    if root.role == "zero" or not root.is_pair or not root.modulus_error > 0.0:
        return ()
    ratio = root.frequency / band.only_line
    if not 1.0 / OCTAVE <= ratio <= OCTAVE:  # not of NaN
        return ()
    return (
        f"the drive is one sine, of {band.only_line:.3g} Hz, and what resonates that near to it "
        "is not told from gain and loop of the hysteresis",
    )


def _errors(spread: FitSpread, rows: NDArray[np.float64]) -> list[float]:
    """Give standard errors: 0 of what is held, infinity of what the records do not determine."""
    rows = np.where(np.isfinite(rows).all(axis=1, keepdims=True), rows, np.nan)
    moves = rows.any(axis=1)  # true of what is not finite
    errors = np.zeros(len(rows))
    errors[moves] = np.inf
    known = moves & np.isfinite(rows).all(axis=1)
    if known.any():
        errors[known] = np.nan_to_num(spread.of(rows[known]), nan=np.inf)
    return [float(each) for each in errors]


def _why_not(root: FoundRoot) -> tuple[str, ...]:
    if not root.modulus_error > 0.0:
        return ()  # held
    reasons = []
    if math.isfinite(root.frequency):
        if not root.is_shown:
            reasons.append("the drive shows nothing within an octave")
        share = root.frequency_error / root.frequency
        if share > UNSURE:
            reasons.append(
                f"the standard error of its frequency is {100.0 * share:.3g} % of it, more than "
                f"{100.0 * UNSURE:g} %"
                if math.isfinite(share)
                else "the records do not tell its frequency from other constants"
            )
    elif not math.isfinite(root.modulus_error):
        reasons.append("the records do not tell it from other constants")
    # A pole on the circle would ring for ever: its damping is not known from 0.
    outermost = abs(root.value) + TO_THE_CIRCLE * root.modulus_error
    if root.role == "pole" and 1.0 <= outermost < math.inf:
        reasons.append(f"{TO_THE_CIRCLE:g} standard errors of it reach the unit circle")
    return tuple(reasons)
