"""Which delays records leave possible: the profile of a cost, read with its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.costs_by_record import CostsByRecord
from hyst.diagnosis.delay_costs import DelayCosts

Array = NDArray[np.float64]
Costs = DelayCosts | CostsByRecord

_CHI_SQUARED = 3.841
"""95 % of a squared normal deviate."""

_DEVIATIONS = 1.645
"""95 % of a normal deviate on one side: another delay can only be worse than the best."""

_BLOCK = 8
_BEYOND = 30.0
"""A cost so many times the least is not possible, and its uncertainty need not be known."""

_MISFIT_OF_LAG, _MISFIT_OF_LEAD = 1.5, 3.0
"""How many times the misfit of the best delay another one may add and still be possible: where the
loops tried do not describe a record, its shape is taken for a delay. No actuator leads its input,
so a lead needs more."""

_FEWEST_STEPS, _FINEST_STEP = 48, 0.25
_RESOLUTION = 2e-4
"""rms in parts of the outputs' range that columns so far apart may leave of any loop."""

_BETWEEN_SAMPLES = 0.1
"""Samples by which the interval is widened: where between two samples the input turned, and how
the loop bends there, no record tells."""
_ALIKE = 0.05
"""By which a residual's rms may exceed the noise, as a part of it, and still be called noise."""

_UNSURE = 1.5
"""Standard deviations of a noise measured by n samples, times the square root of n."""


@dataclass(frozen=True, eq=False)
class CompatibleDelays:
    """What a search found, delays in samples of the first record.

    Parameters
    ----------
    best
        Of the least cost, to the quarter of a sample.
    low, high
        Ends of the interval.
    describes
        Whether what the best delay leaves is the noise.
    residual
        rms, in parts of the outputs' range.
    """

    best: float
    low: float
    high: float
    describes: bool
    residual: float


