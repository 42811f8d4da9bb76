"""hyst compensate: the command that makes the output follow a trajectory."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import typer
from numpy.typing import NDArray

import hyst
from hyst.cli.arguments import (
    DespiteVerdict,
    ModelFile,
    SampleRate,
    history_of,
    numbers,
    require_same_unit,
    sample_time_known,
)
from hyst.cli.command_over import compensate_over, tell_virgin, write_command
from hyst.cli.console import note, progress_bar, show_files, show_table
from hyst.cli.driver_option import DriverOfCommand, driver_for, range_of_codes
from hyst.cli.reading_options import Verb, reads_columns, with_options
from hyst.cli.relevant_options import refuse_irrelevant
from hyst.cli.scheduled import (
    ScheduleColumn,
    ScheduleValue,
    loaded,
    model_at_rest,
    read_signal,
    refuse_what_is_fixed,
)
from hyst.cli.time_column import time_column
from hyst.operators.composition import leaves_of

if TYPE_CHECKING:
    from hyst.operators import ModelDescription, Operator


Reference = Annotated[
    Path,
    typer.Argument(metavar="REFERENCE", show_default=False, help="File with the wanted output."),
]
Column = Annotated[
    str, typer.Option(metavar="COL", show_default=False, help="Its column: name or index from 0.")
]
Out = Annotated[
    Path, typer.Option("-o", "--out", metavar="FILE", show_default=False, help="CSV to write.")
]
Method = Annotated[
    str,
    typer.Option(
        help="exact; for rate-dependent models explicit, sample-exact, preview or trajectory; "
        "for linear dynamics noncausal."
    ),
]
Preview = Annotated[
    int, typer.Option(metavar="N", help="Samples of the reference known ahead, of preview.")
]
Band = Annotated[
    float | None,
    typer.Option(
        metavar="HZ", show_default=False, help="Of noncausal: highest frequency to invert."
    ),
]
RateLimit = Annotated[
    float | None,
    typer.Option(
        metavar="X", show_default=False, help="Largest rate of the input, of preview, trajectory."
    ),
]
Objective = Annotated[
    Literal["rms", "largest"], typer.Option(help="Which error trajectory makes small.")
]
Roughness = Annotated[
    float | None,
    typer.Option(
        metavar="W",
        show_default="10 % of the gain, 2 % for largest",
        help="Of trajectory: a second difference of the command of 1 counts as an error of W.",
    ),
]
AllowUnconverged = Annotated[
    bool, typer.Option("--allow-unconverged", help="Accept a command that did not converge.")
]
Outside = Annotated[
    Literal["refuse", "clip"], typer.Option(help="What to do about a reference out of reach.")
]
Limits = Annotated[
    str | None,
    typer.Option(
        metavar="LOW,HIGH",
        show_default="the range the model was identified from",
        help="Range of the input.",
    ),
]
NoLimits = Annotated[bool, typer.Option("--no-limits", help="Let the input go wherever it must.")]
History = Annotated[
    str | None,
    typer.Option(
        metavar="U,U,...|FILE:COLUMN",
        show_default=False,
        help="Inputs just before, which set the memory: turns, or a record where time counts.",
    ),
]

_FIXED = ("--method", "--outside", "--with-delay")
_BY_METHOD = {
    "preview": ("preview",),
    "band": ("noncausal",),
    "rate_limit": ("preview", "trajectory"),
    "allow_unconverged": ("trajectory",),
    "objective": ("trajectory",),
    "roughness": ("trajectory",),
}


WithDelay = Annotated[
    bool,
    typer.Option(
        "--with-delay",
        help="Give the command earlier by the delay that the model file tells of its record.",
    ),
]


# How the methods go about it, which they are handed as it was typed.
_SOLVING: dict[str, tuple[Any, Any]] = {
    "preview": (Preview, 20),
    "band": (Band, None),
    "rate_limit": (RateLimit, None),
    "objective": (Objective, "rms"),
    "roughness": (Roughness, None),
    "allow_unconverged": (AllowUnconverged, False),
}


def _solves(verb: Verb) -> Verb:
    """Give a verb the options of the methods, as ``solving``."""
    return with_options(verb, _SOLVING, "solving")


@reads_columns
@_solves
def compensate(
    context: typer.Context,
    model_file: ModelFile,
    reference: Reference,
    column: Column,
    out: Out,
    how: dict[str, Any],
    solving: dict[str, Any],
    method: Method = "exact",
    outside: Outside = "refuse",
    limits: Limits = None,
    no_limits: NoLimits = False,
    history: History = None,
    rate: SampleRate = None,
    despite_verdict: DespiteVerdict = False,
    with_delay: WithDelay = False,
    driver: DriverOfCommand = None,
    schedule_column: ScheduleColumn = None,
    schedule_value: ScheduleValue = None,
) -> None:
    """Turn a wanted output into the input that produces it, and predict how well."""
    if method in hyst.compensation.METHODS:
        refuse_irrelevant(context, _BY_METHOD, [method], "--method")
    model = loaded(model_file, schedule_column, schedule_value)
    about = model.description
    y_ref, _, unit = hyst.io.read_column(reference, column, **how)
    require_same_unit(unit, about.output_unit, "the reference")
    table = driver_for(driver, about)
    input_range = range_of_codes(_input_range(limits, no_limits, about), table)
    known = sample_time_known(model_at_rest(model), reference, rate, "the reference", **how)
    if isinstance(model, hyst.Scheduled):
        refuse_what_is_fixed(_FIXED, (method != "exact", outside == "clip", with_delay))
        s = read_signal(model, reference, str(schedule_column), y_ref.size, how)
        time = time_column(reference, rate, model.dt, y_ref.size, **how)
        compensate_over(model, y_ref, s, history, input_range, despite_verdict, out, time, table)
        return
    _require_method_for(model, method)
    turns = None if history is None else history_of(history)
    with progress_bar("inverting") as progress:
        done = hyst.compensation.invert_trajectory(
            model,
            _as_early(y_ref, about) if with_delay else y_ref,
            method,
            input_range=input_range,
            outside=outside,
            history=turns,
            **solving,
            despite_verdict=despite_verdict,
            progress=progress,
        )
    _note_times(known, history, model)
    time = time_column(reference, rate, model.dt, done.u.size, **how)
    coded = None
    if table is not None:
        coded = hyst.compensation.in_codes(model, done, table, limits=input_range, history=turns)
    late = y_ref if with_delay else None
    write_command(out, about, time, _signals(done, about, late, coded), coded and coded.codes)
    _tell(done, about, input_range, with_delay, history is None and model.initial_state().size > 0)
    if coded is not None:
        print(coded.told(about.input_unit, about.output_unit))
    show_files([out])


def _note_times(known: bool, history: str | None, model: Operator) -> None:
    """Say what is taken for a sample time, and that typed turns last a sample each."""
    if not known:
        note(f"the reference is taken to have the model's sample time, {model.dt:.6g} s")
    typed = history is not None and ":" not in history
    if typed and any(each.kind == "creep" for each in leaves_of(model)):
        note(
            "the turns of --history last one sample each, too short for creep to follow; give the "
            "drive before as a record, --history FILE:COLUMN"
        )


def _signals(
    done: hyst.compensation.Compensation,
    about: ModelDescription,
    late_reference: NDArray[np.float64] | None,
    coded: hyst.compensation.CodedCommand | None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Give reference, command and predicted output, later by the delay where it is as asked for."""
    predicted = done.y_predicted if coded is None else coded.y_predicted
    if late_reference is None:
        return done.y_ref, done.u, predicted
    late = hyst.identification.earlier(predicted, -about.delay)
    return late_reference, done.u, late


