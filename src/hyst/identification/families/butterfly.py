"""Butterflies: an output that is a polynomial of the input and of its saturating hysteresis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import models
from hyst.errors import NotIdentifiableError
from hyst.identification.families.butterfly_layout import (
    ButterflyParametrization,
    parametrize_butterfly,
)
from hyst.identification.families.butterfly_relays import (
    RelayParametrization,
    relay_start,
    turns_of_cells,
)
from hyst.identification.families.butterfly_starts import best_guesses, residual_of_a_curve
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Family, Fit, Start, Words
from hyst.identification.families.mapped_plays import KNOTS_OPTION
from hyst.identification.families.option import (
    AUTO,
    choice,
    option,
    whole_number,
    whole_number_or_auto,
)
from hyst.identification.families.preisach.coverage import about_coverage, crossed
from hyst.identification.families.preisach.grid_choice import (
    FEWEST_LEVELS,
    MOST_LEVELS,
    least_samples,
)
from hyst.identification.families.turning_output import turning_share
from hyst.identification.fit.problem import ROUNDING, model_output
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.strokes import shows_minor_loops, stroke_lengths
from hyst.identification.record_use.used_samples import Data
from hyst.models.butterfly import MOST_DEGREE

Array = NDArray[np.float64]

SIZES = (1, 2, 4, 6)
"""Numbers of plays that ``"auto"`` compares."""

MOST_PLAYS, MOST_KNOTS = 20, 50

PLAYS, RELAYS = "plays", "relays"
RELAYS_FROM_PLAYS = 4

WORTH_RELAYS = 0.005
"""Of the output's range: of plays that leave more, and show minor loops, relays are told of."""

LEAST_TURN = 0.08
"""Share of the output's range by which it must go back on a branch of the loop."""

HYSTERESIS_PAYS = 0.85
"""Share of what a curve of the input alone leaves, that a guess with hysteresis must fall below."""

_SMALLEST_WEIGHT = 1e-6
_SMALLEST_GAP = 1e-4


