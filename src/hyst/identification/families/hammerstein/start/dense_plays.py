"""The hysteresis behind known dynamics as many plays: linear, so its shape shows whatever it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.impulse_response.first_dynamics import shortened
from hyst.identification.families.hammerstein.start.output_error import (
    NOTHING,
    free_response,
    orthonormal,
    solve_scaled,
)
from hyst.identification.families.hammerstein.start.play_inputs import play_columns
from hyst.identification.fit.non_negative import non_negative
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics, PrandtlIshlinskii
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]

_PLAYS = 40
_WIDEST = 0.95  # of half the range of the drive
_MOST_SAMPLES = 40_000
_AS_GOOD = 1.02  # times the squared error of weights of any sign
_RIDGE = 1e-8  # of the scaled normal matrix: neighbouring plays are nearly alike


def dense_plays(data: Data, dynamics: LinearDynamics) -> Operator:
    """Give the hysteresis before known dynamics as plays, with weights of one sign if these do.

    Weights of one sign are few (Lawson and Hanson's active set keeps those next to the true radii),
    and need no regularisation.

    Parameters
    ----------
    data
        The records.
    dynamics
        Behind the hysteresis.
    """
    used = shortened(data, _MOST_SAMPLES // len(data.records))
    radii = data.half_range * np.linspace(0.0, _WIDEST, _PLAYS + 1)[1:]
    parts = zip(used.records, used.windows(), strict=True)
    shapes = [play_columns(r.u[: w.stop], radii) for r, w in parts]
    columns, target = behind_dynamics(used, shapes, dynamics)
    triangle: Array = np.linalg.qr(np.column_stack([columns, target]))[1]
    matrix, wanted, rest = triangle[:-1, :-1], triangle[:-1, -1], float(triangle[-1, -1]) ** 2
    free = solve_scaled(matrix.T @ matrix, matrix.T @ wanted, _RIDGE)
    sign = 1.0 if float(wanted @ matrix[:, 0]) >= 0.0 else -1.0
    weights, left = non_negative(sign * matrix, wanted)
    weights = sign * weights
    if free is not None:
        least = float(np.square(matrix @ free - wanted).sum()) + rest
        weights = weights if left**2 + rest <= _AS_GOOD * least else free
    level = float(used.measured().mean())
    made = PrandtlIshlinskii(weights[1:], radii, weights[0])
    offset = level / dynamics.dc_gain() - float(np.mean([made(r.u).mean() for r in used.records]))
    return Affine(1.0, offset) @ made


def behind_dynamics(
    data: Data, shapes: Sequence[Array], dynamics: LinearDynamics
) -> tuple[Array, Array]:
    """Give what the dynamics answer to each column, and the output, over the windows.

    What an unknown state leaves in each record, and a constant, are taken out of both; a column of
    which nothing but rounding is left is 0.

    Parameters
    ----------
    data
        The records.
    shapes
        Of each record, shape (samples up to the window's end, m).
    dynamics
        Behind them.
    """
    a = np.atleast_1d(np.poly(dynamics.A).real)
    columns, targets = [], []
    for shape, window, output in zip(shapes, data.windows(), data.outputs(), strict=True):
        answers = np.asarray(dynamics(np.ascontiguousarray(shape.T))).T[window]
        own = orthonormal(free_response(a, output.size))
        columns.append(answers - own @ (own.T @ answers))
        targets.append(output - own @ (own.T @ output))
    joined = data.joined(columns)
    size = np.linalg.norm(joined, axis=0)
    joined[:, size <= NOTHING * size.max(initial=0.0)] = (
        0.0  # plays that stand still have no weight
    )
    return joined, data.joined(targets)
