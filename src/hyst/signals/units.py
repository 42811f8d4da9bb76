"""Whether two units are the same; hyst keeps units as text and converts none."""

from __future__ import annotations

_MICRO_SIGNS = str.maketrans({"\N{MICRO SIGN}": "u", "\N{GREEK SMALL LETTER MU}": "u"})


def units_differ(unit: str, other: str) -> bool:
    """Tell whether two units are given and differ.

    Parameters
    ----------
    unit, other
        Units as text; an empty one is unknown and agrees with every other. The signs for micro
        are one with u, which is what keyboards have.

    Returns
    -------
    bool

    Examples
    --------
    >>> units_differ("mV", "V"), units_differ("um", "\N{MICRO SIGN}m"), units_differ("", "V")
    (True, False, False)
    """
    if not unit or not other:
        return False
    return unit.translate(_MICRO_SIGNS) != other.translate(_MICRO_SIGNS)
