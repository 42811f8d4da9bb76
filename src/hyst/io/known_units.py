"""Tell whether a text is a unit, so that a row of units is not taken for a row of names."""

from __future__ import annotations

import re

from hyst.io.units_of_time import seconds_per_unit

_BASE = (
    *"mgsAVNJWCTFHSKLlG",
    *("Pa", "Hz", "Wb", "bar", "Oe", "rad", "eV", "Sa", "sps", "VA", "Vrms", "Vpp", "Arms"),
    *("Ohm", "ohm", "\N{OHM SIGN}", "\N{GREEK CAPITAL LETTER OMEGA}"),
)
_PREFIXES = (
    *("", "f", "p", "n", "u", "\N{MICRO SIGN}", "\N{GREEK SMALL LETTER MU}"),
    *("m", "c", "d", "k", "M", "G"),
)
_ALONE = frozenset(
    (
        *("%", "%FS", "ppm", "deg", "degC", "degF", "dB", "dBm", "rpm", "psi", "inch", "in", "lbf"),
        *("\N{DEGREE SIGN}", "\N{DEGREE SIGN}C", "\N{DEGREE SIGN}F", "emu", "mil", "mils"),
        *("counts", "count", "cts", "LSB", "digits", "digit", "bits", "a.u.", "arb.u."),
        *("-", "1", "#", "none"),
    )
)
_WORDS = frozenset(
    (
        *("volt", "volts", "millivolt", "millivolts", "kilovolt", "kilovolts", "microvolt"),
        *("microvolts", "ampere", "amperes", "amp", "amps", "milliampere", "milliamperes"),
        *("milliamps", "newton", "newtons", "kilonewton", "meter", "meters", "metre", "metres"),
        *("millimeter", "millimeters", "millimetre", "millimetres", "micrometer", "micrometers"),
        *("micrometre", "micrometres", "mikrometer", "micron", "microns", "nanometer"),
        *("nanometers", "nanometre", "nanometres", "kelvin", "celsius", "degree", "degrees"),
        *("grad", "percent", "pascal", "kilopascal", "tesla", "millitesla", "oersted", "gauss"),
        *("hertz", "kilohertz", "radian", "radians", "ohm", "ohms", "watt", "watts", "coulomb"),
        *("bar", "sequence", "sample", "samples", "index", "points", "unitless"),
    )
)
_SYMBOLS = frozenset(prefix + base for prefix in _PREFIXES for base in _BASE)
_EXPONENT = re.compile(r"(\^?\(?[+-]?\d\)?|[\N{SUPERSCRIPT TWO}\N{SUPERSCRIPT THREE}])$")
_JOINED = re.compile(r"[*/\N{MIDDLE DOT}\N{DOT OPERATOR}\s]+")


def is_unit(text: str) -> bool:
    """Tell whether a text is a unit, with or without brackets.

    Examples
    --------
    >>> is_unit("um"), is_unit("[m/s^2]"), is_unit("Volt"), is_unit("voltage")
    (True, True, True, False)
    """
    bare = text.strip()
    if len(bare) > 1 and (bare[0], bare[-1]) in {("(", ")"), ("[", "]"), ("<", ">"), ("{", "}")}:
        bare = bare[1:-1].strip()
    if not bare:
        return False
    if bare in _ALONE or bare.casefold() in _WORDS or seconds_per_unit(bare) is not None:
        return True
    parts = [part for part in _JOINED.split(bare.replace("(", "").replace(")", "")) if part]
    return bool(parts) and all(_is_symbol(part) for part in parts)


def is_word(text: str) -> bool:
    """Tell whether a text is a unit that is written out, as ``volts``."""
    return text.casefold() in _WORDS


def _is_symbol(part: str) -> bool:
    bare = _EXPONENT.sub("", part)
    return bare in _SYMBOLS or bare in _ALONE or part == "1" or bare in {"min", "h", "hr"}
