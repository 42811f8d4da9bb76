"""Where the files of a C project lie, and what they are called.

Nothing needs a path of includes: a file includes what lies beside it or in ``core/src/`` below it.
In a folder that several exports share, every file carries the name of its export or of the shared
core.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst.errors import InputError
from hyst.export.c.core_copy import CoreCopy
from hyst.export.c.numbers import Precision
from hyst.export.folder import MANIFEST

LAYOUTS = ("folder", "flat", "single-file")

SHARED_PREFIX = {"double": "hyst", "single": "hystf"}
"""Prefix of a core that exports share, by precision."""


# Its builder knows no options: without this, a product and a sum may be one operation.
_FOR_ARDUINO = """
Arduino's builder leaves `extras` out, and takes options from its `platform.local.txt`:
`compiler.c.extra_flags=-ffp-contract=off`. Without that, `@_selftest()` may tell of other bits on a
processor that multiplies and adds at once, as a Cortex-M4F does.
"""
_ONE_BY_ONE = """
Compile the sources one by one; for a tool that includes all of them in one, export `single-file`.
"""


@final
@dataclass(frozen=True)
class Layout:
    """Places and names of the files of one export.

    Parameters
    ----------
    form
        "folder": the core's files in ``core/src/``. "flat": all that is compiled in one folder, the
        self-test apart in ``extras/``. "single-file": the core's files within the one source.
    shared_core
        Whether exports of one folder share one copy of the core in each precision.
    name
        The prefix of the export.
    precision
        Of the target.

    Raises
    ------
    InputError
        If there is no such layout, or a single file would share its core.
    """

    form: str
    shared_core: bool
    name: str
    precision: Precision

    def __post_init__(self) -> None:
        if self.form not in LAYOUTS:
            raise InputError(f"layout is {self.form!r}; give {', '.join(LAYOUTS)}")
        if self.shared_core and self.form == "single-file":
            raise InputError(
                "a single file has the core within it and cannot share it; choose the layout "
                "folder or flat for a shared core"
            )

    @property
    def is_alone(self) -> bool:
        """Whether the folder is this export's own, so that few files need to carry its name."""
        return self.form == "folder" and not self.shared_core

    @property
    def core(self) -> CoreCopy:
        """The names of the copy of the core."""
        prefix = SHARED_PREFIX[self.precision] if self.shared_core else f"{self.name}_core"
        return CoreCopy(prefix, self.precision)

    @property
    def core_folder(self) -> str:
        """Where the copy of the core lies, as seen from the source; with "/" at the end, or ""."""
        return "core/src/" if self.form == "folder" else ""

    @property
    def test_folder(self) -> str:
        """Where the self-test lies, which has a ``main`` and is no part of a library."""
        return "" if self.form == "folder" else "extras/"

    @property
    def short_test_folder(self) -> str:
        """Where the self-test for a target lies, which belongs to a library but not to one file."""
        return "extras/" if self.form == "single-file" else ""

    @property
    def manifest(self) -> str:
        """The name of the manifest."""
        return self.beside(MANIFEST)

    def beside(self, file: str) -> str:
        """Give what a file is called that has no name of the export in it yet."""
        return file if self.is_alone else f"{self.name}_{file}"

    def is_core_source(self, path: str) -> bool:
        """Tell whether a file of the export is a source of the core."""
        return path.startswith(f"{self.core_folder}{self.core.prefix}_") and path.endswith(".c")

    def own(self, code: str, folder: str = "") -> str:
        """Give C of the export itself as it stands in its file.

        Parameters
        ----------
        code
            With the core's own names.
        folder
            Where the file lies, as seen from the header of the export: "" or "extras/".
        """
        code = self.core.own(code)
        mark = f'#include "{self.core.prefix}_'
        code = code.replace(mark, mark.replace('"', f'"{self.core_folder}'))
        return code.replace(f'"{self.name}.h"', f'"../{self.name}.h"') if folder else code

    def places(self, has_core: bool) -> dict[str, str]:
        """Give what the templates say of places and commands.

        Parameters
        ----------
        has_core
            Whether there are sources of the core.
        """
        short = f"{self.short_test_folder}{self.name}_step_response.c"
        library = f"{self.name}.c {short}"
        if has_core and self.form != "single-file":
            library += f" {self.core_folder}{self.core.prefix}_*.c"
        test = f"{self.test_folder}{self.name}_selftest.c"
        compiler, program = "cc -std=c99 -O2 -ffp-contract=off", f"{self.name}_test"
        example = f"{self.test_folder}example.c"  # has a main, too
        found = "-I. " if self.test_folder else ""
        return {
            "example": example,
            "build_example": f"{found}{example} {library}",
            "test_command": f"{compiler} {test} {library} -o {program} && ./{program}",
            "with_cmake": self._with_cmake(),
            "own_files": self._own_files(),
            "for_tools": self._for_tools(),
            "manifest": self.manifest,
            "core_prefix": f"{self.core.prefix}_",
            "selftest": test,
            "short_test": short,
        }

    def _with_cmake(self) -> str:
        if self.is_alone:
            return "or `cmake -S . -B build && cmake --build build && ctest --test-dir build`"
        test = f"{self.name}_selftest"
        return f"or `include({self.name}.cmake)` in a project of CMake, which then has `{test}`"

    def _for_tools(self) -> str:
        if self.form == "folder":
            return ""
        said = _FOR_ARDUINO.replace("@", self.name)
        return said + (_ONE_BY_ONE if self.form == "flat" else "")

    def _own_files(self) -> str:
        if self.form == "flat":
            return "The `.c` and `.h` files of this folder are all it takes"
        own = f"`{self.name}.c` and `{self.name}.h`"
        if self.form == "folder":
            own = f"`{self.name}.c`, `{self.name}.h` and `core/`"
        return f"{own} are all it takes"
