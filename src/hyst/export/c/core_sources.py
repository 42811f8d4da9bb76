"""The core's files that a piece of C needs: unchanged, and no others.

A source is needed if it defines a function that is called; a header, if it is included. Both are
read from the files themselves, so that no list of dependencies can go stale.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator
from pathlib import Path

from hyst import _engine
from hyst.errors import HystError

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_CALL = re.compile(r"\b(hyst_\w+)\s*\(")
_DEFINITION = re.compile(r"^[a-z][\w \*]*?\b(hyst_\w+)\([^;{}]*\)\s*\{", re.MULTILINE)
_INLINE = re.compile(r"^static inline .*?^\}", re.MULTILINE | re.DOTALL)
_INCLUDE = re.compile(r'^\s*#\s*include\s+"(hyst/\w+\.h)"', re.MULTILINE)


def core_folder() -> Path:
    """Give the folder that holds the core's ``SOURCES``, ``include`` and ``src``.

    Returns
    -------
    pathlib.Path
        The copy beside the compiled engine: what it was compiled from, whatever has been changed in
        a source tree since.

    Raises
    ------
    HystError
        If it is not there.
    """
    folder = Path(_engine.__file__).resolve().parent / "core"
    if not (folder / "SOURCES").is_file():
        raise HystError(f"the C sources of the core are not in {folder}; install hyst again")
    return folder


def core_files(text: str) -> dict[str, bytes]:
    """Give the files of the core that a piece of C needs.

    Parameters
    ----------
    text
        C that calls the core's functions and includes its headers.

    Returns
    -------
    dict
        Content by path, as "src/play.c" and "include/hyst/play.h", sorted.

    Raises
    ------
    HystError
        If the core is not there.

    Examples
    --------
    >>> list(core_files('#include "hyst/play.h"'))
    ['include/hyst/kind.h', 'include/hyst/play.h', 'include/hyst/real.h']
    >>> list(core_files("hyst_play_step(r, z, u);"))
    ['include/hyst/kind.h', 'include/hyst/play.h', 'include/hyst/real.h', 'src/play.c']
    """
    folder = core_folder()
    sources = _sources(folder)
    homes = {name: path for path, code in sources.items() for name in _DEFINITION.findall(code)}
    needed: set[str] = set()
    pending = [text]
    while pending:
        code = _without_comments(pending.pop())
        found = {f"include/{header}" for header in _INCLUDE.findall(code)}
        found |= {homes[name] for name in _called(code) if name in homes}
        for path in found - needed:
            needed.add(path)
            pending.append((folder / path).read_text(encoding="utf-8"))
    return {path: (folder / path).read_bytes() for path in sorted(needed)}


@functools.cache
def _sources(folder: Path) -> dict[str, str]:
    paths = (folder / "SOURCES").read_text(encoding="utf-8").split()
    return {path: _without_comments((folder / path).read_text(encoding="utf-8")) for path in paths}


def _without_comments(code: str) -> str:
    return _COMMENT.sub(" ", code)


def _called(code: str) -> Iterator[str]:
    """Functions that are called; in a header, by its inline functions alone."""
    is_header = re.search(r"^#ifndef HYST_\w+_H$", code, re.MULTILINE) is not None
    for part in _INLINE.findall(code) if is_header else (code,):
        yield from _CALL.findall(part)
