"""Delay and order of dynamics behind plays on a grid: by search over pairs of poles.

A resonance takes two states at once, so an order that grows by one stops before the second.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.families.hammerstein.start.at_full_rate import Dynamic, at_full_rate
from hyst.identification.families.hammerstein.start.grid_front import OnGrid, refined_on_grid
from hyst.identification.families.hammerstein.start.output_error import Guess, steiglitz_mcbride
from hyst.identification.families.hammerstein.start.play_inputs import (
    Piece,
    bandwidth,
    grids_of,
    pieces_of,
    play_columns,
)
from hyst.identification.record_use.used_samples import Data

Array = NDArray[np.float64]

NO_PLAYS = np.empty(0)

LARGEST_ORDER = 12
MOST_DELAY = 10_000

_PARTS = (1.0, 0.6, 0.35)  # of the largest factor that keeps the band of the output
_ABOVE_BAND = 1.3
_MOST_FACTOR = 1000
_FEWEST_ROWS = 300
_LOW_DELAYS = 3
_NEAR = 8  # samples at the low rate by which a resonance alone may seem late
_PAYS = 0.9  # to what share of the squared error a further pair of poles must lower it
_MUCH = 1e-2  # of the output's power: something else is missing, so one more pair is tried
_AS_GOOD = 1.02
_UNSURE = 2.0  # times the cost of the best before refinement: the next is refined, too
_ITERATIONS = 8


@dataclass(frozen=True, eq=False)
class Search:
    """Records as pieces at several rates, for one search.

    Parameters
    ----------
    data
        The records.
    radii
        Of the grid, input units; empty where the input is what drives the dynamics.
    delays
        Samples, to choose from.
    full
        Pieces at the rate of the records.
    low
        Pieces with fewer plays at lower rates, by the factor.
    """

    data: Data
    radii: Array
    delays: range
    full: list[Piece]
    low: dict[int, list[Piece]]
    _known: dict[int, list[Dynamic]] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def of(cls, data: Data, delay: int | None, radii: Array = NO_PLAYS) -> Search:
        """Cut the records to pieces, at the rates that keep the band of the output.

        Parameters
        ----------
        data
            The records.
        delay
            Samples, where it is known.
        radii
            Of the grid, input units; none for a drive that goes straight to the dynamics.
        """
        return cls.over(data, delay, pieces_of(data, lambda u: play_columns(u, radii)), radii)

    @classmethod
    def over(cls, data: Data, delay: int | None, full: list[Piece], radii: Array) -> Search:
        """Search over pieces with what drives the dynamics, at rates that keep the output's band.

        Parameters
        ----------
        data
            The records.
        delay
            Samples, where it is known.
        full
            Pieces at the rate of the records.
        radii
            Of the grid, input units, where the inputs are its plays.
        """
        rows = min(each.output.size for each in full)
        most = min(MOST_DELAY, rows // 8)
        delays = range(most + 1) if delay is None else range(delay, delay + 1)
        largest = 1.0 / (_ABOVE_BAND * bandwidth(full))
        kept = max(sum(each.output.size for each in full) // _FEWEST_ROWS, 1)
        most_factor = min(_MOST_FACTOR, kept)
        factors = {int(np.clip(round(part * largest), 1, most_factor)) for part in _PARTS}
        low = {
            each: [piece.thinned().decimated(each) for piece in full] for each in sorted(factors)
        }
        return cls(data, radii, delays, full, low)

    def candidates(self, order: int) -> list[Dynamic]:
        """Give dynamics of an order found at the rates, the best first.

        Parameters
        ----------
        order
            Number of poles.
        """
        if order in self._known:
            return self._known[order]
        found = self._at(order, self.low)
        if not found and 1 not in self.low:
            # Poles that are over within a few samples are none at a lower rate.
            found = self._at(order, {1: [each.thinned() for each in self.full]})
        self._known[order] = sorted(found, key=lambda each: each.cost)
        return self._known[order]

    def _at(self, order: int, rates: dict[int, list[Piece]]) -> list[Dynamic]:
        dt = self.data.records[0].dt
        found = []
        for factor, pieces in rates.items():
            low = self._low(pieces, order, factor)
            raised = None if low is None else at_full_rate(self.full, low, factor, dt, self.delays)
            if raised is not None and np.isfinite(raised.cost) and raised.dynamics.dc_gain() != 0.0:
                found.append(raised)
        return found

    def _low(self, pieces: Sequence[Piece], order: int, factor: int) -> Guess | None:
        first = self.delays.start // factor
        delays = {first + each for each in range(_LOW_DELAYS)}
        if len(self.delays) > 1:
            late = lag_of_peak(pieces)
            if late > _NEAR:
                delays |= {late - each for each in range(0, _NEAR, 2)}
        else:
            delays = {max(first - 1, 0), first}
        tried = [steiglitz_mcbride(pieces, order, order + 1, each) for each in sorted(delays)]
        guesses = [each for each in tried if each is not None]
        return min(guesses, key=lambda each: each.cost) if guesses else None

    def refined(self, order: int, feedthrough: bool = True) -> OnGrid | None:
        """Give the best dynamics of an order after refinement with the weights of the plays.

        Parameters
        ----------
        order
            Number of poles.
        feedthrough
            Whether the first sample after the delay may answer.
        """
        candidates = self.candidates(order)
        if not candidates:
            return None
        near = [each for each in candidates[:2] if each.cost <= _UNSURE * candidates[0].cost]
        refined = [
            refined_on_grid(self.data, self.radii, each, feedthrough, _ITERATIONS) for each in near
        ]
        return min(refined, key=lambda each: each.cost)


def lag_of_peak(pieces: Sequence[Piece]) -> int:
    """Give the lag at which drive and output are most alike: not before the delay.

    Parameters
    ----------
    pieces
        Inputs, the drive first, and output.
    """
    import scipy.signal  # slow, and only dynamics need it

    longest = max(pieces, key=lambda each: each.output.size)
    u, y = longest.inputs[:, 0], longest.output
    products = scipy.signal.correlate(y - y.mean(), u - u.mean(), mode="full", method="fft")
    ahead = products[u.size - 1 : u.size - 1 + max(u.size // 4, 1)]
    return int(np.abs(ahead).argmax())


def on_better_grid(data: Data, delay: int | None, order: int) -> Search:
    """Give the search with the grid of radii that comes nearer to the output at one order.

    Parameters
    ----------
    data
        The records.
    delay
        Samples, where it is known.
    order
        Number of poles.
    """
    searches = [Search.of(data, delay, each) for each in grids_of(data.half_range)]

    def least(search: Search) -> float:
        found = search.candidates(order)
        return found[0].cost if found else np.inf

    return min(searches, key=least)


class Searched(Protocol):
    """What gives refined dynamics of an order."""

    def refined(self, order: int) -> OnGrid | None:
        """Give them; None where there are none."""


def search_order(search: Searched, orders: Sequence[int] | None, power: float) -> OnGrid:
    """Choose the order by the error that refined dynamics leave.

    Parameters
    ----------
    search
        The records.
    orders
        To choose from; None for all, by pairs.
    power
        Mean square of the output about its mean.

    Raises
    ------
    NotIdentifiableError
        If no order gives stable dynamics.
    """
    if orders is not None:
        found = [each for each in map(search.refined, orders) if each is not None]
        if not found:
            raise _nothing()
        return min(found, key=lambda each: each.cost)
    best, further = _by_pairs(search.refined, power)
    if best is None:
        raise _nothing()
    fewer = search.refined(best.dynamics.order - 1) if best.dynamics.order > 1 else None
    as_good = fewer is not None and fewer.cost <= _AS_GOOD * best.cost
    return replace(fewer if fewer is not None and as_good else best, further=further)


def _by_pairs(
    refined: Callable[[int], OnGrid | None], power: float
) -> tuple[OnGrid | None, OnGrid | None]:
    """Give the best, and what a pair more gave, which did not pay behind so coarse a grid."""
    best: OnGrid | None = None
    further: OnGrid | None = None
    idle = 0
    for order in range(2, LARGEST_ORDER + 1, 2):
        found = refined(order)
        if found is not None and (best is None or found.cost < _PAYS * best.cost):
            best, further, idle = found, None, 0
            continue
        idle += 1
        further = further or found
        if best is not None and (best.cost < _MUCH * power or idle == 2):
            break
    return best, further


def _nothing() -> NotIdentifiableError:
    return NotIdentifiableError(
        "no stable linear dynamics behind plays describe the output; drive more frequencies, or "
        "take out a drift: unstable or integrating dynamics are not identified"
    )
