"""Poles, zeros and limits of identified dynamics in words, for summary, report and verdict."""

from __future__ import annotations

import math
from typing import Any

from hyst.errors import NotInvertibleError
from hyst.identification.families.hammerstein.told.found_root import FoundRoot
from hyst.identification.families.hammerstein.told.known_dynamics import KnownDynamics
from hyst.models import ContinuousDynamics, LinearDynamics
from hyst.operators import Verdict

HEADER = ("", "frequency", "damping or time constant", "in the plane of z", "")


def name_of(root: FoundRoot) -> str:
    """Say what a pole or zero is to an engineer."""
    if root.is_pair:
        return "resonance" if root.role == "pole" else "antiresonance"
    return f"real {root.role}"


def root_rows(known: KnownDynamics) -> tuple[tuple[str, ...], ...]:
    """Give a row of text for each pole and zero, under ``HEADER``.

    Parameters
    ----------
    known
        What a fit tells of its dynamics.
    """
    return tuple(
        (name_of(each), _frequency(each), _decay(each), _in_z(each), "; ".join(_notes(each)))
        for each in (*known.poles, *known.zeros)
    )


def not_determined(known: KnownDynamics) -> tuple[str, ...]:
    """Give sentences on poles, and zeros with a frequency, not to be relied on: one for a reason.

    Parameters
    ----------
    known
        What a fit tells of its dynamics.
    """
    shown = bands_told(known)
    groups: dict[tuple[str, str], list[FoundRoot]] = {}
    for each in _missed(known):
        groups.setdefault(("; ".join(each.undetermined), _advice(each)), []).append(each)
    return tuple(
        f"{_named(roots)} of G {'are' if len(roots) > 1 else 'is'} not determined by this drive: "
        f"{reasons}; the drive shows G {shown}{advice}"
        for (reasons, advice), roots in groups.items()
    )


def bands_told(known: KnownDynamics) -> str:
    """Say at which frequencies the drive shows G."""
    bands = known.band.bands()
    if not bands:
        return "nowhere"
    return "from " + ", from ".join(f"{low:.3g} to {high:.3g} Hz" for low, high in bands)


def verdict_on(verdict: Verdict, known: KnownDynamics) -> Verdict:
    """Add to a verdict what the drive does not determine.

    Where it has no power at a pole, the model is an extrapolation there, whatever is left of the
    record: it is no better than ``fair``.

    Parameters
    ----------
    verdict
        On the fit.
    known
        What it tells of its dynamics.

    Returns
    -------
    Verdict
    """
    missed = [each for each in _missed(known) if each.role == "pole"]
    if not missed:
        return verdict
    sentence = f"This drive does not determine {_named(missed)} of G"
    if all(each.is_shown for each in missed):
        return Verdict(verdict.level, (*verdict.sentences, f"{sentence}."))
    sentence += (
        f": it shows G {bands_told(known)}, and beyond, the model is an extrapolation; drive the "
        "actuator there, too."
    )
    if verdict.level == "good":
        return Verdict("fair", (sentence, *verdict.sentences))
    return Verdict(verdict.level, (*verdict.sentences, sentence))


def continuous_of(dynamics: LinearDynamics) -> tuple[ContinuousDynamics | None, str]:
    """Give the system in continuous time, or None with the reason why there is none."""
    try:
        return dynamics.to_continuous(), ""
    except NotInvertibleError as error:
        return None, str(error)


def summary_lines(known: KnownDynamics) -> list[str]:
    """Give lines of a summary on poles, zeros and the continuous system.

    Parameters
    ----------
    known
        What a fit tells of its dynamics.
    """
    G = known.dynamics
    late = f"; delay {G.delay} samples ({G.delay * G.dt:.4g} s)" if G.delay else ""
    given = ", given" if known.is_held else ""
    shown = "" if known.is_held else f"; the drive shows G {bands_told(known)}"
    lines = [f"zeros and poles of G (order {G.order}{given}){late}{shown}:"]
    for row in root_rows(known):
        name, *rest = row
        lines.append(f"  {name:14s} " + "   ".join(each for each in rest if each))
    continuous, reason = continuous_of(G)
    if continuous is None:
        return [*lines, f"no continuous system: {reason}"]
    late = f", dead time {continuous.delay:.6g} s" if continuous.delay else ""
    return [*lines, f"as continuous system, input held{late}:", *polynomials_told(continuous)]


