"""The options of hyst export."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hyst.cli.export.targets import TARGETS

Out = Annotated[
    Path,
    typer.Option(
        "-o",
        "--out",
        metavar="PATH",
        show_default=False,
        help="What to write: a folder, a zip if it ends in .zip, or an FMU if in .fmu.",
    ),
]

ForTool = Annotated[
    str,
    typer.Option(help="; ".join(f"{name}, {each.purpose}" for name, each in TARGETS.items()) + "."),
]

Inverse = Annotated[bool, typer.Option("--inverse", help="Export the inverse.")]

Explicit = Annotated[
    bool,
    typer.Option(
        "--explicit", help="Export the explicit inverse of a rate-dependent model; not exact."
    ),
]

Precision = Annotated[str, typer.Option(help="Of C, Rust or structured text: double or single.")]

Name = Annotated[str, typer.Option(metavar="NAME", help="Prefix of files, functions and types.")]

Force = Annotated[bool, typer.Option("--force", help="Replace an earlier export, as a whole.")]

FmiVersion = Annotated[str, typer.Option(metavar="VERSION", help="Of an FMU: 2.0 or 3.0.")]

Binary = Annotated[
    bool,
    typer.Option(
        "--binary/--no-binary", help="Whether to compile an FMU's binary for this platform."
    ),
]

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
