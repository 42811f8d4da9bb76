"""One period of a drive from its lines: values spread evenly if wanted, within limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive
from hyst.errors import InputError
from hyst.signals.drive import Limits, fitted
from hyst.signals.even_values import even_phases, unevenness
from hyst.signals.limited_lines import Corners, Lines, said_of, shaped

Array = NDArray[np.float64]

KEPT = ("amplitude", "spectrum")

_FINE = 12  # samples in a period of the highest line, at least
_TURNS = 4  # of evening out and shaping, each of which changes what the other one needs


def period_of(
    lines: Lines, phases: Array, limits: Limits, keep: str, uniform: bool
) -> tuple[Array, tuple[str, ...]]:
    """Make one period that obeys its limits.

    Parameters
    ----------
    lines
        Lines and amplitude wanted.
    phases
        Shape (m,), to begin with.
    limits
        Limits.
    keep
        What limits leave alone: ``"amplitude"``, and the spectrum is shaped; or ``"spectrum"``, and
        the signal is scaled down.
    uniform
        Whether values are to be spread evenly.

    Returns
    -------
    numpy.ndarray
        Shape (count,), without offset.
    tuple of str
        What was done.

    Raises
    ------
    InputError
        If limits cannot be obeyed, or there is nothing of that name to keep.
    """
    require_kept(keep)
    if uniform:
        phases = _evened(lines, lines.sizes, phases)
    if keep == "spectrum":
        period, notes = fitted(lines.wave(lines.sizes, phases), lines.dt, limits, lines.offset)
        return period, (*notes, *_evenness(period, uniform))
    corners = shaped(lines, phases, limits)
    for _ in range(_TURNS if uniform and corners != Corners() else 0):
        phases = _evened(lines, lines.sizes * corners.shape(lines.frequency), phases)
        corners = shaped(lines, phases, limits)
    period = lines.wave(lines.sizes * corners.shape(lines.frequency), phases)
    return period, (*said_of(corners, lines), *_evenness(period, uniform))


def require_kept(keep: str) -> None:
    """Refuse what limits cannot leave alone.

    Parameters
    ----------
    keep
        As of ``period_of``.

    Raises
    ------
    InputError
        If it is none of ``KEPT``.
    """
    if keep not in KEPT:
        raise InputError(f"keep is {keep!r}; choose one of {', '.join(KEPT)}")


def factor_of(period: Array, amplitude: float | None, rms: float | None) -> float:
    """Give the factor that brings a period to its amplitude or rms.

    Parameters
    ----------
    period
        Shape (N,), of mean 0.
    amplitude, rms
        One of them.

    Raises
    ------
    InputError
        If both or none are given, or one is not above 0.
    """
    if (amplitude is None) == (rms is None):
        raise InputError("give either amplitude or rms")
    if amplitude is not None:
        return as_positive(amplitude, "amplitude") * (1.0 - 1e-15) / float(np.abs(period).max())
    return as_positive(rms, "rms") / float(period.std()) if rms is not None else 0.0


def _evened(lines: Lines, sizes: Array, phases: Array) -> Array:
    """Even out the values on as coarse a grid as shows all lines."""
    count = 1 << (_FINE * int(lines.numbers[-1]) - 1).bit_length()  # a fast length
    coarse = lines
    if count < lines.count:
        coarse = replace(lines, count=count, dt=lines.dt * lines.count / count)
    return even_phases(lambda tried: coarse.wave(sizes, tried), lines.numbers, phases)


def _evenness(period: Array, uniform: bool) -> tuple[str, ...]:
    if not uniform:
        return ()
    return (
        f"values are spread evenly to {100.0 * unevenness(period):.2g} % of the samples, and "
        f"{100.0 * _far_out(period):.0f} % of them lie beyond two thirds of the amplitude",
    )


def _far_out(period: Array) -> float:
    return float(np.mean(np.abs(period) > np.abs(period).max() * (2.0 / 3.0)))
