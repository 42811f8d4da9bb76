"""The CMake of a C project: a project of its own, or a file that another project includes."""

from __future__ import annotations

from collections.abc import Sequence

from hyst.export.c.layout import Layout
from hyst.export.c.templating import filled


def cmake_file(layout: Layout, places: dict[str, str], core: Sequence[str]) -> str:
    """Give what CMake reads.

    Parameters
    ----------
    layout
        Where the files lie.
    places
        What the templates have in common.
    core
        Sources of the core that are compiled by themselves.

    Returns
    -------
    str
    """
    name, prefix = layout.name, layout.core.prefix
    shared = layout.shared_core and bool(core)
    sources = [f"{name}.c", places["short_test"], *([] if shared else core)]
    more = {
        "core_folder": layout.core_folder,
        "core_target": f"{prefix}_core",
        "sources": "\n".join(f"  ${{CMAKE_CURRENT_LIST_DIR}}/{each}" for each in sources),
        "linked": f"target_link_libraries({name} PUBLIC {prefix}_core)\n" if shared else "",
        "targets": f"{name} {prefix}_core" if shared else name,
    }
    more["core_library"] = filled("shared_core.cmake", places | more) if shared else ""
    more["library"] = filled("library.cmake", places | more)
    return filled("CMakeLists.txt" if layout.is_alone else "included.cmake", places | more)
