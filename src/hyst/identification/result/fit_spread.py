"""How sure the free parameters of a fit are, and which of them the records do not tell apart."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.delay_evidence import DelayEvidence
from hyst.identification.families.family import Estimates, Fit
from hyst.identification.fit.block import of_records
from hyst.identification.fit.nuisance import Beside
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.covariance import ScoreSums
from hyst.identification.result.lateness import moves_of
from hyst.identification.result.standard_errors import (
    Spread,
    spread_of_estimates,
    spread_under_prior,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FitSpread:
    """How sure the free parameters of a fit are.

    Parameters
    ----------
    spread
        Of the parameters that lie on no bound.
    inside
        Shape (m,), which they are.
    noise_rms
        Of the residual, output units, the free parameters allowed for.
    bounds_hold
        Whether a parameter on its bound counts as known, as one of hundreds under a prior, and not
        as the end of what can be said.
    """

    spread: Spread
    inside: NDArray[np.bool_]
    noise_rms: float
    bounds_hold: bool = False
    moves: Array | None = None

    def of(self, by_theta: Array) -> Array:
        """Give the standard errors of functions of theta.

        Parameters
        ----------
        by_theta
            Shape (q, m), their derivative.

        Returns
        -------
        numpy.ndarray
            Shape (q,), NaN where a function is held, depends on a parameter on its bound or is not
            determined.
        """
        errors = np.full(len(by_theta), np.nan)
        moves = by_theta[:, self.inside].any(axis=1)
        known = moves & (self.bounds_hold | ~by_theta[:, ~self.inside].any(axis=1))
        rows = by_theta[np.ix_(known, self.inside)]
        errors[known] = self._moved(self.spread.of(rows), rows)
        return errors

    def of_what_is_determined(self, by_theta: Array) -> Array:
        """Give the standard errors of functions of theta, as if what is not determined were known.

        Parameters
        ----------
        by_theta
            Shape (q, m), their derivative.

        Returns
        -------
        numpy.ndarray
            Shape (q,).
        """
        rows = by_theta[:, self.inside]
        return self._moved(self.spread.if_determined(rows), rows)

    def _moved(self, errors: Array, rows: Array) -> Array:
        """Add what the things beside the model may move."""
        if self.moves is None:
            return errors
        # Constants have units of their own: squares of what is tiny would underflow.
        return np.asarray(np.hypot(errors, np.hypot.reduce(rows @ self.moves, axis=1)))

    def not_told_apart(self, estimates: Estimates) -> tuple[str, ...]:
        """Name the estimates in every combination that the records do not determine.

        Parameters
        ----------
        estimates
            With their names.

        Returns
        -------
        tuple of str
            Sentences, none of which names what another does.
        """
        disturbed = self.spread.disturbed(estimates.by_theta[:, self.inside])
        sentences = []
        for together in _joined(disturbed):
            names = ", ".join(
                name for name, one in zip(estimates.names, together, strict=True) if one
            )
            sentences.append(
                f"the records do not tell apart {names}; their values are one choice of many"
                if together.sum() > 1
                else f"the records do not determine {names}; its value is one choice of many"
            )
        return tuple(sentences)


def _joined(disturbed: NDArray[np.bool_]) -> list[NDArray[np.bool_]]:
    """Join directions that share an estimate, for any mixture of them is one, too.

    Takes shape (q, k), which estimates each direction disturbs; gives shape (q,) for each group.
    """
    groups: list[NDArray[np.bool_]] = []
    for column in disturbed.T[disturbed.any(axis=0)]:
        shared = [each for each in groups if (each & column).any()]
        groups = [each for each in groups if not (each & column).any()]
        groups.append(np.logical_or.reduce([column, *shared]))
    return groups


def spread_of_fit(data: Data, fit: Fit, delay: DelayEvidence | None = None) -> FitSpread:
    """Find how sure the free parameters of a fit are.

    Parameters
    ----------
    data
        The records.
    fit
        The final fit, in their units.
    delay
        What the records say of their delay where it was estimated: then it is part of what is not
        known exactly.

    Returns
    -------
    FitSpread
    """
    data = fit.family.fitted(data)
    theta, parametrization = fit.solution.theta, fit.parametrization
    inside = parametrization.inside(theta)
    root = fit.family.root_weights(data)
    problem = problem_of(data, parametrization, None, root)
    residual = problem.residual(theta)[: sum(data.lengths())]
    taken_out = 0
    if parametrization.nuisances is not None:
        taken_out = Beside(data, parametrization.nuisances, None, root).at(theta).directions
    blocks = problem.blocks_at(theta)
    sums = ScoreSums.of(lambda: of_records(blocks, inside), residual, data.lengths())
    y = data.measured()
    found = spread_from_sums(sums, fit, float(np.linalg.norm(y - y.mean())), taken_out)
    return found if found.bounds_hold else replace(found, moves=moves_of(data, fit, delay))


def spread_from_sums(
    sums: ScoreSums, fit: Fit, output_spread: float, taken_out: int = 0
) -> FitSpread:
    """Find how sure the free parameters of a fit are from sums over the samples.

    Parameters
    ----------
    sums
        Of the residual and its derivative by the parameters inside their bounds.
    fit
        The fit.
    output_spread
        Norm of the centred output.
    taken_out
        Directions that were projected out of both.
    """
    theta, parametrization = fit.solution.theta, fit.parametrization
    inside = parametrization.inside(theta)
    left = np.sqrt(sums.power) * sums.noise
    if parametrization.prior is not None:
        held_by = output_spread * parametrization.prior[:, inside]
        under = spread_under_prior(sums, held_by, taken_out)
        freedom = max(sums.samples - parametrization.free_count - taken_out, 1)
        return FitSpread(under, inside, float(left / np.sqrt(freedom)), bounds_hold=True)
    gauges = parametrization.gauges
    held = np.empty((0, theta.size)) if gauges is None else gauges(theta)[1]
    spread = spread_of_estimates(sums, theta[inside], held[:, inside], taken_out)
    freedom = max(sums.samples - int(inside.sum()) + len(held) - taken_out, 1)
    return FitSpread(spread, inside, float(left / np.sqrt(freedom)))
