"""C files put one after the other, so that one file is all a compiler needs."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping

# Names that C keeps to one file: functions, tables and types at the margin.
_FILE_SCOPE = re.compile(
    r"^static\s(?!inline)[\w\s\*]*?\b(\w+)\s*(?:\(|=|\[)|^\}\s*(\w+);", re.MULTILINE
)
_OWN_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"(\w+\.h)"[ \t]*\n', re.MULTILINE)
# With the comment above it, whose end is the first one.
_INLINE = re.compile(
    r"(?:^/\*(?:[^*]|\*(?!/))*\*/\n)?^static inline [^;{]*?\b(\w+)\(.*?^\}\n\n?",
    re.MULTILINE | re.DOTALL,
)
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


def in_one_file(files: Mapping[str, bytes], roots: Mapping[str, str]) -> str:
    r"""Give the core's files and those that need them as one text.

    Parameters
    ----------
    files
        Of the core, by name, as ``CoreCopy.files`` gives them.
    roots
        Further files by name, in their order.

    Returns
    -------
    str
        Headers before what includes them, every file once, without the lines that include another
        of them, without inline functions that nothing calls, of which compilers warn, and with
        names of its own for what is static in two of them.

    Examples
    --------
    >>> core = {"x_a.c": b'#include "x_a.h"\nint b;\n', "x_a.h": b"int a;\n"}
    >>> print(in_one_file(core, {}), end="")
    <BLANKLINE>
    /* ---- x_a.h ---- */
    int a;
    <BLANKLINE>
    /* ---- x_a.c ---- */
    int b;
    """
    texts = {name: content.decode("ascii") for name, content in files.items()} | dict(roots)
    texts |= with_own_names({name: text for name, text in texts.items() if name.endswith(".c")})
    placed: list[str] = []
    for name in texts:
        if name.endswith(".c"):
            _place(name, texts, placed)
    return _without_unused(
        "".join(
            f"\n/* ---- {name} ---- */\n{_without_own_includes(texts[name], texts)}"
            for name in placed
        )
    )


def with_own_names(files: Mapping[str, str]) -> dict[str, str]:
    r"""Give files for one compilation, where what is static in two of them has two names.

    Parameters
    ----------
    files
        C by name.

    Returns
    -------
    dict
        The name of the file stands before what an earlier one has, too.

    Examples
    --------
    >>> with_own_names({"a.c": "static int i = 1;\n", "b.c": "static int i = 2;\n"})["b.c"]
    'static int b_i = 2;\n'
    """
    seen: set[str] = set()
    found = {}
    for file, text in files.items():
        own = {name for pair in _FILE_SCOPE.findall(text) for name in pair if name}
        stem = file.removesuffix(".c")
        for name in own & seen:
            text = re.sub(rf"\b{name}\b", f"{stem}_{name}", text)
        found[file] = text
        seen |= own
    return found


def _place(name: str, texts: Mapping[str, str], placed: list[str]) -> None:
    for included in _OWN_INCLUDE.findall(texts[name]):
        if included in texts and included not in placed:
            _place(included, texts, placed)
    placed.append(name)


def _without_own_includes(text: str, texts: Mapping[str, str]) -> str:
    return _OWN_INCLUDE.sub(lambda line: "" if line[1] in texts else line[0], text)


def _without_unused(text: str) -> str:
    names = Counter(re.findall(r"\w+", _COMMENT.sub("", text)))
    less = _INLINE.sub(lambda found: found[0] if names[found[1]] > 1 else "", text)
    return text if less == text else _without_unused(less)
