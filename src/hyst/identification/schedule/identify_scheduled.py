"""Identify a model whose constants follow a slow second signal, as temperature or bias."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.diagnosis import Diagnosis
from hyst.diagnosis.diagnose_records import diagnose_all_but_delay
from hyst.errors import HystError
from hyst.identification.blas_threads import one_blas_thread
from hyst.identification.choice.fits_from_starts import settled
from hyst.identification.families.family import Family, Fit
from hyst.identification.families.registry import chosen_families
from hyst.identification.fit.bounded_least_squares import Problem
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.options import Options
from hyst.identification.progress import Progress, Step, silent
from hyst.identification.record_use.cleaned import Cleaned, as_drift, cleaned
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.part_of_a_sample import lag_in_samples
from hyst.identification.record_use.scales import scales_of
from hyst.identification.record_use.used_samples import Data, require_same_units
from hyst.identification.result.fit_spread import spread_of_fit
from hyst.identification.result.identified import Identified
from hyst.identification.result.identified_from_fit import identified_from_fit, traced
from hyst.identification.schedule.identified_schedule import (
    IdentifiedSchedule,
    ScheduledConstant,
)
from hyst.identification.schedule.joint_fit import fit_jointly
from hyst.identification.schedule.judged import held_out_of, left_out_of
from hyst.identification.schedule.shared import Estimate, Sharing, nothing_shared, sharing_of
from hyst.identification.schedule.values_of_records import AtValue, by_value, require_several
from hyst.identification.schedule.words import notes_of, verdict_of
from hyst.identification.search import Found, find
from hyst.models import Scheduled
from hyst.operators.provenance import options_asked
from hyst.signals import Record

Array = NDArray[np.float64]

AS_GOOD = 0.02
"""Share of its error by which a simpler layout may miss more than a richer one."""

ROUNDING = 1e-12
"""Of the output's range: an error of that size is none."""

MOST_ORDERS = 3

AT_VALUES = 0.7
"""Share of the way that the search at each value by itself is said to be."""
"""How often neighbours that would pass each other are shared, before nothing is."""


@dataclass(frozen=True, eq=False)
class _Value:
    """A value of the signal with its records, cleaned, and what they showed before any model."""

    group: AtValue
    diagnosis: Diagnosis
    clean: Cleaned


@dataclass(frozen=True, eq=False)
class _Fitted:
    """A fit at one value, over its records, in the units of powers of two of the layout."""

    value: _Value
    data: Data
    fit: Fit
    scales: tuple[float, float]

    def given(self) -> tuple[Data, Fit]:
        """Give records and fit in the user's units."""
        theta = self.fit.solution.theta
        parametrization = self.fit.parametrization.in_units(theta, *self.scales)
        return self.data.in_units(*self.scales), replace(self.fit, parametrization=parametrization)


