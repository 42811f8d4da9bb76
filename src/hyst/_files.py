"""Write files whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from hyst.errors import InputError


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside ``path``; rename it onto ``path`` on success only.

    Parameters
    ----------
    path
        The file to create or replace. Its folder must exist.

    Yields
    ------
    pathlib.Path
        Where to write. It has the suffix of ``path`` and does not exist yet.

    Raises
    ------
    InputError
        If the folder does not exist, or ``path`` is a folder or a device.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> target = pathlib.Path(tempfile.mkdtemp()) / "notes.txt"
    >>> with replacing(target) as temporary:
    ...     _ = temporary.write_text("whole")
    >>> target.read_text()
    'whole'
    """
    target = Path(path)
    if not target.parent.is_dir():
        raise InputError(f"{target}: the folder {target.parent} does not exist; create it first")
    if target.is_dir():
        raise InputError(f"{target} is a folder; name a file")
    _refuse_special(target)
    with tempfile.TemporaryDirectory(prefix=".hyst-", dir=target.parent) as folder:
        temporary = Path(folder) / target.name
        yield temporary
        temporary.replace(target)


@contextlib.contextmanager
def replacing_files(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary folder; on success only, move the files in it into ``folder``.

    Parameters
    ----------
    folder
        Made if it does not exist; its own parent must. Files in it of other names stay.

    Yields
    ------
    pathlib.Path
        An empty folder to write files into.

    Raises
    ------
    InputError
        If the parent does not exist, ``folder`` is a file, or a file would replace a folder or a
        device.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> target = pathlib.Path(tempfile.mkdtemp()) / "out"
    >>> with replacing_files(target) as temporary:
    ...     _ = (temporary / "notes.txt").write_text("whole")
    >>> [path.name for path in target.iterdir()]
    ['notes.txt']
    """
    target = Path(folder)
    require_folder(target)
    with tempfile.TemporaryDirectory(prefix=".hyst-", dir=target.parent) as temporary:
        yield Path(temporary)
        files = sorted(Path(temporary).iterdir())
        for file in files:
            if (target / file.name).is_dir():
                raise InputError(f"{target / file.name} is a folder; move it or write elsewhere")
            _refuse_special(target / file.name)
        target.mkdir(exist_ok=True)
        for file in files:
            file.replace(target / file.name)


def require_folder(folder: str | os.PathLike[str]) -> None:
    """Refuse a path that is not and cannot become a folder to write into.

    Parameters
    ----------
    folder
        A folder, or a name for one in a folder that exists.

    Raises
    ------
    InputError
        If it is a file, or its parent does not exist.

    Examples
    --------
    >>> require_folder(".")
    """
    target = Path(folder)
    if target.exists() and not target.is_dir():
        raise InputError(f"{target} is a file; name a folder")
    if not target.absolute().parent.is_dir():
        raise InputError(f"{target}: the folder {target.parent} does not exist; create it first")


def _refuse_special(target: Path) -> None:
    """Refuse a device or a pipe: renaming onto it would remove it from the system."""
    if target.exists() and not target.is_file():
        raise InputError(f"{target} is a device or a pipe, not a regular file; name a file")
