"""Order, delay and feedthrough once more, each with a hysteresis of the family fitted with it.

Behind plays the dynamics make up for what plays cannot do, and a family in front that is fitted
with such dynamics makes up for them in turn. So fewer states are judged with a hysteresis of their
own, and at a delay of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import dynamics_of, joint_of
from hyst.identification.families.hammerstein.known.creeping_front import joined
from hyst.identification.families.hammerstein.start.first_guess_of_plays import ALL, FEWER, Wanted
from hyst.identification.families.hammerstein.start.settled_dynamics import (
    ROUNDING,
    Settled,
    numbers_of,
    price,
    samples_worth,
    settled_dynamics,
    simpler,
)
from hyst.identification.families.option import AUTO
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

_BETTER = 0.97  # of the squared error that plays leave
_ROUNDS = 4  # of fewer states
_WALKS = 3  # of dynamics and hysteresis after each other
_SHAPED = 0.8  # of the samples that what is left is worth: below, it has a shape
_WORTH_SHAPED = 40.0  # a further pair of poles must lower its square by a third
_TRIAL = 12  # iterations of a fit that may not be the one
_NEAR, _MOST_NEAR = 1.15, 3  # times the squared error of the best: trials that may be the one
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
    most
        Iterations of the fit that is given.
    """

    data: Data
    finest: Data
    delay: int | None
    most: int
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
        self._tried[numbers_of(dynamics_of(fit))] = given = fit
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
                return self._polished(best, given)
            fit, steps = best, tuple(each for each in steps if each < 0)
        return self._polished(self._best(), given)

    def _polished(self, best: Fit, given: Fit) -> Fit:
        """Go on with the trials that are near the best; what was given is fitted."""
        near = self._by_price()[:_MOST_NEAR]
        for each in near:
            if each is given or each.solution.cost > _NEAR * best.solution.cost:
                continue
            theta, numbers = each.solution.theta, numbers_of(dynamics_of(each))
            solution = each.family.solve(each.problem(self.data), theta, self.most)
            self._tried[numbers] = replace(each, solution=solution)
        return self._best()

    def _look(self, fit: Fit, steps: Sequence[int] = ()) -> Settled:
        hysteresis = joint_of(fit).hysteresis(fit.solution.theta)
        return settled_dynamics(self.finest, hysteresis, dynamics_of(fit), self.delay, steps)

    def _fitted(self, fit: Fit, dynamics: LinearDynamics) -> Fit | None:
        """Fit from other dynamics; None where such were fitted before."""
        numbers = numbers_of(dynamics)
        if numbers in self._tried:
            return None
        self._tried[numbers] = self._behind(fit, dynamics)
        return self._tried[numbers]

    def _behind(self, fit: Fit, dynamics: LinearDynamics) -> Fit:
        """Fit again, from other dynamics behind the same hysteresis."""
        front = joint_of(fit).front
        start = front, fit.solution.theta[: front.size]
        parametrization, theta = joined(start, dynamics, held=False)
        again = replace(fit, parametrization=parametrization)
        problem = again.problem(self.data)
        return replace(again, solution=fit.family.solve(problem, theta, _TRIAL))

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
        return self._by_price()[0]

    def _by_price(self) -> list[Fit]:
        least = min(self._tried.values(), key=lambda each: each.solution.cost)
        rows = self.data.measured().size
        errors = least.problem(self.data).residual(least.solution.theta)[:rows]
        worth, floor = samples_worth(errors), ROUNDING * float(self.data.measured().var())
        # What a hysteresis of another kind leaves lies around resonances, and each finds some of it
        # to follow: in this very record, and in no other.
        worth = worth if worth > _SHAPED * rows else min(worth, _WORTH_SHAPED)

        def price_of(each: Fit) -> float:
            count = each.parametrization.free_count
            return price(each.solution.cost / rows, count, worth, floor)

        return sorted(self._tried.values(), key=price_of)


def with_settled_dynamics(
    fit: Fit,
    records: tuple[Data, Data],
    wanted: Wanted,
    plays: float | None,
    max_iterations: int,
) -> Fit:
    """Fit again with other delays, orders, and without feedthrough; give the fit that pays.

    What plays made up for by a pole or a delay, the family in front may do itself.

    Parameters
    ----------
    fit
        Hysteresis and dynamics.
    records
        Of the fit, and those with the finest samples.
    wanted
        What is known of the dynamics.
    plays
        Mean squared error that plays left; None where the order is not to be looked at.
    max_iterations
        Of each further fit.
    """
    data, finest = records
    rows = data.measured().size
    steps: tuple[int, ...] = ()
    if plays is not None and wanted.state_order == AUTO:
        steps = ALL if fit.solution.cost < _BETTER * rows * plays else FEWER
    return Refits(data, finest, wanted.delay, max_iterations).settled(fit, steps)
