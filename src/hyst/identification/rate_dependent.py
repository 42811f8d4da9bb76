"""Identification of a rate-dependent model from records at several frequencies together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import threadpool_limits

from hyst.errors import InputError, NotIdentifiableError, SolverError
from hyst.identification.assembly import describe, metrics_by_record
from hyst.identification.bounded_least_squares import CONVERGED
from hyst.identification.covariance import robust_covariance, undetermined_combination
from hyst.identification.data import Data, prepare
from hyst.identification.fitting import model_jacobian, model_output
from hyst.identification.identified import Candidate, Identified
from hyst.identification.rate_dependent_fit import RateDependentFit, fit_layout, root_weights
from hyst.identification.rate_dependent_layout import EVEN, GIVEN, SPACINGS, Layout
from hyst.signals import Record, hysteresis_percent, reversals

Array = NDArray[np.float64]

RDPI = "rdpi"

_SIZES = (1, 2, 3, 4, 6)
_GOOD_ENOUGH = 1.01
"""Of the best residual among all sizes: the smallest size that reaches it is taken."""

_LONGEST_DELAY = 20

_SIZE_FOR_DELAY = 4
"""The delay is found with the fourth size: too few plays would look like a delay."""

_ONE_FREQUENCY = 1.2
"""Half swings whose durations differ by less than this factor all belong to one frequency."""


def identify_rate_dependent(
    records: Record | Sequence[Record],
    *,
    plays: int | Literal["auto"] = "auto",
    radii: ArrayLike | None = None,
    spacing: str = EVEN,
    record_weights: str | ArrayLike = "equal",
    delay: int | Literal["auto"] = 0,
    start: int | Literal["auto"] = "auto",
    validation: Record | Sequence[Record] = (),
    max_iterations: int = 200,
    allow_unconverged: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Identified:
    """Identify ``y = p0 u + sum p_i z_i + offset``, thresholds ``r_i + beta |du/dt|``.

        min  sum_p A_p sum_k (model[u_p](k) - y_p(k))^2

    Parameters
    ----------
    records
        Records of one actuator at several frequencies, with one sample time.
    plays
        Number of plays, or ``"auto"``: the smallest of 1, 2, 3, 4, 6 whose residual is within 1 %
        of the least.
    radii
        Shape (n,), input units: keep these radii at rest instead of finding them.
    spacing
        ``"even"``: ``r_i = zeta i``; ``"free"``: every radius for itself.
    record_weights
        A_p: ``"equal"``, which is best for noise of equal size; ``"hysteresis"``: the hysteresis
        percent of the record over that of the first one; or a number for each record.
    delay
        Whole samples by which the output lags, or ``"auto"``: that with the least residual.
    start, validation, max_iterations, allow_unconverged, progress
        As in ``hyst.identify``.

    Returns
    -------
    Identified
        If all records turn at one frequency, beta stays 0 and ``undetermined`` says why.

    Raises
    ------
    InputError
        If an argument or a record cannot be used.
    NotIdentifiableError
        If the input of a record is constant or turns less than twice, or there are fewer samples
        than parameters.
    SolverError
        If the fit did not converge and ``allow_unconverged`` is false.

    Notes
    -----
    S4 eqs. 42-45, whose zeta is the radii's spacing.
    """
    say = progress or _silent
    with threadpool_limits(1, user_api="blas"):
        data = prepare(records, start, 0)
        weights = _as_record_weights(record_weights, data)
        has_rate, notes = _rate_shows(data)
        layouts = _layouts(data, plays, radii, spacing, has_rate)
        _require_samples(data, layouts)
        data = data.delayed(_as_delay(delay, data))
        if delay == "auto":
            say("delay")
            data = _with_best_delay(data, layouts[:_SIZE_FOR_DELAY][-1], weights, max_iterations)
        fits = []
        for layout in layouts:
            say(f"rdpi with {layout.plays} plays")
            fits.append(fit_layout(data, layout, weights, max_iterations))
        fit, candidates = _smallest_good_enough(data, fits)
        if fit.solution.status != CONVERGED and not allow_unconverged:
            raise SolverError(
                f"the fit of rdpi with {fit.layout.plays} plays did not converge in "
                f"{fit.solution.iterations} iterations; raise max_iterations, give fewer plays, or "
                "accept it with allow_unconverged"
            )
        judged = (validation,) if isinstance(validation, Record) else tuple(validation)
        for record in judged:
            fit.layout.operator(fit.solution.theta).require_sample_time(
                record.dt, "a validation record"
            )
        return _assemble(data, fit, weights, tuple(candidates), judged, notes)


def _silent(_: str) -> None:
    """Report progress to nobody."""


def _as_record_weights(given: str | ArrayLike, data: Data) -> Array:
    count = len(data.records)
    if isinstance(given, str):
        if given == "equal":
            return np.ones(count)
        if given == "hysteresis":
            percent = np.array(
                [
                    hysteresis_percent(r.u[w], r.y[w])
                    for r, w in zip(data.records, data.windows(), strict=True)
                ]
            )
            if percent[0] == 0.0:
                raise InputError("the first record shows no hysteresis; give record_weights")
            return np.asarray(percent / percent[0])
        raise InputError(
            f"record_weights is {given!r}; choose 'equal', 'hysteresis' or a number a record"
        )
    values = np.asarray(given, dtype=np.float64)
    if values.shape != (count,) or not np.isfinite(values).all() or values.min() <= 0.0:
        raise InputError(
            f"record_weights are {values.tolist()}; give {count} positive numbers, one a record"
        )
    return values


def _rate_shows(data: Data) -> tuple[bool, tuple[str, ...]]:
    """Tell whether the records hold more than one frequency, and if not, say what that means."""
    durations = np.concatenate(
        [np.diff(reversals(r.u, 0.05 * float(np.ptp(r.u)))) for r in data.records]
    )
    if durations.size and durations.max() > _ONE_FREQUENCY * durations.min():
        return True, ()
    frequency = 0.5 / (float(np.median(durations)) * data.records[0].dt) if durations.size else 0.0
    return False, (
        f"all records turn at one frequency, {frequency:.4g} Hz: beta and a linear lag cannot be "
        "told apart; beta was left at 0, so the model holds at that frequency only; add records at "
        "other frequencies",
    )


def _layouts(
    data: Data, plays: int | str, radii: ArrayLike | None, spacing: str, has_rate: bool
) -> list[Layout]:
    if spacing not in SPACINGS:
        raise InputError(f"spacing is {spacing!r}; choose one of {', '.join(SPACINGS)}")
    windows = zip(data.records, data.windows(), strict=True)
    u = np.concatenate([record.u[window] for record, window in windows])
    rising = float(np.dot(u - u.mean(), data.measured())) >= 0.0
    common = Layout(
        plays=0,
        spacing=spacing,
        radii=np.empty(0),
        sign=1.0 if rising else -1.0,
        dt=data.records[0].dt,
        largest_radius=data.largest_radius,
        mean_slope=float(np.ptp(data.measured())) / (2.0 * data.half_range),
        has_rate=has_rate,
    )
    if radii is not None:
        r = np.unique(np.asarray(radii, dtype=np.float64))
        if r.size == 0 or not np.isfinite(r).all() or r[0] < 0.0 or r[-1] >= data.half_range:
            raise InputError(
                f"radii are {r.tolist()}; give numbers from 0 to below {data.half_range:.6g}, half "
                "the input range"
            )
        return [replace(common, plays=r.size, spacing=GIVEN, radii=r)]
    if plays == "auto":
        return [replace(common, plays=n) for n in _SIZES]
    if isinstance(plays, bool) or not isinstance(plays, int | np.integer) or not 1 <= plays <= 50:
        raise InputError(f"plays is {plays!r}; give 1 to 50, or 'auto'")
    return [replace(common, plays=int(plays))]


def _require_samples(data: Data, layouts: list[Layout]) -> None:
    needed = min(each.size for each in layouts)
    if data.measured().size <= needed:
        raise NotIdentifiableError(
            f"{data.measured().size} samples can be used but the model has {needed} parameters; "
            "give longer records or fewer plays"
        )


def _as_delay(delay: int | str, data: Data) -> int:
    if delay == "auto":
        return 0
    shortest = min(len(r) - s for r, s in zip(data.records, data.starts, strict=True))
    if isinstance(delay, bool) or not isinstance(delay, int) or not 0 <= delay < shortest:
        raise InputError(f"delay is {delay!r}; give 0 to {shortest - 1} samples, or 'auto'")
    return delay


def _smallest_good_enough(
    data: Data, fits: list[RateDependentFit]
) -> tuple[RateDependentFit, list[Candidate]]:
    if len(fits) == 1:
        return fits[0], []
    rms = [float(np.sqrt(each.solution.cost / data.measured().size)) for each in fits]
    # A fit that is exact but for rounding is as good as any.
    limit = max(_GOOD_ENOUGH * min(rms), 1e-9 * float(np.ptp(data.measured())))
    chosen = next(i for i, each in enumerate(rms) if each <= limit)
    candidates = [
        Candidate(RDPI, fit.layout.plays, fit.layout.size, score, 0.0, chosen=i == chosen)
        for i, (fit, score) in enumerate(zip(fits, rms, strict=True))
    ]
    return fits[chosen], candidates


def _with_best_delay(data: Data, layout: Layout, weights: Array, max_iterations: int) -> Data:
    """Go on to longer delays as long as the mean squared residual falls."""
    found = fit_layout(data, layout, weights, max_iterations)
    for delay in range(1, _LONGEST_DELAY + 1):
        trial = data.delayed(delay)
        next_found = fit_layout(trial, layout, weights, max_iterations, found.solution.theta)
        before = found.solution.cost / data.measured().size
        if next_found.solution.cost / trial.measured().size >= before:
            break
        data, found = trial, next_found
    return data


def _assemble(
    data: Data,
    fit: RateDependentFit,
    weights: Array,
    candidates: tuple[Candidate, ...],
    validation: Sequence[Record],
    notes: tuple[str, ...],
) -> Identified:
    layout, theta = fit.layout, fit.solution.theta
    operator = layout.operator(theta)
    errors, not_told_apart = _standard_errors(data, fit, weights)
    free = layout.transform.any(axis=1)
    names = np.array(operator.parameters().names)
    return Identified(
        model=operator,
        family=RDPI,
        delay=data.delay,
        parameter_names=tuple(str(name) for name in names[free]),
        parameter_values=operator.parameters().values[free],
        standard_errors=errors[free],
        undetermined=notes + not_told_apart,
        metrics=metrics_by_record(data, operator, validation),
        candidates=candidates,
        status=fit.solution.status,
        iterations=fit.solution.iterations,
        used=data.used(),
        description=describe(data, RDPI),
    )


def _standard_errors(
    data: Data, fit: RateDependentFit, weights: Array
) -> tuple[Array, tuple[str, ...]]:
    """Give standard errors of the operator's constants, NaN where on a bound or not determined."""
    layout, theta = fit.layout, fit.solution.theta
    operator, root = layout.operator(theta), root_weights(data, weights)
    jacobian = root[:, None] * (model_jacobian(data, operator) @ layout.transform)
    residual = root * (model_output(data, operator) - data.measured())
    inside = (theta > layout.lower) & (theta < layout.upper)
    share = undetermined_combination(jacobian[:, inside])
    notes: tuple[str, ...] = ()
    if share is not None:
        involved = np.flatnonzero(inside)[share > 0.1 * share.max()]
        constants = np.flatnonzero(layout.transform[:, involved].any(axis=1))
        listed = ", ".join(operator.parameters().names[i] for i in constants)
        notes = (f"the records do not tell apart {listed}; their values are one choice of many",)
        inside[involved] = False
    lengths = [window.stop - window.start for window in data.windows()]
    covariance = np.zeros((theta.size, theta.size))
    if inside.any():
        place = np.ix_(inside, inside)
        covariance[place] = robust_covariance(jacobian[:, inside], residual, lengths)
    variance = np.einsum("ij,jk,ik->i", layout.transform, covariance, layout.transform)
    variance[layout.transform[:, ~inside].any(axis=1)] = np.nan
    return np.sqrt(variance), notes