def identify_scheduled(
    records: Sequence[Record],
    at: ArrayLike,
    *,
    name: str = "s",
    unit: str = "",
    family: str | Family = "auto",
    delay: float | Literal["auto"] = "auto",
    start: int | Literal["auto"] = "auto",
    drift: Literal["auto", False] = "auto",
    validation: Sequence[Record] = (),
    validation_at: ArrayLike = (),
    max_iterations: int = 200,
    allow_unconverged: bool = False,
    progress: Callable[[Step], object] | None = None,
    **options: Any,
) -> IdentifiedSchedule:
    """Identify one model at several values of a second signal, and join them by straight lines.

    Family and size are chosen at each value; the simplest of these layouts that describes all
    values as well as any is that of the model. Its constants are fitted at each value, those that
    differ no more than scatter explains are shared, and all are fitted once more together.

    Parameters
    ----------
    records
        Of one actuator, each taken while the second signal stood still.
    at
        The value of the second signal for each record, in any order; several records may be of one
        value.
    name, unit
        What the second signal is, as ``"temperature"``, ``"degC"``.
    validation, validation_at
        Records that take no part, and the value of each, which may be one between the others.
    family, delay, start, drift, max_iterations, allow_unconverged, progress, **options
        As in ``hyst.identify``. A delay that is not given is that of the layout, at all values.

    Returns
    -------
    IdentifiedSchedule

    Raises
    ------
    InputError
        If an argument or a record cannot be used, there is not one value for each record, or all
        are of one value.
    NotIdentifiableError
        As ``hyst.identify``; the value is named.
    SolverError
        If a fit did not converge and ``allow_unconverged`` is false.

    Examples
    --------
    >>> import numpy as np, hyst
    >>> u = np.sin(np.linspace(0.0, 20.0, 600)) * np.linspace(1.0, 0.4, 600)
    >>> def at(t):
    ...     return hyst.PrandtlIshlinskii([0.5 + t / 100.0], [0.2], p0=1.0)
    >>> records = [hyst.Record(u, at(t)(u), dt=1e-3) for t in (20.0, 40.0)]
    >>> found = identify_scheduled(records, [20.0, 40.0], name="temperature", family="pi", plays=1)
    >>> bool(np.abs(found.model.at(30.0)(u) - at(30.0)(u))[100:].max() < 1e-6)
    True
    """
    asked = options_asked(identify_scheduled, locals()) | options
    groups = by_value(records, at)
    require_several(groups)
    judged = by_value(validation, validation_at, "validation record")
    all_groups = (*groups, *judged)
    require_same_units([record for each in all_groups for record in each.records])
    say = Progress(progress or silent)
    wanted = Options((), say, delay, start, max_iterations, allow_unconverged)
    families, about_drift = chosen_families(family, options), as_drift(drift)
    with one_blas_thread():
        values = [_value(each, name, about_drift) for each in groups]
        found = [
            _found(each, families, replace(wanted, say=_part(say, each, k, values, name)), name)
            for k, each in enumerate(values)
        ]
        layout, free = _layout(found, values, wanted)
        fitted, sharing = _together(free, wanted)
        results = tuple(
            _result(each, sharing, k, asked, judged, layout) for k, each in enumerate(fitted)
        )
    numbers = np.array([each.group.value for each in values])
    model = Scheduled([each.model for each in results], numbers, name, unit)
    data = [each.given()[0] for each in fitted]
    constants = _constants(fitted[0].fit, results, sharing)
    left_out = left_out_of(model, data, results)
    held_out = tuple(held_out_of(model, each, results, data[0], start) for each in judged)
    verdict = verdict_of(model, results, left_out, held_out)
    notes = notes_of(model, results, constants, left_out, held_out, sharing.gave_up)
    about = replace(model.description, verdict=verdict)
    return IdentifiedSchedule(
        model.with_description(about),
        numbers,
        results,
        constants,
        left_out,
        held_out,
        notes,
        verdict,
    )


def _value(group: AtValue, name: str, drift: Literal["auto", False]) -> _Value:
    with _named(name, group.value):
        diagnosis = diagnose_all_but_delay(group.records)
        return _Value(group, diagnosis, cleaned(group.records, diagnosis, drift))


def _found(value: _Value, families: Sequence[Family], options: Options, name: str) -> Found:
    with _named(name, value.group.value):
        return find(value.clean, families, options)


def _part(say: Progress, value: _Value, k: int, values: Sequence[_Value], name: str) -> Progress:
    begin, end = (AT_VALUES * each / len(values) for each in (k, k + 1))
    return say.part(begin, end, f"{name} {value.group.value:.6g}: ")


def _layout(
    found: Sequence[Found], values: Sequence[_Value], options: Options
) -> tuple[Found, list[_Fitted]]:
    """Choose the layout of all, and fit it at every value.

    Of the family that most values take: the simplest that describes all values as well as any.
    """
    names = [each.fit.family.name for each in found]
    most = max(names.count(each) for each in names)
    rivals = {
        each.fit.parametrization.free_count: each
        for each, name in zip(found, names, strict=True)
        if names.count(name) == most
    }
    tried = [
        (each, [_refitted(value, each, options) for value in values])
        for _, each in sorted(rivals.items())
    ]
    missed = [float(np.mean([np.log(_noise(each)) for each in fits])) for _, fits in tried]
    good = [
        one for one, misses in zip(tried, missed, strict=True) if misses <= min(missed) + AS_GOOD
    ]
    return good[0]


def _noise(fitted: _Fitted) -> float:
    """Give the rms that a fit leaves, or what of it rounding cannot tell from nothing."""
    rms = float(np.sqrt(fitted.fit.solution.cost / fitted.data.measured().size))
    return max(rms, ROUNDING * float(np.ptp(fitted.data.measured())))


def _refitted(value: _Value, layout: Found, options: Options) -> _Fitted:
    """Fit a layout, whose parameters are in its own units of powers of two, at another value."""
    family, first = layout.fit.family, layout.data.records[0].dt
    scales = scales_of(layout.data)
    to_own = 1.0 / scales[0], 1.0 / scales[1]
    theta = layout.fit.solution.theta
    own = replace(layout.fit, parametrization=layout.fit.parametrization.in_units(theta, *to_own))
    data = value.clean.marked(family.records_to_use(value.clean.records, options.start)[0])
    data = replace(data, keeps_corners=layout.data.keeps_corners)
    data = data.delayed(lag_in_samples(layout.data.lag, first, data.records[0].dt))
    options.say(f"fit at {value.group.value:.6g}", AT_VALUES)
    overview = Overview(
        data.in_units(*to_own), layout.data.lag, rates_matter=family.depends_on_rate
    )
    problem = own.problem(overview.data, overview.kept)
    reached = replace(own, solution=family.solve(problem, theta, options.max_iterations))
    near = family.finish(reached, overview, options.max_iterations)
    if near.parametrization is not own.parametrization:  # another layout
        near = reached
    fit = options.converged(settled(near, overview, options.max_iterations))
    return _Fitted(value, overview.data, fit, scales)


