"""Dynamics with several inputs that share them: ``y = z^-d B(z)/A(z) (inputs @ weights) + offset``.

The state before the first sample is not known: the n sequences that it can leave in the output are
columns beside the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.start.play_inputs import Piece

Array = NDArray[np.float64]

NOTHING = 1e-9
"""Of the largest column: less is the rounding of one that stands still."""

_RIDGE = 1e-10  # of the scaled normal matrix, which is nearly singular where a drive says little
_INSIDE = 0.9995  # where a pole outside the unit circle is put
_FIRST_JUDGED = 3  # round whose error is looked at; the first ones are on their way
_SETTLED = 0.99  # of the squared error


@dataclass(frozen=True, eq=False)
class Guess:
    """Dynamics, and weights of the inputs before them.

    Parameters
    ----------
    a
        Shape (n + 1,), denominator in rising powers of 1/z; the first is 1.
    b
        Shape (k,), numerator after the delay.
    weights
        Shape (m,), of the inputs.
    delay
        Samples before the first entry of b.
    cost
        Mean squared error of the output.
    """

    a: Array
    b: Array
    weights: Array
    delay: int
    cost: float

    @property
    def order(self) -> int:
        """Number of poles."""
        return self.a.size - 1


def steiglitz_mcbride(
    pieces: Sequence[Piece], order: int, taps: int, delay: int, rounds: int = 6
) -> Guess | None:
    """Iterate linear least squares on signals filtered by the last denominator; keep the best.

    Parameters
    ----------
    pieces
        Inputs and output.
    order
        Number of poles.
    taps
        Of the numerator.
    delay
        Samples before it.
    rounds
        At most.

    Returns
    -------
    Guess or None
        None where no round gives a finite error.

    Notes
    -----
    Steiglitz and McBride, A technique for the identification of linear systems, IEEE Trans.
    Automatic Control 10 (1965), 461-464; for several inputs with one numerator, the best of rank 1.
    """
    a = np.append(1.0, np.zeros(order))
    sizes = _sizes(pieces)
    best: Guess | None = None
    for number in range(1, rounds + 1):
        solution = _filtered_least_squares(pieces, a, taps, delay)
        if solution is None:
            break
        a = stable(np.append(1.0, solution[:order]))
        if number < _FIRST_JUDGED:
            continue
        numerators = solution[order : order + taps * sizes.size].reshape(taps, -1)
        left, _, _ = np.linalg.svd(numerators * sizes, full_matrices=False)
        found = with_weights(pieces, Guess(a, left[:, 0], np.zeros(0), delay, np.inf))
        if found is None or (best is not None and found.cost > _SETTLED * best.cost):
            break
        best = found
    return best


def _sizes(pieces: Sequence[Piece]) -> Array:
    total = sum(np.square(each.inputs).sum(axis=0) for each in pieces)
    return np.asarray(np.sqrt(total / sum(len(each.output) for each in pieces)))


def _filtered_least_squares(
    pieces: Sequence[Piece], a: Array, taps: int, delay: int
) -> Array | None:
    import scipy.signal  # slow, and only dynamics need it

    order = a.size - 1
    blocks, targets = [], []
    for each in pieces:
        first = max(each.first, order, delay + taps - 1)
        stop = each.output.size
        if stop - first < 2:
            return None
        filtered = scipy.signal.lfilter(
            [1.0], a, np.column_stack([each.output, each.inputs]), axis=0
        )
        columns = [-filtered[first - j : stop - j, :1] for j in range(1, order + 1)]
        columns += [filtered[first - delay - j : stop - delay - j, 1:] for j in range(taps)]
        blocks.append((np.concatenate(columns, axis=1), _ringing(a, stop, first)))
        targets.append(filtered[first:, 0])
    return _least_squares(blocks, targets)


def _ringing(a: Array, stop: int, first: int) -> Array:
    """Give what an unknown state leaves, one column a pole, and what an offset does."""
    import scipy.signal  # slow, and only dynamics need it

    order = a.size - 1
    impulse = np.zeros(stop)
    impulse[0] = 1.0
    response = scipy.signal.lfilter([1.0], a, impulse)
    columns = [np.concatenate([np.zeros(j), response])[first:stop] for j in range(order)]
    offset = scipy.signal.lfilter([1.0], a, np.ones(stop))[first:]
    return np.column_stack([*columns, offset])


def _least_squares(blocks: Sequence[tuple[Array, Array]], targets: Sequence[Array]) -> Array | None:
    """Solve for what all pieces share, each with columns of its own projected out."""
    normal: Array | float = 0.0
    moment: Array | float = 0.0
    for (shared, own), target in zip(blocks, targets, strict=True):
        basis = orthonormal(own)
        shared = shared - basis @ (basis.T @ shared)
        normal = normal + shared.T @ shared
        moment = moment + shared.T @ target
    assert isinstance(normal, np.ndarray), "there is a piece"
    return solve_scaled(normal, np.asarray(moment))


def orthonormal(columns: Array) -> Array:
    """Give an orthonormal basis of columns; one of 0 is left out.

    Parameters
    ----------
    columns
        Shape (n, q).
    """
    size = np.linalg.norm(columns, axis=0)
    columns = columns[:, size > 0.0] / size[size > 0.0]
    return np.asarray(np.linalg.qr(columns)[0])


def solve_scaled(normal: Array, moment: Array, ridge: float = _RIDGE) -> Array | None:
    """Solve normal equations whose columns are brought to one size, a little regularised.

    Parameters
    ----------
    normal, moment
        Of the columns.
    ridge
        Added to the diagonal of the scaled matrix.
    """
    scale = np.sqrt(np.maximum(np.diag(normal), 0.0))
    moves = scale > NOTHING * scale.max(initial=0.0)  # what stands still has no coefficient
    scale = np.where(moves, scale, 1.0)
    matrix = np.where(np.outer(moves, moves), normal, 0.0) / np.outer(scale, scale)
    matrix += ridge * np.eye(scale.size)
    try:
        solution = np.linalg.solve(matrix, np.where(moves, moment, 0.0) / scale) / scale
    except np.linalg.LinAlgError:
        return None
    return np.asarray(solution) if np.isfinite(solution).all() else None


def stable(a: Array) -> Array:
    """Bring poles outside the unit circle into it.

    Parameters
    ----------
    a
        Denominator in rising powers of 1/z.
    """
    poles = np.roots(a)
    size = np.abs(poles)
    if not (size >= _INSIDE).any():
        return a
    inside = np.where(size >= _INSIDE, poles * _INSIDE / np.maximum(size, 1e-300), poles)
    return np.asarray(np.real(np.poly(inside)))


def with_weights(pieces: Sequence[Piece], guess: Guess) -> Guess | None:
    """Give the best weights for given dynamics, and what they leave.

    Parameters
    ----------
    pieces
        Inputs and output.
    guess
        Its a, b and delay are taken.
    """
    import scipy.signal  # slow, and only dynamics need it

    late = np.append(np.zeros(guess.delay), guess.b)
    answers = [scipy.signal.lfilter(late, guess.a, each.inputs, axis=0) for each in pieces]
    found = weights_behind(pieces, answers, guess.a, guess.delay)
    return None if found is None else replace(guess, weights=found[0], cost=found[1])


def weights_behind(
    pieces: Sequence[Piece], answers: Sequence[Array], a: Array, delay: int
) -> tuple[Array, float] | None:
    """Give the best weights of answers to the inputs, and the mean squared error they leave.

    Parameters
    ----------
    pieces
        Their outputs are to be explained.
    answers
        Of each piece, shape (n, m).
    a, delay
        Of the dynamics, for what an unknown state before the piece leaves.
    """
    blocks, targets = [], []
    for each, answer in zip(pieces, answers, strict=True):
        first, stop = max(each.first, delay), each.output.size
        if stop - first < 2:
            return None
        blocks.append((answer[first:], free_response(a, stop - first)))
        targets.append(each.output[first:])
    weights = _least_squares(blocks, targets)
    if weights is None:
        return None
    left = count = 0.0
    for (shared, own), target in zip(blocks, targets, strict=True):
        error = target - shared @ weights
        basis = orthonormal(own)
        error = error - basis @ (basis.T @ error)
        left, count = left + float(error @ error), count + error.size
    return (weights, left / count) if np.isfinite(left) else None


def free_response(a: Array, count: int) -> Array:
    """Give the sequences that satisfy the recurrence of a, one a pole, and a constant.

    Parameters
    ----------
    a
        Denominator in rising powers of 1/z.
    count
        Of samples.
    """
    import scipy.signal  # slow, and only dynamics need it

    order = a.size - 1
    impulse = np.zeros(count)
    impulse[0] = 1.0
    response = scipy.signal.lfilter([1.0], a, impulse)
    columns = [np.concatenate([np.zeros(j), response])[:count] for j in range(order)]
    return np.column_stack([*columns, np.ones(count)])
