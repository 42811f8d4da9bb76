"""hyst export: a model as code for other tools."""

from __future__ import annotations

import typer

import hyst
from hyst.cli.arguments import DespiteVerdict, ModelFile, history_of, numbers
from hyst.cli.console import show_table
from hyst.cli.driver_option import DriverOfDrive, driver_or_word
from hyst.cli.export.options import (
    Binary,
    Explicit,
    FmiVersion,
    Force,
    ForTool,
    History,
    HistoryAt,
    Inverse,
    Layout,
    Limits,
    Name,
    Out,
    Precision,
    Preview,
    RateLimit,
    SharedCore,
)
from hyst.cli.export.order import Order
from hyst.cli.export.targets import TARGETS, takers
from hyst.cli.relevant_options import refuse_irrelevant
from hyst.cli.scheduled import ScheduleValue, loaded_at


def export(
    context: typer.Context,
    model_file: ModelFile,
    out: Out,
    target: ForTool = "c",
    inverse: Inverse = False,
    explicit: Explicit = False,
    preview: Preview = None,
    precision: Precision = "double",
    name: Name = "stage",
    force: Force = False,
    fmi: FmiVersion = "2.0",
    binary: Binary = True,
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