def _estimate(fitted: _Fitted) -> Estimate:
    found = spread_of_fit(fitted.data, fitted.fit)
    spread, inside = found.spread, found.inside
    size = spread.noise / spread.unit
    within = spread.covariance * np.outer(size, size)
    within += spread.open_directions @ spread.open_directions.T
    covariance = np.zeros((inside.size, inside.size))
    covariance[np.ix_(inside, inside)] = within
    return Estimate(fitted.fit.solution.theta, covariance, inside)


def _together(free: Sequence[_Fitted], options: Options) -> tuple[list[_Fitted], Sharing]:
    """Fit all values once more, with what they share."""
    options.say("fit at all values", 0.85)
    estimates = [_estimate(each) for each in free]
    problems = [each.fit.problem(each.data) for each in free]
    noises = [_noise(each) for each in free]
    parametrization, held = free[0].fit.parametrization, np.zeros(0, dtype=np.bool_)
    for _ in range(MOST_ORDERS):
        sharing = sharing_of(estimates, held if held.size else None)
        thetas, solution = fit_jointly(
            problems, noises, sharing.shared, sharing.thetas, options.max_iterations
        )
        wrong = _out_of_order(parametrization, thetas)
        if not wrong.any():
            options.converged(replace(free[0].fit, solution=solution))
            status = solution.status
            fitted = [
                _with_theta(*each, status) for each in zip(free, problems, thetas, strict=True)
            ]
            return fitted, sharing
        held = wrong if not held.size else held | wrong
    return list(free), nothing_shared(estimates, sharing)


def _out_of_order(parametrization: Parametrization, thetas: Array) -> NDArray[np.bool_]:
    """Tell which parameters make constants that stand in another order than they must.

    Of two neighbours of which one is shared and one moves, the one may pass the other; shared both,
    they do not.
    """
    wrong = np.zeros(len(parametrization.transform), dtype=np.bool_)
    for theta in thetas:
        constants = parametrization.constants(theta)
        moved = parametrization.template.nearest_parameters(constants) != constants
        wrong |= moved
        wrong[:-1] |= moved[1:]
    return np.asarray(parametrization.transform[wrong].any(axis=0))


def _with_theta(fitted: _Fitted, problem: Problem, theta: Array, status: str) -> _Fitted:
    errors, fit = problem.residual(theta), fitted.fit
    solution = replace(fit.solution, theta=theta, cost=float(errors @ errors), status=status)
    return replace(fitted, fit=replace(fit, solution=solution))


def _result(
    fitted: _Fitted,
    sharing: Sharing,
    place: int,
    asked: dict[str, Any],
    judged: Sequence[AtValue],
    layout: Found,
) -> Identified:
    group = fitted.value.group
    same = [each.records for each in judged if each.value == group.value]
    data, fit = fitted.given()
    found = identified_from_fit(
        data,
        fit,
        layout.candidates,
        same[0] if same else (),
        (),
        fitted.value.diagnosis,
        (),
        None,
    )
    by_theta = fit.family.estimates(fit).by_theta
    variance = np.einsum("ij,jk,ik->i", by_theta, sharing.covariances[place], by_theta)
    errors = np.where(np.isnan(found.standard_errors), np.nan, np.sqrt(np.maximum(variance, 0.0)))
    told = fit.family.result(
        replace(found, standard_errors=errors), fit, Overview(fitted.data, fitted.data.lag)
    )
    return traced(told, group.records, asked)


def _constants(
    fit: Fit, results: Sequence[Identified], sharing: Sharing
) -> tuple[ScheduledConstant, ...]:
    by_theta = fit.family.estimates(fit).by_theta != 0.0
    constants = []
    for i, name in enumerate(results[0].parameter_names):
        values = np.array([each.parameter_values[i] for each in results])
        chances = sharing.chance[by_theta[i]]
        asked = chances[~np.isnan(chances)]
        constants.append(
            ScheduledConstant(
                name,
                values,
                np.array([each.standard_errors[i] for each in results]),
                moves=bool((values != values[0]).any()),
                chance=float(asked.min()) if asked.size else float("nan"),
            )
        )
    return tuple(constants)


@contextlib.contextmanager
def _named(name: str, value: float) -> Iterator[None]:
    """Say in a refusal at which value it was."""
    try:
        yield
    except HystError as error:
        raise type(error)(f"at {name} = {value:.6g}: {error}") from error
