"""Compile the binary of an FMU for the platform Python runs on."""

from __future__ import annotations

import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from hyst.errors import HystError, InputError

_COMPILERS = ("cc", "gcc", "clang")
_FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-fvisibility=hidden", "-shared", "-I.")
_TIME_LIMIT = 300.0

_SYSTEMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib"), "win32": ("windows", ".dll")}
_MACHINES = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}


def find_compiler(compiler: str | None = None) -> list[str]:
    """Give the command of a C compiler.

    Parameters
    ----------
    compiler
        Its command; None for that of the variable CC, or else cc, gcc or clang.

    Returns
    -------
    list of str
        Program and options.

    Raises
    ------
    InputError
        If the one named is not there.
    HystError
        If none is named and none is there.
    """
    named = compiler or os.environ.get("CC")
    if named:
        command = _words(named)
        if command and shutil.which(command[0]):
            return command
        raise InputError(
            f"there is no C compiler {named!r}; name another (variable CC), or leave the binary out"
        )
    for each in _COMPILERS:
        if shutil.which(each):
            return [each]
    raise HystError(
        "no C compiler was found (cc, gcc, clang); install one, name one in the variable CC, or "
        "leave the binary out: its user can then compile the sources in the FMU"
    )


def _words(command: str) -> list[str]:
    try:
        return shlex.split(command)
    except ValueError:
        return []  # a quotation mark without its partner


def binary_path(identifier: str, version: str) -> str:
    """Give where the binary of this platform lies in an FMU.

    Parameters
    ----------
    identifier
        The name of the binary.
    version
        Of FMI, "2.0" or "3.0".

    Returns
    -------
    str

    Raises
    ------
    HystError
        If FMI has no name for the platform.
    """
    system, ending = _SYSTEMS.get(sys.platform, ("", ""))
    machine = _MACHINES.get(platform.machine().lower(), "")
    if not system or not machine:
        raise HystError(
            f"hyst does not compile FMUs for {sys.platform} on {platform.machine()}; leave the "
            "binary out"
        )
    # FMI 2.0 has no word for the processor, only for its bits.
    folder = f"{_SHORT[system]}64" if version == "2.0" else f"{machine}-{system}"
    return f"binaries/{folder}/{identifier}{ending}"


_SHORT = {"linux": "linux", "darwin": "darwin", "windows": "win"}


def compiled(sources: Mapping[str, bytes], compiler: str | None) -> bytes:
    """Compile the sources of an FMU into a shared library.

    Parameters
    ----------
    sources
        Content by path below ``sources/``; ``hyst_all.c`` includes the others.
    compiler
        As in ``find_compiler``.

    Returns
    -------
    bytes
        The library.

    Raises
    ------
    InputError
        If the compiler named is not there.
    HystError
        If there is no compiler, or it fails.
    """
    command = [*find_compiler(compiler), *_FLAGS]
    if sys.platform == "linux":
        command.append("-s")  # the path it was compiled in would differ from time to time
    with tempfile.TemporaryDirectory(prefix="hyst-") as folder:
        for path, content in sources.items():
            file = Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        _run([*command, "hyst_all.c", "-o", "library"], folder)
        return (Path(folder) / "library").read_bytes()


def _run(command: list[str], folder: str) -> None:
    try:
        result = subprocess.run(
            command, cwd=folder, capture_output=True, timeout=_TIME_LIMIT, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise HystError(f"{command[0]} could not compile the FMU: {error}") from None
    if result.returncode != 0:
        lines = result.stderr.decode(errors="replace").strip().splitlines() or ["nothing"]
        said = next((line for line in lines if "error" in line), lines[0])
        raise HystError(
            f"{command[0]} could not compile the FMU and said: {said}; name another compiler "
            "(variable CC), or leave the binary out"
        )
