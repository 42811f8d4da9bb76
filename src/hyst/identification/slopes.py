"""Number of plays, weights and first radii from the slopes of loops, by segmented regression.

Invariant: the segmentation is the best there is of the binned stroke, found by dynamic programming;
only the knots are refined afterwards, between bins.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.blas_threads import one_blas_thread
from hyst.models import PrandtlIshlinskii
from hyst.signals import Record, reversals, suggest_dead_band

Array = NDArray[np.float64]

_BINS = 150
_REFINEMENTS = 30


@dataclass(frozen=True, eq=False)
class Slopes:
    """Slopes of the strokes of a record and the plays they belong to.

    Parameters
    ----------
    slopes
        Shape (n + 1,), ascending, ``p0, p0 + p_1, ..``; output units per input unit.
    knots
        Shape (n,), distance from a reversal at which each slope ends, ``2 r_i``; input units.
    rms
        Root mean square error of the segmented line, output units.
    strokes
        Number of strokes it was fitted to.
    least_steps
        Shape (n + 1,), for each slope the smallest weight a further play must have to be seen
        through the noise, with its knot in the middle of where that slope holds; output units per
        input unit.
    """

    slopes: Array
    knots: Array
    rms: float
    strokes: int
    least_steps: Array

    @property
    def model(self) -> PrandtlIshlinskii:
        """The plays: weights from the slopes, radii from where they change."""
        return PrandtlIshlinskii(np.diff(self.slopes), self.knots / 2.0, float(self.slopes[0]))

    @property
    def noise_hides_plays(self) -> bool:
        """Whether a play as heavy as the lightest one found could be there and not be seen.

        Where none was found: one of a tenth of the slope.
        """
        return bool((self.least_steps > self._lightest()).any())

    def summary(self) -> str:
        """Give number and constants of the plays, and what the noise may hide, in sentences."""
        plays = "; ".join(
            f"p[{i}] = {p:.4g} at r[{i}] = {r:.4g}"
            for i, (p, r) in enumerate(zip(np.diff(self.slopes), self.knots / 2.0, strict=True), 1)
        )
        said = (
            f"{self.knots.size} plays from {self.strokes} strokes, rms error {self.rms:.4g}: "
            f"p0 = {self.slopes[0]:.4g}" + (f"; {plays}" if plays else "")
        )
        if not self.noise_hides_plays:
            return f"{said}."
        worst = int(np.argmax(self.least_steps))
        radii = [0.0, *(self.knots / 2.0)]
        upper = f"and {radii[worst + 1]:.4g}" if worst + 1 < len(radii) else "and the widest"
        return (
            f"{said}. The noise hides plays: between radii {radii[worst]:.4g} {upper} one of a "
            f"weight below {self.least_steps[worst]:.4g} is not seen, so there may be more plays, "
            "and one found may stand for several; average more strokes, or give plays."
        )

    def _lightest(self) -> float:
        if self.knots.size == 0:
            return 0.1 * abs(float(self.slopes[0]))
        return float(np.abs(np.diff(self.slopes)).min())


def identify_weights_from_slopes(
    record: Record,
    plays: int | Literal["auto"] = "auto",
    max_plays: int = 8,
    start: int = 0,
) -> Slopes:
    """Read number and weights of plays off the slopes of a record (S2 lemma 1).

    On a stroke between reversals ``y = y_m +- 2 f(|u - u_m| / 2)`` with f piecewise linear of
    slopes ``p0, p0 + p_1, ..`` and knots r_i. All strokes of nearly the largest swing are laid over
    each other, and the best segmented line is found by dynamic programming, then refined.

    Parameters
    ----------
    record
        With at least two reversals, and strokes that span more than twice the largest radius.
    plays
        How many plays; ``"auto"`` chooses by the Bayesian information criterion.
    max_plays
        Most plays that ``"auto"`` tries.
    start
        First sample to use.

    Returns
    -------
    Slopes

    Raises
    ------
    InputError
        If ``plays``, ``max_plays`` or ``start`` is out of range.
    NotIdentifiableError
        If the record has no stroke between two reversals, too few samples on them, or an output
        that rests.

    Notes
    -----
    S2 lemma 1 and sec. V-A, where segments are chosen by eye and slopes by a bat-inspired search.
    Bellman and Roth (1969) for the dynamic program; Muggeo, Statistics in Medicine 22 (2003),
    3055-3071 for the refinement of the knots.

    Examples
    --------
    >>> truth = PrandtlIshlinskii(p=[0.5, 0.25], r=[0.5, 1.5], p0=1.0)
    >>> u = 5.0 * np.sin(np.arange(2000) / 50.0)
    >>> found = identify_weights_from_slopes(Record(u, truth(u), 1.0)).model
    >>> found.p.round(2), found.r.round(2)
    (array([0.5 , 0.25]), array([0.5, 1.5]))

    ``summary()`` says where noise may hide plays.
    """
    if plays != "auto" and (not isinstance(plays, int) or plays < 0):
        raise InputError(f"plays is {plays!r}; give a whole number of at least 0, or 'auto'")
    if max_plays < 0 or not 0 <= start < len(record):
        raise InputError(f"max_plays is {max_plays} and start {start}; give them within range")
    x, y, strokes = _overlaid_strokes(record.u[start:], record.y[start:])
    counts = range(max_plays + 1) if plays == "auto" else (plays,)
    edges = np.unique(np.linspace(0, x.size, min(_BINS, x.size // 3) + 1).astype(int))
    cuts = _best_cuts(_sums(x, y, edges), max(counts) + 1)
    with one_blas_thread():
        return _best_line(x, y, cuts, counts, edges, strokes)


def _best_line(
    x: Array,
    y: Array,
    cuts: list[NDArray[np.int_]],
    counts: Sequence[int],
    edges: NDArray[np.int_],
    strokes: int,
) -> Slopes:
    """Give the line of the number of plays with the least information criterion."""
    floor = x.size * (1e-9 * float(np.ptp(y))) ** 2
    best, best_score = None, np.inf
    for count in counts:
        knots = _refine(x, y, x[edges[cuts[count]]])
        solution, error = _fit(x, y, knots)
        score = x.size * np.log(max(error, floor)) + (2 * knots.size + 2) * np.log(x.size)
        if score < best_score:
            slopes, rms = np.cumsum(solution[1:]), float(np.sqrt(error / x.size))
            least = _least_steps(x, knots, max(error, floor))
            best, best_score = Slopes(slopes, knots, rms, strokes, least), score
        if error <= floor:
            break
    assert best is not None
    return best


def _least_steps(x: Array, knots: Array, error: float) -> Array:
    """Give the weights at which a play in the middle of each piece lowers the criterion."""
    # N log(1 - p^2 h / error) = -2 log(N), h the square of what the other columns leave of a hinge.
    share = -np.expm1(-2.0 * np.log(x.size) / x.size)
    ends = np.concatenate([x[:1], knots, x[-1:]])
    hinges = np.maximum(x[:, None] - (ends[1:] + ends[:-1]) / 2.0, 0.0)
    matrix = np.column_stack([np.ones(x.size), x, np.maximum(x[:, None] - knots, 0.0)])
    left = hinges - matrix @ np.linalg.lstsq(matrix, hinges, rcond=None)[0]
    with np.errstate(divide="ignore"):
        return np.asarray(np.sqrt(share * error / np.sum(left**2, axis=0)))


def _overlaid_strokes(u: Array, y: Array) -> tuple[Array, Array, int]:
    """Distances from the reversal and outputs, sorted by distance, of all large strokes."""
    turns = reversals(u, suggest_dead_band(u))
    pairs = list(itertools.pairwise(turns.tolist()))
    if not pairs:
        raise NotIdentifiableError(
            f"the input has {turns.size} reversals; slopes are read between two, so drive it "
            "up and down at least once more"
        )
    largest = max(abs(u[b] - u[a]) for a, b in pairs)
    distances, outputs = [], []
    for a, b in pairs:
        if abs(u[b] - u[a]) >= 0.9 * largest:
            side = np.sign(u[b] - u[a])
            distances.append(side * (u[a : b + 1] - u[a]))
            stroke = side * y[a : b + 1]
            # Aligned by their means: one noisy sample at the reversal must not shift a stroke.
            outputs.append(stroke - stroke.mean())
    x, w = np.concatenate(distances), np.concatenate(outputs)
    if x.size < 20:
        raise NotIdentifiableError(f"{x.size} samples on full strokes are too few; give 20 or more")
    if not np.ptp(w) > 0.0:
        raise NotIdentifiableError(
            "the output rests while the input moves, so its slopes are zero; check its column"
        )
    order = np.argsort(x, kind="stable")
    return x[order], w[order], len(distances)


def _sums(x: Array, y: Array, edges: NDArray[np.int_]) -> Array:
    """Cumulative moments at the edges of the bins: count, x, y, xx, xy, yy."""
    moments = np.stack([np.ones(x.size), x, y, x * x, x * y, y * y])
    total = np.concatenate([np.zeros((6, 1)), np.cumsum(moments, axis=1)], axis=1)
    return np.asarray(total[:, edges])


def _costs(sums: Array, last: int) -> Array:
    """Squared errors of the lines over bins first .. last - 1, for every first < last."""
    count, x, y, xx, xy, yy = sums[:, last : last + 1] - sums[:, :last]
    sxx, sxy, syy = xx - x * x / count, xy - x * y / count, yy - y * y / count
    with np.errstate(all="ignore"):
        explained = np.where(sxx > 0.0, sxy * sxy / sxx, 0.0)
    return np.asarray(np.maximum(syy - explained, 0.0))


def _best_cuts(sums: Array, segments: int) -> list[NDArray[np.int_]]:
    """For 1 .. segments lines: the inner edges of the best segmentation."""
    bins = sums.shape[1] - 1
    error = np.full((segments + 1, bins + 1), np.inf)
    source = np.zeros((segments + 1, bins + 1), dtype=int)
    error[0, 0] = 0.0
    for last in range(1, bins + 1):
        costs = _costs(sums, last)
        for k in range(1, segments + 1):
            through = error[k - 1, :last] + costs
            source[k, last] = int(np.argmin(through))
            error[k, last] = through[source[k, last]]
    cuts = []
    for k in range(1, segments + 1):
        path, place = [], bins
        for left in range(k, 0, -1):
            place = int(source[left, place])
            path.append(place)
        cuts.append(np.array(path[-2::-1], dtype=int))
    return cuts


def _fit(x: Array, y: Array, knots: Array) -> tuple[Array, float]:
    """Intercept, first slope and changes of slope of a continuous line, and its squared error."""
    matrix = np.column_stack([np.ones(x.size), x, np.maximum(x[:, None] - knots, 0.0)])
    solution = np.linalg.lstsq(matrix, y, rcond=None)[0]
    return solution, float(np.sum((y - matrix @ solution) ** 2))


def _refine(x: Array, y: Array, knots: Array) -> Array:
    """Move the knots of a continuous line to where its error is least, from a good start."""
    best, error = knots, _fit(x, y, knots)[1]
    for _ in range(_REFINEMENTS if knots.size else 0):
        hinges = np.maximum(x[:, None] - best, 0.0)
        steps = -(x[:, None] > best).astype(np.float64)
        matrix = np.column_stack([np.ones(x.size), x, hinges, steps])
        solution = np.linalg.lstsq(matrix, y, rcond=None)[0]
        changes, shifts = np.split(solution[2:], 2)
        with np.errstate(all="ignore"):
            move = np.where(changes != 0.0, shifts / changes, 0.0)
        for share in (1.0, 0.5, 0.25, 0.1):
            trial = np.sort(np.clip(best + share * move, x[0], x[-1]))
            trial_error = _fit(x, y, trial)[1]
            if trial_error < error:
                break
        else:
            break
        converged = error - trial_error <= 1e-6 * error
        best, error = trial, trial_error
        if converged:
            break
    return best
