"""C files put one after the other, so that one file is all a compiler needs."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

# Names that C keeps to one file: functions, tables and types at the margin.
_FILE_SCOPE = re.compile(
    r"^static\s(?!inline)[\w\s\*]*?\b(\w+)\s*(?:\(|=|\[)|^\}\s*(\w+);", re.MULTILINE
)
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
    homes = {path.removeprefix("core/include/"): path for path in texts}
    homes |= {each: each for each in roots}
    texts |= roots
    shared = shared_names({path: text for path, text in texts.items() if path.endswith(".c")})
    placed: list[str] = []
    for path in texts:
        if path.endswith(".c"):
            _place(path, texts, homes, placed)
    return "".join(
        f"\n/* ---- {path} ---- */\n"
        + renamed(path, shared.get(path, ()), _without_own_includes(texts[path], homes))
        for path in placed
    )


def shared_names(files: Mapping[str, str]) -> dict[str, tuple[str, ...]]:
    r"""Give the names of its own that a file shares with an earlier one.

    Parameters
    ----------
    files
        C by path.

    Returns
    -------
    dict
        Names by path, sorted; paths without any are left out.

    Examples
    --------
    >>> shared_names({"a.c": "static int push(int i)\n{}\n", "b.c": "static int push(void)\n{}\n"})
    {'b.c': ('push',)}
    """
    seen: set[str] = set()
    found = {}
    for path, text in files.items():
        own = {name for pair in _FILE_SCOPE.findall(text) for name in pair if name}
        if own & seen:
            found[path] = tuple(sorted(own & seen))
        seen |= own
    return found


def renamed(path: str, names: Sequence[str], text: str) -> str:
    """Give a text in which some names become the file's own.

    Parameters
    ----------
    path
        Of the file.
    names
        Which.
    text
        C.

    Returns
    -------
    str
        The text between macros.
    """
    stem = re.sub(r"\W", "_", path.rsplit("/", 1)[-1].removesuffix(".c"))
    before = "".join(f"#define {name} hyst_{stem}_{name}\n" for name in names)
    after = "".join(f"#undef {name}\n" for name in names)
    return before + text + after


def _place(path: str, texts: dict[str, str], homes: dict[str, str], placed: list[str]) -> None:
    for name in _OWN_INCLUDE.findall(texts[path]):
        if name in homes and homes[name] not in placed:
            _place(homes[name], texts, homes, placed)
    placed.append(path)


def _without_own_includes(text: str, homes: dict[str, str]) -> str:
    return _OWN_INCLUDE.sub(lambda line: "" if line[1] in homes else line[0], text)
