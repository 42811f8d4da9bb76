"""A project whose code lies in one folder, for builds that know no path of includes."""

from __future__ import annotations

import re

_INCLUDE = re.compile(rb'#include "hyst/(\w+\.h)"')
_CORE = re.compile(r"core/(?:src|include/hyst)/(\w+\.[ch])")
_TESTS = ("selftest.c", "selftest_vectors.h")


def flattened(files: dict[str, bytes], name: str) -> dict[str, bytes]:
    """Put the core's files beside the others and the self-test into a folder of its own.

    An Arduino library or an IDE that compiles what lies in a folder takes such a project as it is:
    every include is found beside the file, and there is one ``main`` less.

    Parameters
    ----------
    files
        Content by path, as a project has it.
    name
        Its prefix.

    Returns
    -------
    dict
        The same, the core's files called ``hyst_play.h`` and so on.

    Examples
    --------
    >>> files = {"a.h": b'#include "hyst/real.h"', "selftest.c": b""}
    >>> files["core/include/hyst/real.h"] = b""
    >>> list(flattened(files, "a")), flattened(files, "a")["a.h"]
    (['a.h', 'selftest/selftest.c', 'hyst_real.h'], b'#include "hyst_real.h"')
    """
    flat: dict[str, bytes] = {}
    for path, content in files.items():
        core = _CORE.fullmatch(path)
        place = f"hyst_{core[1]}" if core else path
        content = _INCLUDE.sub(rb'#include "hyst_\1"', content)
        if path in _TESTS:
            place = f"selftest/{path}"
            content = content.replace(f'"{name}.h"'.encode(), f'"../{name}.h"'.encode())
        flat[place] = content
    for path, edits in _TEXTS.items():
        if path in flat:
            text = _CORE.sub(r"hyst_\1", flat[path].decode("ascii"))
            for before, after in edits:
                text = text.replace(before.format(name=name), after.format(name=name))
            flat[path] = text.encode("ascii")
    return flat


# What the texts of a project say of its folders, and what is true of a flat one.
_TEXTS = {
    "CMakeLists.txt": (
        ("${{CMAKE_CURRENT_SOURCE_DIR}}/core/include", "${{CMAKE_CURRENT_SOURCE_DIR}}/selftest"),
        ("{name}_selftest selftest.c", "{name}_selftest selftest/selftest.c"),
    ),
}
