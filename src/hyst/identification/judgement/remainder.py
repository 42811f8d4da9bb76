"""What a fit leaves of its records, in units in which ranges lie between 1 and 2."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.fit.problem import model_output
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]
Found = TypeVar("Found")

MOST_ROWS = 10_000
"""Samples that regressions take, spread evenly: more would cost time and change no verdict."""


@dataclass(frozen=True, eq=False)
class Part:
    """The samples used of one record.

    Parameters
    ----------
    whole
        Shape (k,), inputs from the first sample of the record to the last one used; its memory
        knows of those, too, that are not used.
    u, y, modelled
        Shape (n,), input, output brought forward by the delay, and the model's output.
    places
        Shape (n,), which samples of the record they are, ascending.
    dt
        Time between samples of the record, s.
    number
        Of the record, counted from 1.
    rows
        Which of its samples regressions take.
    """

    whole: Array
    u: Array
    y: Array
    modelled: Array
    places: NDArray[np.intp]
    dt: float
    number: int
    rows: NDArray[np.intp]

    @property
    def error(self) -> Array:
        """What the model leaves."""
        return self.y - self.modelled

    @property
    def time(self) -> Array:
        """Of every sample, s."""
        return np.asarray(self.places * self.dt)


@dataclass(frozen=True, eq=False)
class Remainder:
    """What a fit leaves of all its records.

    Parameters
    ----------
    parts
        One for each record that has samples in use.
    tangent
        Shape (rows, m), by which the model's output moves with its free constants, those on a
        bound left out.
    output_range
        What percentages refer to.
    input_scale, output_scale
        Powers of two: by them numbers here are to be multiplied to be in the user's units.
    input_unit, output_unit
        Of the user, as text.
    has_memory
        Whether the model has some.
    held
        Share of its free constants that lie on a bound.
    """

    parts: tuple[Part, ...]
    tangent: Array
    output_range: float
    input_scale: float
    output_scale: float
    input_unit: str
    output_unit: str
    has_memory: bool
    held: float
    _found: dict[Hashable, object] = field(default_factory=dict, init=False, repr=False)

    def once(self, key: Hashable, find: Callable[[], Found]) -> Found:
        """Give what ``find`` finds, and find it only the first time this key is asked for."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]  # type: ignore[return-value]

    @functools.cached_property
    def error(self) -> Array:
        """Of all parts, one after the other."""
        return _joined([each.error for each in self.parts])

    @functools.cached_property
    def y(self) -> Array:
        """Measured, of all parts."""
        return _joined([each.y for each in self.parts])

    @functools.cached_property
    def u(self) -> Array:
        """Of all parts."""
        return _joined([each.u for each in self.parts])

    @functools.cached_property
    def rows(self) -> NDArray[np.intp]:
        """Samples that regressions take."""
        return _rows(self.error.size)

    @functools.cached_property
    def input_range(self) -> float:
        """Of all samples used."""
        return float(np.ptp(self.u))

    def columns(self, of_part: Callable[[Part], Array]) -> Array:
        """Give columns over all rows from a function that gives them over the rows of a part."""
        return np.concatenate([of_part(each) for each in self.parts])

    def said(self, amount: float) -> str:
        """Say an amount of output in the user's unit, with its share of the range."""
        percent = 100.0 * amount / self.output_range
        return f"{self.plain(amount)} ({percent:.2g} % of the output's range)"

    def plain(self, amount: float) -> str:
        """Say an amount of output in the user's unit."""
        unit = f" {self.output_unit}" if self.output_unit else ""
        return f"{amount * self.output_scale:.3g}{unit}"


def remainder_of(data: Data, fit: Fit, output_range: float) -> Remainder:
    """Give what a fit leaves of its records.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.
    output_range
        What percentages refer to, in their units.
    """
    measured, modelled = data.measured(), model_output(data, fit.operator)
    parametrization, theta = fit.parametrization, fit.solution.theta
    out = _power_of_two(float(np.ptp(measured)))
    into = _power_of_two(max(float(np.ptp(each.u)) for each in data.records))
    rows = _rows(measured.size)
    parts, first = [], 0
    passes = zip(data.records, data.windows(), data.counted(), strict=True)
    for number, (record, window, counts) in enumerate(passes, start=1):
        # The one place that knows which samples of a record are in use.
        places = np.arange(window.start, window.stop)
        places = places if counts is None else places[counts]
        here = slice(first, first + places.size)
        first += places.size
        if places.size:
            whole = record.u[: window.stop] / into
            parts.append(
                Part(
                    whole,
                    whole[window] if counts is None else whole[places],
                    measured[here] / out,
                    modelled[here] / out,
                    places,
                    record.dt,
                    number,
                    rows[slice(*np.searchsorted(rows, [here.start, here.stop]))] - here.start,
                )
            )
    # What lies on a bound does not move: an error along it is none the model makes up for.
    moving = parametrization.inside(theta)
    tangent = _without_unit(Evaluation(data, parametrization).jacobian_at(theta, rows)[:, moving])
    record = data.records[0]
    held = 1.0 - float(np.mean(parametrization.inside(theta))) if theta.size else 0.0
    has_memory = fit.family.has_memory
    units = record.input_unit, record.output_unit
    span = output_range / out
    return Remainder(tuple(parts), tangent, span, into, out, *units, has_memory, held)


def _joined(parts: list[Array]) -> Array:
    """Put arrays into one; a single one, which may be long, is not copied."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _rows(total: int) -> NDArray[np.intp]:
    """Give the samples that regressions take of so many."""
    return np.round(np.linspace(0, total - 1, min(total, MOST_ROWS))).astype(np.intp)


def _power_of_two(span: float) -> float:
    """Give the power of two whose ratio to a range lies between 1 and 2."""
    return math.ldexp(1.0, math.frexp(span)[1] - 1)


def _without_unit(columns: Array) -> Array:
    """Bring every column to a size near 1 by a power of two."""
    size = np.abs(columns).max(axis=0, initial=0.0)
    columns = columns[:, size > 0.0]
    return np.asarray(columns / np.ldexp(1.0, np.frexp(size[size > 0.0])[1]))
