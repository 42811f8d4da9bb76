"""Weights of the uncertainty of a plant as covers of what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import as_positive, whole_number
from hyst.control.linear_system import LinearSystem
from hyst.control.plants.identified import IdentifiedPlant
from hyst.control.uncertainty.cover import Cover, Target, tightest
from hyst.control.uncertainty.left_unknown import shown_deviations
from hyst.control.uncertainty.responses import (
    Deviations,
    deviations_of,
    nominal_plant,
    response_at,
    sample_time,
)
from hyst.control.uncertainty.spectral_factor import spectral_factor
from hyst.errors import InputError, SolverError

Array = NDArray[np.float64]

MOST = 8
"""Highest order of a cover."""

TIGHT = 1.5
"""Excess with which no higher order is tried."""

_WORTH_AN_ORDER = 0.85  # of the excess before, for one order more
_MORE_ORDERS = 2  # that are tried beyond the last that was worth it: a resonance takes two
_POINTS = 300  # that a linear program takes; of more, the largest of each of so many bins
_DIP = 2.0**0.25  # on either side of what is narrow
_REPEATS, _BETWEEN = 8, 6
_BESIDE = np.array([-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0])  # widths of a dip
_WIDE = 1.1  # ratio of neighbouring frequencies from which there are points between


@final
@dataclass(frozen=True, eq=False)
class UncertaintyWeight:
    """A cover of ``|P / Pn - 1|``, as ``uncertainty_weight`` gives it; a system wherever one goes.

    Parameters
    ----------
    system
        W, stable and of minimum phase; sampled if the nominal plant is, and then up to half the
        sample rate.
    excess
        Largest ratio of ``|W|`` to the samples, of which dips narrower than half an octave are
        filled: no plant is known better there than beside them.
    w
        Shape (p,), rad/s.
    radius
        Shape (p,), the largest ``|P / Pn - 1|`` at each, at least ``least``.
    """

    system: LinearSystem
    excess: float
    w: Array
    radius: Array

    @property
    def order(self) -> int:
        """Number of states of W."""
        return self.system.order

    @property
    def gain(self) -> Array:
        """Shape (p,), ``|W|`` at the samples."""
        return np.abs(response_at(self.system, self.w))


def uncertainty_weight(
    nominal: Any,
    responses: Sequence[Any],
    order: int | None = None,
    *,
    least: float = 0.01,
    w: ArrayLike | None = None,
    matched_at: float | None = None,
    identified: IdentifiedPlant | None = None,
) -> UncertaintyWeight:
    r"""Find the weight of least order that covers how far measured plants are from the nominal one.

    ``|W(jw)| >= |P_i(jw) / Pn(jw) - 1|`` for every sample of every response, with the least excess.

    Parameters
    ----------
    nominal
        Pn: a system as ``as_linear_system`` takes it, or a ``ContinuousDynamics`` with dead time.
    responses
        Of several plants, days, loads or amplitudes: ``hyst.read_frequency_response``, identified
        responses, ``frd`` of python-control, pairs (w, G) with w in rad/s and complex G, or
        systems. Samples above half the sample rate of a sampled nominal plant are left out.
    order
        Of W at most, 0 to 8; None: the least that exceeds the samples by no more than half, or else
        that beyond which an order takes less than a seventh off the excess.
    least
        Least deviation that is asked of W, > 0: no plant is known better.
    w
        Frequencies at which systems are compared, rad/s; a grid about their poles if left out.
    matched_at
        Frequency, Hz, at which each response is given the gain of the nominal plant, for the gain
        of a hysteresis in front is no part of the plant; None: as they are.
    identified
        The nominal plant's identification, whose standard errors the weight bears, too, in the
        bands that the drive showed.

    Returns
    -------
    UncertaintyWeight
        Between two samples of a response it covers the straight line between them, in logarithms.
        Below the first and above the last it does not fall; whatever else is there it cannot know.

    Raises
    ------
    InputError
        If a plant or response cannot be read, the nominal plant is 0 at a sample, or an argument is
        out of its range.
    SolverError
        If the linear programs fail.

    Examples
    --------
    The second mode that a plant has beside the one it is designed for:

    >>> one = ([1.0], [1.0, 1.0, 1.0])
    >>> two = ([25.0], np.polymul([1.0, 1.0, 1.0], [1.0, 1.0, 25.0]))
    >>> found = uncertainty_weight(one, [two])
    >>> found.order, bool(np.all(found.gain >= found.radius)), found.excess < 1.5
    (2, True, True)
    """
    plant = nominal_plant(nominal)
    found = deviations_of(plant, responses, w, matched_at)
    if identified is not None:
        found += shown_deviations(identified)
    return cover_of(found, sample_time(plant), order, least)


def cover_of(
    deviations: Sequence[Deviations],
    dt: float,
    order: int | None,
    least: float,
    tight: float = TIGHT,
) -> UncertaintyWeight:
    """Cover samples of ``|P / Pn - 1|``.

    Parameters
    ----------
    deviations
        Of each plant.
    dt
        Sample time of the weight, s; 0 of a continuous one.
    order, least
        As for ``uncertainty_weight``.
    tight
        Excess with which no higher order is tried.

    Returns
    -------
    UncertaintyWeight
    """
    smallest = as_positive(least, "least", "the least deviation that is asked")
    wanted = None if order is None else whole_number(order, "order", 0, MOST)
    w, radius, judged = envelope(deviations, smallest)
    limit = np.where(judged, without_dips(w, radius), np.inf)
    x = np.square(np.tan(np.minimum(0.5 * w * dt, 0.5 * np.pi)) if dt else w)
    x[x > 1e20] = np.inf if dt else x[x > 1e20]
    whole = Target(x, radius, limit)
    few = _thinned(whole)
    for _ in range(_REPEATS):
        cover = _of_order(few, wanted) if wanted is not None else _of_least_order(few, tight)
        whole = _with_dips(whole, cover)
        missed = _missed(cover, whole)
        if not missed.any():
            break
        few = _with(few, whole, missed)
        wanted = cover.order  # what was left out adds points, no other question
    return _made(cover, w, radius, limit, dt, _short(cover, _with_dips(whole, cover)))


def envelope(
    deviations: Sequence[Deviations], least: float
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Give the largest deviation at every frequency at which any plant was measured.

    Parameters
    ----------
    deviations
        Of each plant; between its samples along straight lines in logarithms.
    least
        Least deviation that is asked.

    Returns
    -------
    w, radius, judged : numpy.ndarray
        Shape (p,); points between samples that are far apart are not judged.
    """
    measured = np.unique(np.concatenate([each.w for each in deviations]))
    wide = np.flatnonzero(measured[1:] > _WIDE * measured[:-1])
    wide = wide[measured[wide] > 0.0]
    between = []
    for k in wide:
        low, high = measured[k], measured[k + 1]
        between.append(np.geomspace(low, high, int(np.log(high / low) / np.log(_WIDE)) + 2)[1:-1])
    w = np.union1d(measured, np.concatenate([np.zeros(0), *between]))
    largest = np.zeros(w.size)
    for each in deviations:
        inside = (w >= each.w[0]) & (w <= each.w[-1])
        at, tiny = np.maximum(each.w, np.finfo(float).tiny), np.finfo(float).tiny
        values = np.log(np.maximum(each.radius, least))
        line = np.interp(np.log(np.maximum(w[inside], tiny)), np.log(at), values)
        largest[inside] = np.maximum(largest[inside], np.exp(line))
        # Logarithm and exponential round: at a sample it is the sample.
        place = np.searchsorted(w, each.w)
        np.maximum.at(largest, place, each.radius)
    return w, np.maximum(largest, least), np.isin(w, measured)


