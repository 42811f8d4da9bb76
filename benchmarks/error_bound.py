"""The error bound of an approximate inverse: how near the truth, and what fewer plays cost.

Prints, for one machine and one run,
- over 10^4 random pairs of model and approximate inverse (PI, GPI, MPI, 0 to 8 plays each): how
  often the bounds are violated, and the ratio of the error reached to the bound,
- the bound of the 10-play example of S1 with an inverse of fewer plays: the best one, the first
  plays of the exact inverse, least squares on equal thresholds,
- the time of one bound and of one reduction.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.compensation import error_bound, reduce_inverse
from hyst.models import GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii

Array = NDArray[np.float64]

PAPER = hyst.PrandtlIshlinskii(
    [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7],
    np.arange(4.0, 41.0, 4.0),
    0.1,
)
Y_MAX = 43.0
PAIRS = 10_000


def main() -> None:
    over_random_pairs()
    fewer_plays()
    times()


def over_random_pairs() -> None:
    rng = np.random.default_rng(0)
    ratios: dict[str, list[tuple[float, float, float]]] = {"PI": [], "GPI": [], "MPI": []}
    violated = 0
    for _ in range(PAIRS):
        kind = str(rng.choice(list(ratios)))
        model, approximate = mapped(rng, kind), mapped(rng, kind).inverse()
        y_max = float(rng.uniform(0.5, 20.0))
        limit = error_bound(model, approximate, y_max)
        y_ref = np.concatenate([limit.worst_reference, rng.uniform(-y_max, y_max, 100)])
        u_hat = approximate(y_ref)
        error = float(np.abs(model.inverse()(y_ref) - u_hat).max())
        output = float(np.abs(model(u_hat) - y_ref).max())
        rounding = 1e-12 * (y_max + np.abs(u_hat).max())
        violated += error > limit.sharp_bound + rounding
        violated += output > limit.output_bound + 1e-12 * limit.output_bound + rounding
        ratios[kind].append(
            (error / limit.bound, error / limit.sharp_bound, output / limit.output_bound)
        )
    print(f"{PAIRS} random pairs, {violated} violations; error reached over bound:")
    print("        eq. 16: median, worst   sharp: median, worst   output: median, worst")
    for kind, rows in ratios.items():
        values = np.array(rows)
        cells = [f"{np.median(c):8.3f} {c.min():8.3f}" for c in values.T]
        print(f"{kind:5s} {'      '.join(cells)}")


def mapped(rng: np.random.Generator, kind: str) -> hyst.Operator:
    """Cumulative weights between 0.1 and 3, slopes of maps between 0.2 and 2."""
    n = int(rng.integers(0, 9))
    levels, r = rng.uniform(0.1, 3.0, n + 1), np.sort(rng.uniform(0.0, 8.0, n))
    plays = hyst.PrandtlIshlinskii(np.diff(levels), r, float(levels[0]))
    slopes, bends = rng.uniform(0.2, 2.0, 3), np.sort(rng.uniform(0.1, 8.0, 2))
    weights = np.append(slopes[0], np.diff(slopes))
    bend = hyst.DeadZone.odd(weights, np.append(0.0, bends))
    if kind == "PI":
        return plays
    if kind == "GPI":
        return GeneralizedPrandtlIshlinskii(bend, plays)
    return ModifiedPrandtlIshlinskii(plays, bend)


def fewer_plays() -> None:
    exact = PAPER.inverse()
    print(f"\nbound of the S1 example within {Y_MAX:g}, by number of plays (0 for the exact 10)")
    print("plays      best  first ones  least squares   output, best")
    for plays in range(10):
        first = hyst.PrandtlIshlinskii(exact.p[:plays], exact.r[:plays], exact.p0)
        best = error_bound(PAPER, reduce_inverse(PAPER, plays, Y_MAX), Y_MAX)
        others = [error_bound(PAPER, each, Y_MAX).bound for each in (first, fitted(plays))]
        print(
            f"{plays:5d} {best.bound:9.3f} {others[0]:11.3f} {others[1]:14.3f} "
            f"{best.output_bound:14.3f}"
        )


def fitted(plays: int) -> hyst.PrandtlIshlinskii:
    """Least squares of the exact inverse's loading curve, thresholds evenly spaced."""
    r, y = np.linspace(0.0, Y_MAX, plays + 2)[1:-1], np.linspace(0.0, Y_MAX, 1000)
    columns = np.column_stack([y, np.maximum(y[:, None] - r, 0.0)])
    weights = np.linalg.lstsq(columns, PAPER.inverse()(y), rcond=None)[0]
    return hyst.PrandtlIshlinskii(weights[1:], r, float(weights[0]))


def times() -> None:
    rng = np.random.default_rng(1)
    for n in (10, 100):
        model = hyst.PrandtlIshlinskii(rng.uniform(0.0, 1.0, n), np.arange(1.0, n + 1), 1.0)
        reach = 0.9 * float(model.inverse().r[-1])
        begin = time.perf_counter()
        reduced = reduce_inverse(model, n // 3, reach)
        middle = time.perf_counter()
        error_bound(model, reduced, reach)
        end = time.perf_counter()
        print(
            f"{n} plays: reduction {1e3 * (middle - begin):.1f} ms, bound "
            f"{1e3 * (end - middle):.1f} ms"
        )
