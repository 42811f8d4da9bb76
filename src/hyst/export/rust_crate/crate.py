"""Export as a Rust crate: the translated C, a type around it, and its self-test."""

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
from hyst.export.c.any_block import any_block
from hyst.export.c.block import Model, described, refuse_unfit
from hyst.export.c.c_sources import header, places
from hyst.export.c.drive import SAMPLES
from hyst.export.c.drive_options import AUTO, DriveOptions
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.exported import Block
from hyst.export.c.names import as_c_name, plain_text
from hyst.export.c.numbers import Precision, as_precision
from hyst.export.c.readme_rows import error_rows, lag_row, provenance_row, signals, verdict_row
from hyst.export.c.selftest import SelfTest
from hyst.export.c.templating import filled
from hyst.export.folder import FORMAT, MANIFEST, write_export
from hyst.export.rust_crate.interface import constants, interface_places, methods
from hyst.export.rust_crate.kernel import kernel
from hyst.export.rust_crate.layout import laid_out
from hyst.export.rust_crate.names import refuse_for_rust
from hyst.export.rust_crate.selftest import selftest_source, vectors
from hyst.export.translate.exported import program_of
from hyst.operators import ModelDescription


@final
@dataclass(frozen=True)
class RustCrate:
    """A crate that has been written.

    Parameters
    ----------
    path
        The folder, or the zip.
    files
        What it holds, sorted.
    name
        Of the crate; the type is called after it.
    precision
        Of its numbers.
    state_length
        Numbers of memory.
    saved_bytes
        Of a state.
    away_from_double
        Largest difference over the self-test from the output in double; 0 in double.
    drive
        What the drive may be.
    history
        The drives it starts after.
    has_start
        Whether ``init_after`` starts it after others.
    """

    path: Path
    files: tuple[str, ...]
    name: str
    precision: str
    state_length: int
    saved_bytes: int
    away_from_double: float
    drive: DriveRange
    history: tuple[float, ...]
    has_start: bool


def rust(
    model: Model,
    folder: str | os.PathLike[str],
    *,
    precision: str = "double",
    name: str = "stage",
    force: bool = False,
    description: ModelDescription | None = None,
    despite_verdict: bool = False,
    limits: Limits | str | None = AUTO,
    rate_limit: float | None = None,
    history: ArrayLike | None = None,
    history_at: float | None = None,
) -> RustCrate:
    """Write a model as a Rust crate without the standard library that gives the bits of Python.

    Parameters
    ----------
    model
        What ``c_project`` takes.
    folder
        What to create: a folder, or a zip if it ends in ``.zip``.
    precision
        "double" or "single".
    name
        Of the crate, in lower case.
    force
        Whether an earlier export of that path is replaced, as a whole.
    description
        Names and units of input and output; that of the model itself if left out.
    despite_verdict
        Export also a model whose verdict is ``unfit``.
    limits, rate_limit, history, history_at
        Of the drive, as ``c_project`` takes them.

    Returns
    -------
    RustCrate

    Raises
    ------
    InputError
        If the model, the name or the precision cannot be used, the path exists, the verdict on the
        model is ``unfit``, the limits are upside down or not for this model, or the history is
        beyond them.
    NotInvertibleError
        If the output of the model in front of an inverse turns back within the limits.
    MissingExtraError
        If pycparser is not installed.

    Examples
    --------
    >>> import tempfile
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5, 0.2], r=[0.1, 0.3], p0=1.0)
    >>> with tempfile.TemporaryDirectory() as parent:
    ...     crate = rust(model.inverse(), f"{parent}/lens", name="lens")
    >>> [file for file in crate.files if file.startswith("src/")]
    ['src/kernel.rs', 'src/lib.rs', 'src/slices.rs']
    """
    as_c_name(name)
    refuse_for_rust(name)
    refuse_unfit(model, description, despite_verdict)
    exact = as_precision(precision)
    block = any_block(
        model, exact, DriveOptions(limits, rate_limit, history, history_at=history_at), description
    )
    about = described(model, description)
    test = SelfTest.of(block, exact, about)
    files = crate_files(block, test, name, exact, about)
    return RustCrate(
        path=write_export(folder, files, name, force=force),
        files=tuple(sorted(files)),
        name=name,
        precision=exact,
        state_length=len(block.start),
        saved_bytes=int(places(block, name, exact, about)["saved_bytes"]),
        away_from_double=test.away_from_double,
        drive=block.drive,
        history=block.history,
        has_start=block.following is not None,
    )


