"""What an estimate knows, from least squares over all that was measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.online.joint.bands.found import CHANCE, Found
from hyst.online.joint.bands.intervals import covariance_of_minimum, interval_of
from hyst.online.joint.bands.shown import fits_of_fewer
from hyst.online.knowledge import Knowledge

Array = NDArray[np.float64]

_NEGLIGIBLE = 1e-4
_TOO_FEW = "the input has turned too seldom, or too few samples came since"


def knowledge_of(names: tuple[str, ...], theta: Array, found: Found | None) -> Knowledge:
    """Say what is known.

    Parameters
    ----------
    names
        Of the m parameters.
    theta
        Shape (m,), the running estimate.
    found
        What least squares found, or None for nothing.

    Returns
    -------
    Knowledge
    """
    m = theta.size
    if found is None:
        nothing = np.full(m, np.inf)
        none = np.zeros(m, dtype=bool)
        return Knowledge(names, -nothing, nothing, none, (_TOO_FEW,) * m, (_TOO_FEW,), (_TOO_FEW,))
    low, high, determined = theta.copy(), theta.copy(), np.ones(m, dtype=bool)
    reasons = [""] * m
    for j in np.flatnonzero(found.problem.free):
        low[j], high[j], determined[j], reasons[j] = _of_one(found, int(j))
    _hide_plays(found, low, high, determined, reasons)
    doubts = _doubts(found)
    sentences = (*doubts, *_about_estimate(names, theta, low, high, found))
    return Knowledge(names, low, high, determined, tuple(reasons), sentences, doubts)


def _of_one(found: Found, j: int) -> tuple[float, float, bool, str]:
    problem, best = found.problem, found.minima[0]
    covariance = covariance_of_minimum(problem, best)
    low, high, quadratic = interval_of(problem, best, covariance, j, best.chi_square)
    several = False
    values = [each.theta[j] for each in found.minima]
    lowest, highest = min(values), max(values)
    for other in found.minima[1:]:
        # Profiles of each would be too slow; those of the outermost do.
        is_outermost = other.theta[j] in (lowest, highest)
        if is_outermost and not low <= other.theta[j] <= high:
            more = interval_of(
                problem, other, covariance_of_minimum(problem, other), j, best.chi_square
            )
            several = several or more[0] > high or more[1] < low
            low, high = min(low, more[0]), max(high, more[1])
    deviation = float(np.sqrt(covariance[j, j]))
    # Data that tell less than the start was believed to do not determine it.
    is_own = deviation < float(np.sqrt(problem.limit[j]))
    if is_own and not several and (quadratic or high - low < 6.0 * deviation):
        return low, high, True, ""
    if several:
        return low, high, False, "several sets of plays fit the samples alike"
    if np.isfinite(low) and np.isfinite(high):
        return low, high, False, f"the samples leave it between {low:.4g} and {high:.4g}"
    return low, high, False, "the samples do not tell it from the others"


def _hide_plays(
    found: Found, low: Array, high: Array, determined: NDArray[np.bool_], reasons: list[str]
) -> None:
    """Call nothing determined that fits of fewer plays, which are as good, have elsewhere."""
    n = found.problem.parts.pi.p.size
    for fewer, fit in enumerate(fits_of_fewer(found.problem, found.minima[0]), 1):
        reason = f"{n - fewer} of {n} plays fit the samples as well"
        width = 2.0 * np.sqrt(np.diag(covariance_of_minimum(found.problem, fit)))
        for j in np.flatnonzero(found.problem.free).tolist():
            if not 1 <= j <= 2 * n:
                low[j] = min(low[j], fit.theta[j] - width[j])
                high[j] = max(high[j], fit.theta[j] + width[j])
            elif (j - 1) % n >= n - fewer or not low[j] <= fit.theta[j] <= high[j]:
                reasons[j] = reasons[j] if not determined[j] else reason
                determined[j] = False


def _doubts(found: Found) -> tuple[str, ...]:
    problem, best = found.problem, found.minima[0]
    n = problem.parts.pi.p.size
    loop = 2.0 * float(np.abs(best.theta[1 : n + 1]) @ best.theta[n + 1 : 2 * n + 1])
    rms = float(np.sqrt(best.chi_square * problem.noise / problem.samples.count.sum()))
    if found.misfit >= CHANCE or rms <= _NEGLIGIBLE * loop:
        return ()
    return (
        f"what the best model of {n} plays leaves is not noise (chance {found.misfit:.1g}), so the "
        "plant is no such model, or has changed, and the bands are too narrow",
    )


def _about_estimate(
    names: tuple[str, ...], theta: Array, low: Array, high: Array, found: Found
) -> list[str]:
    error, _ = found.problem.residual(theta)
    rise = float(error @ error) - found.minima[0].chi_square
    outside = [
        name
        for name, value, least, most in zip(names, theta, low, high, strict=True)
        if not least <= value <= most
    ]
    if not outside or rise < 1.0:
        return []
    return [
        f"the running estimate has {', '.join(outside)} outside these bands, where a better fit "
        "lies"
    ]
