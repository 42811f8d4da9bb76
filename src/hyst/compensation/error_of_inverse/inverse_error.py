"""How wrong an approximate inverse can be at most: the bound of S1 eq. 16, with its parts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import as_positive
from hyst.compensation.error_of_inverse.slope_steps import SlopeSteps
from hyst.errors import InputError
from hyst.models.mapped_plays import MappedPlays
from hyst.models.piecewise_map import PiecewiseMap, largest_distance
from hyst.operators import Operator

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class ErrorBound:
    """The largest error of an approximate inverse, from rest, for every ``|y_ref| <= y_max``.

    Parameters
    ----------
    bound
        ``envelope_error + lipschitz (plays_error + map_error)``, S1 eq. 16: the command of the
        approximate inverse is never farther than this from that of the exact one; input units.
    envelope_error
        Largest difference of the two envelope inverses, over what the approximate inverse plays
        can put out; input units.
    lipschitz
        Largest slope of the exact envelope inverse, over what either inverse plays can put out.
    plays_error
        ``integral |phi_hat - phi|``, the largest difference of the outputs of the inverse plays.
    map_error
        The same for the inverse maps after the plays, times the sum of the inverse plays' absolute
        weights; 0 for PI and GPI models.
    sharp_bound
        The same bound without the triangle inequality of eq. 16, never above ``bound``.
    output_bound
        ``|model(approximate_inverse(y_ref)) - y_ref|`` never exceeds this (the error delta_H of
        S1 eq. 17); output units.
    reached
        The largest command error that one of the inputs tried does reach; between this and
        ``sharp_bound`` lies the least bound there is. Input units.
    worst_reference
        Turning points of the wanted output that reaches it, from rest; output units.
    y_max
        Largest amplitude of the wanted output, output units.
    """

    bound: float
    envelope_error: float
    lipschitz: float
    plays_error: float
    map_error: float
    sharp_bound: float
    output_bound: float
    reached: float
    worst_reference: Array
    y_max: float

    def summary(self) -> str:
        """Give the bound and its parts as a few lines of text."""
        parts = f"{self.envelope_error:.4g} + {self.lipschitz:.4g} x {self.plays_error:.4g}"
        if self.map_error:
            parts = (
                f"{self.envelope_error:.4g} + {self.lipschitz:.4g} x ({self.plays_error:.4g} + "
                f"{self.map_error:.4g})"
            )
        return "\n".join(
            [
                f"For every wanted output within +-{self.y_max:.4g}, from rest:",
                f"  command off by at most   {self.bound:.4g}   (eq. 16: {parts})",
                f"  without its triangle     {self.sharp_bound:.4g}",
                f"  reached by an example    {self.reached:.4g}   "
                f"({self.worst_reference.size} turning points)",
                f"  output off by at most    {self.output_bound:.4g}",
            ]
        )

    def to_dict(self) -> dict[str, Any]:
        """Give all numbers as plain ones."""
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in vars(self).items()
        }


def error_bound(model: Operator, approximate_inverse: Operator, y_max: float) -> ErrorBound:
    """Bound the error of an approximate inverse of a PI, GPI or MPI model.

    With the exact inverse ``u = d(G^-1[m(y)])`` and the approximate one ``u_hat``, hats alike,

        |u - u_hat| <= max |d - d_hat| + L_d (integral_0^R |phi_hat - phi| ds + L_G^-1 max |m -
        m_hat|)

    for every y within ``+-y_max`` that starts from rest; phi and phi_hat are the cumulative weights
    of the inverse plays, R the largest ``|m_hat(y)|``. The numbers of plays may differ; the
    integral of the piecewise constant difference is exact.

    Parameters
    ----------
    model
        ``PrandtlIshlinskii``, alone or between maps (``DeadZone``, ``Affine``), invertible, with
        no initial memory.
    approximate_inverse
        The same kind of chain, of any number of plays, also none: ``Affine(1.0)`` is "no inverse".
    y_max
        Largest ``|y_ref|``, positive, output units.

    Returns
    -------
    ErrorBound

    Raises
    ------
    InputError
        If a model is of another kind or starts from memory, or y_max is not positive and finite.
    NotInvertibleError
        If the model has no exact inverse; the message names the condition that fails.

    Notes
    -----
    S1 eqs. 11-16. The integral is the least bound there is: choose the memory ``s -> F_s`` of slope
    -sign(phi_hat - phi), which some input within +-R leaves, and it is attained (``reached``). As
    printed, three things must be read otherwise: (a) ``sup w`` is ``sup |w|`` (a w that stays below
    0 has sup 0 and an error); (b) ``max |d - d_hat|`` over all numbers is infinite as soon as the
    outermost slopes differ, and is meant over what G_hat^-1 can put out, at most
    ``integral_0^R |phi_hat|``; L_d over what either can; (c) it bounds the *command*. The error
    delta_H of eq. 17 is one of the *output*, and needs the model's own Lipschitz constant, or, as
    here in ``output_bound``, the composition: G after G_hat^-1 is itself a bank of plays, of
    slope ``phi_G(f_hat(s)) phi_hat(s)``, so that ``integral |that - 1|`` bounds it and is attained.

    Examples
    --------
    >>> from hyst.models import PrandtlIshlinskii
    >>> from hyst.operators import Affine
    >>> model = PrandtlIshlinskii([1.0], [1.0], p0=1.0)
    >>> limit = error_bound(model, Affine(1.0), y_max=3.0)
    >>> limit.bound, limit.reached, limit.output_bound
    (1.0, 1.0, 2.0)
    """
    reach = as_positive(y_max, "y_max", "the largest |y_ref|")
    own = MappedPlays.of(model, "the model")
    exact = own.inverse()
    approximate = MappedPlays.of(approximate_inverse, "the approximate inverse", like=exact)
    bound = _bound(own, exact, approximate, reach)
    if not np.isfinite([bound.bound, bound.output_bound]).all():
        raise InputError(
            f"the bound at y_max = {reach:.6g} is beyond double precision; choose other units"
        )
    return bound


def _bound(
    own: MappedPlays, exact: MappedPlays, approximate: MappedPlays, y_max: float
) -> ErrorBound:
    phi, phi_hat = SlopeSteps.of(exact.plays), SlopeSteps.of(approximate.plays)
    difference = phi_hat.minus(phi)
    into = exact.before.largest_value(y_max), approximate.before.largest_value(y_max)
    out = phi.largest_output(into[0]), phi_hat.largest_output(into[1])
    plays_error = difference.largest_output(into[1])
    map_distance = largest_distance(exact.before, approximate.before, (y_max, y_max), 0.0)
    map_error = _gain_of(exact, max(into)) * map_distance
    envelope_error = largest_distance(exact.after, approximate.after, (out[1], out[1]), 0.0)
    lipschitz = exact.after.largest_slope(max(out))
    bound = envelope_error + lipschitz * (plays_error + map_error)
    sharp = largest_distance(exact.after, approximate.after, out, plays_error + map_error)
    worst, reached = _worst_reference(own, exact, approximate, difference, into[1], y_max)
    return ErrorBound(
        bound=bound,
        envelope_error=envelope_error,
        lipschitz=lipschitz,
        plays_error=plays_error,
        map_error=map_error,
        sharp_bound=min(sharp, bound),
        output_bound=_output_bound(own, approximate, (into[1], *out), plays_error, map_distance),
        reached=reached,
        worst_reference=worst,
        y_max=y_max,
    )


def _gain_of(parts: MappedPlays, reach: float) -> float:
    """Lipschitz constant of the plays in the maximum norm: those of larger thresholds rest."""
    plays = parts.plays
    return abs(plays.p0) + float(np.abs(plays.p[plays.r < reach]).sum())


def _output_bound(
    own: MappedPlays,
    approximate: MappedPlays,
    ranges: tuple[float, float, float],
    plays_error: float,
    map_distance: float,
) -> float:
    """Bound of the output error, part by part along ``m(G[d(d_hat(G_hat^-1[m_hat(y)]))])``."""
    into, exact_out, out = ranges
    round_trip = PiecewiseMap((*approximate.after.stages, *own.before.stages))
    envelope = largest_distance(round_trip, PiecewiseMap(), (out, out), 0.0)
    gain = _gain_of(own, max(out, round_trip.largest_value(out)))
    plays = _gain_of(own, max(out, exact_out)) * plays_error
    phi_hat = SlopeSteps.of(approximate.plays)
    if phi_hat.levels.min() >= 0.0:
        plays = _composed_error(SlopeSteps.of(own.plays), phi_hat, into)
    before_map = gain * envelope + plays
    # What the map after the plays can see: within the range of m_hat, and that error beyond.
    steepest = own.after.largest_slope(into + before_map + map_distance)
    return steepest * (before_map + map_distance)


def _composed_error(phi: SlopeSteps, phi_hat: SlopeSteps, reach: float) -> float:
    """``integral |phi(f_hat(s)) phi_hat(s) - 1| ds``, f_hat the rising loading curve of phi_hat."""
    edges, rising = phi_hat.integral(reach)
    # Where f_hat passes a threshold of phi; flat pieces pass none.
    inside = phi.starts[(phi.starts > 0.0) & (phi.starts < rising[-1])]
    piece = np.searchsorted(rising, inside, side="right") - 1
    slopes = phi_hat(edges[piece])
    cuts = np.union1d(edges, edges[piece] + (inside - rising[piece]) / slopes)
    middles = 0.5 * (cuts[1:] + cuts[:-1])
    levels = phi(np.interp(middles, edges, rising)) * phi_hat(middles)
    return float(np.abs(levels - 1.0) @ np.diff(cuts))


def _worst_reference(
    own: MappedPlays,
    exact: MappedPlays,
    approximate: MappedPlays,
    difference: SlopeSteps,
    reach: float,
    y_max: float,
) -> tuple[Array, float]:
    """Of a few references that drive the plays apart, the worst, and the error it reaches."""
    points = difference.worst_input(reach)
    candidates = [sign * each for sign in (1.0, -1.0) for each in (points, np.array([reach]))]
    worst, reached = np.array([y_max]), -1.0
    for x in candidates:
        y = np.clip(own.after(x), -y_max, y_max)
        error = np.abs(_run(exact, y) - _run(approximate, y))
        if error.max() > reached:
            reached = float(error.max())
            worst = y[: int(error.argmax()) + 1]
    return worst, reached


def _run(parts: MappedPlays, y: Array) -> Array:
    return parts.after(parts.plays(parts.before(y)))
