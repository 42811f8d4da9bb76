"""The paper's law on the command line: radii of plays whose weights are known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, cast, final

import numpy as np
import typer
from numpy.typing import NDArray

import hyst
from hyst.cli.adapt.measured import Measured
from hyst.cli.console import note
from hyst.cli.reading_options import Verb, with_options

Array = NDArray[np.float64]

# By this factor errors of the start must be passed before a run along the same record is to blame.
_WORSE, _NEGLIGIBLE = 1.1, 1e-4
_METHODS = ("gradient", "least-squares")
_OPTIONS: dict[str, tuple[Any, Any]] = {
    "law": (
        Annotated[
            str | None,
            typer.Option(
                metavar="|".join(_METHODS),
                show_default=False,
                help="Estimate radii alone, by the law of Al Janaideh, Xu and Tan.",
            ),
        ],
        None,
    ),
    "law_weights": (
        Annotated[
            str,
            typer.Option(
                metavar="model|slopes",
                help="Of the law: those of MODEL, or from slopes of DATA, without MODEL.",
            ),
        ],
        "model",
    ),
    "law_plays": (
        Annotated[
            str,
            typer.Option(metavar="N|auto", help="With --law-weights slopes: how many plays."),
        ],
        "auto",
    ),
    "gain": (
        Annotated[
            float | None,
            typer.Option(
                metavar="X",
                show_default="by the record",
                help="Of the law, per second; of least squares, the start's variance over noise's.",
            ),
        ],
        None,
    ),
    "filter_time": (
        Annotated[
            float,
            typer.Option(
                metavar="SECONDS", help="Over which the law takes the slope; 0: a sample."
            ),
        ],
        0.0,
    ),
    "dead_time": (
        Annotated[
            float,
            typer.Option(metavar="SECONDS", help="After a reversal in which the law rests."),
        ],
        0.0,
    ),
    "tolerance": (
        Annotated[
            float | None,
            typer.Option(
                metavar="SHARE",
                show_default="1, or 0.25 for least squares",
                help="How far a slope may be from one of the plays', up to half their distance.",
            ),
        ],
        None,
    ),
    "slope": (
        Annotated[
            str | None,
            typer.Option(
                metavar="COL",
                show_default=False,
                help="Column of DATA with dy/du, for the law, where it is known better.",
            ),
        ],
        None,
    ),
    "regime": (
        Annotated[
            str | None,
            typer.Option(
                metavar="COL",
                show_default=False,
                help="Or with the number of plays on their envelopes, -1 where unknown.",
            ),
        ],
        None,
    ),
}
_NOT_TYPED = {name: default for name, (_, default) in _OPTIONS.items()}


def asks_law(verb: Verb) -> Verb:
    """Give a verb the options of the law; it gets them as ``law``, a dictionary."""
    return with_options(verb, _OPTIONS, "law")


@final
@dataclass(frozen=True)
class Law:
    """What was typed about the law.

    Parameters
    ----------
    method
        ``gradient`` or ``least-squares``; None if no law was asked for.
    from_slopes
        Whether weights come from slopes of the record.
    plays
        How many, with those.
    gain, filter_time, dead_time, tolerance
        As of ``RadiusEstimator``.
    slope, regime
        Columns.
    """

    method: Literal["gradient", "least-squares"] | None
    from_slopes: bool
    plays: int | Literal["auto"]
    gain: float | None
    filter_time: float
    dead_time: float
    tolerance: float | None
    slope: str | None
    regime: str | None

    @property
    def column(self) -> str | None:
        """The column that tells slope or regime."""
        return self.slope if self.regime is None else self.regime


def law_from(typed: dict[str, Any], resumes: bool, others: dict[str, bool]) -> Law:
    """Read what was typed about the law.

    Parameters
    ----------
    typed
        Values of the options.
    resumes
        Whether an earlier run goes on: then its law does, and only columns may be told.
    others
        Options that have nothing to do with the law, and whether they were typed.

    Raises
    ------
    InputError
        If a value is unknown, or options do not go together.
    """
    method = typed["law"]
    if method is not None and method not in _METHODS:
        raise hyst.InputError(f"--law is {method!r}; choose {' or '.join(_METHODS)}")
    of_a_start = [name for name in _NOT_TYPED if name not in ("slope", "regime")]
    given = [_option(name) for name in of_a_start if typed[name] != _NOT_TYPED[name]]
    if resumes and given:
        raise hyst.InputError(
            f"an estimator that goes on has its own law; leave out {' and '.join(given)} with "
            "--resume"
        )
    columns = [name for name in ("slope", "regime") if typed[name] is not None]
    if method is None and not resumes and (given or columns):
        first = [*given, *map(_option, columns)][0]
        raise hyst.InputError(f"{first} is about the law; name one by --law, or leave it out")
    if len(columns) == 2:
        raise hyst.InputError("--slope and --regime are both given; give one of them")
    clash = [name for name, is_typed in others.items() if is_typed]
    if method is not None and clash:
        raise hyst.InputError(f"the law estimates radii alone; leave out {' and '.join(clash)}")
    weights = typed["law_weights"]
    if weights not in ("model", "slopes"):
        raise hyst.InputError(f"--law-weights is {weights!r}; choose model or slopes")
    if weights == "model" and typed["law_plays"] != "auto":
        raise hyst.InputError("--law-plays is for --law-weights slopes; MODEL has its own plays")
    known = {name: typed[name] for name in ("gain", "filter_time", "dead_time", "tolerance")}
    plays = _plays(typed["law_plays"])
    told = {name: typed[name] for name in ("slope", "regime")}
    return Law(cast(Any, method), weights == "slopes", plays, **known, **told)


def model_from_slopes(law: Law, record: hyst.Record) -> hyst.operators.Operator:
    """Give plays of weights and first radii from the slopes of a record, and its level."""
    found = hyst.identification.identify_weights_from_slopes(record, plays=law.plays)
    print(f"slopes: {found.summary()}")
    model = found.model
    turns = hyst.signals.reversals(record.u, hyst.signals.suggest_dead_band(record.u))
    settled = int(turns[1]) if turns.size > 1 else int(turns[0])
    level = float(np.mean((record.y - model(record.u))[settled:]))
    return hyst.Affine(1.0, level) @ model


def start_law(
    law: Law,
    model: hyst.operators.Operator,
    record: hyst.Record,
    memory: float | None,
    dead_band: float | None,
) -> hyst.online.RadiusEstimator:
    """Make the estimator of the radii of a model."""
    band = hyst.signals.suggest_dead_band(record.u) if dead_band is None else dead_band
    return hyst.online.radius_estimator_for(
        model,
        record.dt,
        law.gain,
        record=record,
        method=law.method,
        memory=math.inf if memory is None else memory,
        filter_time=law.filter_time,
        dead_time=law.dead_time,
        dead_band=band,
        tolerance=law.tolerance,
    )


def run_law(
    estimator: hyst.online.RadiusEstimator,
    law: Law,
    measured: Measured,
    source: tuple[Path, dict[str, Any], float],
    every: int,
) -> hyst.online.Trajectory:
    """Take the law along a record, with the column that tells slope or regime.

    Parameters
    ----------
    estimator
        It goes on from where it is.
    law
        Which column, if any.
    measured
        The record.
    source
        The file, how it is read, and the delay that was taken off.
    every
        Estimates are kept after every so many samples.

    Raises
    ------
    InputError
        If the column does not fit, or no sample could be used.
    """
    told: dict[str, Any] = {}
    if law.column is not None:
        column = _told_column(law.column, measured, source)
        if law.regime is None:
            # At rest dy/du has no meaning, whatever the file has there; the regime stays.
            column[np.diff(measured.record.u, prepend=np.nan) == 0.0] = np.nan
            told["slopes"] = column
        else:
            told["regimes"] = np.where(column == -1.0, np.nan, column)
    used = estimator.counts["used"]
    trajectory = estimator.run(measured.record, every, **told)
    if estimator.counts["used"] == used:
        raise hyst.InputError(
            f"no slope of {source[0]} fits the plays, so nothing was learnt; give weights of this "
            "actuator, as by --law-weights slopes, or a longer --filter-time"
        )
    return trajectory


def tell_law(
    estimator: hyst.online.RadiusEstimator, before: list[float], record: hyst.Record
) -> None:
    """Say what the law rests on, what it does not know, and if its start was better.

    Parameters
    ----------
    estimator
        At the end.
    before
        Its radii at the start.
    record
        What it has learnt from.
    """
    gains = estimator.settings["gain"]
    told = "told" if estimator.knows_regimes else "measured"
    print(f"law: {estimator.settings['method']}, gain {gains[0]:.4g}, regimes {told}")
    # Least squares says so for each radius.
    if not estimator.knows_regimes and estimator.settings["method"] == "gradient":
        note(
            "regimes come from the measured slope, which noise makes wrong; adapt without --law "
            "needs no slope"
        )
    first, last = (_left(estimator, radii, record) for radii in (before, estimator.radii))
    if last > max(_WORSE * first, _NEGLIGIBLE * float(np.ptp(record.y))):
        note(
            f"these radii are worse than those at the start: they leave {last:.4g} rms of the "
            f"record, the others {first:.4g}; do not use model.json, or adapt without --law"
        )


def _left(estimator: hyst.online.RadiusEstimator, radii: Any, record: hyst.Record) -> float:
    """Give the root mean square that radii leave of a record, once the input has turned twice."""
    known = estimator.settings
    y = hyst.PrandtlIshlinskii(known["p"], radii, known["p0"])(record.u) + known["offset"]
    turns = hyst.signals.reversals(record.u, hyst.signals.suggest_dead_band(record.u))
    settled = int(turns[1]) if turns.size > 1 else 0
    return float(np.sqrt(np.mean((record.y - y)[settled:] ** 2)))


def _told_column(
    name: str, measured: Measured, source: tuple[Path, dict[str, Any], float]
) -> Array:
    data, how, delay = source
    table = how.get("table")
    values, _, _ = hyst.io.read_column(
        data,
        name,
        table=None if table is None else int(table),
        format=how.get("format"),
        max_samples=how["max_samples"],
    )
    if values.size != measured.whole.samples:
        raise hyst.InputError(
            f"column {name!r} has {values.size} samples but the record {measured.whole.samples}, "
            "since rows were left out or made; give a file without --repair and --resample"
        )
    # It belongs to the output, which comes later than its input by the delay.
    behind, end = max(math.floor(delay), 0), values.size - max(-math.floor(delay), 0)
    return np.array(values[behind:end][measured.history.size :])


def _plays(text: str) -> int | Literal["auto"]:
    if text == "auto":
        return "auto"
    try:
        return int(text)
    except ValueError:
        raise hyst.InputError(f"--law-plays is {text!r}; give a whole number or auto") from None


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")
