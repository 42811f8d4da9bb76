"""The search for a gain: SLPMM, descent, the quietest of the best, and more order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.control.disturbance_observer.descent import descend_from_many, usual_parameters
from hyst.control.disturbance_observer.minimax import Descent
from hyst.control.disturbance_observer.more_order import with_one_more
from hyst.control.disturbance_observer.problem import ObserverProblem
from hyst.control.disturbance_observer.quietest import noise_of, quietest
from hyst.control.disturbance_observer.slpmm import slpmm
from hyst.control.disturbance_observer.stacked_gain import StackedGain
from hyst.errors import SolverError

Array = NDArray[np.float64]
Progress = Callable[[str, int, float], None]

# Iterations of SLPMM: all of them, as many as the paper's, or a few where each takes long and the
# descent that follows needs no more than a start.
_FULL, _FEW, _LARGE = 14, 2, 5
PAYS = 0.95  # of the norm: an eigenvalue more has to bring it below
USUAL = 2  # starts for the quietest
MOST_MORE = 6  # eigenvalues


@dataclass(frozen=True)
class Search:
    """How to search: the arguments of ``design_disturbance_observer``.

    These are ``method``, ``starts``, ``seed``, ``order``, ``fastest_pole``, ``flat``, ``progress``.
    """

    method: str
    starts: int | None
    seed: int
    order: int | Literal["auto"] | None
    fastest_pole: float | None
    flat: float
    progress: Progress | None


@dataclass(frozen=True)
class Found:
    """A ``gain``, the ``problem`` whose internal model it is for, and ``steps``, a line a stage."""

    problem: ObserverProblem
    gain: Array
    steps: tuple[str, ...]


def search(problem: ObserverProblem, how: Search) -> Found:
    """Look for the gain of least norm.

    Raises
    ------
    SolverError
        If the semidefinite program of the method "slpmm", in ``how``, fails for the problem.
    """
    gain = StackedGain(problem, 0, how.fastest_pole)
    steps: list[str] = []
    linear, norm = _linear(gain, how, steps)
    if "descent" not in how.method:
        return Found(problem, linear, tuple(steps))
    given = []
    if np.isfinite(norm):
        given = [gain.parameters_of(problem.q_filter(linear).poles())]
    best = descend_from_many(gain, given, how.starts, how.seed, _reported(how, "descent"))
    steps.append(f"descent        {best.norm:.4f} after {best.evaluations} evaluations")
    free_of_limits = problem.Wn is None and how.fastest_pole is None
    if free_of_limits and norm < (1.0 - 1e-6) * best.norm:
        return Found(problem, linear, tuple(steps))
    best = _quiet(gain, best, how, steps)
    gain, best = _more(gain, best, how, steps)
    whole = replace(problem, internal_model=gain.internal_model(best.parameters))
    return Found(whole, gain.gain_of(best.parameters), tuple(steps))


def _linear(gain: StackedGain, how: Search, steps: list[str]) -> tuple[Array, float]:
    """Give the gain of SLPMM and its norm; where it is not asked for or fails, the norm is inf."""
    start = gain.gain_of(usual_parameters(gain, 1)[0])
    if "slpmm" not in how.method:
        return start, np.inf
    problem = gain.problem
    iterations = _FULL if how.method == "slpmm" or problem.order < _LARGE else _FEW
    try:
        found = slpmm(problem, start, iterations, progress=_reported(how, "slpmm"))
    except SolverError as reason:
        if how.method == "slpmm":
            raise
        steps.append(f"SLPMM          failed: {reason}")
        return start, np.inf
    steps.append(
        f"SLPMM          {found.norm:.4f} after {found.iterations} iterations, "
        f"trace(P R) - n = {found.distances[-1]:.2g}"
    )
    return found.gain, found.norm


def _quiet(gain: StackedGain, best: Descent, how: Search, steps: list[str]) -> Descent:
    starts = usual_parameters(gain)[:USUAL] if gain.free == 0 else []
    quiet = quietest(gain, best, starts, how.flat)
    if quiet is not best:
        steps.append(
            f"least noise    {quiet.norm:.4f}, noise gain {noise_of(gain, best):.3g} -> "
            f"{noise_of(gain, quiet):.3g}"
        )
    return quiet


def _more(
    gain: StackedGain, best: Descent, how: Search, steps: list[str]
) -> tuple[StackedGain, Descent]:
    """Add stable eigenvalues: as many as asked for, or while each brings enough."""
    if how.order is None:
        return gain, best
    auto = how.order == "auto"
    noise = noise_of(gain, best)
    most = gain.order + MOST_MORE if how.order == "auto" else how.order
    while gain.order < most:
        larger, more = with_one_more(gain, best, noise)
        if how.progress is not None:
            how.progress("order", larger.order, more.norm)
        eigenvalue = larger.eigenvalues(more.parameters)
        told = ", ".join(f"{each:.4g}" for each in np.sort(eigenvalue.real))
        line = f"order {larger.order:<8d} {more.norm:.4f}, noise gain {noise_of(larger, more):.3g}"
        if auto and more.norm > PAYS * best.norm:
            steps.append(f"{line}: does not pay, left at {gain.order}")
            break
        steps.append(f"{line}, eigenvalues {told} 1/s more in the internal model")
        gain, best = larger, more
    return gain, best


def _reported(how: Search, stage: str) -> Callable[..., None] | None:
    progress = how.progress
    if progress is None:
        return None
    return lambda step, *values: progress(stage, step, values[-1])
