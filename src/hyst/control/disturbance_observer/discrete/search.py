"""The search for a gain in discrete time: descent, the quietest of the best, and more order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hyst.control.disturbance_observer.descent import descend_from_many, usual_parameters
from hyst.control.disturbance_observer.discrete.coordinates import held_gain
from hyst.control.disturbance_observer.discrete.problem import SampledObserverProblem
from hyst.control.disturbance_observer.discrete.stacked_gain import SampledStackedGain
from hyst.control.disturbance_observer.discrete.w_plane import from_w_plane
from hyst.control.disturbance_observer.minimax import Descent
from hyst.control.disturbance_observer.more_order import with_one_more
from hyst.control.disturbance_observer.quietest import noise_of, quietest
from hyst.control.disturbance_observer.search import MOST_MORE, PAYS, USUAL, Found, Search

# Poles of the delay that are searched like the others: more of them gain little.
_FREED = 2
_UNMET = 3.0  # times the noise gain, where the norm is above 1


def search_sampled(problem: SampledObserverProblem, how: Search) -> Found:
    """Look for the gain of least norm of the problem's sampled loop, how is asked.

    Raises
    ------
    SolverError
        If no coordinates hold it.
    """
    gain = SampledStackedGain(problem, 0, _FREED, how.fastest_pole)
    progress = how.progress
    told = None
    if progress is not None:
        told = lambda step, value: progress("descent", step, value)  # noqa: E731
    best = descend_from_many(gain, [], how.starts, how.seed, told)
    steps = [f"descent        {best.norm:.4f} after {best.evaluations} evaluations"]
    quiet = quietest(gain, best, usual_parameters(gain)[:USUAL], how.flat)
    if quiet is not best:
        steps.append(
            f"least noise    {quiet.norm:.4f}, noise gain {noise_of(gain, best):.3g} -> "
            f"{noise_of(gain, quiet):.3g}"
        )
    gain, best = _more(gain, quiet, how, steps)
    whole = replace(problem, internal_model=gain.internal_model(best.parameters))
    whole, L = held_gain(gain, best.parameters, whole)
    return Found(whole, L, tuple(steps))


def _more(
    gain: SampledStackedGain, best: Descent, how: Search, steps: list[str]
) -> tuple[SampledStackedGain, Descent]:
    """Add stable eigenvalues: as many as asked for, or while each brings enough."""
    if how.order is None:
        return gain, best
    # Weights that are not met yet are worth some noise.
    noise = noise_of(gain, best) * (1.0 if best.norm < 1.0 else _UNMET)
    auto = how.order == "auto"
    most = gain.problem.order + MOST_MORE if how.order == "auto" else how.order
    while gain.total < most:
        larger, more = with_one_more(gain, best, noise)
        assert isinstance(larger, SampledStackedGain)
        if how.progress is not None:
            how.progress("order", larger.total, more.norm)
        line = f"order {larger.total:<8d} {more.norm:.4f}, noise gain {noise_of(larger, more):.3g}"
        if auto and more.norm > PAYS * best.norm:
            steps.append(f"{line}: does not pay, left at {gain.total}")
            break
        z = from_w_plane(larger.eigenvalues(more.parameters))
        told = ", ".join(f"{each:.4g}" for each in np.sort(z.real))
        steps.append(f"{line}, eigenvalues z = {told} more in the internal model")
        gain, best = larger, more
    return gain, best
