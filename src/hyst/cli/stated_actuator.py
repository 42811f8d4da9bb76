"""The actuator as it is thought to be, from the options of hyst excite."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

import hyst
from hyst.cli.arguments import load_operator, numbers

_PLAYS = 5  # of a front that is not stated, at even radii within the drive's range

StatedModel = Annotated[
    Path | None,
    typer.Option("--model", metavar="FILE", help="Actuator as it is thought to be: a model file."),
]
Resonances = Annotated[
    list[str] | None,
    typer.Option(
        "--resonance",
        metavar="HZ,DAMPING",
        help="In the place of a model: a resonance of it; may be repeated.",
    ),
]
StatedDelay = Annotated[
    int | None, typer.Option("--delay", metavar="N", help="With --resonance: samples late.")
]
Radii = Annotated[
    str | None,
    typer.Option(
        metavar="R,R,...",
        help="Of its plays, input units; five over the drive's range if left out.",
    ),
]
Weights = Annotated[
    str | None,
    typer.Option(
        metavar="P0,P,...", help="Of the input, and of each play; 0.6 and even if left out."
    ),
]
Noise = Annotated[
    str,
    typer.Option(metavar="S", help="Of its sensor: as 40dB below the output, or in output units."),
]


@dataclass(frozen=True)
class StatedActuator:
    """What was typed of it, read but not yet made: that takes the drive.

    Parameters
    ----------
    model
        From a file; None for a sketch.
    resonances
        Hz and damping ratios.
    delay
        Whole samples.
    radii, weights
        Of its plays; empty if left out.
    noise, noise_db
        Output units, or None and dB below the output.
    """

    model: hyst.operators.Operator | None
    resonances: tuple[tuple[float, float], ...]
    delay: int
    radii: tuple[float, ...]
    weights: tuple[float, ...]
    noise: float | None
    noise_db: float

    @property
    def is_stated(self) -> bool:
        """Whether anything of it was."""
        return self.model is not None or bool(self.resonances or self.radii)

    def forecast(self, drive: hyst.signals.Drive) -> hyst.identification.DriveForecast:
        """Tell what a drive will determine of it.

        Parameters
        ----------
        drive
            The drive.

        Raises
        ------
        InputError
            As ``hyst.identification.forecast_drive``, and if the sketch cannot be made.
        """
        made = self.model if self.model is not None else self._sketched(drive)
        return hyst.identification.forecast_drive(
            drive, made, noise=self.noise, noise_db=self.noise_db
        )

    def _sketched(self, drive: hyst.signals.Drive) -> hyst.operators.Operator:
        half = 0.5 * float(drive.u.max() - drive.u.min())
        even = [half * place / (_PLAYS + 1) for place in range(1, _PLAYS + 1)]
        if half == 0.0:
            raise hyst.InputError(f"the drive rests at {drive.u[0]:.6g} and determines nothing")
        front = hyst.identification.sketched_plays(self.radii or even, self.weights or None)
        if not self.resonances:
            return front
        return hyst.identification.sketched_stage(
            drive.dt, self.resonances, delay=self.delay, front=front
        )


def stated_actuator(
    model: Path | None,
    resonances: Sequence[str] | None,
    delay: int | None,
    radii: str | None,
    weights: str | None,
    noise: str,
) -> StatedActuator:
    """Read what was typed, and refuse what does not go together.

    Parameters
    ----------
    model, resonances, delay, radii, weights, noise
        As typed.

    Raises
    ------
    InputError
        If it cannot be read or does not go together.
    """
    if model is not None and (resonances or radii or weights or delay is not None):
        raise hyst.InputError(
            "--model is given, and it states all; leave out --resonance, --delay, --radii and "
            "--weights"
        )
    if delay is not None and not resonances:
        raise hyst.InputError("--delay is for --resonance; give one, or leave it out")
    if weights and not (resonances or radii):
        raise hyst.InputError("--weights is for --resonance or --radii; give one of them")
    absolute, decibels = _read_noise(noise)
    return StatedActuator(
        None if model is None else load_operator(model),
        tuple(_pair(each) for each in resonances or ()),
        delay or 0,
        tuple(numbers(radii, "radii")) if radii else (),
        tuple(numbers(weights, "weights")) if weights else (),
        absolute,
        decibels,
    )


def _pair(text: str) -> tuple[float, float]:
    values = numbers(text, "resonance")
    if len(values) != 2:
        raise hyst.InputError(
            f"--resonance is {text!r}; give frequency in Hz and damping ratio, as 200,0.03"
        )
    return values[0], values[1]


def _read_noise(text: str) -> tuple[float | None, float]:
    """Give noise in output units or None, and decibels."""
    in_decibels = text.strip().lower().endswith("db")
    try:
        value = float(text.strip()[:-2] if in_decibels else text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or (not in_decibels and value <= 0.0):
        raise hyst.InputError(
            f"--noise is {text!r}; give it as 40dB below the output, or as its standard deviation "
            "in output units"
        )
    return (None, value) if in_decibels else (value, 0.0)
