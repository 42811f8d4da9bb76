"""Units in terms of SI base units, so that importers can tell volts from micrometres."""

from __future__ import annotations

_PREFIXES = {"": 1.0, "n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6}

# Factor and exponents of kg, m, s, A.
_UNITS: dict[str, tuple[float, dict[str, int]]] = {
    "m": (1.0, {"m": 1}),
    "s": (1.0, {"s": 1}),
    "A": (1.0, {"A": 1}),
    "V": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "N": (1.0, {"kg": 1, "m": 1, "s": -2}),
    "Pa": (1.0, {"kg": 1, "m": -1, "s": -2}),
    "bar": (1e5, {"kg": 1, "m": -1, "s": -2}),
    "T": (1.0, {"kg": 1, "s": -2, "A": -1}),
    "C": (1.0, {"s": 1, "A": 1}),
    "W": (1.0, {"kg": 1, "m": 2, "s": -3}),
    "Hz": (1.0, {"s": -1}),
    "rad": (1.0, {"rad": 1}),
}


def base_unit(name: str) -> dict[str, str]:
    """Give the attributes of FMI's ``BaseUnit``.

    Parameters
    ----------
    name
        A unit, as "um" or "kV".

    Returns
    -------
    dict
        Exponents and factor as text; empty for a unit that is not known, which is then just a name.

    Examples
    --------
    >>> base_unit("um")
    {'m': '1', 'factor': '1e-06'}
    >>> base_unit("furlong")
    {}
    """
    for unit, (scale, exponents) in _UNITS.items():
        prefix = name.removesuffix(unit)
        if name.endswith(unit) and prefix in _PREFIXES:
            found = {base: str(power) for base, power in exponents.items()}
            factor = scale * _PREFIXES[prefix]
            return found if factor == 1.0 else found | {"factor": repr(factor)}
    return {}
