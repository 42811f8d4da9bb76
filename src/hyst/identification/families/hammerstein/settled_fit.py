"""Order, delay and feedthrough once more, each with a hysteresis of the family fitted with it.

Behind plays the dynamics make up for what plays cannot do, and a family in front that is fitted
with such dynamics makes up for them in turn. So fewer states are judged with a hysteresis of their
own, and at a delay of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import dynamics_of, joint_of
from hyst.identification.families.hammerstein.settled_dynamics import (
    ROUNDING,
    Settled,
    numbers_of,
    price,
    samples_worth,
    settled_dynamics,
    simpler,
)
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

_ROUNDS = 4  # of fewer states
_WALKS = 3  # of dynamics and hysteresis after each other
_FAR = 1e4  # times the least squared error: nothing is near


@dataclass(frozen=True, eq=False)
class Refits:
    """Fits of one family with different whole numbers in the dynamics.

    Parameters
    ----------
    data
        The records.
    finest
        Those that the dynamics are looked at in.
    delay
        Samples, where it is known.
    behind
        Fits again, from other dynamics behind the same hysteresis.
    """

    data: Data
    finest: Data
    delay: int | None
    behind: Callable[[Fit, LinearDynamics], Fit]
    _tried: dict[tuple[int, int, bool], Fit] = field(default_factory=dict, init=False, repr=False)

    def settled(self, fit: Fit, steps: Sequence[int]) -> Fit:
        """Give the fit with the dynamics that pay.

        Parameters
        ----------
        fit
            Of hysteresis and dynamics.
        steps
            How many states more or fewer are tried, too.
        """
        self._tried[numbers_of(dynamics_of(fit))] = fit
        for _ in range(_ROUNDS):
            before = dynamics_of(fit)
            now = self._look(fit, steps)
            simple = (*simpler(now.best.dynamics, self.delay), *simpler(before, self.delay))
            for each in (now.best.dynamics, *now.near, *simple):
                again = self._fitted(fit, each)
                if again is not None and each.order < before.order:
                    self._walk(again)
            best = self._best()
            if dynamics_of(best).order == before.order:
                return best
            fit, steps = best, tuple(each for each in steps if each < 0)
        return self._best()

    def _look(self, fit: Fit, steps: Sequence[int] = ()) -> Settled:
        hysteresis = joint_of(fit).hysteresis(fit.solution.theta)
        return settled_dynamics(self.finest, hysteresis, dynamics_of(fit), self.delay, steps)

    def _fitted(self, fit: Fit, dynamics: LinearDynamics) -> Fit | None:
        """Fit from other dynamics; None where such were fitted before."""
        numbers = numbers_of(dynamics)
        if numbers in self._tried:
            return None
        self._tried[numbers] = self.behind(fit, dynamics)
        return self._tried[numbers]

    def _walk(self, fit: Fit) -> None:
        """Look for the delay that goes with a hysteresis, and fit again, until neither changes."""
        for _ in range(_WALKS):
            least = min(each.solution.cost for each in self._tried.values())
            if fit.solution.cost > _FAR * least:
                return
            again = self._fitted(fit, self._look(fit).best.dynamics)
            if again is None:
                return
            fit = again

    def _best(self) -> Fit:
        """Give the fit whose numbers pay."""
        least = min(self._tried.values(), key=lambda each: each.solution.cost)
        rows = self.data.measured().size
        errors = least.problem(self.data).residual(least.solution.theta)[:rows]
        worth, floor = samples_worth(errors), ROUNDING * float(self.data.measured().var())

        def price_of(each: Fit) -> float:
            count = each.parametrization.free_count
            return price(each.solution.cost / rows, count, worth, floor)

        return min(self._tried.values(), key=price_of)
