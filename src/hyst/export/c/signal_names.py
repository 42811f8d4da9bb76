"""Variables of an example, called by what they mean: ``position_um``."""

from __future__ import annotations

import re
from collections.abc import Iterable

from hyst.export.c.names import is_word, spelled

_LONGEST_PART = 24
# Macros of common headers and compilers in small letters, and functions the example calls.
_MACROS = """
    assert errno far huge i386 linux main near printf signal stderr stdin stdout unix
"""
_OTHERS = frozenset(_MACROS.split())


def variables(
    meant: Iterable[tuple[str, str, str]], name: str, taken: Iterable[str] = ()
) -> dict[str, str]:
    """Give a variable of C for every signal, called by its name and unit.

    Parameters
    ----------
    meant
        What the exported functions call it, its name and its unit; either may be empty, or anything
        the user's file had.
    name
        Prefix of the export, which is also what its state is called.
    taken
        Further words that no variable may have.

    Returns
    -------
    dict
        The variable by what the functions call the signal, all different, in the same order.

    Examples
    --------
    >>> variables([("u", "Position", "µm"), ("y", "Spannung (V)", "V")], "lens")
    {'u': 'position_um', 'y': 'spannung_V'}
    >>> variables([("u", "", ""), ("y", "lens_step", "")], "lens")
    {'u': 'u', 'y': 'y_lens_step'}
    """
    given: dict[str, str] = {}
    refused = {*taken, name}
    for role, signal, unit in meant:
        variable = _joined(role, identifier(signal).lower(), identifier(unit))
        if _is_harmful(variable, name) or variable in refused:
            variable = f"{role}_{variable}"
        while variable in refused:
            variable = f"{variable}_{role}"
        refused.add(variable)
        given[role] = variable
    return given


def identifier(text: str) -> str:
    """Give what of a ``text`` can stand inside an identifier; empty if nothing can."""
    text = spelled(text).replace("%", " percent ").replace("/", " per ").replace("^", "")
    words = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_")
    return words[:_LONGEST_PART].strip("_")


def _joined(role: str, signal: str, unit: str) -> str:
    """Give name and unit in one word; the unit once, where the name ends with it."""
    if not unit:
        return signal or role
    if signal == unit.lower() or signal.endswith(f"_{unit.lower()}"):
        signal = signal[: -len(unit)].rstrip("_")
    return f"{signal or role}_{unit}"


def _is_harmful(variable: str, name: str) -> bool:
    return (
        not variable[0].isalpha()
        or is_word(variable)
        or variable in _OTHERS
        or variable.endswith("_t")
        or variable.lower().startswith((f"{name.lower()}_", "hyst"))
    )
