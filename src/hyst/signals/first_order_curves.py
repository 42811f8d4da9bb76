"""First-order reversal curves of a record, and the density of relays that they show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import InputError, NotIdentifiableError
from hyst.signals.noise import suggest_dead_band
from hyst.signals.record import Record
from hyst.signals.turning_points import reversals

Array = NDArray[np.float64]

NEAR_TOP = 0.05
"""Of the input's range: a descent that begins so near the highest input begins in saturation."""

APART = 0.01
"""Of the input's range: curves whose reversals lie nearer are one curve, driven again."""

AGAIN = 0.1
"""Of the mean spacing of reversals: nearer ones are no spacing."""

FEWEST_CURVES = 4
FEWEST_SAMPLES = 4
TERMS = 6
SPARE = 2
"""Times as many samples as terms that a local polynomial takes at least."""


@dataclass(frozen=True, eq=False)
class ReversalCurve:
    """What an actuator answers while its input rises from a reversal that it came to from the top.

    Parameters
    ----------
    beta
        Input at the reversal, input units.
    u, y
        Shape (N,), input and output from there on, input ascending.
    u_down, y_down
        Shape (M,), on the way from the top to the reversal, input ascending.
    """

    beta: float
    u: Array
    y: Array
    u_down: Array
    y_down: Array


@dataclass(frozen=True, eq=False)
class ForcDensity:
    """Density of relays over their thresholds.

    Parameters
    ----------
    alpha, beta
        Shape (n,), thresholds, ascending, input units.
    density
        Shape (n, n), rows for alpha and columns for beta, mass (half of what the output moves by)
        over the square of an input unit; NaN where the curves do not tell it.
    """

    alpha: Array
    beta: Array
    density: Array


def reversal_curves(records: Record | Sequence[Record]) -> tuple[ReversalCurve, ...]:
    """Find the first-order reversal curves in records.

    A curve is a rise from a reversal that the input came to on one descent from the top of its
    range, as ``hyst.signals.forc`` drives it; rises elsewhere in a record are passed over.

    Parameters
    ----------
    records
        One or more records of one actuator.

    Returns
    -------
    tuple of ReversalCurve
        From the lowest reversal to the highest.

    Raises
    ------
    InputError
        If there is no record, or something else than records.
    NotIdentifiableError
        If there are fewer than four, or fewer than four places where they begin.

    Examples
    --------
    >>> from hyst.signals import forc
    >>> drive = forc(0.01, -1.0, 1.0, 1.0, curves=5)
    >>> curves = reversal_curves(Record(drive.u, drive.u, 0.01))
    >>> [round(each.beta, 2) for each in curves]
    [-1.0, -0.6, -0.2, 0.2, 0.6]
    """
    given = (records,) if isinstance(records, Record) else tuple(records)
    for number, each in enumerate(given, 1):
        if not isinstance(each, Record):
            raise InputError(f"record {number} is {type(each).__name__}; give a hyst.Record")
    if not given:
        raise InputError("there is no record; give one or more")
    high = max(float(each.u.max()) for each in given)
    span = high - min(float(each.u.min()) for each in given)
    found = [curve for record in given for curve in _curves_of(record, high, span)]
    if len(found) < FEWEST_CURVES:
        raise NotIdentifiableError(
            f"the records have {len(found)} first-order reversal curves (rises from a reversal "
            f"that the input came to from the top of its range); {FEWEST_CURVES} are needed, so "
            "drive them with hyst.signals.forc or hyst excite --kind forc"
        )
    curves = tuple(sorted(found, key=lambda each: each.beta))
    places = _places_of_reversal(curves, APART * span)
    if places < FEWEST_CURVES:
        raise NotIdentifiableError(
            f"the {len(curves)} first-order reversal curves of the records begin at {places} "
            f"different input{'s' if places > 1 else ''}, the lowest at {curves[0].beta:.6g}; "
            f"{FEWEST_CURVES} are needed, so drive them with hyst.signals.forc or hyst excite "
            "--kind forc"
        )
    return curves


def _places_of_reversal(curves: Sequence[ReversalCurve], apart: float) -> int:
    """Count the reversals of curves in order, those nearer than so to one counted left out."""
    count, last = 0, -np.inf
    for each in curves:
        if each.beta - last >= apart:
            count, last = count + 1, each.beta
    return count


