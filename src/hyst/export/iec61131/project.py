"""Export as structured text: one file for a PLC, and what one has to know of it."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from numpy.typing import ArrayLike

from hyst import __version__
from hyst.control.drive_limits import Limits
from hyst.errors import InputError
from hyst.export.c.any_block import any_block
from hyst.export.c.block import Block, Model, described, refuse_unfit
from hyst.export.c.drive_options import AUTO, DriveOptions
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.names import as_c_name, plain_text
from hyst.export.c.numbers import Precision, as_precision
from hyst.export.c.readme_rows import error_rows, lag_row, provenance_row, signals, verdict_row
from hyst.export.c.templating import filled
from hyst.export.folder import FORMAT, MANIFEST, write_export
from hyst.export.iec61131.function_block import HISTORY, BlockNames
from hyst.export.iec61131.text import structured_text_of
from hyst.export.iec61131.words import as_block_name
from hyst.export.translate.exported import program_of
from hyst.operators import ModelDescription


@final
@dataclass(frozen=True)
class StructuredText:
    """A function block that has been written.

    Parameters
    ----------
    path
        The folder, or the zip.
    files
        What it holds, sorted.
    name
        Of the function block.
    precision
        Of its numbers.
    inputs, output
        Names of the signals it takes and gives.
    state_length
        Numbers of memory.
    drive
        Limits of the drive.
    history
        Drives it starts after.
    has_start
        Whether it can be started after others.
    """

    path: Path
    files: tuple[str, ...]
    name: str
    precision: str
    inputs: tuple[str, ...]
    output: str
    state_length: int
    drive: DriveRange
    history: tuple[float, ...]
    has_start: bool


def structured_text(
    model: Model,
    folder: str | os.PathLike[str],
    precision: str = "double",
    *,
    name: str = "stage",
    force: bool = False,
    description: ModelDescription | None = None,
    despite_verdict: bool = False,
    limits: Limits | str | None = AUTO,
    rate_limit: float | None = None,
    history: ArrayLike | None = None,
    history_at: float | None = None,
) -> StructuredText:
    """Write a model as a function block of IEC 61131-3 structured text, for PLCs.

    Parameters
    ----------
    model
        What ``c_project`` takes, but no estimator.
    folder
        What to create: a folder, or a zip if it ends in ``.zip``.
    precision
        "double", in LREAL, for the bits of Python; or "single", in REAL.
    name
        Of the function block, a C identifier that structured text does not keep.
    force
        Whether an earlier export of that path is replaced, as a whole.
    description
        Names, units and ranges of input and output; that of the model itself if left out.
    despite_verdict
        Export also a model whose verdict is ``unfit``.
    limits, rate_limit, history, history_at
        As ``c_project`` takes them.

    Returns
    -------
    StructuredText

    Raises
    ------
    InputError
        If the model, the name, the precision, the limits or the history cannot be used, the path
        exists, or the verdict on the model is ``unfit``.
    NotInvertibleError
        If the model turns back within the limits.
    MissingExtraError
        If pycparser is not installed.

    Examples
    --------
    >>> import tempfile
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5, 0.2], r=[0.1, 0.3], p0=1.0)
    >>> with tempfile.TemporaryDirectory() as parent:
    ...     written = structured_text(model.inverse(), f"{parent}/lens", name="lens")
    >>> written.files
    ('README.md', 'lens.st', 'manifest.json')
    """
    as_block_name(as_c_name(name))
    refuse_unfit(model, description, despite_verdict)
    exact = as_precision(precision)
    block = any_block(
        model, exact, DriveOptions(limits, rate_limit, history, history_at=history_at), description
    )
    if block.is_estimator:
        raise InputError(
            "an estimator is not written as structured text; export the model it has found, or "
            "the estimator as C"
        )
    about = described(model, description)
    files, names = text_files(block, name, exact, about)
    return StructuredText(
        path=write_export(folder, files, name, force=force),
        files=tuple(sorted(files)),
        name=name,
        precision=exact,
        inputs=names.inputs,
        output=names.output,
        state_length=len(block.start),
        drive=block.drive,
        history=block.history,
        has_start=block.following is not None,
    )


def text_files(
    block: Block, name: str, precision: Precision, about: ModelDescription
) -> tuple[dict[str, bytes], BlockNames]:
    """Give the files of a function block.

    Parameters
    ----------
    block
        What is exported.
    name
        Of the block, checked.
    precision
        Of the target.
    about
        What the numbers mean.

    Returns
    -------
    tuple
        Content by path, and the names of the signals.
    """
    program = program_of(block, name, precision, about)
    meant = {
        role: plain_text(meaning) + (f" in {plain_text(unit)}" if unit else "")
        for role, (meaning, unit) in signals(block, about).items()
    }
    written = structured_text_of(block, program, name, meant)
    texts = {
        f"{name}.st": written.text,
        "README.md": _readme(block, name, precision, about, written.names, meant),
    }
    files = {path: text.encode("ascii") for path, text in texts.items()}
    return files | {MANIFEST: _manifest(block, name, precision, files)}, written.names


def _readme(
    block: Block,
    name: str,
    precision: str,
    about: ModelDescription,
    names: BlockNames,
    meant: dict[str, str],
) -> str:
    rows = {
        "model": f"{plain_text(block.kind)}, SHA-256 {block.sha256()[:16]}...",
        "numbers": "LREAL, the bits of Python" if precision == "double" else "REAL",
        "memory": f"{len(block.start)} numbers",
        "sample time": "any" if block.dt is None else f"{block.dt!r} s, and no other",
        "limits of the drive": block.drive.said(),
    }
    for own, role in zip(names.inputs, block.inputs, strict=True):
        rows[f"`{own}`"] = meant.get(role, "what the model takes")
    rows[f"`{names.output}`"] = meant.get(block.output, "what the model gives")
    rows |= error_rows(about) | verdict_row(about, all_levels=True) | lag_row(about)
    rows |= provenance_row(about)
    given = ", ".join(f"{each} := {each}" for each in names.inputs)
    values = {
        "name": name,
        "version": plain_text(__version__),
        "rows": "\n".join(f"| {key} | {value} |" for key, value in rows.items()),
        "call": f"{name}_1({given});\n{names.output} := {name}_1.{names.output};",
        "variables": "\n".join(
            f"    {each} : {'LREAL' if precision == 'double' else 'REAL'};"
            for each in (*names.inputs, names.output)
        ),
        "fault": names.fault,
        "restart": names.restart,
        "clear_fault": names.clear_fault,
        "bits": _bits(block, name),
        "start": _start(block, names),
    }
    return filled("structured_text.md", values)


def _bits(block: Block, name: str) -> str:
    """Give what the further bits of the fault mean, as the C header has them."""
    found = []
    for line in block.faults.replace("@{NAME}", name.upper()).splitlines():
        if line.startswith("#define"):
            _, bit, value, *meaning = line.split(maxsplit=3)
            said = " ".join(meaning).strip("/* ")
            found.append(f"- {value.rstrip('u')}: {bit.removeprefix(f'{name.upper()}_')}, {said}")
    return "\n".join(found)


def _start(block: Block, names: BlockNames) -> str:
    if block.following is None:
        reason = f": {block.no_start}" if block.no_start else ""
        return f"It has one start, that of the export{reason}."
    return (
        f"Where it is known what drove the actuator before, set `{names.history}` to the drives at "
        f"which it turned, in time order, at most {HISTORY} of them, `{names.history_count}` to "
        f"how many, and call it once with `{names.restart} := TRUE`. `{names.history_refused}` "
        "tells that one of them was not finite or out of the limits; it has then started as "
        "nothing had ever driven it. Where nothing is known, drive the actuator from one end of "
        "its range to the other first: those two are then its history."
        + (
            f" `{names.inputs[1]}` of that call is taken for its value all the while; if it is "
            f"not finite, `{names.history_refused}` is raised, too."
            if block.second
            else ""
        )
    )


def _manifest(block: Block, name: str, precision: str, files: dict[str, bytes]) -> bytes:
    content: dict[str, Any] = {
        "format": FORMAT,
        "version": 1,
        "hyst": __version__,
        "target": "st",
        "name": name,
        "precision": precision,
        "model": {"kind": block.kind, "sha256": block.sha256()},
        "drive": block.drive.told(),
        "history": list(block.history),
        **({} if block.history_at is None else {"history_at": block.history_at}),
        "files": {path: hashlib.sha256(files[path]).hexdigest() for path in sorted(files)},
    }
    return (json.dumps(content, indent=2) + "\n").encode()
