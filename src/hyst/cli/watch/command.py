"""hyst watch: follow an actuator while it runs, and raise alarms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hyst.cli.arguments import ModelFile
from hyst.cli.reading_options import InputColumn, OutputColumn, Rate, TimeColumn, TimeUnit

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
        metavar="SHARE", show_default="0.1", help="How far off the model may be: 0.1 is 10 percent."
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
    # What it needs loads numerics, which a program that shows its help does not.
    from hyst.cli.watch.start import Wishes, watch_source

    columns = {"input": input_column, "output": output_column, "time": time}
    wishes = Wishes(
        rate=rate,
        time_unit=time_unit,
        only=only,
        every=every,
        log=log,
        stop_after=stop_after,
        tolerance=tolerance,
        drift=drift,
        memory=memory,
        spread=spread,
        resume=resume,
        knows_memory=known_memory,
        wait=wait,
        silence=silence,
        as_json=as_json,
    )
    return watch_source(model_file, data, columns, wishes)
