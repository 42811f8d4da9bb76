"""A fit to every sample of a record in a file: the record goes by, and only sums stay.

By radii of plays it takes secants, not derivatives, and what the model leaves is the mean at the
ends of these: a play that some strokes do not move keeps where its last stroke left it, which jumps
from the upper to the lower end as the radius passes one stroke after the other. A derivative is
that of one tooth; a secant across many is the slope that more such records would show.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.errors import SolverError
from hyst.identification.fit.block import Block
from hyst.identification.fit.bounded_least_squares import Problem
from hyst.identification.fit.normal_equations import LongSum, NormalEquations
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import NO_STEP_TO, beside_the_records
from hyst.identification.result.covariance import (
    BartlettSum,
    ScoreSums,
    bandwidth_of,
    norms_of,
)
from hyst.identification.stream.aligned import aligned
from hyst.identification.stream.survey import Survey
from hyst.signals import Metrics
from hyst.signals.record_stream import RecordStream

Array = NDArray[np.float64]

MOST_OF_A_GAP = 0.05
"""That a secant may reach of the way to the next radius: there its model would be another one."""


class FitOfAll:
    """The least squares problem of a parametrization over a record in a file.

    Parameters
    ----------
    stream
        The record.
    found
        What the first way through it found.
    parametrization
        Free parameters, without columns beside the model.
    late
        Whole samples by which the output lags.
    across
        Shape (m,), how far from theta secants reach; 0 for derivatives, and where left out.
    """

    def __init__(
        self,
        stream: RecordStream,
        found: Survey,
        parametrization: Parametrization,
        late: int,
        across: Array | None = None,
    ) -> None:
        self._stream, self._found, self._late = stream, found, late
        self._parametrization = parametrization
        template = parametrization.template
        self._memory = template.initial_state()
        self._stages = template.at_sample_time(stream.dt).stages()
        self._chain = _engine.Chain(self._stages)
        self._across = np.zeros(parametrization.size) if across is None else across
        self._beside = beside_the_records(parametrization, found.y_spread)
        self._start = max(found.start, -late)
        self.samples = found.samples - max(late, 0) - self._start

    def problem(self) -> Problem:
        """Pose it; only sums can be asked for."""
        own = self._parametrization
        return Problem(
            self._refused,
            self._refused,
            own.lower,
            own.upper,
            own.canonical,
            is_linear=own.is_linear,
            summed=self._normal,
            squares=self._squares,
        )

    def _refused(self, theta: Array):  # type: ignore[no-untyped-def]
        raise SolverError("this family is fitted from residuals of all samples, not from sums")

    def errors(self, theta: Array) -> Iterator[Array]:
        """Give what the model leaves of the samples used, block by block.

        Parameters
        ----------
        theta
            Canonical.
        """
        self._chain.set_parameters(self._parametrization.constants(theta))
        state, place = self._memory[None, :].copy(), 0
        for u, y in aligned(self._stream, self._late):
            modelled = np.empty((1, u.size))
            self._chain.run(state, np.ascontiguousarray(u)[None, :], modelled)
            used = max(self._start - place, 0)
            place += u.size
            if used < u.size:
                yield modelled[0, used:] - y[used:]

    def blocks(self, theta: Array) -> Iterator[tuple[Block, Array]]:
        """Give the derivative of what the model leaves, and that itself, block by block.

        Parameters
        ----------
        theta
            Canonical.
        """
        self._chain.set_parameters(self._parametrization.constants(theta))
        columns = self._chain.parameter_count
        state, memory = self._memory.copy(), np.zeros((self._memory.size, columns))
        transform, place = self._parametrization.transform, 0
        secants = self._secants(theta)
        for u, y in aligned(self._stream, self._late):
            signal, rows = u.copy(), np.empty((u.size, columns))
            self._chain.carry_jacobian(state, memory, signal, rows)
            by_theta, errors = rows @ transform, signal - y
            for each in secants:
                by_theta[:, each.column], mean = each.over(np.ascontiguousarray(u)[None, :])
                errors += mean - signal
            used = max(self._start - place, 0)
            first = max(place - self._start, 0)
            place += u.size
            if used < u.size:
                own = slice(first, first + u.size - used)
                yield Block(0, own, by_theta[used:]), errors[used:]

    def _secants(self, theta: Array) -> list[_Secant]:
        """Give secants, of which none reaches a bound or another radius."""
        low, high = self._parametrization.lower, self._parametrization.upper
        found, radii = list[_Secant](), list(self._parametrization.radii)
        for column in np.flatnonzero(self._across):
            ends = [low[column], high[column], *(theta[i] for i in radii if i != column)]
            room = MOST_OF_A_GAP * min(abs(theta[column] - end) for end in ends)
            width = min(float(self._across[column]), room)
            if width > 0.0:
                found.append(self._secant(theta, int(column), width))
        return found

    def _secant(self, theta: Array, column: int, width: float) -> _Secant:
        chains = []
        for sign in (1.0, -1.0):
            moved = theta.copy()
            moved[column] += sign * width
            chain = _engine.Chain(self._stages)
            chain.set_parameters(self._parametrization.constants(moved))
            chains.append((chain, self._memory[None, :].copy()))
        return _Secant(column, 2.0 * width, chains)

    def _normal(self, theta: Array) -> NormalEquations:
        matrix, gradient = LongSum((theta.size, theta.size)), LongSum((theta.size,))
        cost = LongSum(())
        for block, errors in self.blocks(theta):
            matrix.add(block.jacobian.T @ block.jacobian)
            gradient.add(block.jacobian.T @ errors)
            cost.add(errors @ errors)
        own = NormalEquations(matrix.total, gradient.total, float(cost.total), self.samples)
        for values, by_theta in self._beside(theta):
            own = own.plus(values, by_theta)
        return own

    def _squares(self, theta: Array) -> float:
        is_allowed = self._parametrization.is_allowed
        if is_allowed is not None and not is_allowed(theta):
            return self.samples * (NO_STEP_TO * self._found.y_spread) ** 2
        cost = LongSum(())
        for errors in self.errors(theta):
            cost.add(errors @ errors)
        return float(cost.total) + sum(float(v @ v) for v, _ in self._beside(theta))

    def sums(self, theta: Array, columns: NDArray[np.bool_], left: ErrorsOfAll) -> ScoreSums:
        """Sum what standard errors are made of.

        Parameters
        ----------
        theta
            Canonical.
        columns
            Shape (m,), which parameters are meant.
        left
            What the model leaves.
        """
        unit = norms_of(block.jacobian[:, columns] for block, _ in self.blocks(theta))
        unit = np.where(unit > 0.0, unit, 1.0)
        noise = math.ldexp(1.0, math.frexp(left.largest)[1])
        gram = LongSum((unit.size, unit.size))
        lags = bandwidth_of(left.power, left.product, self.samples, self.samples)
        scores = BartlettSum(lags, unit.size)
        for block, errors in self.blocks(theta):
            scaled = block.jacobian[:, columns] / unit
            gram.add(scaled.T @ scaled)
            scores.add(0, scaled * (errors / noise)[:, None])
        power = left.power / noise**2
        return ScoreSums(unit, noise, gram.total, scores.total(), power, self.samples)


@dataclass(frozen=True, eq=False)
class _Secant:
    """A model with one parameter a little larger, and a little smaller.

    Parameters
    ----------
    column
        Which parameter.
    width
        How far the two are apart.
    chains
        Both, with their memory.
    """

    column: int
    width: float
    chains: list[tuple[_engine.Chain, Array]]

    def over(self, u: Array) -> tuple[Array, Array]:
        """Go on over the next samples, shape (1, n): the slope between both, and their mean."""
        larger, smaller = (self._output(each, u) for each in self.chains)
        return (larger - smaller) / self.width, 0.5 * (larger + smaller)

    @staticmethod
    def _output(model: tuple[_engine.Chain, Array], u: Array) -> Array:
        y = np.empty_like(u)
        model[0].run(model[1], u, y)
        return np.asarray(y[0])


class ErrorsOfAll:
    """What a model leaves of all samples, summed.

    Parameters
    ----------
    errors
        Model minus measurement, block by block.
    """

    def __init__(self, errors: Iterator[Array]) -> None:
        power, product, total = LongSum(()), LongSum(()), LongSum(())
        low, high, last, self.samples = math.inf, -math.inf, 0.0, 0
        for each in errors:
            power.add(each @ each)
            product.add(each[1:] @ each[:-1] + last * each[0])
            total.add(each.sum())
            low, high, last = min(low, float(each.min())), max(high, float(each.max())), each[-1]
            self.samples += each.size
        self.power, self.product = float(power.total), float(product.total)
        self.bias = float(total.total) / self.samples
        self.low, self.high = low, high

    @property
    def largest(self) -> float:
        """Largest size of any."""
        return max(-self.low, self.high)

    def metrics(self, y_spread: float, y_range: float, samples: int, free: bool) -> Metrics:
        """Give them as metrics.

        Parameters
        ----------
        y_spread
            Norm of the centred output over all samples.
        y_range
            What percentages refer to.
        samples
            Of the whole record.
        free
            Whether the mean error is taken out.
        """
        offset = self.bias if free else 0.0
        rms = math.sqrt(max(self.power / self.samples - (self.bias**2 if free else 0.0), 0.0))
        largest = max(self.high - offset, offset - self.low)
        spread = y_spread / math.sqrt(samples)
        return Metrics(
            rms,
            largest,
            100.0 * rms / y_range,
            100.0 * largest / y_range,
            100.0 * (1.0 - rms / spread),
            self.bias,
            self.samples,
            y_range,
        )