@final
@dataclass(frozen=True)
class Butterfly(Family):
    """``y = sum_{i+j<=n} c_ij u^i z^j``, z plays behind a rising envelope of the input.

    Parameters
    ----------
    plays
        Number of plays, 1 to 20, or ``"auto"``: chosen by cross-validation.
    knots
        Number of knots of the envelope, 1 to 50, evenly spaced over the input.
    inside
        ``"plays"``: few constants, and minor loops of one shape; or ``"relays"``: a Preisach model,
        for minor loops of any shape, and records that show them.
    cells
        Of relays: how many their grid has along a side, 4 to 64.
    degree
        n, 2 to 6: of the polynomial of input and hysteresis.
    """

    name = "butterfly"
    in_reserve = "butterfly"
    describes = ("butterfly", "run direction")  # one wing is run one way, the other the other way
    loops_tell_delay = False  # they go one way with the input, and a butterfly looks late to them
    methods = ("trajectory",)
    words = Words(
        full_name="butterfly model",
        equations=(
            "y(t) = \u03a3 c\u1d62\u2c7c u(t)\u2071 z(t)\u02b2,  i + j <= degree",
            "z(t) = \u03a3 p\u1d62 F\u1d63\u1d62[\u03b3(u)](t)",
        ),
        explanations=(
            "z is what the material remembers, as its polarization, between about -1 and 1: plays "
            "F (backlash of half-width r) of \u03b3(u), a rising piecewise linear map of the input "
            "that is steep where the material switches.",
            "The output is a polynomial of input u and state z, as strain is: z\u00b2 stands for "
            "electrostriction, u z for the piezoelectric effect, which turns with z. It falls and "
            "rises with the input, so a wanted output alone does not determine a command.",
        ),
    )

    plays: Any = option(AUTO, whole_number_or_auto(1, MOST_PLAYS, "Number of plays."))
    knots: Any = option(
        20,
        replace(whole_number(1, MOST_KNOTS, KNOTS_OPTION.help), metavar=KNOTS_OPTION.metavar),
    )
    inside: Any = option(
        PLAYS,
        choice((PLAYS, RELAYS), "What makes the hysteresis of a butterfly: plays, or relays."),
    )
    cells: Any = option(
        24, whole_number(FEWEST_LEVELS, MOST_LEVELS, "Cells along a side of the grid of relays.")
    )
    degree: Any = option(
        2, whole_number(2, MOST_DEGREE, "Degree of the polynomial of input and hysteresis.")
    )

    def sizes(self) -> tuple[int, ...]:
        """Give the numbers of plays to compare; relays have none."""
        if self.inside == RELAYS:
            return (0,)
        return SIZES if self.plays == AUTO else (self.plays,)

    def least_parameters(self, size: int) -> int:
        """Give the number of slopes, weights, radii and coefficients, less two scales."""
        coefficients = int(self.degree + 1) * int(self.degree + 2) // 2
        if self.inside == RELAYS:
            return least_samples(int(self.cells)) + coefficients
        return int(self.knots) - 1 + 2 * size + coefficients

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best of a grid over where and how steeply the material switches.

        Raises
        ------
        NotIdentifiableError
            If the output goes one way with the input, or turns but has no memory.
        """
        _require_a_butterfly(overview)
        plays = size or RELAYS_FROM_PLAYS
        guesses = best_guesses(overview, plays, self.knots, self.degree, max(most, 2))
        left = min(each.residual for each in guesses)
        curve = residual_of_a_curve(overview)
        if left > HYSTERESIS_PAYS * curve or curve < ROUNDING * overview.output_range:
            raise NotIdentifiableError(
                "the output turns with the input but shows no hysteresis of a butterfly: a curve "
                f"of the input alone leaves {100.0 * curve / overview.output_range:.3g} % of the "
                f"range, and plays {100.0 * left / overview.output_range:.3g} %; stay on one side "
                "of the turn and use family 'pi'"
            )
        if self.inside == RELAYS:
            key = ("relays", self.cells, self.degree)
            return [overview.once(key, lambda: relay_start(overview, self.cells, self.degree))]
        return [parametrize_butterfly(each) for each in guesses]

    def simplified(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Fit again without plays that came out idle, until none is."""
        while self.inside == PLAYS:
            found = _layout(fit).hysteresis(fit.solution.theta)
            working = found.p > _SMALLEST_WEIGHT * found.p.max()
            working[working] = (
                np.diff(found.r[working], prepend=-np.inf) > _SMALLEST_GAP * found.half
            )
            if working.all():
                return fit
            parametrization, theta = parametrize_butterfly(found.with_plays(working))
            fit = replace(fit, parametrization=parametrization)
            problem = fit.problem(overview.data, overview.kept)
            fit = replace(fit, solution=self.solve(problem, theta, max_iterations))
        return fit

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say how many plays came out idle, or which cells of relays were never crossed."""
        if isinstance(fit.parametrization, RelayParametrization):
            return _about_relays(fit, fit.parametrization, data)
        said, idle = [], fit.size - _layout(fit).plays
        if idle > 0:
            said.append(
                f"{idle} of {fit.size} plays came out with no weight or no radius of their own; "
                "they were left out"
            )
        if shows_minor_loops(stroke_lengths(data)) and _left(fit, data) > WORTH_RELAYS:
            said.append(
                "the records show minor loops, which plays behind one envelope make of one shape: "
                "inside='relays' (--inside relays) lets them have any"
            )
        return tuple(said)

    def estimates(self, fit: Fit) -> Estimates:
        """Give all free constants, but of relays the coefficients alone."""
        told = super().estimates(fit)
        if self.inside == PLAYS:
            return told
        kept = np.array([name.startswith("c[") for name in told.names])
        names = tuple(name for name, each in zip(told.names, kept, strict=True) if each)
        return Estimates(names, told.values[kept], told.by_theta[kept])


def _left(fit: Fit, data: Data) -> float:
    """Give the root mean square of what a fit leaves, over the output's range."""
    y = data.measured()
    error = model_output(data, fit.operator) - y
    return float(np.sqrt(np.mean(error**2)) / np.ptp(y))


def _about_relays(fit: Fit, parametrization: RelayParametrization, data: Data) -> tuple[str, ...]:
    model = fit.operator
    assert isinstance(model, models.Butterfly), "the family made it"
    count = parametrization.cells.count
    turned = crossed(turns_of_cells(Overview(data), model), data.lengths())
    weights = model.hysteresis.parameters().values[1 : 1 + count]
    one_size = not shows_minor_loops(stroke_lengths(data))
    return about_coverage(weights, turned, parametrization.effective, one_size=one_size)


def _layout(fit: Fit) -> ButterflyParametrization:
    parametrization = fit.parametrization
    assert isinstance(parametrization, ButterflyParametrization), "the family made it"
    return parametrization


def _require_a_butterfly(overview: Overview) -> None:
    share = overview.once("turning share", lambda: turning_share(overview.data))
    if share < LEAST_TURN:
        raise NotIdentifiableError(
            "the output never falls while the input rises, or never rises, but for "
            f"{100.0 * share:.2g} % of its range; a butterfly turns on a branch of its loop: use "
            "family 'pi', 'gpi' or 'mpi'"
        )
