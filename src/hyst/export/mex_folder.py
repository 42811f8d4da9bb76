"""Export as a MEX function: one C file and thin wrappers, for MATLAB and GNU Octave."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import final

from numpy.typing import ArrayLike

import hyst
from hyst.control.drive_limits import Limits
from hyst.errors import InputError
from hyst.export.c.block import Block, Model, described, refuse_unfit
from hyst.export.c.c_sources import bad_samples, header, places, source
from hyst.export.c.core_copy import CoreCopy
from hyst.export.c.core_sources import core_files
from hyst.export.c.drive_options import AUTO, DriveOptions
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.names import as_c_name, plain_text
from hyst.export.c.one_file import in_one_file
from hyst.export.c.readme_rows import lag_row, verdict_row
from hyst.export.c.templating import filled
from hyst.export.folder import FORMAT, MANIFEST, write_export
from hyst.export.mex_start import start_texts
from hyst.export.tool_block import ToolBlock, tool_block
from hyst.operators import ModelDescription

_LICENSE = Path(__file__).resolve().parent / "templates" / "LICENSE"

# Words of MATLAB and Octave that C does not have, and names a file must not hide from them.
_WORDS = """
    ans catch classdef elseif end endfor endfunction endif endswitch endwhile eps function global i
    inf j mex mexext nan otherwise parfor persistent pi spmd until unwind_protect
    abs any cell clear close cos disp eig error eval exist exp feval figure filter find handle hold
    inv inverse isempty isnan length linspace load log max mean min nargin nargout norm numel ones
    path plot rand round save sin size sort sqrt strcmp sum uint8 zeros
