"""The best estimate of all that was measured, what else fits as well, and whether anything fits."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, ndtr

from hyst.online.joint.bands.intervals import RISE, covariance_of_minimum
from hyst.online.joint.bands.refit import Minimum, Problem, minimum_from
from hyst.online.joint.bands.samples import FoldedSamples
from hyst.online.joint.bands.starts import grid_of, relocations, scattered, starts_on_grid
from hyst.online.joint.parts import Parts

Array = NDArray[np.float64]

CHANCE = 1e-3
"""Of doubting errors that are noise."""

_BINS = 32
_FEWEST = 20
_MOST_MINIMA = 60
_ROUNDS = 3
_HOPELESS = 200.0
_SCATTERED, _FEW_ROWS = 48, 300


@dataclass(frozen=True, eq=False)
class Found:
    """What least squares over folded samples found.

    Parameters
    ----------
    problem
        What was fitted.
    minima
        The best one first, then others that the data do not tell from it.
    misfit
        Chance that errors of noise lie as far from it as these.
    """

    problem: Problem
    minima: tuple[Minimum, ...]
    misfit: float

    def nearest_to(self, start: Array) -> Minimum:
        """Give the minimum nearest to ``start`` of those that the data do not tell apart."""
        free = self.problem.free
        spread = np.sqrt(self.problem.limit[free])

        def distance(minimum: Minimum) -> float:
            return float(np.linalg.norm((minimum.theta - start)[free] / spread))

        return min(self.minima, key=distance)


def found_in(
    parts: Parts,
    samples: FoldedSamples,
    pages: tuple[FoldedSamples, ...],
    theta: Array,
    limit: Array,
    bounds: tuple[float, float, float],
    floor: float,
) -> Found | None:
    """Fit a model to folded samples.

    Parameters
    ----------
    parts
        The model.
    samples
        Folded.
    pages
        The same in parts, younger and older, which a plant that has changed answers differently.
    theta
        Shape (m,), the running estimate.
    limit
        Shape (m,), variances of the start; 0 holds a parameter.
    bounds
        Least and most cumulative weight, most radius.
    floor
        Least variance of the noise.

    Returns
    -------
    Found or None
        None where there are too few samples.
    """
    total, m = float(samples.count.sum()), int((limit > 0.0).sum())
    if total < _FEWEST + 2 * m or samples.y.size < 2:
        return None
    first = Problem(parts, samples, 1.0, limit, bounds)
    left = minimum_from(first, theta).chi_square / max(samples.y.size - m, 1)
    within = _noise_within(pages)
    noise = within if np.isfinite(within) else left
    problem = Problem(parts, samples, max(noise, floor), limit, bounds)
    kept = _minima(problem, theta)
    if not np.isfinite(within):
        noise = kept[0].chi_square * problem.noise / max(samples.y.size - m, 1)
        problem = Problem(parts, samples, max(noise, floor), limit, bounds)
        kept = [minimum_from(problem, each.theta) for each in kept]
    misfit = misfit_of(problem, kept[0], pages)
    excess = kept[0].chi_square / max(samples.y.size - m, 1)
    if misfit < CHANCE and excess > 1.0:
        # What is no noise is at least counted like it.
        problem = replace(problem, noise=problem.noise * excess)
        kept = [
            Minimum(each.theta, each.chi_square / excess, each.information / excess)
            for each in kept
        ]
    most = kept[0].chi_square + RISE
    near = tuple(each for each in kept if each.chi_square <= most)[:_MOST_MINIMA]
    return Found(problem, near, misfit)


def _noise_within(pages: tuple[FoldedSamples, ...]) -> float:
    """Give the variance within rows, NaN where there are too few samples."""
    told = [each for each in pages if np.isfinite(each.noise)]
    freedom = sum(each.freedom for each in told)
    return sum(each.freedom * each.noise for each in told) / freedom if told else float("nan")


def _minima(problem: Problem, theta: Array) -> list[Minimum]:
    """Give the different minima that the starts lead to, the best one first."""
    grid = grid_of(problem)
    kept: list[Minimum] = []
    if grid is None:
        _keep(problem, kept, [theta])
        return kept
    _keep(problem, kept, [theta, *starts_on_grid(problem, grid, theta)])
    for _ in range(_ROUNDS):
        before = kept[0].chi_square
        _keep(problem, kept, relocations(problem, grid, kept[0].theta))
        if kept[0].chi_square > before - 1.0:
            break
    if _is_flat(problem, kept[0]):
        count = _SCATTERED if problem.samples.y.size <= _FEW_ROWS else _SCATTERED // 3
        _keep(problem, kept, scattered(problem, grid, kept[0].theta, count))
    return kept


def _is_flat(problem: Problem, minimum: Minimum) -> bool:
    """Whether something is not determined by the samples near a minimum."""
    variance = np.diag(covariance_of_minimum(problem, minimum))[problem.free]
    return bool((variance > 0.25 * problem.limit[problem.free]).any())


def _keep(problem: Problem, kept: list[Minimum], starts: list[Array]) -> None:
    for start in starts:
        hopeless = kept[0].chi_square + _HOPELESS if kept else np.inf
        found = minimum_from(problem, start, hopeless=hopeless)
        if all(_apart(found, other) for other in kept):
            kept.append(found)
            kept.sort(key=lambda each: each.chi_square)


def _apart(one: Minimum, other: Minimum) -> bool:
    way = one.theta - other.theta
    return bool(way @ (one.information + other.information) @ way > 0.2)


def misfit_of(problem: Problem, minimum: Minimum, pages: tuple[FoldedSamples, ...]) -> float:
    """Give the chance that noise leaves sums of errors as large.

    Errors are summed over stretches of the input, rising and falling, older and younger ones apart:
    noise cancels in these sums, a wrong model does not. Besides, over all rows, each a mean.

    Parameters
    ----------
    problem, minimum
        What was fitted, and where.
    pages
        The samples in parts.

    Returns
    -------
    float
        Between 0 and 1.
    """
    m = int(problem.free.sum())
    freedom = sum(each.freedom for each in pages if np.isfinite(each.noise))
    chances = []
    rows = problem.samples.y.size - m
    if rows > 1 and freedom > 0.0:
        chances.append(_chance(minimum.chi_square, rows, freedom))
    sums = [_stretches(problem, minimum, each) for each in pages if each.y.size]
    found = np.concatenate(sums) if sums else np.zeros(0)
    if found.size > m:
        # The fit has taken at most as many as there are parameters.
        chances.append(_chance(float(found @ found), found.size - m // 2, freedom))
    return min([1.0, *(len(chances) * each for each in chances)])


def _stretches(problem: Problem, minimum: Minimum, page: FoldedSamples) -> Array:
    """Give sums of errors over stretches of the input, over the deviations noise gives them."""
    error, _ = replace(problem, samples=page).residual(minimum.theta)
    u = page.way[-1]
    rising = u > page.way[-2] if page.way.shape[0] > 1 else u > np.median(u)
    edges = np.quantile(u, np.linspace(0.0, 1.0, _BINS + 1)[1:-1])
    bins = np.searchsorted(edges, u) + _BINS * rising
    sums = np.bincount(bins, error * np.sqrt(page.count), 2 * _BINS)
    counts = np.bincount(bins, page.count, 2 * _BINS)
    return np.asarray(sums[counts > 0] / np.sqrt(counts[counts > 0]))


def _chance(square: float, freedom: float, of_noise: float) -> float:
    if of_noise <= 0.0:
        return float(chdtrc(freedom, square))
    # The noise is itself known from so many samples only.
    spread = np.sqrt(2.0 * freedom + 2.0 * freedom**2 / of_noise)
    wide = float(ndtr((freedom - square) / spread))
    return max(float(chdtrc(freedom, square)), wide)
