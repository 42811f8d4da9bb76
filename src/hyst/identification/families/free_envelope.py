"""Plays behind an envelope of any shape, which may be flat and fall, so that there is no inverse.

theta = (p0, p_1 .. p_n, r_1 .. r_n, weights of the envelope, its knots if they are found, offset).
The weights of the plays add up to 1: only the product of their scale and the envelope's shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hyst.identification.choice.fits_from_starts import best_of_starts
from hyst.identification.families.family import Fit, Start
from hyst.identification.families.play_layout import PlayLayout, PlayParametrization
from hyst.identification.families.plays import layout_of, weights_left
from hyst.identification.families.prandtl_ishlinskii import PrandtlIshlinskii
from hyst.identification.fit.parametrization import selection
from hyst.identification.fit.weight_rules import NON_NEGATIVE
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import LARGEST_RADIUS
from hyst.models import GeneralizedPrandtlIshlinskii
from hyst.models import PrandtlIshlinskii as PlayModel
from hyst.operators import Affine, DeadZone
from hyst.operators.composition import leaves_of

Array = NDArray[np.float64]

_ITERATIONS = 30


def free_envelope_starts(
    overview: Overview,
    size: int,
    most: int,
    knots: int | tuple[float, ...],
    radii: tuple[float, ...] | None,
) -> Sequence[Start]:
    """Fit an envelope with the hysteresis taken as noise, then plays behind it.

    Parameters
    ----------
    overview
        The records.
    size
        Number of plays.
    most
        How many starts of the plays are worth trying.
    knots
        How many, whose places are found; or their places, input units.
    radii
        To keep; those of the plays for an envelope whose output spans what its input spans.
    """
    data = overview.data
    places = _places(overview.input, knots)
    weights = _fit_map(overview.input, data.measured(), places)
    envelope = DeadZone(weights, np.concatenate([[0.0], places]))
    inner = tuple(replace(each, u=envelope(each.u)) for each in data.records)
    low, high = min(r.u.min() for r in inner), max(r.u.max() for r in inner)
    swing = float(high - low)
    kept = None if radii is None else [r * swing / (2.0 * data.half_range) for r in radii]
    plays = PrandtlIshlinskii(radii=kept, weights=NON_NEGATIVE)
    behind = Overview(replace(data, records=inner, half_range=swing / 2.0))
    fit = best_of_starts(plays, behind, size, most, _ITERATIONS)
    layout, theta = layout_of(fit), fit.solution.theta
    found, scale = layout.weights(theta), float(layout.weights(theta).sum())
    return [
        _parametrize(
            DeadZone(behind.sign * scale * weights, envelope.thresholds),
            PlayModel(found[1:] / scale, layout.radii(theta) * scale, found[0] / scale),
            float(theta[-1]),
            radius_limit=LARGEST_RADIUS * swing * scale / 2.0,
            knots_move=isinstance(knots, int),
            radii_move=radii is None,
        )
    ]


def with_plays_left_out(fit: Fit, working: NDArray[np.bool_]) -> Start:
    """Give the same envelope before fewer plays.

    Parameters
    ----------
    fit
        Of plays behind a free envelope.
    working
        Which plays to keep.
    """
    envelope, plays, affine = leaves_of(fit.operator)
    assert isinstance(envelope, DeadZone), "the envelope comes first"
    assert isinstance(plays, PlayModel), "then the plays"
    assert isinstance(affine, Affine), "then the offset"
    layout = layout_of(fit)
    radii = slice(layout.plays + 1, 2 * layout.plays + 1)
    kept = weights_left(plays.p, working)
    total = plays.p0 + float(kept.sum())
    count = fit.solution.theta.size - 2 * layout.plays - 2 - envelope.weights.size
    return _parametrize(
        DeadZone(envelope.weights * total, envelope.thresholds),
        PlayModel(kept / total, plays.r[working] * total, plays.p0 / total),
        affine.offset,
        radius_limit=float(layout.upper[radii].max()) * total,
        knots_move=count > 0,
        radii_move=True,
    )


def _parametrize(
    envelope: DeadZone,
    plays: PlayModel,
    offset: float,
    *,
    radius_limit: float,
    knots_move: bool,
    radii_move: bool,
) -> Start:
    n, size = plays.p.size, envelope.weights.size
    template = Affine(1.0, offset) @ GeneralizedPrandtlIshlinskii(envelope, plays)
    fixed = template.parameters().values.copy()
    # Constants: weights and thresholds of the envelope, p0, p, r, gain, offset.
    places = [*range(2 * size, 2 * size + 1 + 2 * n), *range(size)]
    places += range(size + 1, 2 * size) if knots_move else ()
    places += [fixed.size - 1]
    theta = fixed[places]
    fixed[places] = 0.0
    lower, upper = np.full(theta.size, -np.inf), np.full(theta.size, np.inf)
    lower[: n + 1] = 0.0
    radii, knots = slice(n + 1, 2 * n + 1), slice(2 * n + 1 + size, theta.size - 1)
    lower[radii], upper[radii] = 1e-4 * radius_limit, radius_limit
    if not radii_move:
        lower[radii] = upper[radii] = theta[radii]
    if knots_move:
        lower[knots], upper[knots] = _reach(theta[knots])
    theta = np.clip(theta, lower, upper)
    layout = PlayLayout(np.eye(n + 1), lower, upper)
    parametrization = PlayParametrization(
        template,
        selection(fixed.size, places),
        fixed,
        lower,
        upper,
        layout.canonical,
        gauges=partial(_sum_of_weights, n),
        gauge_count=1,
        layout=layout,
    )
    return parametrization, theta


def _sum_of_weights(n: int, theta: Array) -> tuple[Array, Array]:
    row = np.zeros((1, theta.size))
    row[0, : n + 1] = 1.0
    return row @ theta - 1.0, row


def _places(u: Array, knots: int | tuple[float, ...]) -> Array:
    """Give knots at equal shares of the samples, or those given; none at 0, where maps start."""
    if isinstance(knots, int):
        shares = np.arange(1, knots + 1) / (knots + 1)
        # Half evenly over the range: a map bends where the input seldom is, too.
        even = np.linspace(u.min(), u.max(), knots + 2)[1:-1]
        places = 0.5 * (np.quantile(u, shares) + even)
    else:
        places = np.array(knots)
    return np.asarray(places[np.abs(places) > 1e-6 * float(np.ptp(u))])


def _reach(knots: Array) -> tuple[Array, Array]:
    """Let each knot move to halfway to its neighbours, and not across 0."""
    fence = np.sort(np.append(knots, 0.0))
    halves = 0.5 * (fence[1:] + fence[:-1])
    edges = np.concatenate([[1.5 * fence[0]], halves, [1.5 * fence[-1]]])
    place = np.searchsorted(fence, knots)
    lower, upper = edges[place], edges[place + 1]
    return np.minimum(lower, knots), np.maximum(upper, knots)


def _fit_map(u: Array, y: Array, knots: Array) -> Array:
    """Weights of the map by least squares, the hysteresis taken as noise."""
    at = u[:, None]
    ramps = np.where(knots > 0.0, np.maximum(at - knots, 0.0), np.minimum(at - knots, 0.0))
    columns = np.column_stack([u, ramps, np.ones(u.size)])
    scale = np.maximum(np.abs(columns).max(axis=0), np.finfo(np.float64).tiny)
    solution = np.linalg.lstsq(columns / scale, y, rcond=1e-10)[0] / scale
    return np.asarray(solution[:-1])
