"""Write files whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from pathlib import Path

from hyst.errors import InputError

_KEPT: ContextVar[tuple[Path, ...]] = ContextVar("files that are read", default=())


@contextlib.contextmanager
def keeping(files: Sequence[Path]) -> Iterator[None]:
    """Let none of some files be replaced meanwhile.

    Parameters
    ----------
    files
        That exist.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "record.csv"
    >>> _ = path.write_text("1")
    >>> with keeping([path]), replacing(path) as temporary:
    ...     _ = temporary.write_text("2")
    Traceback (most recent call last):
    hyst.errors.InputError: ... is one of the files to read; write elsewhere
    """
    token = _KEPT.set((*_KEPT.get(), *files))
    try:
        yield
    finally:
        _KEPT.reset(token)


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside ``path``; rename it onto ``path`` on success only.

    Parameters
    ----------
    path
        The file to create or replace. Folders on the way to it are made.

    Yields
    ------
    pathlib.Path
        Where to write. It has the suffix of ``path`` and does not exist yet.

    Raises
    ------
    InputError
        If there is a file on the way to it, or ``path`` is a folder or a device.

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
    require_folder(target.parent)
    if target.is_dir():
        raise InputError(f"{target} is a folder; name a file")
    _refuse_special(target)
    _refuse_kept(target)
    _make_folder(target.parent)
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
        Made if it does not exist, with the folders on the way to it. Files in it of other names
        stay.

    Yields
    ------
    pathlib.Path
        An empty folder to write files into.

    Raises
    ------
    InputError
        If there is a file on the way, ``folder`` is a file, or a file would replace a folder or a
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
    _make_folder(target.parent)
    with tempfile.TemporaryDirectory(prefix=".hyst-", dir=target.parent) as temporary:
        yield Path(temporary)
        files = sorted(Path(temporary).iterdir())
        for file in files:
            if (target / file.name).is_dir():
                raise InputError(f"{target / file.name} is a folder; move it or write elsewhere")
            _refuse_special(target / file.name)
            _refuse_kept(target / file.name)
        target.mkdir(exist_ok=True)
        for file in files:
            file.replace(target / file.name)


def require_folder(folder: str | os.PathLike[str]) -> None:
    """Refuse a path that is not and cannot become a folder to write into.

    Parameters
    ----------
    folder
        A folder, or a name for one.

    Raises
    ------
    InputError
        If it is a file, or there is one on the way to it.

    Examples
    --------
    >>> require_folder(".")
    """
    target = Path(folder)
    if target.exists() and not target.is_dir():
        raise InputError(f"{target} is a file; name a folder")
    for folder_above in target.absolute().parents:
        if folder_above.is_dir():
            return
        if folder_above.exists():
            raise InputError(f"{target}: {folder_above} is a file; name a folder below a folder")


def read_small(path: Path, most: int = 200_000_000) -> bytes:
    """Read a regular file of moderate size, such as a model or a spec.

    Parameters
    ----------
    path
        The file.
    most
        Largest size, bytes.

    Returns
    -------
    bytes
        Its content.

    Raises
    ------
    InputError
        If it is a device or a pipe, which may never end, or larger than that.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "spec.toml"
    >>> _ = path.write_text("a = 1")
    >>> read_small(path)
    b'a = 1'
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise InputError(f"{path} is a device or a pipe, not a regular file; name a file")
    size = path.stat().st_size
    if size > most:
        raise InputError(f"{path} has {size} bytes, more than a file of its kind; check the path")
    return path.read_bytes()


def _make_folder(folder: Path) -> None:
    """Make a folder and those on the way to it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise InputError(f"the folder {folder} cannot be made: {reason}; name another") from error


def _refuse_special(target: Path) -> None:
    """Refuse a device or a pipe: renaming onto it would remove it from the system."""
    if target.exists() and not target.is_file():
        raise InputError(f"{target} is a device or a pipe, not a regular file; name a file")


def _refuse_kept(target: Path) -> None:
    """Refuse a file that is being read, by whatever name."""
    if target.exists() and any(each.exists() and each.samefile(target) for each in _KEPT.get()):
        raise InputError(f"{target} is one of the files to read; write elsewhere")