def crate_files(
    block: Block, test: SelfTest, name: str, precision: Precision, about: ModelDescription
) -> dict[str, bytes]:
    """Give the files of a crate.

    Parameters
    ----------
    block
        What is exported.
    test
        Its self-test.
    name
        Of the crate, checked.
    precision
        Of the target.
    about
        What the numbers mean.

    Returns
    -------
    dict
        Content by path.
    """
    program = program_of(block, name, precision, about)
    common = places(block, name, precision, about) | interface_places(block, name, precision)
    common["title"] = f"{plain_text(block.kind)}, {precision} precision"
    common["constants"] = constants(header(block, common), name, precision)
    common["signals"] = _signals(common["signals"])
    has_history = f"{name}_init_after" in program.functions
    common["history_error"] = filled("rust/history_error.rs", {}) if has_history else ""
    common["methods"] = methods(block, program, name, common)
    head = f"//! {common['title']}: the C of hyst {common['version']}, translated.\n{_ALLOWED}\n"
    texts = {
        "Cargo.toml": filled("rust/Cargo.toml", common),
        "LICENSE": filled("LICENSE", {}),
        "README.md": _readme(block, common, about, test),
        "src/kernel.rs": laid_out(kernel(program, head)),
        "src/lib.rs": filled("rust/lib.rs", common),
        "src/slices.rs": filled("rust/slices.rs", common),
        "tests/selftest/main.rs": selftest_source(block, common),
        "tests/selftest/vectors.rs": vectors(block, test, precision),
    }
    files = {path: text.encode("ascii") for path, text in texts.items()}
    return files | {MANIFEST: _manifest(block, name, precision, files, test)}


# What a compiler finds odd in C that was translated, and what a step has no use for.
_ALLOWED = """#![allow(
    dead_code,
    non_snake_case,
    unused_assignments,
    unused_parens,
    unused_variables,
    clippy::all
)]
"""


def _signals(in_c: str) -> str:
    lines = [line.removeprefix(" *").strip() for line in in_c.splitlines() if line.strip(" *")]
    return "//!\n" + "".join(f"//! * {line}\n" for line in lines) if lines else ""


def _readme(block: Block, common: dict[str, str], about: ModelDescription, test: SelfTest) -> str:
    own = common["name"]
    rows = {
        "model": f"{plain_text(block.kind)}, SHA-256 {block.sha256()[:16]}...",
        "precision": common["precision"],
        "memory": f"{len(block.start)} numbers; saved in {common['saved_bytes']} bytes",
        "sample time": "any" if block.dt is None else f"{block.dt!r} s, and no other",
    }
    rows["limits"] = block.drive.said()
    if block.history:
        rows["start"] = f"after {len(block.history)} drives"
        if block.history_at is not None:
            rows["start"] += f" at {plain_text(block.second_meaning[0])} {block.history_at:.6g}"
    for role, (meaning, unit) in signals(block, about).items():
        said = f" in {plain_text(unit)}" if unit else ""
        rows[f"`{role}`"] = plain_text(meaning) + said
    if common["precision"] == "single":
        rows["away from double"] = f"at most {test.away_from_double:.3g} over the self-test"
    rows |= error_rows(about) | verdict_row(about, all_levels=True) | lag_row(about)
    rows |= provenance_row(about)
    given = ", ".join("0.0" for _ in block.inputs)
    output = common["output"]
    answer = "answer" if output == own else output
    step = f"let {answer} = {own}.step({given}); // every sample: {common['inputs']}"
    if block.is_estimator:
        step = f"{own}.update(0.0, 0.0); // learns from u and y\nlet {answer} = {own}.command(0.0);"
    single = common["precision"] == "single"
    more = {
        "rows": "\n".join(f"| {key} | {value} |" for key, value in rows.items()),
        "example": f"{step}\nif {own}.fault() & {own}::NOT_FINITE != 0 {{ /* a bad sample */ }}",
        "faults": _FAULTS,
        "in_precision": " in single precision" if single else "",
        "samples": str(SAMPLES),
    }
    return filled("rust/README.md", common | more)


_FAULTS = """\
A sample that is NaN or infinite, or that overflows inside, is answered with the last output, and
`fault()` has the bit `NOT_FINITE` until `clear_fault()`; the other bits are constants of the crate.
"""


def _manifest(
    block: Block, name: str, precision: str, files: dict[str, bytes], test: SelfTest
) -> bytes:
    content: dict[str, Any] = {
        "format": FORMAT,
        "version": 1,
        "hyst": __version__,
        "target": "rust",
        "name": name,
        "precision": precision,
        "model": {"kind": block.kind, "sha256": block.sha256()},
        "selftest": {"samples": SAMPLES, "away_from_double": test.away_from_double},
        "files": {path: hashlib.sha256(files[path]).hexdigest() for path in sorted(files)},
    }
    return (json.dumps(content, indent=2) + "\n").encode()