def compatible_delays(costs: Costs, longest: int, noise: float) -> CompatibleDelays:
    """Search delays from ``-longest`` to ``longest``, ever finer about the best and the ends.

    A delay d stays possible while

        J(d) - J(best) <= max(3.84 s^2 n / n_eff, 1.645 sd(e_d^2 - e_best^2)) + misfit,

    J the sum of squares left, s^2 n / n_eff the residual's variance with its correlation counted,
    sd that of the paired differences, and misfit what the best delay leaves beyond noise: as much
    may pass for a delay.

    Parameters
    ----------
    costs
        Of the records.
    longest
        Samples of the first record, >= 1.
    noise
        rms in parts of the outputs' range.
    """
    step = float(-(-2 * longest // _FEWEST_STEPS))
    tried = {0.0, *np.arange(-longest, longest + 1, step).tolist(), float(longest)}
    profile = _Profile.of(costs, tried, noise)
    while step > _FINEST_STEP:
        finer = step / (4.0 if step >= 4.0 else 2.0)
        low, high = profile.ends()
        wide = high - low > 16.0 * step
        middles = [profile.best] if wide else [profile.best, low, high]
        near = {
            round((m + i * finer) / _FINEST_STEP) * _FINEST_STEP
            for m in middles
            for i in range(-4, 5)
            if abs(i * finer) < step and abs(m + i * finer) <= longest
        }
        tried, step = tried | near, finer
        profile = _Profile.of(costs, tried, noise)
    low, high = profile.ends()
    low, high = max(low - _BETWEEN_SAMPLES, -longest), min(high + _BETWEEN_SAMPLES, longest)
    residual = float(np.sqrt(costs.cost(profile.best) / costs.rows))
    return CompatibleDelays(profile.best, low, high, profile.describes, residual)


def lowest_between(costs: Costs, about: float, plain: bool) -> float:
    """Refine a delay by smaller steps, and by the parabola through the costs beside it at last.

    Parameters
    ----------
    costs
        Of the records.
    about
        Where to begin, samples.
    plain
        Whether of plays and a map after them alone.
    """
    h = _FINEST_STEP
    for _ in range(2):
        h /= 2.0
        about = min((about, about - h, about + h), key=lambda d: costs.cost(d, plain))
    before, here, after = (costs.cost(about + i * h, plain) for i in (-1, 0, 1))
    bend = before - 2.0 * here + after
    if bend <= 0.0:
        return about
    return about + h * float(np.clip(0.5 * (before - after) / bend, -1.0, 1.0))


@dataclass(frozen=True, eq=False)
class _Profile:
    """Delays tried, ascending, with their cost above the least as part of what is allowed."""

    delays: Array
    above: Array
    best: float
    describes: bool

    @classmethod
    def of(cls, costs: Costs, tried: set[float], noise: float) -> _Profile:
        delays = np.array(sorted(tried))
        cost = np.array([costs.cost(d) for d in delays])
        place = int(cost.argmin())
        best, e = float(delays[place]), costs.left(float(delays[place]))
        misfit, describes = _misfit(e, noise)
        likely = max(_CHI_SQUARED * cost[place] / _effective(e), e.size * _RESOLUTION**2)
        allowed = np.full(delays.size, likely)
        for i in np.flatnonzero((cost > cost[place] + likely) & (cost < _BEYOND * cost[place])):
            allowed[i] = max(likely, _paired(costs.left(float(delays[i])), e))
        leading = (best < 0.0) & (delays > best)
        allowed = allowed + misfit * np.where(leading, _MISFIT_OF_LEAD, _MISFIT_OF_LAG)
        return cls(delays, (cost - cost[place]) / allowed, best, describes)

    def ends(self) -> tuple[float, float]:
        """Give the ends of what is possible, by lines between what was tried."""
        inside = np.flatnonzero(self.above <= 1.0)
        return self._end(int(inside[0]), -1), self._end(int(inside[-1]), 1)

    def _end(self, last: int, step: int) -> float:
        beyond = last + step
        if not 0 <= beyond < self.delays.size:
            return float(self.delays[last])
        share = (1.0 - self.above[last]) / (self.above[beyond] - self.above[last])
        return float(self.delays[last] + share * (self.delays[beyond] - self.delays[last]))


def _misfit(e: Array, noise: float) -> tuple[float, bool]:
    """Give the squares beyond noise, and whether there are hardly any.

    Counted two ways: beyond the noise that is known, and what means of a few successive residuals
    hold beyond what independent ones would, one standard deviation of it granted.
    """
    total = float(e @ e)
    most = (1.0 + _ALIKE + _UNSURE / np.sqrt(e.size)) ** 2 * e.size * noise**2
    count = e.size // _BLOCK
    slow = 0.0
    if count >= 2:
        blocks = e[: count * _BLOCK].reshape(count, _BLOCK)
        means = blocks.mean(axis=1)
        within = float(((blocks - means[:, None]) ** 2).sum()) / (count * (_BLOCK - 1))
        slow = _BLOCK * float(means @ means) - within * (count + np.sqrt(2.0 * count))
    describes = total <= most + e.size * _RESOLUTION**2
    return max(total - most, slow, 0.0), bool(describes)


def _effective(e: Array) -> float:
    """Give the number of independent residuals that would tell as much."""
    n = e.size
    power = np.abs(np.fft.rfft(e - e.mean(), 2 * n)) ** 2
    correlation = np.fft.irfft(power)[: n // 3]
    if correlation.size < 2 or correlation[0] <= 0.0:
        return float(n)
    correlation = correlation / correlation[0]
    small = np.flatnonzero(correlation < 0.05)
    stop = int(small[0]) if small.size else correlation.size
    return n / max(1.0, 1.0 + 2.0 * float(correlation[1:stop].sum()))


def _paired(e: Array, best: Array) -> float:
    """Give 1.645 standard deviations of the difference of two sums of squares."""
    difference = e**2 - best**2
    n = difference.size
    return _DEVIATIONS * n * float(np.sqrt(difference.var() / _effective(difference)))
