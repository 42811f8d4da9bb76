"""The folder that the studio was started in: what it may read and where it may write."""

from __future__ import annotations

import filecmp
import os
import tempfile
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path

from hyst.errors import InputError

MOST_BYTES = 1 << 30
"""Of a file: a record of more is no job for a page; the command line reads it from its file."""

MOST_LISTED, DEEPEST = 300, 3
MARK = "commands.sh"
"""File that makes a folder a session of the studio."""

SUFFIXES = (
    *(".csv", ".tsv", ".txt", ".dat", ".asc", ".lvm", ".log", ".mat", ".h5", ".hdf5"),
    *(".parquet", ".npz", ".npy", ".tdms", ".xlsx", ".isf", ".wfm", ".gz"),
)
_LONGEST_NAME = 120


@dataclass(frozen=True)
class WorkFolder:
    """A folder beyond which nothing is read and nothing is written.

    Parameters
    ----------
    root
        The folder, resolved.
    """

    root: Path

    @staticmethod
    def at(path: str | os.PathLike[str]) -> WorkFolder:
        """Give the folder at a path.

        Raises
        ------
        InputError
            If there is none.
        """
        root = Path(path)
        if not root.is_dir():
            raise InputError(f"{root} is no folder; name the folder with your records")
        return WorkFolder(root.resolve())

    def files(self) -> tuple[str, ...]:
        """Name the data files in the folder and a few folders down, as paths from it."""
        found: list[str] = []
        for here, folders, names in os.walk(self.root):
            depth = len(Path(here).relative_to(self.root).parts)
            inner = [each for each in folders if _is_open(here, each)]
            folders[:] = sorted(inner) if depth < DEEPEST else []
            for name in sorted(names):
                path = Path(here) / name
                if path.suffix.lower() in SUFFIXES and not path.is_symlink():
                    found.append(path.relative_to(self.root).as_posix())
            if len(found) >= MOST_LISTED:
                break
        return tuple(found[:MOST_LISTED])

    def inside(self, name: str) -> Path:
        """Give the path of a file or folder that is to lie in the folder.

        Parameters
        ----------
        name
            From the folder.

        Raises
        ------
        InputError
            If it leads out of it, by ``..``, an absolute path or a link.
        """
        if "\0" in name:
            raise InputError(f"{name!r} is no name of a file; give another one")
        path = (self.root / name).resolve()
        if path == self.root or not path.is_relative_to(self.root):
            raise InputError(
                f"{name} does not lie in {self.root}; the studio reads and writes nothing else"
            )
        return path

    def readable(self, name: str) -> Path:
        """Give the path of a file to read.

        Raises
        ------
        InputError
            If it leads out of the folder, is no file, or is too large.
        """
        path = self.inside(name)
        if not path.is_file():
            raise InputError(f"{name} is no file in {self.root}; choose one of the list")
        require_size(path.stat().st_size, name)
        return path

    async def keep(self, name: str, content: AsyncIterator[bytes]) -> str:
        """Write what was dropped into the folder, beside a file of that name with another content.

        Parameters
        ----------
        name
            Of the file.
        content
            Its bytes, piece by piece.

        Returns
        -------
        str
            The name under which it lies there.

        Raises
        ------
        InputError
            If the name is none, or there is too much of it.
        """
        plain = plain_name(name)
        handle, temporary = tempfile.mkstemp(prefix=".hyst-", dir=self.root)
        try:
            with os.fdopen(handle, "wb") as file:
                async for piece in content:
                    file.write(piece)
                    require_size(file.tell(), plain)
            target = self._free(plain, Path(temporary))
            os.chmod(temporary, 0o644)
            os.replace(temporary, target)
            return target.name
        finally:
            Path(temporary).unlink(missing_ok=True)

    def _free(self, name: str, content: Path) -> Path:
        stem, suffix = Path(name).stem, Path(name).suffix
        for number in range(1, 1000):
            path = self.root / (name if number == 1 else f"{stem}-{number}{suffix}")
            if not (path.exists() or path.is_symlink()):
                return path
            if path.is_file() and not path.is_symlink() and filecmp.cmp(path, content, False):
                return path
        raise InputError(f"there are a thousand files called {name}; give this one another name")


def _is_open(here: str, folder: str) -> bool:
    """Tell whether records are looked for in a folder: not in hidden ones, nor in sessions."""
    return not folder.startswith((".", "_")) and not (Path(here) / folder / MARK).is_file()


def plain_name(name: str) -> str:
    """Give a name without folders.

    Parameters
    ----------
    name
        As the browser says.

    Raises
    ------
    InputError
        If nothing is left, it is hidden, or it is too long.
    """
    plain = name.replace("\\", "/").rpartition("/")[2].strip()
    if not plain or plain.startswith(".") or "\0" in plain or len(plain) > _LONGEST_NAME:
        raise InputError(f"{name[:40]!r} is no name for a file here; give the file another one")
    return plain


def require_size(size: int, name: str) -> None:
    """Refuse a file that is too large, before it is read.

    Parameters
    ----------
    size, name
        Bytes, and the file's name.

    Raises
    ------
    InputError
        If it is.
    """
    if size > MOST_BYTES:
        raise InputError(
            f"{name} has {size / 1e9:.2f} GB, and the studio takes files of at most "
            f"{MOST_BYTES / 1e9:.2f} GB; identify from it on the command line, hyst identify "
            "--in-file yes, or cut out a part"
        )
