"""Hysteresis and creep fitted together, with as many lags as the records pay for."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.identification.creep.creeping_family import CreepingFamily
from hyst.identification.creep.evidence import evenly, nuisances_of
from hyst.identification.creep.lags import bounds_of, in_use
from hyst.identification.creep.merging import merged
from hyst.identification.families.family import Fit
from hyst.identification.families.staged_family import staged_of, without_stage
from hyst.identification.fit.bounded_least_squares import Solution
from hyst.identification.fit.nuisance import Beside, Drift, Nuisances, moments_of
from hyst.identification.fit.projection import Basis
from hyst.identification.fit.stages import with_stage
from hyst.identification.judgement.regression import chance, correlation_time
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import Creep

Array = NDArray[np.float64]
Rows = NDArray[np.bool_]

MOST_LAGS = 5

SEARCHED = 20_000
"""Samples by which numbers of lags are compared; the last fit takes all."""

UNLIKELY = 1e-3
"""Probability that noise alone lets a further lag explain as much."""

LEAST_GAIN = 0.02
"""Of the squared error: a further lag that lowers it by less is none."""

FAST = 1.01
"""Times the shortest time constant: a lag on that bound is part of the delay."""

IDLE = 1e-6
"""Of the sum of weights: a lag of less weight does nothing."""


@dataclass(frozen=True, eq=False)
class Joint:
    """What a joint fit of hysteresis and creep is made on.

    Parameters
    ----------
    data
        The records, their drift left in, in units in which ranges lie between 1 and 2.
    drifts
        Whether the output may also drift.
    late
        For each record, by which its output changes where it comes a second later; empty where the
        delay is known.
    kept
        Shape (samples used,): which samples are to be fitted; None for all.
    most
        Iterations.
    """

    data: Data
    drifts: bool
    late: tuple[Array, ...]
    kept: Rows | None
    most: int

    def fit(self, front: Fit, weights: Array, tau: Array, count: int, rows: Rows | None) -> Fit:
        """Fit all constants together, from lags that do about as they should.

        Parameters
        ----------
        front
            Of what is left without creep.
        weights, tau
            Shape (n,), first guess, tau ascending, s.
        count
            Of lags to fit.
        rows
            Shape (samples used,): which samples count; None for all.
        """
        bounds = bounds_of(self.data)
        w, times = merged(weights, tau, count, bounds)
        stage = Creep(w, times, self.data.records[0].dt)
        lower = np.concatenate([np.zeros(count), np.full(count, bounds[0])])
        upper = np.concatenate([np.full(count, np.inf), np.full(count, bounds[1])])
        base, start = front.parametrization, front.solution.theta
        parametrization, theta = with_stage(base, start, stage, "output", lower, upper)
        nuisances = nuisances_of(count, self.drifts, base.size + count, self.late)
        family = CreepingFamily(front.family)
        made = Fit(
            family,
            front.size,
            replace(parametrization, nuisances=nuisances),
            Solution(theta, np.inf, 0, ""),
        )
        return replace(made, solution=family.solve(made.problem(self.data, rows), theta, self.most))

    def searched(self) -> Rows | None:
        """Give the samples that numbers of lags are compared by: all of a short record."""
        if sum(self.data.lengths()) <= SEARCHED:
            return self.kept
        rows = evenly(self.data, SEARCHED)
        return rows if self.kept is None else rows & self.kept

    def best_number(self, front: Fit, weights: Array, tau: Array) -> Fit:
        """Fit with one lag, two and so on while each further one pays.

        Parameters
        ----------
        front, weights, tau
            As of ``fit``.
        """
        rows = self.searched()
        best = self.fit(front, weights, tau, 1, rows)
        for count in range(2, MOST_LAGS + 1):
            further = self.fit(front, weights, tau, count, rows)
            if self.idle(further).any() or not _pays(self.data, best, further, rows):
                break
            best = further
        return best

    def finished(self, fit: Fit) -> Fit | None:
        """Fit all samples, without idle lags, and with the lags in order; None if no lag is left.

        Parameters
        ----------
        fit
            With creep.
        """
        while True:
            weights, tau = lags_of(fit)
            order = np.argsort(tau)
            works = ~self.idle(fit)[order]
            if not works.any():
                return None
            w, times = weights[order][works], tau[order][works]
            fit = self.fit(without_stage(fit), w, times, w.size, self.kept)
            if not self.idle(fit).any() and bool(np.all(np.diff(lags_of(fit)[1]) > 0.0)):
                overview = Overview(self.data, rates_matter=True)
                return fit.family.renewed(fit, overview, self.most)

    def idle(self, fit: Fit) -> NDArray[np.bool_]:
        """Tell which lags of a fit do nothing, or nothing but come late.

        Parameters
        ----------
        fit
            With creep.
        """
        weights, tau = lags_of(fit)
        return np.asarray(
            (weights <= IDLE * max(float(weights.sum()), 1e-300))
            | (tau <= FAST * bounds_of(self.data)[0])
        )

    def delay(self, fit: Fit) -> tuple[float, float]:
        """Give how much later the output comes than the fit has it, s, and the standard error.

        Parameters
        ----------
        fit
            With creep, and lateness beside it.
        """
        count = lags_of(fit)[0].size
        alone = nuisances_of(count, self.drifts, fit.solution.theta.size - count)
        return self._beside(fit, alone, in_use(self.data, self.late)[:, None])[0]

    def drift(self, fit: Fit) -> list[tuple[float, float]]:
        """Give by how much each record drifts beside its creep, and the standard error.

        Parameters
        ----------
        fit
            With creep.
        """
        if not self.drifts:
            return []
        count = lags_of(fit)[0].size
        alone = nuisances_of(count, False, fit.solution.theta.size - count, self.late)
        moments = moments_of(self.data)
        lines = [Drift().columns(each, fit.solution.theta) for each in moments]
        # From -1 to 1 over a record.
        return self._beside(fit, alone, 0.5 * scipy.linalg.block_diag(*lines))

    def _beside(self, fit: Fit, alone: Nuisances, columns: Array) -> list[tuple[float, float]]:
        """Give the coefficient of each of some columns beside all else, with its standard error."""
        theta = fit.solution.theta
        model = replace(fit, parametrization=replace(fit.parametrization, nuisances=alone))
        residual, jacobian = model.problem(self.data, self.kept).linearize(theta)
        columns = columns if self.kept is None else columns[self.kept]
        n = len(columns)
        projection = Beside(self.data, alone, self.kept).at(theta)
        basis = Basis.of(jacobian[:n, fit.parametrization.inside(theta)])
        left, error = (basis.out_of(each) for each in (projection.out_of(columns), -residual[:n]))
        inverse = np.linalg.pinv(left.T @ left)
        coefficients = inverse @ (left.T @ error)
        rest = error - left @ coefficients
        freedom = max(n - theta.size - projection.directions, 1)
        variance = float(rest @ rest) / freedom * correlation_time(rest)
        errors = np.sqrt(variance * np.diag(inverse))
        return list(zip(coefficients.tolist(), errors.tolist(), strict=True))


def _pays(data: Data, fewer: Fit, more: Fit, rows: Rows | None) -> bool:
    """Tell whether a further lag explains more than noise of this correlation would."""
    before, after = fewer.solution.cost, more.solution.cost
    if before - after < LEAST_GAIN * before:
        return False
    residual = more.problem(data, rows).residual(more.solution.theta)
    freedom = (residual.size - more.parametrization.free_count) / correlation_time(residual)
    added = 2 + len(data.records)  # weight, time constant, and its state before each record
    return chance(before, after, added, freedom) <= UNLIKELY


def lags_of(fit: Fit) -> tuple[Array, Array]:
    """Give weights and time constants of a fit.

    Parameters
    ----------
    fit
        With creep.
    """
    count = fit.parametrization.size - staged_of(fit).base.size
    own = fit.solution.theta[-count:]
    return own[: count // 2], own[count // 2 :]
