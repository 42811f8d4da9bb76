"""Preisach models of any density: non-negative weights of cells under a prior of smoothness.

    min  sum_k (model[u](k) - y(k))^2 + (lambda |y - mean|)^2 integral |grad density|^2

The density is smooth where the records leave it open; how much is decided on left-out blocks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_number
from hyst.checks.numbers import whole_number as as_whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.option import (
    AUTO,
    Option,
    as_numbers,
    option,
    read_number,
    read_numbers,
)
from hyst.identification.families.preisach.cells import Cells, adapted_cells, even_cells
from hyst.identification.families.preisach.coverage import about_coverage, crossed
from hyst.identification.families.preisach.grid_choice import (
    ADAPTED_LEVELS,
    FEWEST_LEVELS,
    MOST_LEVELS,
    GridFit,
    best_grid,
    fitted_grid,
    least_samples,
    levels_for,
)
from hyst.identification.families.preisach.layout import (
    CellParametrization,
    parametrized,
    weights_of,
)
from hyst.identification.families.preisach.told import estimates_of
from hyst.identification.fit.evaluation import Evaluation
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.strokes import shows_minor_loops, stroke_lengths
from hyst.identification.record_use.thinning import thinned
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

SEARCHED_SAMPLES, FITTED_SAMPLES = 6_000, 20_000
LARGEST_SMOOTHNESS = 100.0


def _as_levels(levels: Any, name: str) -> Any:
    """Check a number of levels, the thresholds themselves, or ``"auto"``."""
    if isinstance(levels, str) and levels == AUTO:
        return AUTO
    if isinstance(levels, int | float | str | np.generic):
        return as_whole_number(
            levels, name, FEWEST_LEVELS, MOST_LEVELS, f", {AUTO!r}, or a list of thresholds"
        )
    what = f"{FEWEST_LEVELS + 1} to {MOST_LEVELS + 1} different finite thresholds, or a number"
    thresholds = np.unique(as_numbers(levels, name, what))
    if not FEWEST_LEVELS < thresholds.size <= MOST_LEVELS + 1:
        raise InputError(f"{name} are {thresholds.size} thresholds; give {what}")
    return tuple(thresholds.tolist())


def _read_levels(text: str, name: str) -> Any:
    if "," in text:
        return read_numbers(text, name)
    return int(text) if text.isdecimal() else text


def _as_smoothness(value: Any, name: str) -> Any:
    if isinstance(value, str) and value == AUTO:
        return AUTO
    number = as_number(value, name)
    if not 0.0 <= number <= LARGEST_SMOOTHNESS:
        raise InputError(
            f"{name} is {number}; give {AUTO!r} or a number from 0 to {LARGEST_SMOOTHNESS:g}"
        )
    return number


def _read_smoothness(text: str, name: str) -> Any:
    return text if text == AUTO else read_number(text, name)


LEVELS_OPTION = Option(
    _as_levels,
    "Cells of the grid along a side, or its thresholds, input units, as -1,-0.5,0,0.5,1.",
    _read_levels,
    "N|auto|T1,T2,..",
)
SMOOTHNESS_OPTION = Option(
    _as_smoothness,
    "Strength of the prior that densities of neighbouring cells are alike; 0 for none.",
    _read_smoothness,
    "X|auto",
)

RELAY_TEXT = (
    "Relays switch up where the rising input reaches \u03b1 (alpha) and down where the falling one "
    "reaches \u03b2 (beta). Their density is w over the area of a cell in every cell of a grid, so "
    "minor loops may have any shape; p0 is the part without hysteresis."
)
ESTIMATES_TEXT = (
    "In the table below, switched is how far all relays together move the output, coercive the "
    "mean of (\u03b1 - \u03b2)/2 and bias that of (\u03b1 + \u03b2)/2 over their mass; the weights "
    "are in the model file and in the figure."
)


@dataclass(frozen=True)
class Relays(Family):
    """What all models of relays on a grid have in common.

    Parameters
    ----------
    levels
        Cells of the grid along a side, 4 to 48, evenly spaced over the range of the input; its
        thresholds, input units; or ``"auto"``: 24, fewer for short records, and 32 that are
        narrower where relays switch if those leave more than noise.
    smoothness
        Strength of the prior that densities of neighbouring cells are alike, from 0; ``"auto"``:
        what predicts left-out blocks best; of records without minor loops the largest that does
        not predict them worse.
    """

    is_linear = True

    levels: Any = option(AUTO, LEVELS_OPTION)
    smoothness: Any = option(AUTO, SMOOTHNESS_OPTION)

    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Refuse more levels than the samples are enough for."""
        samples = data.measured().size
        needed = self.least_parameters(0)
        if self.levels != AUTO and samples <= needed:
            raise NotIdentifiableError(
                f"{samples} samples can be used, but {self._side} levels need more than {needed}; "
                "give fewer levels or a longer record"
            )
        return self, ()

    def searched(self, data: Data) -> Data:
        """Give fewer samples: there are hundreds of unknowns."""
        return thinned(data, SEARCHED_SAMPLES)

    def fitted(self, data: Data) -> Data:
        """Give as many samples as memory allows."""
        return thinned(data, FITTED_SAMPLES)

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with scaled thresholds."""
        if not isinstance(self.levels, tuple):
            return self
        return replace(self, levels=[each * input_scale for each in self.levels])

    def least_parameters(self, size: int) -> int:
        """Give what one loop determines: a mass a level and branch, the linear part, the offset."""
        return least_samples(self._side)

    def cells(self, low: float, high: float, samples: int) -> Cells:
        """Give the grid over a range, evenly spaced unless its thresholds are given.

        Parameters
        ----------
        low, high
            Ends of what the relays see, input units.
        samples
            Of all records.
        """
        if isinstance(self.levels, tuple):
            return Cells(np.array(self.levels))
        return even_cells(low, high, levels_for(samples) if self.levels == AUTO else self.levels)

    @property
    def strength(self) -> float | None:
        """Strength of the prior; None where it is to be chosen."""
        return None if self.smoothness == AUTO else float(self.smoothness)

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say how many cells the records never crossed, and how much the prior decides."""
        parametrization = fit.parametrization
        assert isinstance(parametrization, CellParametrization), "a family of relays made it"
        used = self.fitted(data)
        evaluation = Evaluation(used, parametrization)
        weights = weights_of(fit.operator)
        columns = evaluation.jacobian(fit.solution.theta)[:, 1 : 1 + weights.size]
        # Per weight in the units of the fit: the columns of the cells are shares of one number.
        size = np.abs(parametrization.transform).max(axis=0)[1 : 1 + weights.size]
        turned = crossed(columns / size, used.lengths())
        one_size = not shows_minor_loops(stroke_lengths(data))
        return about_coverage(weights, turned, parametrization.effective, one_size=one_size)

    def estimates(self, fit: Fit) -> Estimates:
        """Give the few numbers that hundreds of weights come to."""
        return estimates_of(fit.operator, fit.parametrization)

    @property
    def _side(self) -> int:
        if isinstance(self.levels, tuple):
            return len(self.levels) - 1
        return FEWEST_LEVELS if self.levels == AUTO else int(self.levels)


