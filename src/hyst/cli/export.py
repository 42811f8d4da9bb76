"""hyst export: a model as code for other tools."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import hyst
from hyst.cli.arguments import ModelFile
from hyst.cli.console import show_table

if TYPE_CHECKING:
    from hyst.operators import ModelDescription, Operator


@dataclass(frozen=True)
class _Order:
    """What is asked for: model and meaning, where to, and how."""

    model: Operator
    about: ModelDescription
    out: Path
    precision: str
    name: str
    force: bool


@dataclass(frozen=True)
class _Done:
    """What has been written: rows for the table, and what to do next."""

    rows: tuple[tuple[str, str], ...]
    next_step: str


def _c(order: _Order) -> _Done:
    project = hyst.export.c_project(
        order.model,
        order.out,
        order.precision,
        order.name,
        order.force,
        description=order.about,
    )
    zipped = order.out.suffix.lower() == ".zip"
    folder = order.name if zipped else str(order.out)
    unpack = f"unzip {order.out} && " if zipped else ""
    rows = (
        ("files", ", ".join(each for each in project.files if "/" not in each)),
        ("files of the core", str(sum(each.startswith("core/") for each in project.files))),
        ("precision", project.precision),
        ("state", f"{project.state_bytes} bytes, {project.state_length} numbers of memory"),
        ("saved state", f"{project.saved_bytes} bytes"),
    )
    return _Done(
        rows,
        f"{unpack}cd {folder} && cmake -S . -B build && cmake --build build && "
        f"ctest --test-dir build; {folder}/README.md says the rest",
    )


# One function a target, by the name the command line gives it.
_TARGETS: dict[str, Callable[[_Order], _Done]] = {"c": _c}


def export(
    model_file: ModelFile,
    out: Annotated[
        Path,
        typer.Option(
            "-o",
            "--out",
            metavar="PATH",
            show_default=False,
            help="What to write: a folder, or a zip if it ends in .zip.",
        ),
    ],
    target: Annotated[str, typer.Option(help="c, for firmware.")] = "c",
    inverse: Annotated[bool, typer.Option("--inverse", help="Export the inverse.")] = False,
    explicit: Annotated[
        bool,
        typer.Option(
            "--explicit", help="Export the explicit inverse of a rate-dependent model; not exact."
        ),
    ] = False,
    precision: Annotated[str, typer.Option(help="double or single.")] = "double",
    name: Annotated[
        str, typer.Option(metavar="NAME", help="Prefix of files, functions and types.")
    ] = "stage",
    force: Annotated[
        bool, typer.Option("--force", help="Replace an earlier export, as a whole.")
    ] = False,
) -> None:
    """Write a model as code for other tools: the numbers of Python, bit for bit in double."""
    if target not in _TARGETS:
        raise hyst.InputError(f"--target is {target!r}; give {' or '.join(_TARGETS)}")
    model, about = hyst.models.load_described(model_file)
    if inverse or explicit:
        model = hyst.export.explicit_inverse(model) if explicit else model.inverse()
        about = hyst.export.reversed_description(about)
    done = _TARGETS[target](_Order(model, about, out, precision, name, force))
    what = "inverse of " if inverse or explicit else ""
    title = f"{what}{model_file.name} as {target}: {out}"
    show_table(hyst.report.Table(title, ("", ""), done.rows))
    print(f"\nnext: {done.next_step}")
