"""Export as an FMU: a zip with description, sources and a binary, for simulation tools."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import final

from numpy.typing import ArrayLike

import hyst
from hyst.control.drive_limits import Limits
from hyst.errors import InputError
from hyst.export.c.block import Block, Model, described, refuse_unfit
from hyst.export.c.drive_options import AUTO, DriveOptions
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.names import as_c_name
from hyst.export.fmi.binary import binary_path, compiled
from hyst.export.fmi.description import (
    FmiVersion,
    FmuDescription,
    Signal,
    build_description,
    model_description,
)
from hyst.export.fmi.sources import FmuModel, fmu_model, fmu_sources
from hyst.export.folder import FORMAT, MANIFEST, write_export
from hyst.operators import ModelDescription

_VERSIONS: tuple[FmiVersion, ...] = ("2.0", "3.0")
_LICENSE = Path(__file__).resolve().parents[1] / "templates" / "LICENSE"


@final
@dataclass(frozen=True)
class Fmu:
    """An FMU that has been written.

    Parameters
    ----------
    path
        The file.
    files
        What it holds, sorted.
    name
        Its model identifier.
    version
        Of FMI.
    token
        Its guid or instantiation token.
    inputs, output
        Names of the signals' variables.
    parameters
        Names of the variables that may be set.
    dt
        Sample time, seconds: communication steps must be whole multiples of it. None if any will
        do.
    drive
        Limits of the drive, and where they come from.
    history
        The drives it starts after.
    """

    path: Path
    files: tuple[str, ...]
    name: str
    version: FmiVersion
    token: str
    inputs: tuple[str, ...]
    output: str
    parameters: tuple[str, ...]
    dt: float | None
    drive: DriveRange
    history: tuple[float, ...]


def fmu(
    model: Model,
    path: str | os.PathLike[str],
    *,
    version: str = "2.0",
    name: str = "stage",
    force: bool = False,
    description: ModelDescription | None = None,
    binary: bool = True,
    compiler: str | None = None,
    despite_verdict: bool = False,
    limits: Limits | str | None = AUTO,
    rate_limit: float | None = None,
    history: ArrayLike | None = None,
) -> Fmu:
    """Write a model as an FMU for co-simulation, with its sources and a binary for this platform.

    Parameters
    ----------
    model
        Any operator, a tracking controller or a joint estimator.
    path
        The file to create; it ends in ``.fmu``.
    version
        Of FMI, "2.0" or "3.0".
    name
        The model identifier, a C identifier.
    force
        Whether an earlier export of that path is replaced.
    description
        Names and units of input and output; that of the model itself if left out.
    binary
        Whether to compile a binary; without one, an importer compiles the sources.
    compiler
        Command of a C compiler; by default that of the variable CC, or else cc, gcc or clang.
    despite_verdict
        Export also a model whose verdict is ``unfit``.
    limits, rate_limit, history
        Of the drive, as ``c_project`` takes them. With a history what its memory depends on is no
        parameter.

    Returns
    -------
    Fmu

    Raises
    ------
    InputError
        If the model, the name, the version or the compiler cannot be used, the path exists, or the
        verdict on the model is ``unfit``, or limits or history cannot be used.
    NotInvertibleError
        As ``c_project``.
    HystError
        If there is no compiler, or it fails.

    Examples
    --------
    >>> import tempfile
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5], r=[0.1], p0=1.0)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = fmu(model.inverse(), f"{folder}/inverse.fmu", binary=False)
    >>> written.inputs, written.output, written.parameters
    (('u',), 'y', ('p0', 'p[1]', 'r[1]'))
    """
    as_c_name(name)
    refuse_unfit(model, description, despite_verdict)
    fmi = _as_version(version)
    if Path(path).suffix.lower() != ".fmu":
        raise InputError(f"{path} is not the name of an FMU; give one that ends in .fmu")
    options = DriveOptions(limits, rate_limit, history)
    exported = fmu_model(model, options, description)
    files, said = _contents(exported, name, described(model, description), fmi)
    if binary:
        library = compiled(_below_sources(files), compiler)
        files[binary_path(name, fmi)] = library
    files[f"resources/{MANIFEST}"] = _manifest(exported.tool.block, name, fmi, files)
    target = write_export(path, files, "", force=force)
    return Fmu(
        path=target,
        files=tuple(sorted(files)),
        name=name,
        version=fmi,
        token=said.token,
        inputs=tuple(each.name for each in said.inputs),
        output=said.output.name,
        parameters=tuple(each.name for each in said.parameters),
        dt=said.dt,
        drive=exported.tool.block.drive,
        history=exported.tool.block.history,
    )


def _as_version(version: str) -> FmiVersion:
    for each in _VERSIONS:
        if version == each:
            return each
    raise InputError(f"version is {version!r}; give 2.0 or 3.0, of FMI")


def _contents(
    model: FmuModel, name: str, about: ModelDescription, version: FmiVersion
) -> tuple[dict[str, bytes], FmuDescription]:
    """Give everything but binary and manifest: sources first, for the token is their hash."""
    said = _describe(model, name, about, "")
    draft = fmu_sources(model, name, about, version, "")
    token = _token({**draft, "modelDescription.xml": model_description(said, version)})
    said = _describe(model, name, about, token)
    sources = fmu_sources(model, name, about, version, token)
    files = {f"sources/{path}": content for path, content in sources.items()}
    files["modelDescription.xml"] = model_description(said, version)
    files["documentation/licenses/license.txt"] = _LICENSE.read_bytes()
    if version == "3.0":
        files["sources/buildDescription.xml"] = build_description(name)
    return files, said


def _describe(model: FmuModel, name: str, about: ModelDescription, token: str) -> FmuDescription:
    tool = model.tool
    units = {
        "u": (about.input_name.strip() or "u", about.input_unit),
        "y": (about.output_name.strip() or "y", about.output_unit),
    }
    units |= {"y_ref": (f"wanted {units['y'][0]}", units["y"][1])}
    units |= {"command": (f"wanted {units['u'][0]}", units["u"][1])}
    return FmuDescription(
        identifier=name,
        kind=tool.block.kind,
        token=token,
        inputs=tuple(Signal(each, *units[each]) for each in tool.inputs),
        output=Signal(tool.output, *units[tool.output]),
        direct=model.direct,
        parameters=model.parameters,
        estimates=tool.estimates,
        dt=tool.block.dt,
    )


def _token(files: dict[str, bytes]) -> str:
    """Give a GUID that is a hash of the content: the same model gives the same FMU."""
    total = hashlib.sha256()
    for path in sorted(files):
        total.update(f"{path} {len(files[path])}\n".encode())
        total.update(files[path])
    digest = total.hexdigest()[:32]
    parts = (digest[:8], digest[8:12], digest[12:16], digest[16:20], digest[20:])
    return "{" + "-".join(parts) + "}"


def _below_sources(files: dict[str, bytes]) -> dict[str, bytes]:
    return {
        path.removeprefix("sources/"): content
        for path, content in files.items()
        if path.startswith("sources/")
    }


def _manifest(block: Block, name: str, version: str, files: dict[str, bytes]) -> bytes:
    content = {
        "format": FORMAT,
        "version": 1,
        "hyst": hyst.__version__,
        "target": "fmu",
        "fmi": version,
        "name": name,
        "model": {"kind": block.kind, "sha256": block.sha256()},
        "drive": block.drive.told(),
        "history": list(block.history),
        "files": {path: hashlib.sha256(files[path]).hexdigest() for path in sorted(files)},
    }
    return (json.dumps(content, indent=2) + "\n").encode()
