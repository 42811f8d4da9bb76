"""What a drive leaves open, and what to add to it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.forecast.drive_forecast import SURE, TOLD_APART, ExpectedError
from hyst.operators import Operator
from hyst.signals import Drive

Array = NDArray[np.float64]

_NOTHING = 1e-3  # of the largest line: what is below does not excite
_ABOVE = 1.5  # times a resonance: so far a band should go beyond it
_HOPELESS = 1e3
_MANY = 6  # names in a sentence


def advice_on(
    drive: Drive,
    leaves: Sequence[Operator],
    dynamics: Sequence[ExpectedError],
    front: Sequence[ExpectedError],
    delay_evidence: float | None,
) -> tuple[str, ...]:
    """Say what stays undetermined, why, and what to add.

    Parameters
    ----------
    drive
        The drive.
    leaves
        Parts of the stated model in the order of the signal.
    dynamics, front
        Expected errors.
    delay_evidence
        Standard errors by which the delay is told from its neighbours; None without dynamics.
    """
    said = _on_resonances(drive, dynamics)
    on_plays, named = _on_plays(drive, leaves)
    said += on_plays
    said += _on_constants(
        [each for each in front if not each.determined and each.name not in named]
    )
    if delay_evidence is not None and delay_evidence < TOLD_APART:
        said.append(
            "the delay is not determined: one sample more or less is "
            f"{delay_evidence:.2g} standard errors away, and {TOLD_APART:g} tell them apart, for "
            "the zeros of the dynamics make up for it in this band; add higher frequencies, or "
            "hold the delay if it is known"
        )
    return tuple(said)


def band_of(drive: Drive) -> tuple[float, float]:
    """Give the lowest and the highest frequency at which a drive moves, Hz.

    Parameters
    ----------
    drive
        Not constant.
    """
    u = drive.u[: drive.period] if drive.period else drive.u
    # Against leakage of a drive that ends elsewhere than it began.
    window = np.ones(u.size) if drive.period else np.hanning(u.size)
    size = np.abs(np.fft.rfft(window * (u - u.mean())))
    frequency = np.fft.rfftfreq(u.size, drive.dt)
    moves = frequency[size > _NOTHING * size.max()]
    return float(moves[0]), float(moves[-1])


def _on_resonances(drive: Drive, dynamics: Sequence[ExpectedError]) -> list[str]:
    """Group resonance and damping, the same cause and the same cure."""
    said, low_high = list[str](), band_of(drive)
    hertz, open_ones = 0.0, dict[float, list[ExpectedError]]()
    for each in dynamics:
        hertz = each.value if each.is_frequency else hertz
        if not each.determined:
            open_ones.setdefault(hertz, []).append(each)
    for at, those in open_ones.items():
        worst = max(those, key=lambda each: each.share)
        what = those[0].name.removesuffix(" [Hz]")
        if those[0].is_frequency:
            what = f"{what} at {at:.4g} Hz"
        what += " and its damping are" if len(those) > 1 else " is"
        said.append(f"the {what} not determined: {_cure(low_high, at, worst)}")
    return said


def _cure(band: tuple[float, float], hertz: float, each: ExpectedError) -> str:
    if band[1] < hertz / _ABOVE:
        return (
            f"the drive has nothing above {band[1]:.4g} Hz; add frequencies up to "
            f"{_ABOVE * hertz:.4g} Hz"
        )
    if band[0] > hertz * _ABOVE:
        return (
            f"the drive has nothing below {band[0]:.4g} Hz; add frequencies down to "
            f"{hertz / _ABOVE:.4g} Hz"
        )
    if not math.isfinite(each.share):
        return f"the drive has too few lines near {hertz:.4g} Hz; add some around it"
    return f"{_error_of(each)}; {_more_of_it(each)} near {hertz:.4g} Hz"


def _on_plays(drive: Drive, leaves: Sequence[Operator]) -> tuple[list[str], set[str]]:
    """Name plays that the drive does not move both ways, and their constants."""
    said, named, signal = [], set[str](), drive.u
    for leaf in leaves:
        r = getattr(leaf, "r", None)
        if isinstance(r, np.ndarray) and r.ndim == 1:
            half = 0.5 * float(np.ptp(signal))
            idle = np.flatnonzero(r >= half)
            if idle.size:
                named |= {f"{letter}[{index + 1}]" for letter in "pr" for index in idle}
                radii = ", ".join(f"{r[index]:.4g}" for index in idle[:_MANY])
                said.append(
                    f"plays of radius {radii} are not determined: their input moves by "
                    f"{half:.4g} to either side of its middle, and must move by more than the "
                    "radius; raise the amplitude"
                )
        signal = leaf(signal)
    return said, named


def _on_constants(errors: Sequence[ExpectedError]) -> list[str]:
    left_open = [each for each in errors if not math.isfinite(each.standard_error)]
    weak = [each for each in errors if math.isfinite(each.standard_error)]
    said = []
    if left_open:
        said.append(
            f"{_listed(left_open)}: nothing in the output tells them apart, however low the noise; "
            "add other amplitudes, or hold or leave out what is redundant"
        )
    if weak:
        worst = max(weak, key=lambda each: each.share)
        said.append(
            f"{_listed(weak)} {'is' if len(weak) == 1 else 'are'} not determined: "
            f"{_error_of(worst)} for {worst.name}; {_more_of_it(worst)}, or large amplitudes more "
            "often (uniform values, levels)"
        )
    return said


def _error_of(each: ExpectedError) -> str:
    return f"a standard error of {100.0 * each.share:.3g} %"


def _more_of_it(each: ExpectedError) -> str:
    if not math.isfinite(each.share):
        return "give more amplitude"
    factor = each.share / SURE
    if factor > _HOPELESS:
        return "the output hardly shows it, so give more power"
    return (
        f"give {factor:.2g} times the amplitude, {factor:.2g} times less noise, or "
        f"{factor**2:.2g} times the samples"
    )


def _listed(errors: Sequence[ExpectedError]) -> str:
    names = [each.name for each in errors]
    more = f" and {len(names) - _MANY} more" if len(names) > _MANY else ""
    return ", ".join(names[:_MANY]) + more