def _curves_of(record: Record, high: float, span: float) -> list[ReversalCurve]:
    u, y = record.u, record.y
    turns = reversals(u, max(suggest_dead_band(u), 1e-3 * span)).tolist()
    ends = [0, *turns, u.size - 1]
    found = []
    for top, low, end in zip(ends, ends[1:], ends[2:], strict=False):
        falls = u[top] - u[low] > 0.0 and u[end] > u[low]
        if falls and u[top] >= high - NEAR_TOP * span and end - low >= FEWEST_SAMPLES:
            rise, descent = (
                _ascending(u[at], y[at]) for at in (slice(low, end + 1), slice(top, low))
            )
            found.append(ReversalCurve(float(u[low]), *rise, *descent))
    return found


def _ascending(u: Array, y: Array) -> tuple[Array, Array]:
    order = np.argsort(u, kind="stable")
    return u[order], y[order]


def forc_density(
    curves: Sequence[ReversalCurve], points: int = 60, smoothing: int = 3
) -> ForcDensity:
    """Find the density of relays from first-order reversal curves by local polynomials.

        rho(alpha, beta) = -1/2 d^2 y / (d alpha d beta)

    At every point of a grid a polynomial of second order is fitted to the samples within
    ``smoothing`` spacings of reversals and of the grid; its mixed term is the density. What does
    not change from curve to curve, as a linear part or a drift from one to the next, has none.

    Parameters
    ----------
    curves
        Of ``reversal_curves``.
    points
        Of the grid along a side, 10 to 400.
    smoothing
        How many spacings of the reversals (for beta) and of the grid (for alpha, at least as far)
        are taken on either side, 1 to 20: noise falls with it, and peaks get wider.

    Returns
    -------
    ForcDensity

    Raises
    ------
    InputError
        If a count is out of range, or all curves begin at one input.

    Notes
    -----
    Pike, Roberts and Verosub, J. Appl. Phys. 85 (1999) 6660-6667, eq. 2 and sec. III.

    Examples
    --------
    >>> import hyst
    >>> drive = hyst.signals.forc(0.01, -1.0, 1.0, 1.0)
    >>> even = hyst.Preisach([[1.0]], [-1.0, 1.0])
    >>> record = Record(drive.u, even(drive.u), 0.01)
    >>> found = forc_density(reversal_curves(record), points=20)
    >>> float(np.nanmedian(found.density).round(6))  # a mass of 1 over an area of 2
    0.5
    """
    count = whole_number(points, "points", 10, 400)
    width = whole_number(smoothing, "smoothing", 1, 20)
    spacing = _spacing(curves)
    betas = np.array([each.beta for each in curves])
    alpha_of = np.concatenate([each.u for each in curves])
    beta_of = np.repeat(betas, [each.u.size for each in curves])
    y = np.concatenate([each.y for each in curves])
    low, high = float(betas.min()), float(alpha_of.max())
    grid = np.linspace(low, high, count)
    reach = width * max(spacing, (high - low) / count)
    density = np.full((count, count), np.nan)
    for j, beta in enumerate(grid):
        near = np.abs(beta_of - beta) <= reach
        for i in range(j, count):
            rows = near & (np.abs(alpha_of - grid[i]) <= reach)
            density[i, j] = _mixed(alpha_of[rows] - grid[i], beta_of[rows] - beta, y[rows], reach)
    return ForcDensity(grid, grid, density)


def _spacing(curves: Sequence[ReversalCurve]) -> float:
    """Give the usual distance between neighbouring reversals."""
    if not isinstance(curves, Sequence) or not all(isinstance(c, ReversalCurve) for c in curves):
        raise InputError("these are no curves; give what hyst.signals.reversal_curves gives")
    betas = np.sort([each.beta for each in curves])
    steps = np.diff(betas)
    steps = steps[steps > AGAIN * (betas[-1] - betas[0]) / betas.size] if betas.size else steps
    if not steps.size:
        raise InputError(
            f"{len(curves)} curves begin at one input, so none shows how they change with it; give "
            "those of several reversals"
        )
    return float(np.median(steps))


def _mixed(a: Array, b: Array, y: Array, reach: float) -> float:
    """Give minus half the mixed derivative of a local polynomial; NaN of too few samples."""
    if a.size < SPARE * TERMS:
        return float("nan")
    x, z = a / reach, b / reach
    matrix = np.column_stack([np.ones(x.size), x, z, x * x, z * z, x * z])
    solution, _, rank, _ = np.linalg.lstsq(matrix, y - y.mean(), rcond=1e-9)
    return float("nan") if rank < TERMS else -0.5 * float(solution[-1]) / reach**2
