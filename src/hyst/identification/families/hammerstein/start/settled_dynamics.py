"""Order, delay and feedthrough of the dynamics once more, behind the hysteresis that was found.

Behind plays on a grid a coarse hysteresis is made up for by a delay or a pole. Behind a fitted one
the drive of the dynamics is known, and what is left tells how many numbers it pays for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.start.at_full_rate import Dynamic
from hyst.identification.families.hammerstein.start.grid_front import OnGrid, refined_on_grid
from hyst.identification.families.hammerstein.start.order_search import LARGEST_ORDER, Search
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

_ITERATIONS = 8
_FARTHEST = 12  # samples of delay
_UNSURE, _MOST_NEAR = 1.1, 3  # times the squared error: a hysteresis fitted with them moves it
_HOPELESS = 4.0  # times the squared error: no hysteresis makes up for as much
_MEANT = 2  # samples by which feedthrough may make up for a delay that is too long
_LAGS = 100  # of the residual, for how many samples of it are worth one
ROUNDING = 1e-14
"""Of the output's power: less is nothing."""


@dataclass(frozen=True, eq=False)
class Tried:
    """Dynamics behind a known drive, and what they leave.

    Parameters
    ----------
    dynamics
        Refined, of gain 1 at rest.
    cost
        Mean squared error.
    numbers
        How many of G are free: 2 for each pole, one more with feedthrough, less the gain.
    errors
        Shape (samples,), what is left.
    """

    dynamics: LinearDynamics
    cost: float
    numbers: int
    errors: Array


@dataclass(frozen=True, eq=False)
class Settled:
    """What pays, and what pays nearly as well behind this very hysteresis.

    Parameters
    ----------
    best
        Dynamics.
    near
        Others, which a hysteresis fitted with them may prefer.
    """

    best: Tried
    near: tuple[LinearDynamics, ...]


def settled_dynamics(
    data: Data,
    hysteresis: Callable[[Array], Array],
    dynamics: LinearDynamics,
    delay: int | None,
    steps: Sequence[int] = (),
) -> Settled:
    """Give the dynamics that pay behind a known hysteresis: order, delay, feedthrough.

    Parameters
    ----------
    data
        The records.
    hysteresis
        As it was fitted.
    dynamics
        As they were fitted with it.
    delay
        Samples, where it is known.
    steps
        How many states more or fewer are tried, too.
    """
    behind = driven_by(data, hysteresis)
    nearest = _at_best_delay(behind, dynamics, delay)
    tried = [nearest, *_without_feedthrough(behind, nearest.dynamics, delay)]
    if steps:
        tried += _of_other_orders(behind, [dynamics.order + each for each in steps], delay)
    tried = [each for each in tried if np.isfinite(each.cost)] or [nearest]
    worth = samples_worth(min(tried, key=lambda each: each.cost).errors)
    floor = ROUNDING * float(behind.measured().var())
    prices = [price(each.cost, each.numbers, worth, floor) for each in tried]
    order = np.argsort(prices, kind="stable")
    best, rest = tried[order[0]], [tried[i] for i in order[1:]]
    alike = [each for each in rest if each.cost <= _UNSURE * best.cost]
    low = [each for each in rest if each.dynamics.order < best.dynamics.order]
    fewer = [each for each in low if each.cost <= _HOPELESS * best.cost]
    near = [*_unlike(best, alike)[:_MOST_NEAR], *_first_of_each_order(fewer)]
    return Settled(best, tuple(each.dynamics for each in near))


def _first_of_each_order(tried: Sequence[Tried]) -> list[Tried]:
    found: dict[int, Tried] = {}
    for each in tried:
        found.setdefault(each.dynamics.order, each)
    return list(found.values())


def _unlike(best: Tried, tried: Sequence[Tried]) -> list[Tried]:
    """Give the first of each kind that is not that of the best."""
    kinds = {numbers_of(best.dynamics)}
    found = []
    for each in tried:
        if numbers_of(each.dynamics) not in kinds:
            kinds.add(numbers_of(each.dynamics))
            found.append(each)
    return found


def numbers_of(dynamics: LinearDynamics) -> tuple[int, int, bool]:
    """Give what whole numbers dynamics have: order, delay, and whether they have feedthrough.

    Parameters
    ----------
    dynamics
        Any.
    """
    return dynamics.order, dynamics.delay, dynamics.D != 0.0


