"""hyst export: a model as code for other tools."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import hyst
from hyst.cli.arguments import DespiteVerdict, ModelFile
from hyst.cli.console import show_table
from hyst.cli.relevant_options import refuse_irrelevant
from hyst.cli.scheduled import ScheduleValue, loaded_at

if TYPE_CHECKING:
    from hyst.export.c.block import Model


Flat = Annotated[
    bool,
    typer.Option(
        "--flat", help="C in one folder without paths of includes, as an Arduino library."
    ),
]

Preview = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        show_default=False,
        help="With --inverse: it knows the next N samples of the reference, and its command is as "
        "many samples late; rate-dependent models and delays have no other inverse.",
    ),
]

_OF_THE_CORE = ("core/", "hyst_")


@dataclass(frozen=True)
class _Order:
    """What is asked for: which model, where to, and how."""

    model: Model
    out: Path
    precision: str
    name: str
    force: bool
    fmi: str
    binary: bool
    despite_verdict: bool
    flat: bool


@dataclass(frozen=True)
class _Done:
    """What has been written: rows for the table, and what to do next."""

    rows: tuple[tuple[str, str], ...]
    next_step: str


def _c(order: _Order) -> _Done:
    project = hyst.export.c_project(
        order.model,
        order.out,
        precision=order.precision,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
        flat=order.flat,
    )
    own = [each for each in project.files if "/" not in each and not each.startswith("hyst_")]
    zipped = order.out.suffix.lower() == ".zip"
    folder = order.name if zipped else str(order.out)
    unpack = f"unzip {_quoted(order.out)} && " if zipped else ""
    rows = (
        ("files", ", ".join(own)),
        ("files of the core", str(sum(each.startswith(_OF_THE_CORE) for each in project.files))),
        ("precision", project.precision),
        ("state", f"{project.state_bytes} bytes, {project.state_length} numbers of memory"),
        ("saved state", f"{project.saved_bytes} bytes"),
    )
    return _Done(
        rows,
        f"{unpack}cd {_quoted(folder)} && cmake -S . -B build && cmake --build build && "
        f"ctest --test-dir build; {folder}/README.md says the rest",
    )


def _fmu(order: _Order) -> _Done:
    path = order.out
    if path.suffix.lower() != ".fmu":
        if not path.is_dir():
            raise hyst.InputError(f"{path} is no folder; name one, or a file that ends in .fmu")
        path = path / f"{order.name}.fmu"
    written = hyst.export.fmu(
        order.model,
        path,
        version=order.fmi,
        name=order.name,
        force=order.force,
        binary=order.binary,
        despite_verdict=order.despite_verdict,
    )
    binaries = [each for each in written.files if each.startswith("binaries/")]
    rows = (
        ("FMI", f"{written.version}, co-simulation"),
        ("variables", f"{', '.join(written.inputs)} -> {written.output}; fault"),
        ("parameters", _shortened(written.parameters)),
        ("communication step", "any" if written.dt is None else f"multiples of {written.dt!r} s"),
        ("binary", ", ".join(binaries) or "none; the importer compiles the sources"),
    )
    return _Done(rows, f"import {path} into a simulation tool; docs/fmu.md says what it expects")


def _mex(order: _Order) -> _Done:
    written = hyst.export.mex(
        order.model,
        order.out,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
    )
    rows = (
        ("files", ", ".join(written.files)),
        ("state", f"{written.saved_bytes} bytes, {written.state_length} numbers of memory"),
    )
    zipped = order.out.suffix.lower() == ".zip"
    unpack = f"unzip {_quoted(order.out)} && " if zipped else ""
    return _Done(
        rows,
        f"{unpack}cd {_quoted(order.name if zipped else order.out)} && "
        f"mkoctfile --mex {order.name}_mex.c, or in MATLAB mex {order.name}_mex.c; "
        f"then {written.output} = {order.name}({', '.join(written.inputs)})",
    )


def _quoted(path: str | Path) -> str:
    """Give a path as a shell takes it."""
    return shlex.quote(str(path))


def _shortened(names: tuple[str, ...], most: int = 6) -> str:
    if len(names) <= most:
        return ", ".join(names) or "none"
    return f"{', '.join(names[: most - 1])} ... ({len(names)})"


# One function a target, by the name the command line gives it.
_TARGETS: dict[str, Callable[[_Order], _Done]] = {"c": _c, "fmu": _fmu, "mex": _mex}
_BY_TARGET = {"precision": ["c"], "fmi": ["fmu"], "binary": ["fmu"], "flat": ["c"]}


def export(
    context: typer.Context,
    model_file: ModelFile,
    out: Annotated[
        Path,
        typer.Option(
            "-o",
            "--out",
            metavar="PATH",
            show_default=False,
            help="What to write: a folder, a zip if it ends in .zip, or an FMU if in .fmu.",
        ),
    ],
    target: Annotated[
        str,
        typer.Option(
            help="c, for firmware; fmu, for simulation tools; mex, for MATLAB and Octave."
        ),
    ] = "c",
    inverse: Annotated[bool, typer.Option("--inverse", help="Export the inverse.")] = False,
    explicit: Annotated[
        bool,
        typer.Option(
            "--explicit", help="Export the explicit inverse of a rate-dependent model; not exact."
        ),
    ] = False,
    preview: Preview = None,
    precision: Annotated[str, typer.Option(help="Of C: double or single.")] = "double",
    name: Annotated[
        str, typer.Option(metavar="NAME", help="Prefix of files, functions and types.")
    ] = "stage",
    force: Annotated[
        bool, typer.Option("--force", help="Replace an earlier export, as a whole.")
    ] = False,
    fmi: Annotated[str, typer.Option(metavar="VERSION", help="Of an FMU: 2.0 or 3.0.")] = "2.0",
    binary: Annotated[
        bool,
        typer.Option(
            "--binary/--no-binary", help="Whether to compile an FMU's binary for this platform."
        ),
    ] = True,
    despite_verdict: DespiteVerdict = False,
    flat: Flat = False,
    schedule_value: ScheduleValue = None,
) -> None:
    """Write a model as code for other tools: the numbers of Python, bit for bit in double."""
    if target not in _TARGETS:
        raise hyst.InputError(f"--target is {target!r}; give {' or '.join(_TARGETS)}")
    refuse_irrelevant(context, _BY_TARGET, [target], "--target")
    if preview is not None and not inverse:
        raise hyst.InputError("--preview is of an inverse; add --inverse, or leave it out")
    model = loaded_at(model_file, schedule_value)
    if inverse or explicit:
        model = hyst.export.inverse_of(model, explicit, preview)
    order = _Order(model, out, precision, name, force, fmi, binary, despite_verdict, flat)
    done = _TARGETS[target](order)
    what = "inverse of " if inverse or explicit else ""
    title = f"{what}{model_file.name} as {target}: {out}"
    show_table(hyst.report.Table(title, ("", ""), done.rows))
    _tell_lateness(model.description, preview)
    print(f"\nnext: {done.next_step}")


def _tell_lateness(about: hyst.ModelDescription, preview: int | None) -> None:
    if about.delay:
        print("\n" + hyst.report.delay_sentence(about.delay, about.dt, about.delay_interval))
    if preview:
        print(f"\nthe output at sample k is the command for sample k - {preview} of the reference")