@final
@dataclass(frozen=True)
class Preisach(Relays):
    """``y = sign (p0 u + sum of relays) + offset``, their density constant in each cell of a grid.

    Parameters
    ----------
    levels, smoothness
        See ``Relays``.
    """

    name = "preisach"
    in_reserve = True
    loops_tell_delay = "own"  # general ones do not saturate, and narrow a loop by a wrong delay
    explains = ("output ahead of input",)  # so its loops look to them
    words = Words(
        full_name="Preisach model",
        equations=(
            "y(t) = {sign}P[u](t) + offset",
            "P[u](t) = p0 u(t) + \u03a3 w\u1d62\u2c7c R\u1d62\u2c7c[u](t),  R = \u00b11",
        ),
        explanations=(RELAY_TEXT, ESTIMATES_TEXT),
    )

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the weights themselves: the problem is linear, and its solution unique."""
        found = overview.once(("grid", self), lambda: self._found(overview))
        return [(found.parametrization, found.theta)]

    def _found(self, overview: Overview) -> GridFit:
        low = min(float(each.u.min()) for each in overview.data.records)
        high = max(float(each.u.max()) for each in overview.data.records)
        cells = self.cells(low, high, overview.input.size)
        even = fitted_grid(overview, cells, parametrized(overview, cells), self.strength)
        if self.levels != AUTO:
            return even

        def adapted(found: GridFit) -> GridFit:
            levels = levels_for(overview.input.size, ADAPTED_LEVELS)
            narrow = adapted_cells(cells, found.theta[1 : 1 + cells.count], levels)
            return fitted_grid(overview, narrow, parametrized(overview, narrow), found.strength)

        return best_grid(overview, even, adapted)
