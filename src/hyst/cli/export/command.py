"""hyst export: a model as code for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import hyst
from hyst.cli.arguments import DespiteVerdict, ModelFile, history_of, numbers
from hyst.cli.console import show_table
from hyst.cli.driver_option import DriverOfDrive, driver_or_word
from hyst.cli.export.order import Order
from hyst.cli.export.targets import TARGETS, takers
from hyst.cli.relevant_options import refuse_irrelevant
from hyst.cli.scheduled import ScheduleValue, loaded_at

Layout = Annotated[
    str,
    typer.Option(
        help="Of C: folder; flat, all that is compiled in one folder, as for Arduino; or "
        "single-file, one header and one source."
    ),
]

SharedCore = Annotated[
    bool,
    typer.Option(
        "--shared-core",
        help="Of C: exports of one folder share one copy of the core in each precision.",
    ),
]

Limits = Annotated[
    str,
    typer.Option(
        metavar="auto|none|LOW,HIGH",
        help="Of the drive, which is the output of an inverse and the input of a model: auto for "
        "its range in the record; where more is asked for, it is held, and the memory follows.",
    ),
]

RateLimit = Annotated[
    float | None,
    typer.Option(
        "--rate-limit",
        metavar="R",
        show_default=False,
        help="The most the drive moves in a second.",
    ),
]

History = Annotated[
    str | None,
    typer.Option(
        metavar="A,B,..|FILE:COLUMN",
        show_default=False,
        help="Start after this: where the drive of the actuator turned, in time order; samples "
        "where time counts.",
    ),
]

HistoryAt = Annotated[
    float | None,
    typer.Option(
        metavar="X",
        show_default=False,
        help="The second signal of a scheduled model during --history, as a temperature.",
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
            help="; ".join(f"{name}, {each.purpose}" for name, each in TARGETS.items()) + "."
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
    precision: Annotated[str, typer.Option(help="Of C or Rust: double or single.")] = "double",
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
    layout: Layout = "folder",
    shared_core: SharedCore = False,
    limits: Limits = "auto",
    rate_limit: RateLimit = None,
    history: History = None,
    history_at: HistoryAt = None,
    driver: DriverOfDrive = "auto",
    schedule_value: ScheduleValue = None,
) -> None:
    """Write a model as code for other tools: the numbers of Python, bit for bit in double."""
    if target not in TARGETS:
        raise hyst.InputError(f"--target is {target!r}; give {' or '.join(TARGETS)}")
    refuse_irrelevant(context, takers(), [target], "--target")
    if preview is not None and not inverse:
        raise hyst.InputError("--preview is of an inverse; add --inverse, or leave it out")
    model = loaded_at(model_file, schedule_value)
    if inverse or explicit:
        model = hyst.export.inverse_of(model, explicit, preview)
    order = Order(
        model,
        out,
        precision,
        name,
        force,
        fmi,
        binary,
        despite_verdict,
        layout,
        shared_core,
        _ends(limits),
        rate_limit,
        None if history is None else history_of(history),
        driver_or_word(driver, model.description),
        history_at,
    )
    done = TARGETS[target].write(order)
    what = "inverse of " if inverse or explicit else ""
    title = f"{what}{model_file.name} as {target}: {out}"
    show_table(hyst.report.Table(title, ("", ""), done.rows))
    _tell_lateness(model.description, preview)
    print(f"\nnext: {done.next_step}")


def _ends(text: str) -> tuple[float, float] | str:
    if text in ("auto", "none"):
        return text
    ends = numbers(text, "limits")
    if len(ends) != 2:
        raise hyst.InputError(
            f"--limits is {text!r}; give auto, none, or the lowest and the highest drive, as 0,150"
        )
    return ends[0], ends[1]


def _tell_lateness(about: hyst.ModelDescription, preview: int | None) -> None:
    if about.delay:
        print("\n" + hyst.report.delay_sentence(about.delay, about.dt, about.delay_interval))
    if preview:
        print(f"\nthe output at sample k is the command for sample k - {preview} of the reference")