def _as_early(y_ref: NDArray[np.float64], about: ModelDescription) -> NDArray[np.float64]:
    """Give the reference as early as the output lags."""
    if about.delay < 0:
        raise hyst.InputError(
            f"--with-delay: the model file tells of an output {-about.delay:.4g} samples ahead of "
            "its input, which no actuator is; align the channels of the record and identify again"
        )
    return hyst.identification.earlier(y_ref, about.delay)


def _require_method_for(model: Operator, method: str) -> None:
    """Name the methods of the command line where the library would name its functions."""
    if method != "exact" or model.dt is None:
        return
    try:
        model.inverse()
    except hyst.NotInvertibleError as refusal:
        kinds = {type(each) for each in leaves_of(model)}
        if hyst.RateDependentPrandtlIshlinskii in kinds:
            raise hyst.NotInvertibleError(
                "a model whose thresholds follow the rate of its input has no exact inverse; "
                "choose --method trajectory (the whole reference known), preview (the next "
                "samples), sample-exact or explicit"
            ) from refusal
        raise


def _input_range(
    limits: str | None, no_limits: bool, about: ModelDescription
) -> tuple[float, float] | None:
    if limits is not None and no_limits:
        raise hyst.InputError("--limits and --no-limits are both given; give one of them")
    if no_limits:
        return None
    if limits is not None:
        ends = numbers(limits, "limits")
        if len(ends) != 2:
            raise hyst.InputError(f"--limits is {limits!r}; give the lowest and the highest input")
        return ends[0], ends[1]
    if about.input_low is None or about.input_high is None:
        return None
    return about.input_low, about.input_high


