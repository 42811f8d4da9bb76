"""Names of one file alone, made those of its export, so that sources may include one another."""

from __future__ import annotations

import re

# At the margin: functions, tables, types, and macros wherever they stand.
_DEFINED = re.compile(
    r"^static\s[\w\s\*]*?\b(\w+)\s*(?:\(|=|\[)|^\}\s*(\w+);|^typedef\s[\w\s\*]*?\b(\w+);"
    r"|^[ \t]*#[ \t]*define[ \t]+(\w+)",
    re.MULTILINE,
)
_LISTED = re.compile(r"^(?:typedef )?enum \{([^{}]*)\}", re.MULTILINE)
_COMMENT = r"/\*.*?\*/"


def with_prefix(text: str, name: str) -> str:
    r"""Give C in which everything that it defines has the name of the export in it.

    Parameters
    ----------
    text
        C, with what it defines at the margin.
    name
        Of the export; what starts with it, or its upper case, stays.

    Returns
    -------
    str
        The others have ``NAME_core_own_`` before them, macros its upper case.

    Examples
    --------
    >>> with_prefix("/* a */\nstatic int a = 1;\nint lens_b(void) { return a; }\n", "lens")
    '/* a */\nstatic int lens_core_own_a = 1;\nint lens_b(void) { return lens_core_own_a; }\n'
    """
    found = {each for names in _DEFINED.findall(text) for each in names if each}
    for listed in _LISTED.findall(text):
        found |= set(re.findall(r"(?:^|,)\s*(\w+)", re.sub(_COMMENT, "", listed, flags=re.DOTALL)))
    own = {each for each in found if not each.lower().startswith(f"{name.lower()}_")}
    if not own:
        return text
    prefix = f"{name}_core_own_"

    def renamed(match: re.Match[str]) -> str:
        if match[1] is None:
            return match[0]
        return (prefix.upper() if match[1].isupper() else prefix) + match[1]

    words = "|".join(sorted(own))
    return re.sub(rf"{_COMMENT}|\b({words})\b", renamed, text, flags=re.DOTALL)