def without_dips(w: Array, radius: Array) -> Array:
    """Fill dips narrower than half an octave: the closing of the samples over ``ln w``.

    Parameters
    ----------
    w
        Shape (p,), rad/s, ascending.
    radius
        Shape (p,).

    Returns
    -------
    numpy.ndarray
        Shape (p,), nowhere below the radius; slopes and peaks stay as they are.
    """
    first = np.searchsorted(w, w / _DIP, side="left")
    last = np.searchsorted(w, w * _DIP, side="right")
    ends = list(zip(first, last, strict=True))
    widened = np.array([radius[start:stop].max() for start, stop in ends])
    return np.array([widened[start:stop].min() for start, stop in ends])


def _of_least_order(target: Target, enough: float) -> Cover:
    """Give the first cover that is tight enough, or else the last whose order was worth it."""
    best: Cover | None = None
    for order in range(MOST + 1):
        tight = tightest(target, order, enough)
        if tight is not None:
            return tight
        found = tightest(target, order)
        if best is None or (found is not None and _is_worth(found, best)):
            best = found
        if best is not None and order >= best.order + _MORE_ORDERS:
            break
    if best is None:
        raise SolverError("no cover was found; give fewer samples, or an order")
    return best


def _is_worth(found: Cover, best: Cover) -> bool:
    """Tell whether every further order pays: noise is covered a little better by each."""
    return found.excess < best.excess * _WORTH_AN_ORDER ** (found.order - best.order)


