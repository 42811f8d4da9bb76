"""hyst watch: follow an actuator while it runs, and raise alarms."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

import hyst
from hyst.checks.numbers import as_positive
from hyst.cli.arguments import ModelFile, load_operator, refuse_inputs_as_outputs
from hyst.cli.console import note
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.reading_options import InputColumn, OutputColumn, Rate, TimeColumn, TimeUnit
from hyst.cli.watch.log import LogFiles, log_files
from hyst.cli.watch.loop import Loop, Waiting, ended_by_signals
from hyst.cli.watch.session import Plan, Session
from hyst.cli.watch.sources import source_of
from hyst.io.growing import GrowingRows
from hyst.online.choice import estimator_for
from hyst.online.estimator import Estimator
from hyst.online.watch.limits import Limits

Data = Annotated[
    str,
    typer.Argument(
        metavar="FILE|-",
        show_default=False,
        help="Text file that grows, or - for lines on standard input.",
    ),
]
Only = Annotated[
    str,
    typer.Option(
        metavar="NAMES",
        show_default=False,
        help="What to estimate, with commas between: scale,offset. Else all the model has, if "
        "that can be estimated.",
    ),
]
Every = Annotated[float, typer.Option(metavar="SECONDS", help="Time between two reports.")]
LogPath = Annotated[
    Path | None,
    typer.Option(
        "--log",
        metavar="DIR|FILE.csv",
        show_default=False,
        help="Where to write reports and alarms, and the estimator at the end.",
    ),
]
StopAfter = Annotated[
    str | None,
    typer.Option(
        metavar="SECONDS|at-end",
        show_default=False,
        help="When to end: after a time, or where the file ends. Else Ctrl-C ends it.",
    ),
]
Tolerance = Annotated[
    float | None,
    typer.Option(
        metavar="X",
        show_default="twice what the model states",
        help="Root mean square error from which on there is an alarm, units of the output.",
    ),
]
Drift = Annotated[
    float,
    typer.Option(
        metavar="SHARE",
        help="How far estimate and model may differ, as a share of the output's range.",
    ),
]
Memory = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        show_default="60 s, at least 10,000 samples",
        help="Time over which the past is forgotten.",
    ),
]
Spread = Annotated[
    float | None,
    typer.Option(
        metavar="SHARE", show_default=False, help="How far off the model may be: 0.3 is 30 percent."
    ),
]
Resume = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        show_default=False,
        help="Go on from the estimator that an earlier watch saved; its log goes on, too.",
    ),
]
KnownMemory = Annotated[
    bool,
    typer.Option(
        "--known-memory",
        help="The actuator stands as the model does before the first line; learn from there.",
    ),
]
Wait = Annotated[
    float, typer.Option(metavar="SECONDS", min=0.0, help="How long to wait for a missing file.")
]
Silence = Annotated[
    float, typer.Option(metavar="SECONDS", help="Time without a line after which to raise alarm.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print lines of JSON.")]

_FORGETS_AFTER, _FORGETS_SAMPLES = 60.0, 10_000


def watch(
    model_file: ModelFile,
    data: Data,
    input_column: InputColumn,
    output_column: OutputColumn,
    rate: Rate = None,
    time: TimeColumn = None,
    time_unit: TimeUnit = None,
    only: Only = "",
    every: Every = 5.0,
    log: LogPath = None,
    stop_after: StopAfter = None,
    tolerance: Tolerance = None,
    drift: Drift = 0.02,
    memory: Memory = None,
    spread: Spread = None,
    resume: Resume = None,
    known_memory: KnownMemory = False,
    wait: Wait = 30.0,
    silence: Silence = 10.0,
    as_json: AsJson = False,
) -> int:
    """Follow an actuator through a growing file; report estimates, errors and alarms.

    Exit code 3 if an alarm was on at the end.
    """
    model = load_operator(model_file)
    estimator = None if resume is None else _resumed(resume, model, bool(only or memory or spread))
    plan = Plan(
        model=model,
        make=_maker(model, estimator, only, memory, spread),
        dt=_sample_time(model, estimator, rate, time),
        has_stamps=time is not None,
        every=as_positive(every, "--every", "seconds"),
        limits=Limits(error=tolerance, drift=drift),
        knows_memory=known_memory,
        start=None if estimator is None else _start_of(model, estimator, only),
    )
    waiting = _waiting(stop_after, wait, as_positive(silence, "--silence", "seconds"))
    files = None if log is None else _files_beside(log, [model_file, Path(data)])
    roles = {"input": input_column, "output": output_column, "time": time}
    name = "standard input" if data == "-" else Path(data).name
    rows = GrowingRows(name, roles, time_unit)
    source = source_of(data)
    if data != "-" and not Path(data).exists():
        note(f"waiting for {data}")
    loop = Loop(source, Session(plan, rows, note), waiting, files, resume is not None, as_json)
    with ended_by_signals() as stop:
        loop.run(stop)
    _tell_end(loop, rows, files)
    return UNFIT if loop.active else DONE


def _sample_time(
    model: hyst.operators.Operator,
    estimator: Estimator | None,
    rate: float | None,
    time: str | None,
) -> float | None:
    """Give the sample time if it is known before the first row."""
    if rate is not None and time is not None:
        raise hyst.InputError("both --rate and --time are given; give one")
    own = model.dt if estimator is None else estimator.dt
    if rate is not None:
        dt = 1.0 / as_positive(rate, "--rate", "samples per second")
        model.require_sample_time(dt, "the file by its --rate")
        if estimator is not None and not math.isclose(dt, estimator.dt, rel_tol=1e-6):
            raise hyst.InputError(
                f"--rate gives {dt:.6g} s, the estimator was made for {estimator.dt:.6g} s; record "
                "at its rate, or start anew without --resume"
            )
        return dt if own is None else own
    if own is None and time is None:
        raise hyst.InputError("neither of --rate and --time is given; give one")
    return own


def _maker(
    model: hyst.operators.Operator,
    estimator: Estimator | None,
    only: str,
    memory: float | None,
    spread: float | None,
) -> Callable[[float], Estimator]:
    names = [each.strip() for each in only.split(",") if each.strip()]

    def make(dt: float) -> Estimator:
        seconds = max(_FORGETS_AFTER, _FORGETS_SAMPLES * dt) if memory is None else memory
        return estimator_for(model, dt=dt, memory=seconds, spread=spread, only=names)

    if estimator is None:
        make(1.0 if model.dt is None else model.dt)  # refuses options before anything is waited for
        return make
    return lambda _: estimator


def _resumed(path: Path, model: hyst.operators.Operator, has_options: bool) -> Estimator:
    if has_options:
        raise hyst.InputError(
            f"{path} has its own options; leave out --only, --memory and --spread with --resume"
        )
    found = hyst.load(path)
    if not isinstance(found, Estimator):
        raise hyst.InputError(f"{path} holds no estimator; give one that hyst watch saved")
    if found.settings.get("model", model.to_dict()) != model.to_dict():
        raise hyst.InputError(
            f"{path} was started from another model; give that one, or leave out --resume"
        )
    return found


def _start_of(model: hyst.operators.Operator, estimator: Estimator, only: str) -> None | object:
    """Give the parameters that an estimator of the same kind starts from."""
    fresh = estimator_for(model, dt=estimator.dt, estimator=estimator.kind)
    return fresh.parameters if fresh.names == estimator.names else None


def _waiting(stop_after: str | None, wait: float, silence: float) -> Waiting:
    if stop_after is None or stop_after == "at-end":
        return Waiting(wait, silence, None, stop_after is not None)
    try:
        seconds = float(stop_after)
    except ValueError:
        raise hyst.InputError(f"--stop-after is {stop_after!r}; give seconds, or at-end") from None
    return Waiting(wait, silence, as_positive(seconds, "--stop-after", "seconds"), False)


def _files_beside(log: Path, inputs: list[Path]) -> LogFiles:
    files = log_files(log)
    refuse_inputs_as_outputs(files.all(), inputs)
    return files


def _tell_end(loop: Loop, rows: GrowingRows, files: LogFiles | None) -> None:
    if rows.head is None:
        note(f"{rows.source} gave no rows")
        return
    if rows.first_unreadable is not None:
        line, text = rows.first_unreadable
        note(f"{rows.unreadable} lines could not be read, the first was line {line}: {text!r}")
    if loop.active:
        note(f"alarms at the end: {', '.join(loop.active)}")
    if files is not None:
        note(f"wrote {', '.join(each.name for each in files.all())} in {files.log.parent}")
