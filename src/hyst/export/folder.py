"""Write an export: a folder or a zip that appears whole or not at all."""

from __future__ import annotations

import io
import json
import os
import shutil
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hyst._files import replacing, require_folder
from hyst.errors import InputError

MANIFEST = "manifest.json"
FORMAT = "hyst export"

Files = Mapping[str, bytes]


def write_export(path: str | os.PathLike[str], files: Files, top: str, *, force: bool) -> Path:
    """Write files into a new folder, or into a zip if the path ends in ``.zip`` or ``.fmu``.

    Parameters
    ----------
    path
        What to create; the folder it is in must exist.
    files
        Content by path inside the export, "/" between folders.
    top
        The folder inside a zip; "" for none.
    force
        Whether an earlier export at ``path`` is replaced, as a whole; files in its folder that no
        export wrote stay.

    Returns
    -------
    pathlib.Path
        The path.

    Raises
    ------
    InputError
        If it exists and ``force`` is not given, or it is not an earlier export, or the folder it is
        in cannot be made or written to.
    """
    target = Path(path)
    if top and target.suffix.lower() == ".fmu":
        raise InputError(f"{target} is the name of an FMU; name a folder or a zip, or write an FMU")
    _refuse_existing(target, force)
    require_folder(target.parent)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.suffix.lower() in (".zip", ".fmu"):
            with replacing(target) as temporary:
                temporary.write_bytes(zipped(files, top))
        else:
            _write_folder(target, files)
    except OSError as error:
        # Its own words name a temporary file that nobody asked for.
        raise InputError(
            f"{target} cannot be written: {error.strerror or error}; choose a folder that can"
        ) from error
    return target


def zipped(files: Files, top: str) -> bytes:
    """Give a zip of the files whose bytes depend on nothing else.

    Parameters
    ----------
    files
        Content by path.
    top
        The folder they are in; "" for none.

    Returns
    -------
    bytes
        Not compressed, for compressors differ.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path in sorted(files):
            entry = zipfile.ZipInfo(f"{top}/{path}" if top else path, (1980, 1, 1, 0, 0, 0))
            entry.create_system = 3  # Unix, wherever this runs
            entry.external_attr = 0o100644 << 16
            archive.writestr(entry, files[path])
    return buffer.getvalue()


def _refuse_existing(target: Path, force: bool) -> None:
    if not os.path.lexists(target):
        return
    if not force:
        raise InputError(f"{target} exists; name another, or replace it as a whole with --force")
    if target.is_symlink() or not _is_ours(target):
        raise InputError(
            f"{target} is not an earlier export of hyst, so --force does not replace it; name "
            "another, or remove it yourself"
        )


def _is_ours(target: Path) -> bool:
    """Tell whether it is an earlier export or an empty folder."""
    if target.is_dir():
        return not any(target.iterdir()) or export_manifest(target / MANIFEST) is not None
    if not zipfile.is_zipfile(target):
        return False
    with zipfile.ZipFile(target) as archive:
        names = [name for name in archive.namelist() if name.endswith(MANIFEST)]
        return any(_as_manifest(archive.read(name)) is not None for name in names)


def export_manifest(file: Path) -> dict[str, Any] | None:
    """Give what the manifest of an export says; None for any other file, or none.

    Parameters
    ----------
    file
        Its path.
    """
    return _as_manifest(file.read_bytes()) if file.is_file() else None


def _as_manifest(text: bytes) -> dict[str, Any] | None:
    try:
        content = json.loads(text)
    except ValueError:
        return None
    ours = isinstance(content, dict) and content.get("format") == FORMAT
    return content if ours else None


def _keep_files_of_others(target: Path, new: Path) -> None:
    """Copy what no export wrote, as a program beside it, to the folder that replaces ``target``."""
    manifest = export_manifest(target / MANIFEST) or {}
    written = {MANIFEST, *manifest.get("files", ())}
    for folder, _, names in os.walk(target):
        for name in names:
            file = Path(folder) / name
            place = file.relative_to(target)
            if place.as_posix() in written:
                continue
            if os.path.lexists(new / place):
                raise InputError(
                    f"{file} is no file of the earlier export, and the new one has a file of that "
                    "name; move it away, or name another folder"
                )
            (new / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(file, new / place, follow_symlinks=False)


def _write_folder(target: Path, files: Files) -> None:
    parent = target.absolute().parent
    with tempfile.TemporaryDirectory(prefix=".hyst-", dir=parent) as temporary:
        new, old = Path(temporary) / "new", Path(temporary) / "old"
        for path, content in files.items():
            file = new / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        if target.exists():
            _keep_files_of_others(target, new)
            target.rename(old)
        try:
            new.rename(target)
        except BaseException:
            if old.exists():
                old.rename(target)
            raise
