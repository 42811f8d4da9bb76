"""Add an export to a folder that holds others, or files of the user's, and touch none of them."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any, final

from hyst.errors import InputError
from hyst.export.folder import MANIFEST, Files, export_manifest, write_export


def add_to_folder(path: str | os.PathLike[str], files: Files, name: str, *, force: bool) -> Path:
    """Write files into a folder, beside what it holds; a new folder or a zip as any export.

    Parameters
    ----------
    path
        The folder or zip; the folder it is in is made.
    files
        Content by path inside the folder, with the export's manifest ``NAME_manifest.json``.
    name
        Of the export.
    force
        Whether an earlier export of that name is replaced, as a whole.

    Returns
    -------
    pathlib.Path
        The path.

    Raises
    ------
    InputError
        If there is an earlier export of that name and ``force`` is not given, a file would
        overwrite one that is not this export's, or the folder cannot be written to.
    """
    target = Path(path)
    if target.suffix.lower() in (".zip", ".fmu") or not os.path.isdir(target):
        return write_export(target, files, name, force=force)
    there = _Exports.of(target, name)
    there.refuse_clashes(files, force)
    new = {path: text for path, text in files.items() if not _holds(target / path, text)}
    try:
        _exchange(target, new, there.left_over(files))
    except OSError as error:
        raise InputError(
            f"{target} cannot be written: {error.strerror or error}; choose a folder that can"
        ) from error
    return target


@final
@dataclass(frozen=True)
class _Exports:
    """The exports of a folder: files of the one of this name, and of others by their names."""

    target: Path
    name: str
    own: frozenset[str] | None
    others: Mapping[str, frozenset[str]]

    @classmethod
    def of(cls, target: Path, name: str) -> _Exports:
        if export_manifest(target / MANIFEST) is not None:
            raise InputError(
                f"{target} is the folder of one export, which is replaced as a whole; name another "
                "folder"
            )
        found = {}
        for file in sorted(target.glob(f"*_{MANIFEST}")):
            content = export_manifest(file)
            if content is not None and file.name == f"{content.get('name')}_{MANIFEST}":
                found[str(content["name"])] = _listed(content) | {file.name}
        return cls(target, name, found.pop(name, None), found)

    def refuse_clashes(self, files: Files, force: bool) -> None:
        """Refuse to write what would overwrite another's file."""
        if self.own is not None and not force:
            raise InputError(
                f"{self.target} has an export named {self.name}; give another name, or replace it "
                "as a whole with --force"
            )
        for other in self.others:
            if other.lower() == self.name.lower():
                raise InputError(
                    f"{self.target} has an export named {other}, and macros and some file systems "
                    f"know no difference to {self.name}; give another name"
                )
        for path, content in files.items():
            file = self.target / path
            if os.path.lexists(file.parent) and not file.parent.is_dir():
                raise InputError(f"{file.parent} is a file where a folder is needed; move it")
            if os.path.lexists(file) and not _holds(file, content):
                self._refuse_unless_own(path)

    def _refuse_unless_own(self, path: str) -> None:
        for other, listed in self.others.items():
            if path in listed:
                raise InputError(
                    f"{self.target / path} is also of the export {other}, written by another "
                    "version of hyst; write this export into a new folder, and that one too"
                )
        if path not in (self.own or ()):
            raise InputError(
                f"{self.target / path} exists and is of no export of hyst; give another name or "
                "folder, or move the file"
            )

    def left_over(self, files: Files) -> list[str]:
        """Give files of the earlier export that are in no export any more."""
        of_others = frozenset[str]().union(*self.others.values())
        return sorted((self.own or frozenset()) - set(files) - of_others)


def _listed(manifest: Mapping[str, Any]) -> frozenset[str]:
    """Files that a manifest lists; what leads out of the folder is none of them."""
    listed = manifest.get("files")
    paths = listed if isinstance(listed, dict) else {}
    return frozenset(
        path
        for path in paths
        if not PurePosixPath(path).is_absolute() and ".." not in PurePosixPath(path).parts
    )


def _holds(file: Path, content: bytes) -> bool:
    return file.is_file() and file.read_bytes() == content


def _exchange(target: Path, files: Files, left_over: list[str]) -> None:
    """Put new files in place and take old ones away, all of it or nothing."""
    with tempfile.TemporaryDirectory(prefix=".hyst-", dir=target) as temporary:
        new, old = Path(temporary) / "new", Path(temporary) / "old"
        for path, content in files.items():
            (new / path).parent.mkdir(parents=True, exist_ok=True)
            (new / path).write_bytes(content)
        done: list[str] = []
        try:
            for path in (*left_over, *files):
                _move(target / path, old / path)
                done.append(path)
                _move(new / path, target / path)
        except BaseException:
            for path in reversed(done):
                (target / path).unlink(missing_ok=True)
                _move(old / path, target / path)
            raise


def _move(before: Path, after: Path) -> None:
    """Move a file, if there is one."""
    if os.path.lexists(before):
        after.parent.mkdir(parents=True, exist_ok=True)
        before.rename(after)
