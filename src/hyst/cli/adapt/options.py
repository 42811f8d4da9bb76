"""What hyst adapt can be asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="MODEL DATA",
        show_default=False,
        help="Model file and measured record; with --resume or --law-weights slopes the record "
        "alone.",
    ),
]
Folder = Annotated[
    Path, typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write.")
]
Memory = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        show_default="nothing is forgotten",
        help="Time over which the past is forgotten, for constants that drift.",
    ),
]
Spread = Annotated[
    float | None,
    typer.Option(
        metavar="SHARE", show_default="0.3", help="How far off the model may be: 0.3 is 30 percent."
    ),
]
Maps = Annotated[
    bool, typer.Option("--estimate-maps", help="Estimate the maps before and after the plays too.")
]
Only = Annotated[
    str,
    typer.Option(
        metavar="NAMES",
        show_default="every constant",
        help="What to estimate, with commas: scale,offset of any model, or constants of its own.",
    ),
]
Which = Annotated[
    str,
    typer.Option(
        "--estimator",
        metavar="NAME",
        # Those of hyst.online.ESTIMATORS, which would load what help does not need.
        help="Which one: auto by what is estimated, or scale, joint, model.",
    ),
]
Guard = Annotated[
    bool,
    typer.Option(
        "--guard", help="Predict under a guard that falls back to the last good model; guard.csv."
    ),
]
Window = Annotated[
    str,
    typer.Option(
        metavar="SECONDS|auto",
        help="Over how long the guard compares errors; auto: periods of the motion.",
    ),
]
Commands = Annotated[
    str | None,
    typer.Option(
        metavar="COL",
        show_default=False,
        help="Column of DATA with a wanted output: the guarded inverse's commands for it, too.",
    ),
]
Resume = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        show_default=False,
        help="Go on from the estimator.json or guard.json of an earlier run; it has the model and "
        "all options.",
    ),
]
Start = Annotated[
    int,
    typer.Option(
        metavar="N", min=0, help="First sample to learn from; earlier ones set the memory."
    ),
]
