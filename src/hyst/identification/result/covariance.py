"""Standard errors that take the autocorrelation of the residual into account.

All that is summed over the samples is in ``ScoreSums``, block by block, so that a long record needs
no Jacobian of all of its samples.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.block import Blocks, blocks_of
from hyst.identification.fit.normal_equations import LongSum

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ScoreSums:
    """Sums over the samples of a residual e and its Jacobian J, both brought to a size near 1.

    Columns are divided before they are summed, as rounding of the sums is not to depend on units.

    Parameters
    ----------
    unit
        Shape (m,), norms of the columns of J, by which they were divided; 1 for columns of zeros.
    noise
        Power of two by which e was divided.
    gram
        ``J'J``, shape (m, m).
    middle
        Shape (m, m), Bartlett-weighted sum of the autocovariances of the scores ``J_k e_k``.
    power
        ``e'e``.
    samples
        How many there are.
    """

    unit: Array
    noise: float
    gram: Array
    middle: Array
    power: float
    samples: int

    @classmethod
    def of(cls, blocks: Blocks, residual: Array, lengths: Sequence[int]) -> Self:
        """Sum them.

        Parameters
        ----------
        blocks
            Derivative of the residual.
        residual
            Shape (N,), of the records.
        lengths
            Samples of each record, in order; correlation does not reach across records.
        """
        unit = norms_of(each.jacobian for each in blocks())
        unit = np.where(unit > 0.0, unit, 1.0)
        noise = float(np.ldexp(1.0, np.frexp(np.abs(residual).max(initial=0.0))[1]))
        errors = residual / noise
        gram = LongSum((unit.size, unit.size))
        scores = BartlettSum(_bandwidth(errors, lengths), unit.size)
        for each in blocks():
            scaled = each.jacobian / unit
            gram.add(scaled.T @ scaled)
            scores.add(each.record, scaled * errors[each.rows, None])
        power = float(errors @ errors)
        return cls(unit, noise, gram.total, scores.total(), power, residual.size)

    def along(self, basis: Array) -> ScoreSums:
        """Give the sums over other columns.

        Parameters
        ----------
        basis
            Shape (m, k): the columns are the scaled ones of J times this.
        """
        gram, middle = (basis.T @ each @ basis for each in (self.gram, self.middle))
        one = np.ones(basis.shape[1])
        return ScoreSums(one, self.noise, gram, middle, self.power, self.samples)

    def covariance(self, prior: Array | None = None, taken_out: int = 0) -> Array:
        """Give the covariance of what the scaled columns are multiplied by, over the noise squared.

        Parameters
        ----------
        prior
            Shape (q, m), in scaled columns.
        taken_out
            Directions that were projected out of both.
        """
        square = np.diag(self.gram)
        square = square if prior is None else square + np.einsum("ij,ij->j", prior, prior)
        scale = np.sqrt(square)
        outer = np.outer(scale, scale)
        gram, middle, count = self.gram / outer, self.middle / outer, float(scale.size)
        if prior is None:
            inverse = np.linalg.inv(gram)
        else:
            held = (prior / scale).T @ (prior / scale)
            inverse = np.linalg.inv(gram + held)
            count = float(np.sum(inverse * gram))
            middle = middle + self.power / self.samples * held
        correction = self.samples / max(self.samples - count - taken_out, 1.0)
        return np.asarray(inverse @ middle @ inverse * correction / outer)


def norms_of(blocks: Iterable[Array]) -> Array:
    """Give the norms of the columns of a matrix that comes block by block, at any size.

    Parameters
    ----------
    blocks
        Shape (n, m) each, at least one.
    """
    sizes, squares = list[Array](), list[Array]()
    for each in blocks:
        largest = np.abs(each).max(axis=0, initial=0.0)
        sizes.append(np.where(largest > 0.0, np.ldexp(1.0, np.frexp(largest)[1]), 0.0))
        squares.append(np.square(each / np.where(largest > 0.0, sizes[-1], 1.0)).sum(axis=0))
    size = np.max(sizes, axis=0)
    shares = np.array(sizes) / np.where(size > 0.0, size, 1.0)
    return np.asarray(size * np.sqrt((np.array(squares) * shares**2).sum(axis=0)))


def robust_covariance(
    jacobian: Array,
    residual: Array,
    lengths: Sequence[int],
    prior: Array | None = None,
    taken_out: int = 0,
) -> Array:
    """Estimate the covariance of least squares estimates with autocorrelated residuals.

    ``(J'J)^-1 S (J'J)^-1 N / (N - m)`` with S the Bartlett-weighted sum of the autocovariances of
    the scores ``J_k e_k``. White residuals give the usual covariance. With prior rows P, whose
    square was added to the cost, ``A^-1 (S + s^2 P'P) A^-1``, A = J'J + P'P, s^2 the variance of
    the residual: what the prior filled is as unsure as the prior is.

    Parameters
    ----------
    jacobian
        Shape (N, m), full rank but for the prior.
    residual
        Shape (N,), of the records.
    lengths
        Samples of each record, in order; correlation does not reach across records.
    prior
        Shape (q, m).
    taken_out
        Directions that were projected out of both: they are estimates as well.

    Returns
    -------
    numpy.ndarray
        Shape (m, m).

    Notes
    -----
    Newey and West, Econometrica 55 (1987), 703-708; bandwidth from a first-order autoregression of
    the residual, Andrews, Econometrica 59 (1991), 817-858, eq. 6.2. The prior's part: Wahba, J. R.
    Stat. Soc. B 45 (1983), 133-150; such errors hold bias as well as scatter, on average.
    """
    sums = ScoreSums.of(lambda: blocks_of(jacobian, lengths), residual, lengths)
    held = None if prior is None else prior / sums.unit
    scaled = sums.covariance(held, taken_out)
    return np.asarray(scaled * sums.noise**2 / np.outer(sums.unit, sums.unit))


def _bandwidth(residual: Array, lengths: Sequence[int]) -> int:
    before = np.ones(residual.size, dtype=bool)
    before[np.cumsum(lengths) - 1] = False
    now, after = residual[:-1][before[:-1]], residual[1:][before[:-1]]
    return bandwidth_of(float(residual @ residual), float(now @ after), residual.size, min(lengths))


def bandwidth_of(power: float, product: float, samples: int, shortest: int) -> int:
    """Choose the number of lags, at most a quarter of the shortest record.

    Parameters
    ----------
    power, product
        Of the residual: sum of squares, and of products of neighbours.
    samples, shortest
        Of all records, and of the shortest.
    """
    rho = float(np.clip(product / power, -0.99, 0.99)) if power > 0.0 else 0.0
    alpha = 4.0 * rho**2 / ((1.0 - rho) ** 2 * (1.0 + rho) ** 2)
    lags = 1.1447 * (alpha * samples) ** (1.0 / 3.0)
    return int(np.clip(np.ceil(lags), 1, max(shortest // 4, 1)))


class BartlettSum:
    """Sum of the autocovariances of scores with weights 1 - |lag| / bandwidth.

    The sum over all windows of ``bandwidth`` samples of (window sum)(window sum)' is exactly that,
    times the bandwidth, and needs one matrix product instead of one for each lag.

    Parameters
    ----------
    bandwidth
        Samples.
    columns
        Of the scores, m.
    """

    def __init__(self, bandwidth: int, columns: int) -> None:
        self._bandwidth = bandwidth
        self._total = LongSum((columns, columns))
        self._record = 0
        self._past = np.zeros((bandwidth, columns))

    def add(self, record: int, scores: Array) -> None:
        """Go on with the scores of some samples.

        Parameters
        ----------
        record
            Which one they are of.
        scores
            Shape (n, m).
        """
        if record != self._record:
            self._end()
            self._record = record
        self._windows(scores)

    def total(self) -> Array:
        """Give the sum once all scores were added."""
        self._end()
        return self._total.total / self._bandwidth

    def _end(self) -> None:
        """Let the windows run out of a record."""
        self._windows(np.zeros_like(self._past))

    def _windows(self, scores: Array) -> None:
        both = np.concatenate([self._past, scores])
        self._past = both[-self._bandwidth :].copy()
        sums = np.cumsum(both, axis=0)
        windows = sums[self._bandwidth :] - sums[: -self._bandwidth]
        self._total.add(windows.T @ windows)
