"""Sample by sample, block by block: what an estimate of any family does and remembers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotInvertibleError
from hyst.online.model.averaged import Averaged, averaged
from hyst.online.model.block_fit import Fitted, Task, fitted
from hyst.online.model.commands import Commands, refusal_of
from hyst.online.model.model_innovation import ModelInnovation
from hyst.online.model.past import Past
from hyst.online.model.prior import spreads_of, tied_scales
from hyst.online.model.regularities import LEAST_SAMPLES, Regularities
from hyst.online.model.rivals import rival_of
from hyst.online.model.window import Window
from hyst.operators import Operator

Array = NDArray[np.float64]

_BEYOND = 1e100
_PASSES = 4
_LEAST_NOISE = 1e-10
_ROUNDING = 1e-14
# Tried in any case: noise may hide in every sum that a minimum is false.
_SURE_TRIALS = 8
RIVALS = 8
"""How many of the last estimates from elsewhere are remembered; each may be as likely."""
_COMMANDS = 500


@final
class Course:
    """An estimate along its samples.

    Parameters
    ----------
    model
        Where to start.
    settings
        Of the estimator.
    """

    def __init__(self, model: Operator, settings: dict[str, Any]) -> None:
        self.settings = settings
        self.model = model
        given = model.parameters()
        self.names, self.lower, self.upper = given.names, given.lower, given.upper
        fixed = {n for n, a, b in zip(given.names, given.lower, given.upper, strict=True) if a == b}
        self.held = tuple(sorted({*settings["held"], *tied_scales(model), *fixed}))
        self.block = int(settings["block"])
        self.room = max(round(settings["window"] / settings["dt"]), self.block)
        memory = settings["memory"]
        self.fading = 0.0 if memory is None else settings["dt"] / memory
        self.theta_start = given.values.copy()
        self.counts = dict.fromkeys(("used", "skipped", "refused", "refused steps"), 0)
        self.trials = self.replacements = self.wait = 0
        self.window = Window(model, self.room)
        self.last_input, self.error, self.is_begun = 0.0, 0.0, False
        self._begin(
            self.theta_start, spreads_of(model, settings["spread"], settings["spreads"], (0.0, 0.0))
        )

    def _begin(self, theta: Array, spread: Array) -> None:
        """Start from constants, knowing nothing but how far off they may be."""
        self.theta_start = theta.copy()
        self.theta = theta.copy()
        # Of the start, so that limits do not move with what they limit.
        self.must = self.model.with_parameters(theta).inequalities()
        self.spread = np.where([name in self.held for name in self.names], 0.0, spread)
        self.free = np.flatnonzero(self.spread > 0.0)
        self.past = Past.none(self.free.size)
        self.information = np.zeros((self.free.size, self.free.size))
        self.recent = self.information.copy()
        noise = self.settings["noise"]
        self.variance = 0.0 if noise is None else noise**2
        self.averaged: Averaged | None = None
        self.rivals = np.tile(theta, (RIVALS, 1))
        self.regularities = Regularities()
        self.has_left = False
        self.in_block = 0
        self.set_estimate(theta)

    def set_estimate(self, theta: Array) -> None:
        """Go on with other constants; the memory is theirs."""
        if (theta != self.model.parameters().values).any():
            self.model = self.model.with_parameters(theta)
        self.theta = theta.copy()
        state = self.window.outputs(self.theta)[1]
        self._step = self.model.stepper(state)

    @property
    def memory(self) -> Array:
        """State of the model after the last sample."""
        return np.array(self._step.state)

    def take_memory(self, state: Array) -> None:
        """Go on from the very bits of a saved memory."""
        self._step.state[:] = state

    def take(self, u: float, y: float, counted: bool = True) -> bool:
        """Take in a sample; tells whether it was learnt from."""
        told = math.isfinite(y)
        if not math.isfinite(u) or (counted and not told):
            self.counts["skipped"] += 1
            return False
        if max(abs(u), abs(y) if told else 0.0) > _BEYOND:
            self.counts["refused"] += counted
            return False
        predicted = self._step(u)
        if self._step.fault:
            self._step.clear_fault()
            self.counts["refused"] += counted
            return False
        if told:
            self.error = y - predicted
        self.counts["used"] += counted
        self.last_input = u
        self.window.add(u, y if told else 0.0, float(told))
        self.in_block += 1
        if self.in_block == self.block or self.window.count == self.room:
            self._close_block()
        return told

    def _close_block(self) -> None:
        told = self.window.told[: self.window.count]
        self.in_block = 0
        if not self.is_begun and told.any():
            self._take_sizes()
        if self.free.size and told.any() and self.is_begun:
            self._fit()
        theta = self.theta
        if self.window.count + self.block > self.room:
            self._leave(min(self.block, self.window.count))
        self.set_estimate(theta)

    def _take_sizes(self) -> None:
        """Let the first block say how large signals are, where no constant does."""
        u, y = self.window.u[: self.window.count], self.window.y[: self.window.count]
        self.is_begun = True
        sizes = float(np.abs(u).max()), float(np.std(y[self.window.told[: y.size] > 0.0]))
        settings = self.settings
        spread = spreads_of(self.model, settings["spread"], settings["spreads"], sizes)
        if not self.free.size or (spread > 0.0).sum() > (self.spread > 0.0).sum():
            self._begin(self.theta_start, spread)

    def task(self) -> Task:
        """Give what is to be fitted now."""
        window = self.window
        age = np.arange(window.count - 1.0, -1.0, -1.0)
        weights = window.told[: window.count] * np.exp(-self.fading * age)
        must = self.must
        scale = self.spread[self.free]
        return Task(
            window,
            weights,
            self.past,
            self.free,
            scale,
            self.theta_start[self.free] / scale,
            must.rows,
            must.least,
            self.lower,
            self.admissible,
        )

    def admissible(self, theta: Array) -> Array | None:
        """Give constants with their roundings mended, or None if they have no inverse."""
        if not np.isfinite(theta).all():
            return None
        mended = self.model.nearest_parameters(np.clip(theta, self.lower, self.upper))
        rows = self.must.rows
        room = rows @ mended - np.minimum(self.must.least, rows @ self.theta)
        if (room < -_ROUNDING * (np.abs(rows) @ np.abs(mended))).any():
            return None
        try:
            model = self.model.with_parameters(mended)
            return None if refusal_of(model) else np.array(mended)
        except (InputError, NotInvertibleError):
            return None

    def floor(self) -> float:
        """Give the least variance of the noise: far below the output's own."""
        y = self.window.y[: self.window.count]
        return max((_LEAST_NOISE * float(np.sqrt(np.mean(y**2)))) ** 2, 1e-290)

    def _fit(self) -> None:
        self.averaged = None
        task = self.task()
        try:
            found = fitted(task, self.theta, self.variance, self.floor(), _PASSES)
        except np.linalg.LinAlgError:
            found = None
        if found is None:
            newest = slice(max(self.window.count - self.block, 0), self.window.count)
            lost = int(self.window.told[newest].sum())
            self.counts["refused"] += lost
            self.counts["used"] -= lost
            self.window.told[newest] = 0.0
            return
        self._accept(found)
        if not self.has_left:
            self.regularities.set_levels(self.window.u[: self.window.count])
        if self.settings["search"] and 2 * self.window.count >= self.room:
            self._search(task)

    def _accept(self, found: Fitted) -> None:
        before, self.theta = self.theta, found.theta
        self.variance = float(found.variance)
        self.counts["refused steps"] += found.refused
        known = self.information if self.information.any() else found.information
        self.averaged, information = self._seen_from(found.theta, known, found.columns)
        if self.past.information.any():
            _, old = self._seen_from(before, known, found.columns_before)
            now = self.theta[self.free] / self.spread[self.free]
            self.past = self.past.turned(old, information, self.variance, now)
        self.information = information + self.past.information
        self.recent = information + self.past.recent

    def _seen_from(
        self, theta: Array, known: Array, columns: Array
    ) -> tuple[Averaged | None, Array]:
        """Give averaged derivatives of the window, if finite, and its information from there."""
        scale, limits = self.spread[self.free], (self.lower, self.upper)
        precision = known / self.variance + np.eye(scale.size)
        weights = self.task().weights
        with np.errstate(all="ignore"):
            rows = averaged(self.window, theta, self.free, scale, precision, limits, columns)
        if rows is not None:
            columns, weights = rows.columns, rows.weights(weights, self.variance)
        return rows, columns.T @ (columns * weights[:, None])

    def _search(self, task: Task) -> None:
        """Try an estimate from elsewhere, some in any case; while errors are no noise, for ever."""
        if self.trials >= _SURE_TRIALS and max(self.judged()[:2]) <= 1.0:
            return
        self.wait = max(self.wait - 1, 0)
        if self.wait:
            return
        self.wait = max(self.trials - _SURE_TRIALS, 0)
        self.trials += 1
        alone = replace(task, past=Past.none(self.free.size))
        found = rival_of(alone, self.theta, self.trials, self.floor(), self.judge)
        if found is None:
            return
        rival, is_better = found
        self.rivals[(self.trials - 1) % RIVALS] = self.theta if is_better else rival.theta
        if is_better:
            self.replacements += 1
            self.past = alone.past
            self._accept(rival)
            self.regularities.set_levels(self.window.u[: self.window.count])

    def _leave(self, count: int) -> None:
        """Leave the first samples of the window to the past, with the derivatives they have now."""
        window, free = self.window, self.free
        weights = self.task().weights[:count]
        u, y, told = (each[:count].copy() for each in (window.u, window.y, window.told))
        live = self.memory
        with np.errstate(all="ignore"):
            predicted, jacobian = window.drop(self.theta, count)
            columns, middle = jacobian[:, free] * self.spread[free], predicted
            if self.averaged is not None:
                rows = self.averaged.first(count)
                columns, middle = rows.columns, rows.middle
                weights = rows.weights(weights, max(self.variance, self.floor()))
            information = columns.T @ (columns * weights[:, None])
            error = y - predicted
            pull = columns.T @ (weights * (y - middle))
        if not (np.isfinite(window.tangents).all() and np.isfinite(window.state).all()):
            window.begin_at(live)
            return
        lost = -math.expm1(-self.fading * count)
        if np.isfinite(information).all() and np.isfinite(pull).all() and free.size:
            x = self.theta[free] / self.spread[free]
            kept = self.past.faded(lost, information, max(self.variance, self.floor()), x)
            self.past = kept.with_samples(information, pull, x)
            self.regularities.forget(lost)
            self.regularities.add(u, error, told)
            self.has_left = True

    def judge(self, theta: Array) -> tuple[float, float]:
        """Give how far errors of constants along the window, and those before, are from noise."""
        window = self.window
        y, _ = window.outputs(theta)
        u, told = window.u[: y.size], window.told[: y.size]
        return self.regularities.judge(u, window.y[: y.size] - y, told)

    def judged(self) -> tuple[float, float, float, float, float]:
        """Give regimes, neighbours, rms, correlation and the output's spread of the window."""
        window, count = self.window, self.window.count
        y, _ = window.outputs(self.theta)
        told = window.told[:count] > 0.0
        error = np.where(told, window.y[:count] - y, 0.0)
        regimes, neighbours = self.regularities.judge(window.u[:count], error, window.told[:count])
        if not told.any():
            return regimes, neighbours, 0.0, 0.0, 0.0
        square = float(error @ error)
        near = float(error[1:] @ error[:-1]) / square if square > 0.0 else 0.0
        rms = math.sqrt(square / float(told.sum()))
        return regimes, neighbours, rms, near, float(np.std(window.y[:count][told]))

    def innovation(self) -> ModelInnovation:
        """Say what is left unexplained."""
        regimes, neighbours, rms, correlation, size = self.judged()
        samples = int(self.window.told[: self.window.count].sum())
        is_known = samples >= LEAST_SAMPLES and bool(self.information.any())
        return ModelInnovation(
            rms=rms,
            correlation=correlation,
            loop_height=size,
            rivals=self.trials,
            replacements=self.replacements,
            regimes=regimes,
            neighbours=neighbours,
            samples=samples if is_known else 0,
        )

    def covariance(self) -> Array:
        """Give the covariance, shape (m, m)."""
        full = np.zeros((self.theta.size, self.theta.size))
        full[np.ix_(self.free, self.free)] = self.free_covariance(self.information)
        return full

    def free_covariance(self, information: Array, belief: float = 1.0) -> Array:
        """Give that of the constants that are estimated.

        Parameters
        ----------
        information
            Of samples, shape (f, f).
        belief
            How much the start counts, as a share of what it tells.
        """
        scale = self.spread[self.free]
        if not scale.size:
            return np.zeros((0, 0))
        if not information.any() or not self.variance > 0.0:
            return np.diag(scale**2) / belief
        values, axes = np.linalg.eigh(information / self.variance)
        inverse = (axes / (np.maximum(values, 0.0) + belief)) @ axes.T
        return np.asarray(0.5 * (inverse + inverse.T) * np.outer(scale, scale))

    def restart(self, theta: Array) -> None:
        """Forget what was learnt, go on from constants with the memory the input has left."""
        model = self.model.with_parameters(theta)
        why = refusal_of(model)
        if why:
            raise NotInvertibleError(f"the estimation cannot start: {why}")
        self._only_memory(theta)
        self._begin(np.asarray(theta, float), self._new_spread(model))

    def goes_on_from(self, other: Course) -> None:
        """Take over the memory of another estimate of the same model."""
        self.window.go_on_from(other.window)
        self.last_input = other.last_input
        self._only_memory(self.theta)
        self.set_estimate(self.theta)

    def _only_memory(self, theta: Array) -> None:
        live = self.memory
        with np.errstate(all="ignore"):
            self.window.drop(theta, self.window.count)
        window = self.window
        if not (np.isfinite(window.tangents).all() and np.isfinite(window.state).all()):
            window.begin_at(live)
        self.in_block = 0

    def _new_spread(self, model: Operator) -> Array:
        self.is_begun = False
        return spreads_of(model, self.settings["spread"], self.settings["spreads"], (0.0, 0.0))

    def error_of_commands(self) -> float:
        """Give the root mean square of what commands for the last predicted outputs would miss."""
        window = self.window
        y, _ = window.outputs(self.theta)
        first = max(window.count - _COMMANDS, 0)
        if first == window.count:
            return 0.0
        begin = window.memory_for(self.theta)
        state = self.model.run(window.u[:first], begin)[1] if first else begin
        step, commands = self.model.stepper(state), Commands(self.model, state)
        near, missed = float(window.u[first]), []
        for wanted in y[first:].tolist():
            near = commands.input_for(wanted, np.array(step.state), near)
            missed.append(step(near) - wanted)
            commands.passed(near, np.array(step.state))
        return float(np.sqrt(np.mean(np.square(missed))))
