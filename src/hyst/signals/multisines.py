"""Multisine: many frequencies at once, exactly periodic."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_sample_time
from hyst.errors import InputError
from hyst.signals.drive import Drive, Limits, as_count, require_length
from hyst.signals.limited_lines import Lines
from hyst.signals.line_shapes import line_sizes
from hyst.signals.periodic_drive import factor_of, period_of

Array = NDArray[np.float64]

_LINES = ("all", "odd", "odd-random")
_PHASES = ("random", "schroeder")


def multisine(
    dt: float,
    samples: int,
    *,
    amplitude: float | None = None,
    rms: float | None = None,
    band: tuple[float, float] | None = None,
    lines: str = "all",
    phases: str = "random",
    spectrum: str = "flat",
    corner: float | None = None,
    uniform: bool = False,
    periods: int = 1,
    offset: float = 0.0,
    max_rate: float = math.inf,
    max_acceleration: float = math.inf,
    keep: str = "amplitude",
    seed: int = 0,
) -> Drive:
    """Make ``u_k = offset + sum_l a_l cos(2 pi l k / N + phi_l)`` over the lines of a band.

    Random phases make the values Gaussian, which seldom are large; ``uniform`` spreads them evenly.
    A map without memory behind Gaussian values only scales the linear part (Bussgang); hysteresis
    also adds slow parts to it. Odd lines keep even distortion out of the lines that are measured;
    Schroeder phases keep the peaks low.

    Parameters
    ----------
    dt
        Sample time, s.
    samples
        N, samples of one period; the lines are 1 / (N dt) apart.
    amplitude
        Largest deviation from the offset, input units. Give it or ``rms``.
    rms
        Root mean square deviation from the offset.
    band
        Lowest and highest frequency, Hz; from one line to just below half the sample rate if left
        out.
    lines
        ``"all"``, ``"odd"``, or ``"odd-random"``: one odd line in each group of four is left out,
        so that its level shows odd distortion.
    phases
        ``"random"`` or ``"schroeder"``.
    spectrum
        ``"flat"``: lines alike; ``"pink"``: their power falls as 1/f, as much in each octave.
    corner
        From this frequency, Hz, lines fall as 1/f more: below it the displacement is flat, above it
        the rate.
    uniform
        Spread the values evenly between both ends; phases are changed for it, lines are not.
    periods
        How often the period is repeated.
    offset
        Mean, input units.
    max_rate, max_acceleration
        Limits, as of ``Limits``.
    keep
        What limits leave alone: ``"amplitude"`` (or rms), and high lines are made smaller, as 1/f
        for the rate and as 1/f^2 for the acceleration; or ``"spectrum"``, and all is scaled down.
    seed
        Of the random phases; equal seeds give equal signals.

    Returns
    -------
    Drive

    Raises
    ------
    InputError
        If the band goes beyond half the sample rate or holds no line, the lowest line alone is
        beyond a limit, the drive would have more than 1e8 samples, or an argument cannot be used.

    Notes
    -----
    Pintelon and Schoukens, System Identification, 2nd ed. (2012), ch. 4; Schroeder, IEEE Trans.
    Inf. Theory 16 (1970), 85-89; for even values Schreiber and Schmitz, Phys. Rev. Lett. 77 (1996),
    635-638.

    Examples
    --------
    >>> drive = multisine(0.01, 1000, rms=30.0, periods=2)
    >>> len(drive), round(drive.rms, 9), drive.period
    (2000, 30.0, 1000)
    """
    time, count = as_sample_time(dt), as_count(samples, "samples", 4)
    require_length(count * as_count(periods, "periods"))
    rng = np.random.default_rng(seed)
    chosen = _lines(time, count, band, lines, rng)
    angles = _angles(chosen.size, phases, rng)
    sizes = line_sizes(chosen / (count * time), spectrum, corner)
    made = Lines(
        chosen, sizes, count, time, lambda period: factor_of(period, amplitude, rms), offset
    )
    period, notes = period_of(made, angles, Limits(max_rate, max_acceleration), keep, uniform)
    u = np.tile(period, periods) + offset
    return Drive(u, time, "multisine", count, notes)


def _lines(
    dt: float, samples: int, band: tuple[float, float] | None, lines: str, rng: np.random.Generator
) -> NDArray[np.intp]:
    if lines not in _LINES:
        raise InputError(f"lines is {lines!r}; choose one of {', '.join(_LINES)}")
    last = (samples - 1) // 2
    low, high = band if band is not None else (0.0, 0.5 / dt)
    if not 0.0 <= low <= high <= 0.5 / dt * (1.0 + 1e-9):
        raise InputError(
            f"the band is {low:.6g} to {high:.6g} Hz; give two frequencies in ascending order, up "
            f"to half the sample rate, {0.5 / dt:.6g} Hz"
        )
    first = max(1, math.ceil(low * samples * dt - 1e-9))
    last = min(last, math.floor(high * samples * dt + 1e-9))
    chosen = np.arange(first, last + 1)
    if lines != "all":
        chosen = chosen[chosen % 2 == 1]
    if lines == "odd-random" and chosen.size >= 4:
        groups = chosen.size // 4
        chosen = np.delete(chosen, 4 * np.arange(groups) + rng.integers(0, 4, groups))
    if chosen.size == 0:
        raise InputError(
            f"no line lies between {low:.6g} and {high:.6g} Hz; lines are "
            f"{1.0 / (samples * dt):.6g} Hz apart, up to {0.5 / dt:.6g} Hz"
        )
    return chosen


def _angles(count: int, phases: str, rng: np.random.Generator) -> Array:
    if phases == "random":
        return rng.uniform(0.0, 2.0 * np.pi, count)
    if phases == "schroeder":
        l = np.arange(1, count + 1)  # noqa: E741  the field's letter for a line
        return np.asarray(-np.pi * l * (l - 1) / count)
    raise InputError(f"phases is {phases!r}; choose one of {', '.join(_PHASES)}")
