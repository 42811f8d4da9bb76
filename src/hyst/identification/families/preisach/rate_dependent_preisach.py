"""Relays whose thresholds move with a power of the rate, from records at several frequencies.

For a given shift and exponent the weights solve a linear problem, so first guesses come from a
search over those two alone, on a coarse grid; then all are fitted together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, final

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from hyst import models
from hyst.errors import NotIdentifiableError
from hyst.identification.families.family import Fit, Start, Words
from hyst.identification.families.preisach.cells import even_cells
from hyst.identification.families.preisach.grid_choice import (
    GridFit,
    fitted_grid,
    levels_for,
)
from hyst.identification.families.preisach.layout import (
    CellParametrization,
    linear_fit,
    parametrized,
    start_of,
)
from hyst.identification.families.preisach.preisach import ESTIMATES_TEXT, RELAY_TEXT, Relays
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.strokes import shows_minor_loops, stroke_lengths
from hyst.identification.record_use.used_samples import Data
from hyst.operators.composition import leaves_of
from hyst.signals import reversals

if TYPE_CHECKING:
    from hyst.identification.result.identified import Identified

Array = NDArray[np.float64]

SEARCH_LEVELS = 12
SEARCH_STRENGTH = 3e-4

LEAST_EXPONENT, LARGEST_EXPONENT = 0.02, 2.0
EXPONENTS = (0.05, 0.15, 0.4, 1.0)
SHIFTS = (0.02, 0.06, 0.15, 0.3)
"""At the fastest rate, of half the input's range."""

LARGEST_SHIFT = 0.8
FEWEST_RATES = 1.2
"""Ratio of the slowest to the fastest half swing, up to which all belong to one frequency."""

TRADE_OFF = ("rate_shift.c", "rate_shift.m", "preisach.coercive")
"""Constants that loops of one size hardly tell apart: all of them widen the loop."""


