"""What is told of a law of the widening: its own constants, where it bends, and if it fits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis import Diagnosis
from hyst.diagnosis.findings.rate_dependence import NAME as RATE_DEPENDENCE
from hyst.identification.families.estimates import Estimates
from hyst.identification.families.family import Fit
from hyst.identification.families.rate_dependent_layout import RateDependentLayout
from hyst.identification.families.rate_law import (
    LINEAR,
    PIECEWISE,
    SATURATING,
    SQRT,
    RateLaw,
    piecewise_law,
)
from hyst.identification.families.rate_law_choice import layout_of
from hyst.identification.fit.problem import model_jacobian, model_output
from hyst.identification.judgement.regression import chance, correlation_time
from hyst.identification.record_use.used_samples import Data
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import Composition
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]

MATTERS = 3e-4
"""Of the output's range (rms): less than that the straight pieces of tables may leave."""

UNLIKELY = 1e-6
"""Probability that chance lowers the residual so much."""

WORTH_A_NOTE = 0.02
"""Share of the residual's sum of squares that another law must take away to be told."""


def with_constants_of_law(told: Estimates, fit: Fit) -> Estimates:
    """Put the law's own constants in the place of those of its table.

    Parameters
    ----------
    told
        Every constant of the operator that is free.
    fit
        The fit, in the user's units, perhaps the part of one with dynamics.
    """
    layout = layout_of(fit)
    law = layout.law
    if law.name == LINEAR:
        return told
    tail = ("beta", *(f"slopes[{i}]" for i in range(1, law.fixed.size)))
    of_law = [name.split(".")[-1] in tail for name in told.names]
    if not any(of_law):
        return told
    first = of_law.index(True)
    prefix = told.names[first].removesuffix(told.names[first].split(".")[-1])
    names, factors = _own_constants(law)
    places = np.arange(layout.law_places.start, layout.law_places.stop)
    own = np.zeros((law.size, told.by_theta.shape[1]))
    own[np.arange(law.size), places] = factors
    kept = ~np.array(of_law)
    before, after = np.flatnonzero(kept[:first]), first + np.flatnonzero(kept[first:])
    return Estimates(
        (
            *(told.names[i] for i in before),
            *(prefix + name for name in names),
            *(told.names[i] for i in after),
        ),
        np.concatenate(
            [told.values[before], factors * fit.solution.theta[places], told.values[after]]
        ),
        np.concatenate([told.by_theta[before], own, told.by_theta[after]]),
    )


def _own_constants(law: RateLaw) -> tuple[tuple[str, ...], Array]:
    """Names of a law's constants, and the factors that bring theta to the user's units."""
    if law.name == SQRT:
        return ("square_root",), np.array([np.sqrt(law.fastest)])
    if law.name == SATURATING:
        return ("slope", "rate"), np.array([1.0, law.fastest])
    return tuple(f"slope[{i}]" for i in range(1, law.size + 1)), np.ones(law.size)


def notes_of_law(fit: Fit) -> tuple[str, ...]:
    """Say which law the radii follow, if not the linear one, and what of it is at a bound.

    Parameters
    ----------
    fit
        The fit, in the user's units.
    """
    layout = layout_of(fit)
    law, constants = layout.law, fit.solution.theta[layout.law_places]
    if law.name == LINEAR or not layout.has_rate:
        return ()
    if law.name == SQRT:
        c = float(constants[0] * np.sqrt(law.fastest))
        return (
            f"the radii grow by g(x) = {c:.4g} sqrt(x) with the rate x of the input, as a table "
            "that ends at twice the fastest rate of the records",
        )
    if law.name == PIECEWISE:
        return (
            f"the radii grow with the rate along {law.size} straight pieces, "
            f"{_reached(layout, fit)}; beyond the fastest rate of the records the last one goes on",
        )
    slope, rate = float(constants[0]), float(constants[1] * law.fastest)
    formula = (
        f"{slope:.4g} x / (1 + x / {rate:.4g})"
        if law.form == "rational"
        else f"{slope * rate:.4g} (1 - exp(-x / {rate:.4g}))"
    )
    said: tuple[str, ...] = (
        f"the radii grow by g(x) = {formula} with the rate x of the input, as a table that ends at "
        "twice the fastest rate of the records",
    )
    if constants[1] > 5.0:
        said += (
            "up to the fastest rate of the records this law is nearly a straight line: the rate at "
            "which it bends is no estimate; rate 'linear' says as much",
        )
    return said


def _reached(layout: RateDependentLayout, fit: Fit) -> str:
    law = layout.law
    curve = next(
        each.rate_curve
        for each in leaves_of(fit.operator)
        if isinstance(each, RateDependentPrandtlIshlinskii)
    )
    half, full = (float(curve(share * law.fastest)) for share in (0.5, 1.0))
    return (
        f"by {half:.4g} at {0.5 * law.fastest:.4g} and {full:.4g} at {law.fastest:.4g} per second"
    )


_NARROWS = (
    "the loops narrow as the rate grows, and radii that shrink with the rate are no model of this "
    "family: their growth came out 0, its bound; creep, which widens slow loops, or a lead of the "
    "output looks like that (--creep auto, --family hammerstein)"
)