def _of_order(target: Target, order: int) -> Cover:
    """Give the tightest cover of an order, or of the next below where rounding leaves none."""
    for each in range(order, -1, -1):
        found = tightest(target, each)
        if found is not None:
            return found
    raise SolverError(f"no cover of order {order} was found; give another order")


def _thinned(target: Target) -> Target:
    """Keep the largest of each bin where there are many: between them there is noise."""
    if target.x.size <= _POINTS:
        return target
    bins = np.linspace(0, target.x.size, _POINTS + 1).astype(int)[:-1]
    kept = np.zeros(target.x.size, dtype=bool)
    for start, stop in zip(bins, [*bins[1:], target.x.size], strict=True):
        kept[start + int(np.argmax(target.radius[start:stop]))] = True
    kept[[0, -1]] = True
    return Target(target.x[kept], target.radius[kept], target.tight[kept])


def _with_dips(target: Target, cover: Cover) -> Target:
    """Ask at the zeros of a cover as well, which may dip between two samples."""
    roots = cover.roots(cover.above)
    width = np.clip(np.abs(np.angle(roots)), 1e-3, 0.1)
    x = np.unique(np.abs(roots) * np.exp(width * _BESIDE[:, None]))
    inner = target.x[np.isfinite(target.x) & (target.x > 0.0)]
    x = x[(x > inner.min(initial=np.inf)) & (x < inner.max(initial=0.0)) & ~np.isin(x, target.x)]
    if not x.size:
        return target
    known = np.isfinite(target.x) & (target.x > 0.0)
    at = np.log(target.x[known]), np.log(target.radius[known])
    line = np.exp(np.interp(np.log(x), *at))
    return _joined(target, x, line)


def _lines(w: Array, radius: Array) -> tuple[Array, Array]:
    """Give points on the straight lines between samples, in logarithms."""
    known = w > 0.0
    at, values = np.log(w[known]), np.log(radius[known])
    parts = np.arange(1, _BETWEEN)[:, None] / _BETWEEN
    between = (at[:-1] + parts * np.diff(at)).ravel()
    return np.exp(between), np.exp(np.interp(between, at, values))


def _gain2(cover: Cover, x: Array) -> Array:
    basis = np.hstack([np.ones((x.size, 1)), cover.corners / (x[:, None] + cover.corners)])
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((basis @ cover.above) / (basis @ cover.below))


def _missed(cover: Cover, target: Target) -> NDArray[np.bool_]:
    return ~(_gain2(cover, target.x) >= np.square(target.radius) * (1.0 - 1e-6))


def _short(cover: Cover, target: Target) -> float:
    """Factor that the cover lacks at worst, between samples as well."""
    gain2 = _gain2(cover, target.x)
    sound = gain2 > 0.0
    return float(np.sqrt(np.square(target.radius[sound]) / gain2[sound]).max(initial=1.0))


def _with(few: Target, whole: Target, missed: NDArray[np.bool_]) -> Target:
    """Add what is not covered; only to be covered, not to be tight on."""
    return _joined(few, whole.x[missed], whole.radius[missed])


def _joined(target: Target, x: Array, radius: Array) -> Target:
    """Add points that are only to be covered."""
    x, radius = np.concatenate([target.x, x]), np.concatenate([target.radius, radius])
    tight = np.concatenate([target.tight, np.full(x.size - target.x.size, np.inf)])
    order = np.argsort(x, kind="stable")
    return Target(x[order], radius[order], tight[order])


def _made(
    cover: Cover, w: Array, radius: Array, tight: Array, dt: float, between: float
) -> UncertaintyWeight:
    """Give the weight, raised by what it lacks between samples, or by rounding of its factors."""
    made = UncertaintyWeight(spectral_factor(cover, dt), cover.excess, w, radius)
    at, line = _lines(w, radius)
    lacks = line / np.abs(response_at(made.system, at))
    short = max(float((radius / made.gain).max()), float(lacks.max(initial=1.0)), between)
    if not np.isfinite(short):
        raise InputError("the deviations are too large to be covered; leave out what is not finite")
    if short > 1.0:
        factor = short * (1.0 + 1e-12)
        system = made.system
        raised = LinearSystem(system.A, system.B, factor * system.C, factor * system.D, dt)
        made = replace(made, system=raised)
    return replace(made, excess=float((made.gain / tight).max()))