@final
@dataclass(frozen=True)
class RateDependentPreisach(Relays):
    """Preisach model behind a shift: thresholds ``alpha + c |du/dt|^m``, ``beta - c |du/dt|^m``.

    Parameters
    ----------
    levels, smoothness
        See ``Relays``.
    """

    name = "rate-dependent-preisach"
    methods = ("learning",)
    depends_on_rate: ClassVar[bool] = True
    settles_delay: ClassVar[bool] = False
    loops_tell_delay = False
    explains = ("rate dependence", "dynamics")  # its loops widen as the rate grows
    words = Words(
        full_name="rate-dependent Preisach model",
        equations=(
            "z(t) = play of half-width c |du/dt|\u1d50 of u",
            "P[z](t) = p0 z(t) + \u03a3 w\u1d62\u2c7c R\u1d62\u2c7c[z](t),  R = \u00b11",
            "y(t) = {sign}P[z](t) + offset",
        ),
        explanations=(
            RELAY_TEXT,
            ESTIMATES_TEXT,
            "The faster the input moves, the later the relays switch: \u03b1 grows and \u03b2 "
            "falls by c |du/dt|\u1d50.",
        ),
    )

    def least_parameters(self, size: int) -> int:
        """Give those of one loop, c and m."""
        return super().least_parameters(size) + 2

    def searched(self, data: Data) -> Data:
        """Give all samples: what is left out changes the rate."""
        return data

    def fitted(self, data: Data) -> Data:
        """Give all samples."""
        return data

    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give the best shift and exponent of a search, with their weights."""
        found, shift, exponent = overview.once(("rate grid", self), lambda: self._found(overview))
        return [_with_rate(found, shift, exponent)]

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say if the exponent ended at a limit, and what else the prior decides."""
        exponent = float(shift_of(fit).m)
        said: tuple[str, ...] = ()
        if not LEAST_EXPONENT * 1.01 < exponent < LARGEST_EXPONENT * 0.99:
            said = (
                f"the exponent m ended at its limit {exponent:.3g}, so it is no estimate; record "
                "at frequencies further apart",
            )
        if not shows_minor_loops(stroke_lengths(data)):
            said += (
                "without minor loops the records tell how far thresholds move from one of their "
                "rates to another, and hardly what they are at rest: c, m and the coercive mean "
                "trade off against each other, so none of them is an estimate",
            )
        return said + super().notes(fit, data)

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Give no errors of constants that trade off where the records show no minor loops."""
        if overview.shows_minor_loops:
            return identified
        open_ones = [name in TRADE_OFF for name in identified.parameter_names]
        errors = np.where(open_ones, np.nan, identified.standard_errors)
        return replace(identified, standard_errors=errors)

    def _found(self, overview: Overview) -> tuple[GridFit, float, float]:
        fastest = _require_rates(overview.data)
        shift, exponent = _search(overview, fastest)
        cells = self.cells(*_seen(overview.data, shift, exponent), overview.input.size)
        front = (models.RateShift(shift, exponent, overview.data.records[0].dt),)
        grid = fitted_grid(overview, cells, parametrized(overview, cells, front), self.strength)
        return grid, shift, exponent


def shift_of(fit: Fit) -> models.RateShift:
    """Give the shift of a fit.

    Parameters
    ----------
    fit
        Of this family.
    """
    return next(each for each in leaves_of(fit.operator) if isinstance(each, models.RateShift))


def _require_rates(data: Data) -> float:
    """Refuse records of one frequency, and give the fastest rate."""
    durations = np.concatenate(
        [r.dt * np.diff(reversals(r.u, 0.05 * float(np.ptp(r.u)))) for r in data.records]
    )
    if not durations.size or durations.max() <= FEWEST_RATES * durations.min():
        raise NotIdentifiableError(
            "all records turn at one frequency, so that nothing shows how thresholds move with the "
            "rate; add records at other frequencies, or use family 'preisach'"
        )
    return max(float(np.abs(np.diff(each.u)).max()) / each.dt for each in data.records)


def _search(overview: Overview, fastest: float) -> tuple[float, float]:
    """Find shift and exponent on a coarse grid: the best of a few, then downhill."""
    half = overview.data.half_range

    def cost(place: Array) -> float:
        share, exponent = float(np.exp(place[0])), float(np.exp(place[1]))
        return _misfit(overview, share * half / fastest**exponent, exponent)

    tried = [np.log([share, exponent]) for share in SHIFTS for exponent in EXPONENTS]
    first = min(tried, key=cost)
    bounds = [
        (np.log(1e-3), np.log(LARGEST_SHIFT)),
        (np.log(LEAST_EXPONENT), np.log(LARGEST_EXPONENT)),
    ]
    found = scipy.optimize.minimize(
        cost,
        first,
        method="Nelder-Mead",
        bounds=bounds,
        options={"xatol": 0.05, "fatol": 0.0, "maxfev": 24},
    )
    exponent = float(np.exp(found.x[1]))
    return float(np.exp(found.x[0])) * half / fastest**exponent, exponent


def _misfit(overview: Overview, shift: float, exponent: float) -> float:
    """Give the squared error of the weights of a coarse grid behind a shift."""
    data = overview.data
    cells = even_cells(
        *_seen(data, shift, exponent), min(SEARCH_LEVELS, levels_for(data.measured().size))
    )
    front = (models.RateShift(shift, exponent, data.records[0].dt),)
    parametrization = parametrized(overview, cells, front)
    fit = linear_fit(overview, parametrization, cells)
    normal, moment = fit.gram(np.ones(fit.y.size, dtype=bool))
    held = fit.held(SEARCH_STRENGTH)
    theta = fit.solve(normal + held, moment, start_of(parametrization) + 1.0)
    left = fit.columns @ theta - fit.y
    return float(left @ left) / fit.spread**2


def _seen(data: Data, shift: float, exponent: float) -> tuple[float, float]:
    """Give the range of what the relays see behind a shift."""
    seen = [
        models.RateShift(shift, exponent, record.dt)(record.u[: window.stop])[window]
        for record, window in zip(data.records, data.windows(), strict=True)
    ]
    return min(float(each.min()) for each in seen), max(float(each.max()) for each in seen)


def _with_rate(grid: GridFit, shift: float, exponent: float) -> Start:
    """Free shift and exponent as well: two more entries of theta."""
    own = grid.parametrization
    fixed, count = own.fixed.copy(), own.size
    fixed[:2] = 0.0
    transform = np.zeros((fixed.size, count + 2))
    transform[:, :count] = own.transform
    transform[[0, 1], [count, count + 1]] = 1.0
    prior = own.prior
    if prior is not None:
        prior = np.column_stack([prior, np.zeros((len(prior), 2))])
    wider: CellParametrization = replace(
        own,
        fixed=fixed,
        transform=transform,
        lower=np.append(own.lower, [0.0, LEAST_EXPONENT]),
        upper=np.append(own.upper, [np.inf, LARGEST_EXPONENT]),
        prior=prior,
        is_linear=False,
        effective=own.effective + 2,
    )
    return wider, np.append(grid.theta, [shift, exponent])
