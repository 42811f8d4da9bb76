"""Choose a method of inversion by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hyst.checks.numbers import as_number, as_positive, whole_number
from hyst.compensation.exact import invert_exactly
from hyst.compensation.expectation import beyond_the_records, error_to_expect
from hyst.compensation.nearest_input import drive_to_nearest, turns
from hyst.compensation.noncausal import invert_noncausally
from hyst.compensation.rate_dependent.explicit import drive_explicitly
from hyst.compensation.rate_dependent.limits_kept import held_in_range, judge_rate_limit
from hyst.compensation.rate_dependent.preview import drive_with_preview
from hyst.compensation.rate_dependent.sample_exact import drive_sample_by_sample
from hyst.compensation.rate_dependent.solved_drive import ITERATION_LIMIT, SolvedDrive
from hyst.compensation.rate_dependent.task import RateDependentTask, prepare_task
from hyst.compensation.rate_dependent.trajectory_polish import Aim, Objective
from hyst.compensation.rate_dependent.whole_trajectory import drive_along_trajectory
from hyst.compensation.result import Compensation
from hyst.errors import InputError, SolverError
from hyst.models.rate_preview import MOST_PLANNED
from hyst.operators import ModelDescription, Operator
from hyst.operators.verdict import refuse_if_unfit

METHODS = ("exact", "noncausal", "explicit", "sample-exact", "preview", "trajectory")


def invert_trajectory(
    model: Operator,
    y_ref: ArrayLike,
    method: str = "exact",
    *,
    input_range: tuple[float, float] | None = None,
    outside: Literal["refuse", "clip"] = "refuse",
    history: ArrayLike | None = None,
    rate_limit: float | None = None,
    objective: Objective = "rms",
    roughness: float | None = None,
    preview: int = 20,
    band: float | None = None,
    max_iterations: int = 1000,
    allow_unconverged: bool = False,
    despite_verdict: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Compensation:
    """Find the input that makes a model follow a wanted output.

    ``exact``: ``u = model.inverse()(y_ref)``, with the memory of both starting in the same state.
    The other methods are for rate-dependent plays, with maps, lags, delays or creep before and
    after them, which are taken back exactly, or without:

    ``explicit``: the explicit inverse of S4 eqs. 12-16, causal and smooth. It takes the rate of the
    reference for that of the drive and leaves an error.
    ``sample-exact``: every sample solved exactly, causal; the drive may chatter.
    ``preview``: causal but for the next ``preview`` samples of the reference, planned ahead as
    ``model.inverse(preview=N)`` does sample by sample, here for a record that goes on as it ends.
    ``trajectory``: the whole reference known; the simulated error of the plays is taken to a
    minimum of ``objective``. For a butterfly, whose output turns: sample by sample the nearest
    input that gives the wanted output.

    The predicted error is always that of the model driven by the command, thresholds from the
    command's own rate.

    ``noncausal``: for linear dynamics behind or before a hysteresis, or on both sides; looks ahead
    through the dynamics and inverts the hysteresis exactly.

    Parameters
    ----------
    model
        An operator; for ``exact`` one with an exact inverse.
    y_ref
        Wanted output, shape (N,), finite, output units.
    method
        One of ``METHODS``.
    input_range
        Lowest and highest input allowed, input units; no limits if left out.
    outside
        What to do about a reference that would take the input out of its range: ``"refuse"``, or
        ``"clip"``: hold the input at the end of the range. ``exact`` then lets the memory of the
        inverse follow the output really reached, so that tracking is exact again as soon as the
        reference is back in reach; ``sample-exact``, ``preview`` and ``trajectory`` do so anyway.
    history
        Inputs the actuator has passed just before the first sample, shape (M,), input units; they
        set its memory. Left out, the model starts from its own initial state.
    rate_limit
        Largest rate of the input, input units per second, for ``preview`` and ``trajectory``. One
        that is out of reach is refused; with ``outside="clip"`` a note says so, and ``trajectory``
        gives nothing worse than a drive at rest, which ``preview`` cannot know beforehand.
    objective
        What ``trajectory`` minimises: ``"rms"``, the root mean square of the error, or
        ``"largest"``, its largest absolute value. The drive pays for either: without
        ``input_range`` it leaves the range of the first, smooth solution by 1.5 % of it at most.
    roughness
        Of ``trajectory``: a second difference of one input unit (of the drive of the plays, from
        sample to sample) counts as an error of so many output units, >= 0. More of it gives a
        smoother drive and a larger error; 0 the least error that was found, for a plant that the
        model knows well. Left out, it is 10 % (for ``"largest"`` 2 %) of the gain of the plays.
    preview
        Samples of the reference known beyond the present one, 1 to 60, for ``preview``.
    band
        Of ``noncausal``: highest frequency of the reference, Hz; above it dynamics are not inverted
        whose gain there is next to nothing, so that sensors' noise does not come back enlarged.
    max_iterations
        Of each stage of ``trajectory`` and of each window of its polish.
    allow_unconverged
        Give the best command with its status instead of raising if ``trajectory`` did not converge.
    despite_verdict
        Make a command also of a model whose verdict is ``unfit``.
    progress
        Called with the share done, 0 to 1.

    Returns
    -------
    Compensation
        The command ``u``, ``y_predicted``, ``predicted_error`` and what follows from it; what the
        model itself missed, ``expected``, and what its records did not show, ``unknown``.

    Raises
    ------
    InputError
        If a signal is empty or not finite (the first bad index is named), the method, ``outside``
        or another option is not one there is, the range is not two finite ascending numbers, the
        method is not for this model, or, with ``"refuse"``, the reference is out of reach or takes
        the input of ``explicit`` or ``sample-exact`` out of its range, or the limit of the rate is
        far below what the reference needs; or if the model's verdict is ``unfit``.
    NotInvertibleError
        If the model has no exact inverse and the method needs one, or p0 is not positive.
    SolverError
        If the trajectory inversion did not converge and ``allow_unconverged`` is false.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5], r=[1.0], p0=1.0)
    >>> done = invert_trajectory(model, [0.0, 4.0, 9.0, 5.5], input_range=(0, 5), outside="clip")
    >>> done.u
    array([0. , 3. , 5. , 3.5])
    >>> done.predicted_error
    array([ 0.,  0., -2.,  0.])
    """
    if method not in METHODS:
        known = ", ".join(METHODS)
        raise InputError(f"unknown method {method!r}; the methods there are: {known}")
    if outside not in ("refuse", "clip"):
        raise InputError(f"outside is {outside!r}; choose 'refuse' or 'clip'")
    if rate_limit is not None and method not in ("preview", "trajectory"):
        raise InputError(f"method {method!r} knows no rate limit; use 'preview' or 'trajectory'")
    about = model.description if isinstance(model, Operator) else ModelDescription()
    refuse_if_unfit(about.verdict, "no command is made", despite_verdict)
    if band is not None and method != "noncausal":
        raise InputError(f"method {method!r} knows no band; use 'noncausal'")
    task = _Task(model, y_ref, input_range, outside == "clip", history)
    if method != "trajectory" and (objective != "rms" or roughness is not None):
        raise InputError(f"method {method!r} has no objective and no roughness; use 'trajectory'")
    options = _Options(
        rate_limit,
        _aim(objective, roughness),
        preview,
        band,
        max_iterations,
        allow_unconverged,
        progress or _silent,
    )
    done = _inverted(task, method, options)
    unknown = beyond_the_records(about, done.u, done.y_ref)
    return replace(done, expected=error_to_expect(about), unknown=unknown)


@dataclass(frozen=True, eq=False)
class _Task:
    """What is wanted of which model."""

    model: Operator
    y_ref: ArrayLike
    input_range: tuple[float, float] | None
    clip: bool
    history: ArrayLike | None


@dataclass(frozen=True, eq=False)
class _Options:
    """Of methods other than the exact one."""

    rate_limit: float | None
    aim: Aim
    preview: int
    band: float | None
    max_iterations: int
    allow_unconverged: bool
    say: Callable[[float], None]


def _inverted(asked: _Task, method: str, options: _Options) -> Compensation:
    """Invert by one of the methods."""
    if method == "exact":
        return invert_exactly(
            asked.model, asked.y_ref, asked.input_range, asked.clip, asked.history
        )
    if method == "noncausal":
        return invert_noncausally(
            asked.model, asked.y_ref, asked.input_range, asked.clip, asked.history, options.band
        )
    if method == "trajectory" and isinstance(asked.model, Operator) and turns(asked.model):
        if options.rate_limit is not None:
            raise InputError("method 'trajectory' of a butterfly knows no rate limit; leave it out")
        if options.aim != Aim():
            raise InputError(
                "method 'trajectory' of a butterfly knows no objective and no roughness; leave "
                "them out"
            )
        return drive_to_nearest(
            asked.model, asked.y_ref, asked.input_range, asked.clip, asked.history
        )
    task = prepare_task(asked.model, asked.y_ref, asked.input_range, asked.clip, asked.history)
    if method == "explicit":
        found = drive_explicitly(task)
    elif method == "sample-exact":
        found = drive_sample_by_sample(task)
    elif method == "preview":
        ahead = whole_number(options.preview, "preview", 1, MOST_PLANNED)
        change = _change(task, options.rate_limit)
        found = drive_with_preview(task, ahead, change, options.say)
        found = judge_rate_limit(task, found, change, False)
    else:
        limit = whole_number(options.max_iterations, "max_iterations", 1)
        change = _change(task, options.rate_limit)
        found = drive_along_trajectory(task, change, options.aim, limit, options.say)
        found = judge_rate_limit(task, found, change, True)
    done = _compensation(task, found, method)
    if found.unpolished is not None:
        before = _compensation(task, replace(found, drive=found.unpolished), method)
        done = replace(done, objective=options.aim.objective)
        done = replace(done, notes=(_traded(before, done, found.roughness), *done.notes))
    if found.status == ITERATION_LIMIT and not options.allow_unconverged:
        raise SolverError(
            f"the trajectory inversion did not converge in {options.max_iterations} iterations a "
            f"stage or window; its best command leaves an error of {done.max_abs:.4g} (rms "
            f"{done.rms:.4g}); raise max_iterations, or accept it with allow_unconverged"
        )
    return done


def _silent(_: float) -> None:
    """Report progress to nobody."""


def _compensation(task: RateDependentTask, found: SolvedDrive, method: str) -> Compensation:
    """Drive the whole model with the command and see what it does."""
    u = task.input_of(found.drive)
    at_end = int(np.count_nonzero((found.drive <= task.low) | (found.drive >= task.high)))
    if task.before is not None:
        u, beyond = held_in_range(task, u)
        at_end = max(at_end, beyond)
    y_predicted, _ = task.model.run(u, task.start)
    return Compensation(
        u, task.y_ref, y_predicted, method, at_end, found.status, found.iterations, found.notes
    )


def _aim(objective: Objective, roughness: float | None) -> Aim:
    if objective not in ("rms", "largest"):
        raise InputError(f"objective is {objective!r}; choose 'rms' or 'largest'")
    if roughness is None:
        return Aim(objective, None)
    weight = as_number(roughness, "roughness")
    if weight < 0.0:
        raise InputError(f"roughness is {weight:.6g}; give a weight >= 0")
    return Aim(objective, weight)


def _traded(before: Compensation, after: Compensation, roughness: float) -> str:
    """Say what the polish has gained, and what the drive pays for it."""
    pairs = (
        ("rms error", before.rms, after.rms),
        ("largest error", before.max_abs, after.max_abs),
        ("size of the command", before.command_size, after.command_size),
        ("rms of its second differences", before.roughness, after.roughness),
    )
    changes = ", ".join(f"{what} {old:.4g} to {new:.4g}" for what, old, new in pairs)
    return (
        f"polished for the {after.objective} error, a second difference of 1 counting as an error "
        f"of {roughness:.3g}: {changes}"
    )


def _change(task: RateDependentTask, rate_limit: float | None) -> float:
    """Largest change of the drive per sample."""
    if rate_limit is None:
        return float("inf")
    rate = as_positive(rate_limit, "rate_limit", "a rate in input units per second")
    if task.before is not None:
        raise InputError(
            "the model has a stage before its plays, so the rate of its input is not that of the "
            "drive; leave out rate_limit"
        )
    return rate * task.plays.dt