def _tell(
    done: hyst.compensation.Compensation,
    about: ModelDescription,
    input_range: tuple[float, float] | None,
    with_delay: bool,
    virgin: bool,
) -> None:
    print(done.expectation(about.output_unit))
    for sentence in done.unknown:
        note(sentence)
    unit = f" {about.input_unit}" if about.input_unit else ""
    limits = (
        "no limits"
        if input_range is None
        else f"limits {input_range[0]:.6g} to {input_range[1]:.6g}"
    )
    print(f"command from {done.u.min():.6g} to {done.u.max():.6g}{unit} ({limits})")
    if done.clipped:
        print(f"{done.clipped} of {done.u.size} samples are out of reach and were clipped")
    show_table(hyst.report.compensation_table(done, about.output_unit))
    if done.method != "exact" and done.total_variation is not None:
        print(
            f"{done.method}, {done.status}: the command's total variation is "
            f"{done.total_variation:.3f} of the reference's, its peak rate {done.peak_rate:.3f}; "
            f"it turns {done.reversals} times, its second differences are {done.roughness:.4g} rms "
            f"and {done.largest_bend:.4g} at most"
        )
    for sentence in done.notes:
        print(sentence)
    if about.delay:
        print(hyst.report.delay_sentence(about.delay, about.dt, about.delay_interval))
    if about.delay > 0:
        print(_with_delay_counted(done, about, with_delay))
    tell_virgin(virgin)


def _with_delay_counted(
    done: hyst.compensation.Compensation, about: ModelDescription, with_delay: bool
) -> str:
    """Say what the delay does to the output, which the model itself does not predict."""
    if with_delay:
        of = "" if about.dt is None else f" of {about.dt:.4g} s"
        return (
            f"--with-delay: the command comes {about.delay:.4g} samples{of} earlier, and the "
            "errors above are those of the delayed output; the end of the reference is held"
        )
    error = hyst.identification.earlier(done.y_predicted, -about.delay) - done.y_ref
    unit = f" {about.output_unit}" if about.output_unit else ""
    return (
        f"with that delay, which the errors above leave out, the output would miss the reference "
        f"by {float(np.sqrt(np.mean(error**2))):.3g}{unit} rms, at most "
        f"{float(np.abs(error).max()):.3g}{unit}; --with-delay gives the command earlier"
    )