def simpler(dynamics: LinearDynamics, delay: int | None) -> Iterable[LinearDynamics]:
    """Give the same dynamics without feedthrough, at delays of which one is meant by it.

    Parameters
    ----------
    dynamics
        With feedthrough, or there are none.
    delay
        Samples, where it is known.
    """
    if dynamics.D == 0.0:
        return
    last = dynamics.delay
    for each in range(max(last - _MEANT, 0), last + 1) if delay is None else (delay,):
        moved = _delayed(dynamics, each)
        yield LinearDynamics(moved.A, moved.B, moved.C, 0.0, moved.dt, each)


def driven_by(data: Data, hysteresis: Callable[[Array], Array]) -> Data:
    """Give the records with the output of a hysteresis as their input.

    Parameters
    ----------
    data
        The records.
    hysteresis
        The model.
    """
    records = tuple(replace(each, u=hysteresis(each.u)) for each in data.records)
    spans = [float(np.ptp(each.u)) for each in records]
    return replace(data, records=records, half_range=max(spans) / 2.0, measured_inputs=())


def _of_other_orders(data: Data, orders: Sequence[int], delay: int | None) -> Iterable[Tried]:
    search = Search.of(data, delay)
    for each in orders:
        found = search.refined(each) if 0 < each <= LARGEST_ORDER else None
        if found is not None:
            yield _tried(found, feedthrough=True)
            yield from _without_feedthrough(data, found.dynamics, delay)


def _at_best_delay(data: Data, dynamics: LinearDynamics, delay: int | None) -> Tried:
    """Walk to the delay that leaves the least, sample by sample."""
    if delay is not None:
        return _refined(data, _delayed(dynamics, delay), feedthrough=True)
    known: dict[int, Tried] = {}
    place = dynamics.delay
    for _ in range(_FARTHEST):
        for each in range(max(place - 1, 0), place + 2):
            if each not in known:
                start = known[place].dynamics if place in known else dynamics
                known[each] = _refined(data, _delayed(start, each), feedthrough=True)
        best = min(known, key=lambda each: known[each].cost)
        if best == place:
            break
        place = best
    return known[place]


def _delayed(dynamics: LinearDynamics, delay: int) -> LinearDynamics:
    G = dynamics
    return LinearDynamics(G.A, G.B, G.C, G.D, G.dt, delay)


def _without_feedthrough(
    data: Data, dynamics: LinearDynamics, delay: int | None
) -> Iterable[Tried]:
    last = dynamics.delay
    for each in range(max(last - 1, 0), last + 1) if delay is None else (delay,):
        moved = LinearDynamics(dynamics.A, dynamics.B, dynamics.C, 0.0, dynamics.dt, each)
        yield _refined(data, moved, feedthrough=False)


def _refined(data: Data, dynamics: LinearDynamics, feedthrough: bool) -> Tried:
    start = Dynamic(dynamics, np.ones(1), np.inf)
    return _tried(refined_on_grid(data, np.empty(0), start, feedthrough, _ITERATIONS), feedthrough)


def _tried(found: OnGrid, feedthrough: bool) -> Tried:
    numbers = 2 * found.dynamics.order + int(feedthrough) - 1
    return Tried(found.dynamics, found.cost, numbers, found.errors)


def samples_worth(errors: Array) -> float:
    """Give how many independent samples what is left is worth.

    Parameters
    ----------
    errors
        Shape (samples,).
    """
    errors = errors - errors.mean()
    power = float(errors @ errors)
    if power <= 0.0:
        return float(errors.size)
    most = min(_LAGS, errors.size // 4)
    shares = [float(errors[lag:] @ errors[:-lag]) / power for lag in range(1, most + 1)]
    alike = float(np.square(shares).sum())
    return errors.size / (1.0 + 2.0 * alike)


def price(cost: float, numbers: int, worth: float, floor: float) -> float:
    """Give the Bayesian information criterion over samples that are worth one.

    Parameters
    ----------
    cost
        Mean squared error.
    numbers
        That are free.
    worth
        Independent samples.
    floor
        Of the mean squared error: rounding.
    """
    return worth * float(np.log(cost + floor)) + numbers * float(np.log(worth))
