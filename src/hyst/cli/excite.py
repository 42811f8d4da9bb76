"""hyst excite: design a drive and say what it is good for, before anyone runs it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

import hyst
from hyst._files import replacing
from hyst.checks.numbers import as_positive, whole_number
from hyst.cli.arguments import numbers
from hyst.cli.console import note, show_files, show_table
from hyst.cli.relevant_options import given, refuse_irrelevant
from hyst.cli.stated_actuator import (
    Noise,
    Radii,
    Resonances,
    StatedDelay,
    StatedModel,
    Weights,
    stated_actuator,
)

KINDS = (
    "multisine",
    "odd-multisine",
    "schroeder",
    "noise",
    "levels",
    "prbs",
    "swept-sine",
    "triangle",
    "reversals",
    "forc",
    "staircase",
)

_MULTISINES = KINDS[:3]
_SPECTRAL = (*_MULTISINES, "noise")
_BY_KIND = {
    "rms": _SPECTRAL,
    "duration": (*_SPECTRAL, "levels", "swept-sine", "staircase"),
    "band": (*_MULTISINES, "swept-sine"),
    "spectrum": _MULTISINES,
    "corner": _SPECTRAL,
    "uniform": _SPECTRAL,
    "keep": (*_SPECTRAL, "swept-sine"),
    "spacing": ("swept-sine",),
    "hold": ("levels",),
    "decay": ("reversals",),
    "clock": ("prbs",),
    "register": ("prbs",),
    "seed": ("multisine", "odd-multisine", "noise", "levels", "prbs"),
}
_AS_TYPED = (
    *("amplitude", "rms", "offset", "periods", "spectrum", "corner", "uniform", "keep"),
    *("spacing", "hold", "decay", "clock", "register", "seed"),
)
"""Options that are given to the design of a drive as they are."""

Kind = Annotated[str, typer.Option(help=f"One of {', '.join(KINDS)}.", show_default=False)]
Rate = Annotated[float, typer.Option(metavar="HZ", help="Samples per second.", show_default=False)]
Amplitude = Annotated[float, typer.Option(help="Largest distance from the offset, input units.")]
Rms = Annotated[
    float | None,
    typer.Option(
        help="Of multisines and noise, in the place of the amplitude.", show_default=False
    ),
]
Offset = Annotated[float, typer.Option(help="Middle of the drive, input units.")]
Duration = Annotated[
    float, typer.Option(metavar="S", help="Of one period, or of the hold of a staircase, s.")
]
Periods = Annotated[int, typer.Option(help="Periods, cycles, curves or steps.")]
Band = Annotated[
    str | None,
    typer.Option(metavar="LOW,HIGH", help="Frequencies of multisine and sweep, Hz."),
]
Spectrum = Annotated[
    str, typer.Option(help="Of multisines: flat, or pink (as much power in each octave).")
]
Corner = Annotated[
    float | None,
    typer.Option(
        metavar="HZ",
        show_default=False,
        help="From here the lines of a multisine fall as 1/f more; of noise, its low pass.",
    ),
]
Uniform = Annotated[
    bool, typer.Option("--uniform", help="Spread values evenly, not as a bell; multisine, noise.")
]
Keep = Annotated[
    str,
    typer.Option(
        help="What limits leave alone: amplitude (high frequencies get less) or spectrum (all is "
        "scaled down)."
    ),
]
Spacing = Annotated[str, typer.Option(help="Of swept-sine: linear, or logarithmic.")]
Hold = Annotated[int, typer.Option(metavar="N", help="Of levels: samples at each.")]
MaxRate = Annotated[
    float | None,
    typer.Option(help="Largest rate, input units per second.", show_default=False),
]
MaxAcceleration = Annotated[
    float | None,
    typer.Option(help="Largest acceleration, input units per second squared.", show_default=False),
]
Rest = Annotated[
    float | None,
    typer.Option(
        metavar="U",
        show_default=False,
        help="Ramp from this value to the start of the drive and back from its end, in the limits.",
    ),
]
Decay = Annotated[float, typer.Option(help="Of reversals (a decaying triangle): factor a cycle.")]
Clock = Annotated[int, typer.Option(help="Of prbs: samples of one bit.")]
Register = Annotated[int, typer.Option(help="Of prbs: the period has 2^N - 1 bits.")]
FirOrder = Annotated[
    int,
    typer.Option(help="Impulse response of the paper's first step, to tell rank and condition."),
]
Seed = Annotated[int, typer.Option(help="Of what is random; equal seeds give equal drives.")]
Name = Annotated[str, typer.Option(metavar="LABEL", help='Header of the column, as "drive [V]".')]
Out = Annotated[
    Path, typer.Option("-o", "--out", metavar="FILE", show_default=False, help="CSV to write.")
]


def excite(
    context: typer.Context,
    kind: Kind,
    rate: Rate,
    out: Out,
    amplitude: Amplitude = 1.0,
    rms: Rms = None,
    offset: Offset = 0.0,
    duration: Duration = 1.0,
    periods: Periods = 1,
    band: Band = None,
    spectrum: Spectrum = "flat",
    corner: Corner = None,
    uniform: Uniform = False,
    keep: Keep = "amplitude",
    spacing: Spacing = "linear",
    hold: Hold = 5,
    max_rate: MaxRate = None,
    max_acceleration: MaxAcceleration = None,
    rest: Rest = None,
    decay: Decay = 0.85,
    clock: Clock = 1,
    register: Register = 10,
    model: StatedModel = None,
    resonance: Resonances = None,
    delay: StatedDelay = None,
    radii: Radii = None,
    weights: Weights = None,
    noise: Noise = "40dB",
    fir_order: FirOrder = 30,
    seed: Seed = 0,
    name: Name = "u",
) -> None:
    """Design an input within limits; write it with a figure, and say what it can determine."""
    as_positive(rate, "--rate", "samples per second")
    if kind in KINDS:
        refuse_irrelevant(context, _BY_KIND, [kind], "--kind")
    if rms is not None and given(context, "amplitude"):
        raise hyst.InputError("--amplitude and --rms are both given; give one of them")
    whole_number(fir_order, "--fir-order", 0, more=" samples")
    ends = None if band is None else _ends(band)
    actuator = stated_actuator(model, resonance, delay, radii, weights, noise)
    limits = {
        "max_rate": math.inf if max_rate is None else max_rate,
        "max_acceleration": math.inf if max_acceleration is None else max_acceleration,
    }
    drive = hyst.signals.design(
        kind,
        dt=1.0 / rate,
        samples=_samples(duration, rate),
        band=ends,
        limits=limits,
        **{each: context.params[each] for each in _AS_TYPED},
    )
    if rest is not None:
        drive = hyst.signals.from_rest(drive, rest, **limits)
    found = actuator.forecast(drive) if actuator.is_stated else None
    show_files(write_drive(drive, out, name, () if found is None else found.frequencies))
    _tell_drive(drive, name)
    _tell_forecast(found)
    _tell_persistence(drive, fir_order)


def _ends(band: str) -> tuple[float, float]:
    """Read the two frequencies of a band."""
    values = numbers(band, "band")
    if len(values) != 2:
        raise hyst.InputError(f"--band is {band!r}; give the lowest and the highest frequency")
    return values[0], values[1]


def _samples(duration: float, rate: float) -> int:
    """Give the samples of one period; how many there may be is for the drive to say."""
    count = as_positive(duration, "--duration", "seconds") * rate
    return max(round(min(count, 1e18)), 1)


def write_drive(
    drive: hyst.signals.Drive, out: Path, name: str, resonances: Sequence[float] = ()
) -> list[Path]:
    """Write a drive as CSV, and a figure of it beside that; give both files."""
    label, unit = hyst.io.split_unit(name)
    figure = out.with_suffix(".png")
    hyst.io.write_columns(out, ["time [s]", hyst.io.join_unit(label, unit)], (drive.time, drive.u))
    with replacing(figure) as temporary:
        temporary.write_bytes(hyst.report.draw_drive(drive, label, unit, resonances))
    return [out, figure]


def _tell_drive(drive: hyst.signals.Drive, name: str) -> None:
    show_table(hyst.report.drive_table(drive, name))
    for sentence in drive.notes:
        note(sentence)


def _tell_forecast(found: hyst.identification.DriveForecast | None) -> None:
    if found is None:
        print(
            "\nState the actuator to be told what the drive will determine: --resonance 200,0.03, "
            "or --model FILE."
        )
        return
    show_table(hyst.report.forecast_table(found))
    for sentence in found.advice:
        print(f"  {sentence}")
    if found.held:
        others = [each for each in found.shared if each not in found.held]
        print(
            f"  {', '.join(found.held)} held, for no drive tells what is shared with "
            f"{', '.join(others)}"
        )
    if found.sufficient:
        print("  nothing stays open")


def _tell_persistence(drive: hyst.signals.Drive, fir_order: int) -> None:
    if fir_order < len(drive):
        print(f"\nfor the paper's method alone, an impulse response of order {fir_order}, it is")
        print(f"  {drive.persistence(fir_order).advice()}")
    else:
        note(f"the drive is shorter than the impulse response of order {fir_order}")