def dynamics_as_data(known: KnownDynamics) -> dict[str, Any]:
    """Give poles, zeros, excited bands and the continuous system as plain numbers and text.

    Parameters
    ----------
    known
        What a fit tells of its dynamics.
    """
    continuous, reason = continuous_of(known.dynamics)
    poles = [each.to_dict() for each in known.poles if not each.is_pair]
    return {
        "resonances": [each.to_dict() for each in known.poles if each.is_pair],
        "real_poles": poles,
        "zeros": [each.to_dict() for each in known.zeros],
        "excited_bands_hz": [list(each) for each in known.band.bands()],
        "continuous": {"refused": reason}
        if continuous is None
        else {
            "numerator": continuous.num.tolist(),
            "denominator": continuous.den.tolist(),
            "dead_time_s": continuous.delay,
        },
    }


def polynomials_told(continuous: ContinuousDynamics) -> list[str]:
    """Give numerator and denominator, descending powers of s in rad/s, a line each."""
    return [
        f"  {name:11s} in s: " + "  ".join(f"{each:.6g}" for each in coefficients)
        for name, coefficients in (("numerator", continuous.num), ("denominator", continuous.den))
    ]


def _advice(root: FoundRoot) -> str:
    return ", so a smaller state_order may do" if root.is_shown else ""


def _missed(known: KnownDynamics) -> list[FoundRoot]:
    roots = (*known.poles, *(each for each in known.zeros if each.is_pair))
    return [each for each in roots if not each.is_determined]


def _named(roots: list[FoundRoot]) -> str:
    return ", ".join(f"the {name_of(each)} at {_place(each)}" for each in roots)


def _place(root: FoundRoot) -> str:
    if root.is_pair:
        return f"{root.frequency:.4g} Hz"
    if math.isfinite(root.time_constant):
        return f"{root.frequency:.4g} Hz (time constant {root.time_constant:.3g} s)"
    return f"z = {root.value.real:.4g}"


def _with_error(value: float, error: float, digits: int = 6) -> str:
    shown = f" +- {error:.2g}" if 0.0 < error < math.inf else " +- ?" if error > 0.0 else ""
    return f"{value:.{digits}g}{shown}"


def _in_z(root: FoundRoot) -> str:
    z, error = root.value, root.standard_error
    if not root.is_pair:
        return _with_error(z.real, error.real)
    return f"({_with_error(z.real, error.real)}) +- ({_with_error(z.imag, error.imag)})j"


def _frequency(root: FoundRoot) -> str:
    if not math.isfinite(root.frequency):
        return ""
    hertz = _with_error(root.frequency, root.frequency_error)
    return f"{hertz} Hz ({root.angular_frequency:.5g} rad/s)"


def _decay(root: FoundRoot) -> str:
    if root.is_pair:
        return f"damping {_with_error(root.damping, root.damping_error, 4)}"
    if not math.isfinite(root.time_constant):
        return ""
    return f"time constant {_with_error(root.time_constant, root.time_constant_error, 4)} s"


def _notes(root: FoundRoot) -> list[str]:
    notes = []
    if not root.is_determined:
        notes.append("NOT DETERMINED")
    if not math.isfinite(root.frequency):
        notes.append(
            "of sampling: no continuous system has it"
            if root.role == "pole"
            else "between samples: it has no frequency"
        )
    if root.role == "zero" and root.side != "inside":
        where = {
            "outside": "outside the unit circle: nonminimum phase",
            "open": "on either side of the unit circle within its error",
        }
        notes.append(where[root.side])
    return notes