"""
_TAKEN = frozenset(_WORDS.split())


@final
@dataclass(frozen=True)
class MexFolder:
    """A MEX function that has been written.

    Parameters
    ----------
    path
        The folder, or the zip.
    files
        What it holds, sorted.
    name
        Of the function in MATLAB and Octave.
    inputs, output
        Names of the signals it takes and gives.
    state_length
        Numbers of memory.
    saved_bytes
        Of a state.
    drive
        Limits of the drive, and where they come from.
    history
        The drives it starts after.
    has_start
        Whether ``init_after`` of the object starts it after others.
    """

    path: Path
    files: tuple[str, ...]
    name: str
    inputs: tuple[str, ...]
    output: str
    state_length: int
    saved_bytes: int
    drive: DriveRange
    history: tuple[float, ...]
    has_start: bool


def mex(
    model: Model,
    folder: str | os.PathLike[str],
    *,
    name: str = "stage",
    force: bool = False,
    description: ModelDescription | None = None,
    despite_verdict: bool = False,
    limits: Limits | str | None = AUTO,
    rate_limit: float | None = None,
    history: ArrayLike | None = None,
    history_at: float | None = None,
) -> MexFolder:
    """Write a model as one C file that MATLAB and Octave compile, with wrappers in their language.

    Parameters
    ----------
    model
        Any operator, a tracking controller or a joint estimator.
    folder
        What to create: a folder, or a zip if it ends in ``.zip``.
    name
        Of the function, a C identifier.
    force
        Whether an earlier export of that path is replaced, as a whole.
    description
        Names and units of input and output, for comments; that of the model itself if left out.
    despite_verdict
        Export also a model whose verdict is ``unfit``.
    limits, rate_limit, history, history_at
        Of the drive, as ``c_project`` takes them.

    Returns
    -------
    MexFolder

    Raises
    ------
    InputError
        If the model or the name cannot be used, the path exists, or the verdict on the model is
        ``unfit``, or limits or history cannot be used.
    NotInvertibleError
        As ``c_project``.

    Examples
    --------
    >>> import tempfile
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5, 0.2], r=[0.1, 0.3], p0=1.0)
    >>> with tempfile.TemporaryDirectory() as parent:
    ...     written = mex(model.inverse(), f"{parent}/lens", name="lens")
    >>> written.files
    ('README.md', 'lens.m', 'lens_mex.c', 'lens_stepper.m', 'manifest.json')
    """
    _as_function_name(name)
    refuse_unfit(model, description, despite_verdict)
    tool = tool_block(
        model, DriveOptions(limits, rate_limit, history, history_at=history_at), description
    )
    about = described(model, description)
    files = mex_files(tool, name, about)
    path = write_export(folder, files, name, force=force)
    return MexFolder(
        path=path,
        files=tuple(sorted(files)),
        name=name,
        inputs=tool.inputs,
        output=tool.output,
        state_length=len(tool.block.start),
        saved_bytes=int(places(tool.block, name, "double", about)["saved_bytes"]),
        drive=tool.block.drive,
        history=tool.block.history,
        has_start=tool.block.following is not None,
    )


def mex_files(tool: ToolBlock, name: str, about: ModelDescription) -> dict[str, bytes]:
    """Give the files of a MEX function.

    Parameters
    ----------
    tool
        What is exported.
    name
        Of the function, checked.
    about
        What the numbers mean.

    Returns
    -------
    dict
        Content by path.
    """
    block = tool.block
    common = places(block, name, "double", about)
    elements = tuple(f"input[{i}][k]" for i in range(len(tool.inputs)))
    common |= {
        "title": plain_text(block.kind),
        "signals": ", ".join(tool.inputs),
        "output": tool.output,
        "inputs": str(len(tool.inputs)),
        "with_state": str(len(tool.inputs) + 1),
        "quoted": ", ".join(f'"{each}"' for each in tool.inputs),
        "step": CoreCopy(f"{name}_core", "double").own(tool.step(name, "state", elements)),
        "bad_sample": "changes no parameter"
        if tool.estimates
        else "is answered with the last output, leaves the memory as it is",
        **(_estimates(tool, name) if tool.estimates else _limited(block, name)),
        **start_texts(block, name),
        "bad": bad_samples(block, name, "state"),
        "bad_here": bad_samples(block, name, "&state"),
        "license": _commented(_LICENSE.read_text(encoding="utf-8"), " *"),
        "meaning": _meaning(common["signals"]),
        "rows": _rows(block, common["signals"], about),
    }
    texts = {
        f"{name}_mex.c": _c_file(block, common, about),
        f"{name}.m": filled("mex/stage.m", common),
        f"{name}_stepper.m": filled("mex/stepper.m", common),
        "README.md": filled("mex/README.md", common),
    }
    files = {path: text.encode("ascii") for path, text in texts.items()}
    return files | {MANIFEST: _manifest(block, name, files)}


def _limited(block: Block, name: str) -> dict[str, str]:
    """Give what tells whether a drive was held at its limits, where there are any."""
    if "OUT_OF_RANGE" not in block.tells:
        return {"estimate_in_c": "", "estimate_in_m": ""}
    return {
        "estimate_in_c": f"""    }} else if (strcmp(command, "limited") == 0) {{
        plhs[0] = mxCreateLogicalScalar(
            (mxLogical)(({name}_fault(&state) & {name.upper()}_OUT_OF_RANGE) != 0u));
""",
        "estimate_in_m": f"""        function raised = limited(self)
            % True since the drive was held at its limits or its rate.
            raised = {name}_mex('limited', self.state);
        end
""",
    }


def _estimates(tool: ToolBlock, name: str) -> dict[str, str]:
    """Give what the gateway and the object need to tell the estimated parameters."""
    said = ", ".join(tool.estimates)
    comment = "\n            % ".join(wrap(f"A row: {said}.", 80))
    return {
        "estimate_in_c": f"""    }} else if (strcmp(command, "theta") == 0) {{
        plhs[0] = mxCreateDoubleMatrix(1, {len(tool.estimates)}, mxREAL);
        memcpy(HYST_MEX_DOUBLES(plhs[0]), state.memory + {name.upper()}_THETA,
               {len(tool.estimates)} * sizeof(double));
""",
        "estimate_in_m": f"""        function theta = estimate(self)
            % {comment}
            theta = {name}_mex('theta', self.state);
        end
""",
    }


def _as_function_name(name: str) -> str:
    as_c_name(name)
    if name.lower() in _TAKEN:
        raise InputError(
            f"the name is {name!r}, which MATLAB or Octave has itself; give another, as stage"
        )
    return name


def _c_file(block: Block, common: dict[str, str], about: ModelDescription) -> str:
    name = common["name"]
    plain = places(block, name, "double", about)
    stage, declared = source(block, plain, "double"), header(block, plain)
    copy = CoreCopy(f"{name}_core", "double")
    own = {f"{name}.h": copy.own(declared), f"{name}.c": copy.own(stage)}
    everything = in_one_file(copy.files(core_files(stage + declared)), own)
    return filled("mex/head.c", common) + everything + "\n" + filled("mex/gateway.c", common)


def _commented(text: str, mark: str) -> str:
    return "".join(f"{mark} {line}".rstrip() + "\n" for line in text.strip().splitlines())


def _signal_lines(signals: str) -> list[str]:
    return [line.removeprefix(" *").strip() for line in signals.splitlines() if line.strip(" *")]


def _meaning(signals: str) -> str:
    lines = _signal_lines(signals)
    return "".join(f"\n%     {line}" for line in lines) + ("\n%" if lines else "")


def _rows(block: Block, signals: str, about: ModelDescription) -> str:
    rows = {
        "model": plain_text(block.kind),
        "state": f"{len(block.start)} numbers of memory",
        "sample time": "any" if block.dt is None else f"{block.dt!r} s, and no other",
    }
    rows |= dict(line.split(": ", 1) for line in _signal_lines(signals))
    rows |= verdict_row(about) | lag_row(about)
    return "\n".join(f"| {key} | {value} |" for key, value in rows.items())


def _manifest(block: Block, name: str, files: dict[str, bytes]) -> bytes:
    content = {
        "format": FORMAT,
        "version": 1,
        "hyst": hyst.__version__,
        "target": "mex",
        "name": name,
        "model": {"kind": block.kind, "sha256": block.sha256()},
        "drive": block.drive.told(),
        "history": list(block.history),
        **({} if block.history_at is None else {"history_at": block.history_at}),
        "files": {path: hashlib.sha256(files[path]).hexdigest() for path in sorted(files)},
    }
    return (json.dumps(content, indent=2) + "\n").encode()
