"""C files put one after the other, so that one file is all a compiler needs."""

from __future__ import annotations

import re
from collections.abc import Mapping

_OWN_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([\w/]+\.h)"[ \t]*\n', re.MULTILINE)


def in_one_file(files: Mapping[str, bytes], roots: Mapping[str, str]) -> str:
    r"""Give the core's files and those that need them as one text.

    Parameters
    ----------
    files
        Of the core, by path, as ``core_files`` gives them.
    roots
        Further files by name, in their order.

    Returns
    -------
    str
        Headers before what includes them, every file once and as it is, except for lines that
        include another of them.

    Examples
    --------
    >>> core = {"include/hyst/a.h": b"int a;\n", "src/a.c": b'#include "hyst/a.h"\nint b;\n'}
    >>> print(in_one_file(core, {}), end="")
    <BLANKLINE>
    /* ---- core/include/hyst/a.h ---- */
    int a;
    <BLANKLINE>
    /* ---- core/src/a.c ---- */
    int b;
    """
    texts = {f"core/{path}": content.decode("ascii") for path, content in files.items()}
    homes = {path.removeprefix("core/include/"): path for path in texts} | {
        each: each for each in roots
    }
    texts |= roots
    placed: list[str] = []
    for path in texts:
        if path.endswith(".c"):
            _place(path, texts, homes, placed)
    return "".join(
        f"\n/* ---- {path} ---- */\n{_without_own_includes(texts[path], homes)}" for path in placed
    )


def _place(path: str, texts: dict[str, str], homes: dict[str, str], placed: list[str]) -> None:
    for name in _OWN_INCLUDE.findall(texts[path]):
        if name in homes and homes[name] not in placed:
            _place(homes[name], texts, homes, placed)
    placed.append(path)


def _without_own_includes(text: str, homes: dict[str, str]) -> str:
    return _OWN_INCLUDE.sub(lambda line: "" if line[1] in homes else line[0], text)
