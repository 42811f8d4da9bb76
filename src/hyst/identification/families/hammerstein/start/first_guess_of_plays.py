"""Dynamics to start the joint fit from, behind plays: no impulse response need be excited."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hyst.errors import NotIdentifiableError
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import (
    behind_operator,
    of_gain_one,
)
from hyst.identification.families.hammerstein.impulse_response.first_guess import FirstDynamics
from hyst.identification.families.hammerstein.known.held_front import HeldFront
from hyst.identification.families.hammerstein.start.at_full_rate import Dynamic
from hyst.identification.families.hammerstein.start.bent_plays import (
    BentPlays,
    BentSearch,
    bent_plays,
)
from hyst.identification.families.hammerstein.start.dense_plays import dense_plays
from hyst.identification.families.hammerstein.start.grid_front import OnGrid, refined_on_grid
from hyst.identification.families.hammerstein.start.order_search import (
    Search,
    Searched,
    on_better_grid,
    search_order,
)
from hyst.identification.families.hammerstein.start.settled_dynamics import (
    ROUNDING,
    Tried,
    numbers_of,
    price,
    samples_worth,
    settled_dynamics,
)
from hyst.identification.families.option import AUTO
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics
from hyst.operators import Affine, Operator
from hyst.operators.composition import leaves_of

_ROUNDS = 4  # of dynamics and hysteresis after each other
_ITERATIONS = 8
ALL, FEWER = (-2, -1, 1, 2), (-2, -1)
"""Steps of the order: a resonance takes two states at once."""

_LITTLE = 3e-4  # of the output's power: the rest of plays may well be noise
_WHITE = 0.9  # of the samples that what is left is worth
_MUCH_LESS = 0.5  # of the squared error of plays
_FAR = 4.0  # times the error of plays: what a line leaves is not looked at closer


@dataclass(frozen=True, eq=False)
class Wanted:
    """What is known of the dynamics before they are found.

    Parameters
    ----------
    state_order
        Number of states, or ``"auto"``.
    delay
        Samples, or None.
    known
        The hysteresis, or None: if it is known it is what drives the dynamics.
    bent
        Whether squares and products of plays are looked at, too.
    """

    state_order: int | str
    delay: int | None
    known: HeldFront | None = None
    bent: bool = False

    @property
    def orders(self) -> tuple[int, ...] | None:
        """Orders to choose from; None for all."""
        return None if self.state_order == AUTO else (int(self.state_order),)

    def search(self, data: Data, plays: bool) -> OnGrid:
        """Search the order behind plays on a grid, behind what is known, or behind a line.

        Parameters
        ----------
        data
            The records.
        plays
            Whether the drive goes through plays; a line otherwise.
        """
        searched: Searched
        if self.bent:
            searched = BentSearch.of(data, self.delay)
        elif self.known is not None:
            searched = Search.of(self.known.behind(data), self.delay)
        elif plays:
            searched = on_better_grid(
                data, self.delay, 2 if self.orders is None else self.orders[0]
            )
        else:
            searched = Search.of(data, self.delay)
        return search_order(searched, self.orders, float(data.measured().var()))

    def hysteresis(self, data: Data, dynamics: LinearDynamics) -> Operator | BentPlays:
        """Give the hysteresis before dynamics: many plays, or what is known.

        Parameters
        ----------
        data, dynamics
            The records, and the dynamics behind it.
        """
        if self.bent:
            return bent_plays(data, dynamics)
        if self.known is None:
            return dense_plays(data, dynamics)
        return self.known.operator.at_sample_time(data.records[0].dt)


def first_dynamics_of_plays(overview: Overview, wanted: Wanted) -> FirstDynamics:
    """Choose delay and order with plays on a grid of radii before the dynamics.

    Parameters
    ----------
    overview
        The records.
    wanted
        What is known.

    Raises
    ------
    NotIdentifiableError
        If no order gives stable dynamics of a gain at rest.
    """
    data = overview.data
    found, wanted = _settled_behind_best(data, wanted)
    hysteresis = wanted.hysteresis(data, found.dynamics)
    if wanted.known is None and not wanted.bent and _is_a_line(data, wanted, found, hysteresis):
        hysteresis = _line_of(data, hysteresis)
    behind = Overview(behind_operator(data, hysteresis), rates_matter=True)
    return FirstDynamics(of_gain_one(found.dynamics), behind, None, found.cost)


def _is_more_than_noise(data: Data, found: Tried) -> bool:
    if found.cost <= _LITTLE * float(data.measured().var()):
        return False
    return samples_worth(found.errors) < _WHITE * found.errors.size


def _settled_behind_best(data: Data, wanted: Wanted) -> tuple[Tried, Wanted]:
    """Find dynamics behind plays; where these leave more than noise, behind bent ones, too."""
    bent = replace(wanted, bent=True)
    try:
        found = _settled(data, wanted)
    except NotIdentifiableError as refusal:
        if wanted.known is not None:
            raise
        try:
            return _settled(data, bent), bent
        except NotIdentifiableError:
            raise refusal from None
    if wanted.known is not None or not _is_more_than_noise(data, found):
        return found, wanted
    try:
        other = _settled(data, bent)
    except NotIdentifiableError:
        return found, wanted
    return (other, bent) if other.cost < _MUCH_LESS * found.cost else (found, wanted)


def _settled(data: Data, wanted: Wanted) -> Tried:
    """Find dynamics and the hysteresis before them after each other, until none changes."""
    grid = wanted.search(data, plays=True)
    dynamics = of_gain_one(grid.dynamics)
    looked = wanted.orders is not None
    found: Tried | None = None
    for _ in range(_ROUNDS):
        hysteresis, before = wanted.hysteresis(data, dynamics), dynamics
        found = settled_dynamics(data, hysteresis, before, wanted.delay).best
        dynamics = found.dynamics
        if numbers_of(dynamics) == numbers_of(before):
            if looked:
                break
            found = _of_best_order(data, wanted, hysteresis, found, grid.further)
            dynamics, looked = found.dynamics, True
    assert found is not None, "there is a round"
    return found


def _of_best_order(
    data: Data,
    wanted: Wanted,
    hysteresis: Operator | BentPlays,
    found: Tried,
    further: OnGrid | None,
) -> Tried:
    """Look at other orders; at fewer states, and a pair more, with the hysteresis of their own.

    A hysteresis fitted before too few states bends until it makes up for some of those that lack.
    """
    settled = settled_dynamics(data, hysteresis, found.dynamics, wanted.delay, ALL)
    best, worth = settled.best, samples_worth(settled.best.errors)
    floor = ROUNDING * float(data.measured().var())
    others = [each for each in settled.near if each.order < best.dynamics.order]
    if further is not None and further.dynamics.order > best.dynamics.order:
        others.append(of_gain_one(further.dynamics))
    for each in others:
        behind = wanted.hysteresis(data, of_gain_one(each))
        other = settled_dynamics(data, behind, each, wanted.delay).best
        of_other, of_best = (price(t.cost, t.numbers, worth, floor) for t in (other, best))
        best = other if of_other <= of_best else best
    return best


def _is_a_line(data: Data, wanted: Wanted, found: Tried, hysteresis: Operator | BentPlays) -> bool:
    """Tell whether a line before dynamics, of another order perhaps, leaves as little as plays."""
    G = found.dynamics
    near = Dynamic(G, np.ones(1), np.inf)
    line = refined_on_grid(data, np.empty(0), near, G.D != 0.0, _ITERATIONS)
    if line.cost > _FAR * found.cost:
        return False
    if wanted.orders is None:
        line = min(line, wanted.search(data, plays=False), key=lambda each: each.cost)
    worth, floor = samples_worth(found.errors), ROUNDING * float(data.measured().var())
    numbers = 2 * found.dynamics.order + _plays_of(hysteresis)
    of_line = price(line.cost, 2 * line.dynamics.order, worth, floor)
    return of_line <= price(found.cost, numbers, worth, floor)


def _plays_of(hysteresis: Operator | BentPlays) -> int:
    """Give the plays that have a weight."""
    if isinstance(hysteresis, BentPlays):
        return int(np.count_nonzero(hysteresis.weights))
    return sum(
        int(np.count_nonzero(getattr(each, "p", np.empty(0)))) for each in leaves_of(hysteresis)
    )


def _line_of(data: Data, hysteresis: Operator | BentPlays) -> Operator:
    """Give the least squares line of a hysteresis."""
    u = data.inputs()
    v = data.joined([hysteresis(r.u)[w] for r, w in zip(data.records, data.windows(), strict=True)])
    slope, offset = np.polyfit(u, v, 1)
    return Affine(float(slope), float(offset))
