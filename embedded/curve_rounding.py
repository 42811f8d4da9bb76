"""Rounding of operators made of a curve: loading curves with reversals, memory elements."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hyst import _engine
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

UNIT = 2.0**-24
_GRID = 2000


class Passed(Protocol):
    """What the bounds need: a stage, its record and state, and the error that enters."""

    @property
    def stage(self) -> Stage: ...
    @property
    def constants(self) -> Array: ...
    @property
    def u(self) -> Array: ...
    @property
    def y(self) -> Array: ...
    @property
    def state(self) -> Array: ...
    @property
    def error(self) -> float: ...


def power_rounding(x: Array, exponent: float) -> Array:
    """Relative error of x^exponent: that of core/include/hyst/power.h, and of the exponent."""
    logarithm = np.abs(np.log2(np.maximum(x, 1e-30)))
    own = (4.0 + 2.0 * np.abs(exponent) * logarithm) * 2.0 * UNIT
    return np.asarray(own + np.abs(exponent) * logarithm * np.log(2.0) * UNIT)


def _loading(curve: str, constants: Array, x: Array) -> tuple[Array, Array, Array]:
    """Value, slope and absolute error of a loading curve."""
    if curve == "power-law":
        linear, c2, c3 = constants
        exponent = c3 + 1.0
        power = 2.0**c3 * c2 / exponent * x**exponent
        error = power * (power_rounding(x, exponent) + 3.0 * UNIT) + 3.0 * UNIT * linear * x
        return linear * x + power, linear + 2.0**c3 * c2 * x**c3, error
    if curve == "plays":
        plays = len(constants) // 2
        p0, p, r = constants[0], constants[1 : 1 + plays], constants[1 + plays :]
        past = x[:, None] > r
        value = p0 * x + np.maximum(x[:, None] - r, 0.0) @ p
        error = 6.0 * UNIT * (abs(p0) + np.abs(p).sum()) * np.full_like(x, x.max())
        return value, p0 + past @ p, error
    if curve == "exponential":
        c, d, b = constants
        lost = -np.expm1(-x / b)
        # An exponential is off by six roundings, a sum of terms of one sign by one for each.
        error = UNIT * (8.0 * (abs(c) + abs(d)) * x + 16.0 * abs(d) * b * lost)
        return c * x - d * b * lost, c - d * (1.0 - lost), error
    if curve == "iwan":
        force, total, chi, beta, residual = constants
        share, exponent = beta + (chi + 1.0) / (chi + 2.0), chi + 2.0
        limit = force * (1.0 + beta) / (total * share)
        along = np.minimum(x, limit)
        power = total / ((1.0 + beta) * exponent) * along * (along / limit) ** (chi + 1.0)
        slips = power_rounding(along, exponent) + power_rounding(np.array([limit]), chi + 1.0)
        error = power * (slips + 12.0 * UNIT) + 4.0 * UNIT * (total + residual) * x
        slope = np.where(x < limit, total - exponent * power / np.maximum(along, 1e-30), 0.0)
        return total * along - power + residual * x, slope + residual, error
    degrees = np.arange(1, len(constants) + 1)
    powers = x[:, None] ** degrees
    slope = (degrees * constants * x[:, None] ** (degrees - 1)).sum(axis=1)
    error = (2.0 * len(constants) + 1.0) * UNIT * (powers @ np.abs(constants))
    return powers @ constants, slope, error


def deepest(passage: Passed) -> int:
    """Give the largest number of reversals on the stack."""
    chain = _engine.Chain([passage.stage])
    step = _engine.stepper(chain, passage.state.copy(), 0.0)
    most = 0.0
    for u in passage.u.tolist():
        step(u)
        most = max(most, float(step.state[2]))
    return int(most)


def turning_points(u: Array) -> int:
    """Give how often a record changes its direction."""
    steps = np.diff(u, prepend=0.0)
    directions = np.sign(steps[steps != 0.0])
    return int((directions[1:] != directions[:-1]).sum())


def curve_bound(passage: Passed) -> float:
    """Bound the error of a loading curve with memory of reversals."""
    inverse, last_reversal = (passage.stage.choices[key] for key in ("inverse", "last_reversal"))
    u, y = float(np.abs(passage.u).max()) + passage.error, float(np.abs(passage.y).max())
    x = np.linspace(0.0, y if inverse else u, _GRID)
    value, slope, error = _loading(passage.stage.form, passage.constants, x)
    if inverse:
        slope, error, value = 1.0 / slope, error / slope + 4.0 * UNIT * x, x
    variation = float(slope[0] + np.abs(np.diff(slope)).sum())
    # The difference of two inputs is rounded, then the curve, then twice it is added to the start.
    branch = 2.0 * (float(slope.max()) * 2.0 * UNIT * u + float(error.max()))
    branch += 2.0 * UNIT * (y + 2.0 * float(value.max()))
    starts = 2 * turning_points(passage.u) if last_reversal else deepest(passage) + 1
    return variation * passage.error + (starts + 1) * branch


def _memory(form: str, knots: Array, values: Array, p: Array) -> tuple[Array, Array, Array]:
    """Value, slope and absolute error of M."""
    if form == "power-law":
        c1, c2, c3 = values
        size = np.maximum(np.abs(p), 1e-30)
        power = c2 * size**c3
        error = np.abs(power) * (power_rounding(size, c3) + 3.0 * UNIT) + 2.0 * UNIT * abs(c1)
        return c1 + power, c2 * c3 * size ** (c3 - 1.0) * np.sign(p), error
    if form == "polynomial":
        degrees = np.arange(len(values))
        terms = values * p[:, None] ** degrees
        slope = (degrees[1:] * values[1:] * p[:, None] ** (degrees[1:] - 1)).sum(axis=1)
        error = (2.0 * len(values) + 1.0) * UNIT * np.abs(terms).sum(axis=1)
        return terms.sum(axis=1), slope, error
    slopes = np.diff(values) / np.diff(knots)
    steepest = float(np.abs(slopes).max())
    error = 6.0 * UNIT * (np.abs(values).max() + steepest * np.abs(knots).max())
    return np.interp(p, knots, values), np.full_like(p, steepest), np.full_like(p, error)


def memory_element_bound(passage: Passed) -> float:
    """Bound the error of a memory element along its trajectory."""
    stage, dt = passage.stage, passage.stage.dt or 1.0
    inverse, absolute, is_reset = (
        stage.choices[key] for key in ("inverse", "absolute", "is_reset")
    )
    (reset_to,) = stage.fixed["reset_to"]
    knots, values = np.array(stage.fixed["knots"]), passage.constants
    chain = _engine.Chain([stage])
    step = _engine.stepper(chain, passage.state.copy(), 0.0)
    drive = passage.y if inverse else passage.u
    rate = np.abs(drive) if absolute else drive
    after = np.empty_like(drive)
    for k, input_ in enumerate(passage.u.tolist()):
        step(input_)
        after[k] = step.state[0]
    before = after - dt * rate
    memory, slope, error = _memory(stage.form, knots, values, before)
    # Of the drive: its own error, and its error for an error of p in this step.
    if inverse:
        own = passage.error / memory + np.abs(drive) * (error / memory + UNIT)
        by_memory = -drive * slope / memory
    else:
        own, by_memory = np.full_like(drive, passage.error), np.zeros_like(drive)
    sign = np.where(rate == drive, 1.0, -1.0)
    at_start = of_p = UNIT * max(abs(reset_to), float(np.abs(passage.state[0])))
    worst = 0.0
    for k in range(drive.size):
        if is_reset and k > 0 and abs(before[k] - after[k - 1]) > 1e-12:
            of_p = at_start
        if inverse:
            worst = max(worst, own[k] + abs(by_memory[k]) * of_p)
        else:
            of_memory = abs(slope[k]) * of_p + error[k] + 2.0 * UNIT * memory[k]
            worst = max(worst, own[k] * memory[k] + abs(drive[k]) * of_memory)
        of_p = abs(1.0 + dt * sign[k] * by_memory[k]) * of_p + dt * own[k]
        of_p += 3.0 * UNIT * dt * abs(drive[k]) + UNIT * abs(after[k])
    return worst