def loops_that_narrow(fit: Fit, diagnosis: Diagnosis) -> tuple[str, ...]:
    """Say that loops narrow with the rate where growth came out 0 and the diagnosis shows it.

    Where the error that is left is smooth, regression on it leaves this open.

    Parameters
    ----------
    fit
        The fit, in the user's units.
    diagnosis
        Of its records.
    """
    layout, beside = layout_of(fit), fit.parametrization.nuisances is not None
    if beside or not layout.has_rate:
        return ()
    if layout.law.widening(fit.solution.theta[layout.law_places]) > 0.0:
        return ()
    narrow = any(
        each.amounts["fastest width"] < each.amounts["slowest width"]
        for each in diagnosis.named(RATE_DEPENDENCE)
    )
    return (_NARROWS,) if narrow else ()


@dataclass(frozen=True, eq=False)
class _Seen:
    """What other slopes over the rate would take of a residual."""

    share: float
    probability: float
    narrows: bool


def law_that_does_not_fit(fit: Fit, data: Data, root: Array | None) -> tuple[str, ...]:
    """Say if slopes of the widening that differ from rate to rate would lower the residual.

    A score test: the residual is regressed on its derivatives by all free parameters, and by the
    slopes between rates that the records hold besides.

    Parameters
    ----------
    fit
        The fit, in the user's units.
    data
        Its records.
    root
        Square root of every sample's weight, or None.
    """
    layout = layout_of(fit)
    beside = fit.parametrization.nuisances is not None
    if beside or not layout.has_rate or layout.law.name == PIECEWISE:
        return ()
    seen = _slopes_missed(fit, data, root)
    if seen is None or seen.probability > UNLIKELY or seen.share < WORTH_A_NOTE:
        return ()
    if seen.narrows:
        return (_NARROWS,)
    name = {LINEAR: "in proportion to the rate", SQRT: "with the root of the rate"}.get(
        layout.law.name, "by the saturating law"
    )
    return (
        f"the law of the rate does not fit: with radii that do not grow {name} the squared error "
        f"would be some {100.0 * seen.share:.2g} % smaller; try rate 'auto' (--rate-law auto), or "
        "'piecewise' where it was chosen so",
    )


def _slopes_missed(fit: Fit, data: Data, root: Array | None) -> _Seen | None:
    layout = layout_of(fit)
    law = piecewise_law(data, layout.law.fastest)
    if law.size < 2:
        return None
    weight = np.ones(1) if root is None else root
    by_slopes, by_theta = (each * weight[:, None] for each in _derivatives(fit, data, law))
    error = (model_output(data, fit.operator) - data.measured()) * weight
    if float(error @ error) == 0.0:
        return None
    grows = layout.law.widening(fit.solution.theta[layout.law_places]) > 0.0
    own = by_theta if grows else by_theta[:, fit.parametrization.inside(fit.solution.theta)]
    before = _left(own, error)
    # At the bound a mean slope that is free tells which way the radii would go.
    more = by_slopes if grows else by_slopes.sum(axis=1)[:, None]
    left = _left(np.column_stack([own, more]), error)
    cost, rest = float(before @ before), float(left @ left)
    least = MATTERS * float(np.ptp(data.measured()))
    if cost - rest <= least**2 * float(np.sum(np.square(np.broadcast_to(weight, error.shape)))):
        return None
    freedom = max(error.size / correlation_time(left) - own.shape[1] - law.size, 1.0)
    directions = law.size - 1 if grows else 1
    narrows = not grows and float(_left(own, more[:, 0]) @ before) > 0.0
    return _Seen(1.0 - rest / cost, chance(cost, rest, directions, freedom), narrows)


def _derivatives(fit: Fit, data: Data, law: RateLaw) -> tuple[Array, Array]:
    """By the slopes of a piecewise law tangent to the fit's, and by the fit's parameters."""
    operator = fit.operator
    leaves = list(leaves_of(operator))
    at = next(i for i, e in enumerate(leaves) if isinstance(e, RateDependentPrandtlIshlinskii))
    plays = leaves[at]
    assert isinstance(plays, RateDependentPrandtlIshlinskii), "just found"
    by_theta = model_jacobian(data, operator) @ fit.parametrization.transform
    # Knees of both laws in one curve, so that the plays stay what they are.
    curve = plays.rate_curve
    joined = type(curve)(
        curve.beta,
        curve.powers,
        np.concatenate([curve.slopes, np.zeros(law.curve.knees.size)]),
        np.concatenate([curve.knees, law.curve.knees]),
    )
    leaves[at] = RateDependentPrandtlIshlinskii(
        plays.p, plays.r, joined, plays.dt, plays.p0, plays.z0
    )
    by_all = model_jacobian(data, Composition(tuple(leaves)))
    first = sum(len(each.parameters()) for each in leaves[:at]) + 2 * plays.p.size + 1
    new = slice(first + 1 + curve.slopes.size, first + 1 + joined.slopes.size)
    return np.column_stack([by_all[:, first], by_all[:, new]]), by_theta


def _left(columns: Array, error: Array) -> Array:
    """Give what is left of an error beside columns."""
    scale = np.linalg.norm(columns, axis=0)
    scaled = columns[:, scale > 0.0] / scale[scale > 0.0]
    solution, *_ = np.linalg.lstsq(scaled, error, rcond=1e-10)
    return np.asarray(error - scaled @ solution)
