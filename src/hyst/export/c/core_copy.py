"""A copy of the core's files under names and for a number type of its own.

Two exports in one program must not share a function that only looks alike: one in double takes what
one in single cannot. So every copy of the core has its own prefix where the core has ``hyst``, and
is of one precision, whatever a compiler is told.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

from hyst.export.c.numbers import Precision

NUMBER = {"double": "double", "single": "float"}
"""The number type of a target in C, by precision."""

_NAME = re.compile(r"\bhyst_(?=\w)")
_MACRO = re.compile(r"(?:\b|(?<=-D))HYST_(?=\w)")
_HEADER = re.compile(r"\bhyst/(?=\w+\.h\b)")
_LITERAL = re.compile(r"\bHYST_REAL\(([^()]*)\)")
_REAL_INCLUDE = '#include "hyst/real.h"\n\n'
_CONDITION = re.compile(r"#\s*(?:(ifdef|ifndef)\s+(\w+)|(if)\b|(else)\b|(endif)\b)")
_BLANK_LINES = re.compile(r"\n{3,}")
_FIRST_COMMENT = re.compile(r"\A/\*.*?\*/\n", re.DOTALL)


@final
@dataclass(frozen=True)
class CoreCopy:
    """What becomes of the core's files in an export.

    Parameters
    ----------
    prefix
        What stands for ``hyst`` in names, macros and files, as "lens_core".
    precision
        Of the target.
    """

    prefix: str
    precision: Precision

    def files(self, needed: Mapping[str, bytes]) -> dict[str, bytes]:
        """Give the copies of files, which lie in one folder.

        Parameters
        ----------
        needed
            Content by path, as ``core_files`` gives it.

        Returns
        -------
        dict
            Content by name.
        """
        return {self.name_of(path): _copied(self, path, text) for path, text in needed.items()}

    def name_of(self, path: str) -> str:
        """Give the name of the copy of a file of the core."""
        return f"{self.prefix}_{path.rsplit('/', 1)[-1]}"

    def own(self, code: str) -> str:
        """Give C of the export itself: plain numbers, and calls of this copy.

        Parameters
        ----------
        code
            With the core's own names.
        """
        suffix = "f" if self.precision == "single" else ""
        code = _LITERAL.sub(rf"\g<1>{suffix}", code.replace(_REAL_INCLUDE, ""))
        return self.renamed(re.sub(r"\bhyst_real\b", NUMBER[self.precision], code))

    def renamed(self, code: str) -> str:
        """Give C in which the core's names are those of this copy."""
        code = _HEADER.sub(f"{self.prefix}_", code)
        code = _MACRO.sub(f"{self.prefix.upper()}_", code)
        return _NAME.sub(f"{self.prefix}_", code)


@functools.lru_cache(256)
def _copied(copy: CoreCopy, path: str, content: bytes) -> bytes:
    text, known = content.decode("ascii"), {"HYST_SINGLE": copy.precision == "single"}
    if path.endswith("/real.h"):
        text = _FIRST_COMMENT.sub("/* The number type of this copy of the core. */\n", text)
        known["HYST_REAL_HEADER"] = False
    return copy.renamed(_BLANK_LINES.sub("\n\n", decided(text, known))).encode("ascii")


def decided(text: str, known: Mapping[str, bool]) -> str:
    r"""Give C without the conditions whose outcome is known.

    Parameters
    ----------
    text
        C.
    known
        Whether a macro is defined.

    Returns
    -------
    str
        Only the branches that are compiled; other conditions stay.

    Examples
    --------
    >>> decided("#ifdef A\nint a;\n#else\nint b;\n#endif\n", {"A": False})
    'int b;\n'
    """
    kept: list[str] = []
    # Of every open condition: whether its branch is compiled; None where that is not known.
    opened: list[bool | None] = []
    for line in text.splitlines(keepends=True):
        found = _CONDITION.match(line)
        how, name, other, otherwise, end = found.groups() if found else (None,) * 5
        if how or other:
            outcome = known.get(name) if name else None
            opened.append(outcome if how == "ifdef" or outcome is None else not outcome)
            hidden = opened[-1] is not None
        elif otherwise:
            hidden = opened[-1] is not None
            opened[-1] = None if opened[-1] is None else not opened[-1]
        elif end:
            hidden = opened.pop() is not None
        else:
            hidden = False
        if not hidden and False not in opened:
            kept.append(line)
    return "".join(kept)
