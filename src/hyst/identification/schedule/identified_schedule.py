"""What an identification over a second signal gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.result.identified import Identified
from hyst.models import Scheduled
from hyst.operators import ModelDescription, Verdict

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class ScheduledConstant:
    """One constant over the second signal.

    Parameters
    ----------
    name
        As in ``Scheduled.at(value).parameters()``.
    values, standard_errors
        Shape (values,); an error is NaN where the constant lies on a bound or is not determined.
    moves
        Whether it changes with the signal beyond what scatter explains; else it is shared.
    chance
        How probable differences as large as those of the free estimates are where it does not
        change; NaN where that cannot be asked.
    """

    name: str
    values: Array
    standard_errors: Array
    moves: bool
    chance: float


@final
@dataclass(frozen=True)
class Checked:
    """The model at a value that took no part, against records taken there.

    Parameters
    ----------
    value
        Of the second signal.
    rms, rms_percent
        Of the error, output units and percent of the range.
    noise
        The rms that the fit leaves at the values next to it; at the value itself, where a knot was
        left out.
    between
        The values between which the straight lines ran.
    outside
        Whether it is outside the schedule, so that constants are held.
    """

    value: float
    rms: float
    rms_percent: float
    noise: float
    between: tuple[float, float]
    outside: bool = False

    @property
    def interpolation(self) -> float:
        """What the straight lines add to the error, rms in output units; 0 within the noise."""
        return float(np.sqrt(max(self.rms**2 - self.noise**2, 0.0)))


@final
@dataclass(frozen=True, eq=False, repr=False)
class IdentifiedSchedule:
    """A model over a second signal, identified from records, and how far it can be trusted.

    Parameters
    ----------
    model
        The ``Scheduled`` model.
    values
        Shape (values,), at which records were taken.
    results
        What ``identify`` tells, at each value; with the constants of the joint fit.
    constants
        Every constant over the signal.
    left_out
        For every value but the first and the last: the model of the others there.
    held_out
        For every value of validation records.
    notes
        What was decided, and what is not known.
    verdict
        How far the model can be trusted.
    """

    model: Scheduled
    values: Array
    results: tuple[Identified, ...]
    constants: tuple[ScheduledConstant, ...]
    left_out: tuple[Checked, ...]
    held_out: tuple[Checked, ...]
    notes: tuple[str, ...]
    verdict: Verdict

    @property
    def family(self) -> str:
        """Name of the family."""
        return self.results[0].family

    @property
    def description(self) -> ModelDescription:
        """What the numbers of the model mean."""
        return self.model.description

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the constants that change with the signal."""
        return tuple(each.name for each in self.constants if each.moves)

    def __repr__(self) -> str:
        shared = len(self.constants) - len(self.moving)
        return (
            f"{type(self).__name__}({self.verdict.level}: {self.verdict.sentences[0]!r}; "
            f"{self.family} at {self.values.size} values of {self.model.name}, {len(self.moving)} "
            f"constants move, {shared} are shared)"
        )

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as plain numbers and text, for metrics.json."""

        def known(value: float) -> float | None:
            return None if np.isnan(value) else float(value)

        return {
            "verdict": self.verdict.to_dict(),
            "family": self.family,
            "schedule": {
                "name": self.model.name,
                "unit": self.model.unit,
                "values": self.values.tolist(),
            },
            "constants": [
                {
                    "name": each.name,
                    "moves": each.moves,
                    "chance": known(each.chance),
                    "values": each.values.tolist(),
                    "standard_errors": [known(error) for error in each.standard_errors],
                }
                for each in self.constants
            ],
            "left_out": [_plain(each) for each in self.left_out],
            "held_out": [_plain(each) for each in self.held_out],
            "notes": list(self.notes),
            "results": [
                {"value": float(value), **each.to_dict()}
                for value, each in zip(self.values, self.results, strict=True)
            ],
        }

    def summary(self) -> str:
        """Give a page or less for people, the verdict first.

        Returns
        -------
        str
        """
        out = f" {self.description.output_unit}" if self.description.output_unit else ""
        unit = f" {self.model.unit}" if self.model.unit else ""
        lines = [self.verdict.told(), f"family {self.family}, over {self.model.name}", ""]
        for value, each in zip(self.values, self.results, strict=True):
            metrics = each.metrics["training"]
            lines.append(
                f"{self.model.name} {value:.6g}{unit}: rms {metrics.rms:.4g}{out} "
                f"({metrics.rms_percent:.3f} % of range), {each.verdict.level}"
            )
        lines += [told_of(each, self.model.name, unit, out) for each in self._checked()]
        head = "".join(f"{f'{value:.6g}':>24s}" for value in self.values)
        lines += ["", f"{'constant':36s}{head}"]
        lines += [_row(each) for each in self.constants]
        lines += [f"note: {sentence}" for sentence in self.notes]
        return "\n".join(lines)

    def _checked(self) -> tuple[Checked, ...]:
        return self.left_out + self.held_out


def told_of(checked: Checked, name: str, unit: str, output_unit: str) -> str:
    """Say how the model does at a value that took no part.

    Parameters
    ----------
    checked
        What was found.
    name, unit
        Of the second signal.
    output_unit
        Of the output.
    """
    low, high = checked.between
    error = f"rms {checked.rms:.4g}{output_unit} ({checked.rms_percent:.3f} % of range)"
    if checked.value in checked.between:
        return f"{name} {checked.value:.6g}{unit}, records that took no part: {error}"
    if checked.outside:
        return (
            f"{name} {checked.value:.6g}{unit}, outside {low:.6g} to {high:.6g}, constants held at "
            f"the end: {error}"
        )
    return (
        f"{name} {checked.value:.6g}{unit}, by straight lines from {low:.6g} to {high:.6g}: "
        f"{error}, of which the lines add {checked.interpolation:.3g}{output_unit}"
    )


def _row(each: ScheduledConstant) -> str:
    def shown(value: float, error: float) -> str:
        return f"{value:.6g} +- {'-' if np.isnan(error) else f'{error:.2g}'}"

    pairs = zip(each.values, each.standard_errors, strict=True)
    cells = [f"{shown(*pair):>24s}" for pair in pairs]
    return f"{each.name:36s}" + ("".join(cells) if each.moves else f"{cells[0]}  the same at all")


def _plain(each: Checked) -> dict[str, Any]:
    return {**vars(each), "between": list(each.between), "interpolation": each.interpolation}
