"""How far single precision may be from double: a bound for every model, derived, not measured.

Every constant and every operation is rounded once, by at most u = 2^-24 of its value; k roundings
in a row change a product or a term of a sum by at most g(k) = k u / (1 - k u) of it (Higham,
Accuracy and Stability of Numerical Algorithms, 2nd ed., sec. 3.1). A stage adds what its own
operations lose and passes on the error e of its input:

- a play is a clamp of its memory to u -+ r, which never enlarges an error, so rounding does not add
  up over time: e + g(2) (|u| + r) for ever;
- sums of plays and of dead zones: the weighted errors of the terms, and g(n + 2) of all terms;
- linear dynamics: every step's rounding is a disturbance of the state, carried to the output by
  the sum of |c A^k|;
- a loading curve with reversals: the operator is a sum of plays with the slope's variation as
  weights; the rounding of one branch adds to that of the reversal it starts from, so it counts
  once for each reversal on the stack;
- relays of the Preisach operator: the same, and thresholds that are off by their own rounding;
- a memory element: the rounding of each step stays in its sum, carried along the trajectory.

Terms of second order in u are covered by one per cent more. Magnitudes are those of the run in
double. Where a decision depends on the sign of a rounded difference (dead zones by direction,
memory of the last reversal) a bound exists only while the input carries no error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from embedded.curve_rounding import curve_bound, memory_element_bound
from embedded.relay_rounding import relay_bound
from hyst import _engine
from hyst.control import TrackingController
from hyst.operators import Operator
from hyst.operators.stage import Stage

Array = NDArray[np.float64]

UNIT = 2.0**-24
SECOND_ORDER = 1.01


class NoBoundError(Exception):
    """No bound is known; the message says why."""


def g(roundings: int) -> float:
    """Give the relative error of so many roundings in a row."""
    return roundings * UNIT / (1.0 - roundings * UNIT)


@dataclass(frozen=True)
class Passage:
    """One stage, what enters it (finite samples), its state before, and what leaves it."""

    stage: Stage
    u: Array
    state: Array
    y: Array
    error: float

    @property
    def constants(self) -> Array:
        """The stage's own, in the order of its operator's parameters."""
        return np.array(self.stage.constants)

    @property
    def most(self) -> float:
        """The largest input, its error included."""
        return float(np.abs(self.u).max()) + self.error

    def demand_exact_input(self) -> None:
        if self.error > 0.0:
            raise NoBoundError("a decision hangs on the sign of a rounded number")


def single_precision_bound(model: Operator, u: Array, error: float = 0.0) -> float:
    """Bound the output error of a record of finite samples, given that of its input."""
    states = model.initial_state()
    for stage in model.stages():
        if stage.kind not in BOUNDS:
            raise NoBoundError(f"nobody has derived one for stages of kind {stage.kind!r}")
        chain = _engine.Chain([stage])
        state, states = states[: chain.state_length], states[chain.state_length :]
        y = np.empty((1, u.size))
        chain.run(state.reshape(1, -1).copy(), u.reshape(1, -1), y, "loop")
        error = BOUNDS[stage.kind](Passage(stage, u, state, y[0], error))
        u = y[0]
    return SECOND_ORDER * error


def controller_bound(controller: TrackingController, inputs: Array) -> float:
    """Bound the output error of a tracking controller for finite rows (y_ref, y) held exactly."""
    if controller.is_limited:
        raise NoBoundError("rounding decides on which samples the drive is limited")
    A, B, c, D = controller.A, controller.B, controller.C, controller.D
    x, most = controller.x0.copy(), np.abs(controller.x0)
    v = np.empty(inputs.shape[0])
    for k, row in enumerate(inputs):
        v[k] = c @ x + D @ row
        x = A @ x + B @ row
        most = np.maximum(most, np.abs(x))
    top = np.abs(inputs).max(axis=0)
    terms = g(c.size + 4)
    rounding = terms * (np.abs(A) @ most + np.abs(B) @ top) + g(1) * most
    error = terms * float(np.abs(c) @ most + np.abs(D) @ top)
    error = SECOND_ORDER * (error + carried(A, c, rounding, v.size))
    return (
        error
        if controller.inverse is None
        else single_precision_bound(controller.inverse, v, error)
    )


def _affine(passage: Passage) -> float:
    gain, offset = np.abs(passage.constants)
    return float(gain * passage.error + g(3) * gain * passage.most + g(2) * offset)


def _play_errors(passage: Passage, r: Array, z0: Array) -> Array:
    """Errors of plays: those of the clamp's bounds, or of the memory at the start."""
    return np.maximum(passage.error + g(2) * (passage.most + r), g(1) * np.abs(z0))


def _play(passage: Passage) -> float:
    return float(_play_errors(passage, passage.constants, passage.state)[0])


def _stop(passage: Passage) -> float:
    return passage.error + _play(passage) + g(1) * float(np.abs(passage.y).max())


def _steepest(weights: Array, thresholds: Array) -> float:
    """Give the largest slope of a two-sided dead-zone map."""
    knees = np.unique(np.concatenate([[0.0], thresholds]))
    places = np.concatenate([[knees[0] - 1.0], 0.5 * (knees[1:] + knees[:-1]), [knees[-1] + 1.0]])
    acts = np.where(thresholds > 0.0, places[:, None] > thresholds, places[:, None] < thresholds)
    acts |= thresholds == 0.0
    return float(np.abs(acts @ weights).max())


def _terms(passage: Passage, weights: Array, thresholds: Array) -> float:
    """Give what the terms of a dead-zone map and their sum lose."""
    rho = np.abs(thresholds)
    terms = np.where(rho > 0.0, g(2) * (passage.most + rho), 0.0)
    sizes = np.maximum(passage.most - rho, 0.0)
    return float(np.abs(weights) @ (terms + g(weights.size + 2) * sizes))


def _dead_zone(passage: Passage) -> float:
    weights, thresholds = np.split(passage.constants, 2)
    return _steepest(weights, thresholds) * passage.error + _terms(passage, weights, thresholds)


def _direction_dead_zone(passage: Passage) -> float:
    passage.demand_exact_input()
    return _dead_zone(passage)


def _sum_of_plays(passage: Passage, p0: float, p: Array, z: Array, errors: Array) -> float:
    """Error of p0 u + sum p_i z_i with plays at most z and their errors."""
    own = abs(p0) * passage.most + float(np.abs(p) @ z)
    return float(abs(p0) * passage.error + np.abs(p) @ errors + g(p.size + 2) * own)


def _pi(passage: Passage) -> float:
    p0, (p, r), z0 = passage.constants[0], np.split(passage.constants[1:], 2), passage.state
    z = np.maximum(np.maximum(passage.most - r, 0.0), np.abs(z0))
    return _sum_of_plays(passage, p0, p, z, _play_errors(passage, r, z0))


def _rate_dependent_pi(passage: Passage) -> float:
    stage, dt = passage.stage, passage.stage.dt or 1.0
    n, m = stage.choices["plays"], stage.choices["powers"]
    knees = np.abs(stage.fixed["knees"])
    first, p, r, growth, powers, slopes = np.split(passage.constants, np.cumsum([1, n, n, 1, m]))
    p0, beta, z0 = float(first[0]), float(growth[0]), passage.state[:n]
    change = float(np.abs(np.diff(passage.u)).max(initial=0.0)) + 2.0 * passage.error
    rate = change / dt
    degrees = np.arange(2, 2 + len(powers))
    coefficients, kinks = np.abs(powers), np.abs(slopes)
    slope = beta + float(degrees * coefficients @ rate ** (degrees - 1)) + float(kinks.sum())
    size = beta * rate + float(coefficients @ rate**degrees) + float(kinks.sum()) * rate
    terms = 2 * len(powers) + len(slopes) + 4
    widening = slope / dt * (2.0 * passage.error + g(1) * change) + g(terms) * (
        size + float(kinks @ knees)
    )
    errors = np.maximum(
        passage.error + widening + g(3) * (passage.most + size + r), g(1) * np.abs(z0)
    )
    z = np.maximum(passage.most, np.abs(z0))
    return _sum_of_plays(passage, p0, p, z, errors)


def carried(A: Array, c: Array, disturbance: Array, steps: int) -> float:
    """Give sum_k |c A^k| disturbance, over as many steps as the record has."""
    total, row = 0.0, c.copy()
    for _ in range(steps):
        total += float(np.abs(row) @ disturbance)
        row = row @ A
    return total


def _state_space(passage: Passage) -> float:
    n = passage.stage.choices["order"]
    a, b, c, (d,) = np.split(passage.constants, np.cumsum([n * n, n, n]))
    A = a.reshape(n, n)
    w = np.concatenate([passage.state[n:], passage.u])[: passage.u.size]
    x, most = passage.state[:n].copy(), np.abs(passage.state[:n])
    for w_k in w:
        x = A @ x + b * w_k
        most = np.maximum(most, np.abs(x))
    rounding = g(n + 3) * (np.abs(A) @ most + np.abs(b) * passage.most) + g(1) * most
    output = g(n + 3) * (float(np.abs(c) @ most) + abs(d) * passage.most) + abs(d) * passage.error
    return float(output) + carried(A, c, rounding + np.abs(b) * passage.error, w.size)


def _sections(passage: Passage) -> float:
    u, error, states = passage.u, passage.error, passage.state.copy()
    for i, (b0, b1, b2, a1, a2) in enumerate(passage.constants.reshape(-1, 5)):
        state, most = states[2 * i : 2 * i + 2], np.zeros(2)
        y = np.empty_like(u)
        for k, u_k in enumerate(u):
            most = np.maximum(most, np.abs(state))
            y[k] = b0 * u_k + state[0]
            state = np.array([b1 * u_k - a1 * y[k] + state[1], b2 * u_k - a2 * y[k]])
        top, out = float(np.abs(u).max()) + error, float(np.abs(y).max())
        own = g(3) * (abs(b0) * top + most[0])
        rounding = np.array(
            [
                g(5) * (abs(b1) * top + abs(a1) * out + most[1]) + abs(a1) * own,
                g(4) * (abs(b2) * top + abs(a2) * out) + abs(a2) * own,
            ]
        )
        A = np.array([[-a1, 1.0], [-a2, 0.0]])
        b = np.array([b1 - a1 * b0, b2 - a2 * b0])
        through = carried(A, np.array([1.0, 0.0]), rounding + np.abs(b) * error, u.size)
        error = abs(b0) * error + own + through
        u = y
    return error


def _masing(passage: Passage) -> float:
    if passage.stage.choices["last_reversal"]:
        passage.demand_exact_input()
    return curve_bound(passage)


def _memory_element(passage: Passage) -> float:
    if passage.stage.choices["is_reset"]:
        passage.demand_exact_input()  # memory is set back where the input changes its sign
    return memory_element_bound(passage)


def _preisach(passage: Passage) -> float:
    if passage.stage.choices["inverse"]:
        raise NoBoundError("the inverse has no known bound of its slope over histories")
    return relay_bound(passage)


BOUNDS: dict[str, Callable[[Passage], float]] = {
    "affine": _affine,
    "play": _play,
    "stop": _stop,
    "dead_zone": _dead_zone,
    "direction_dead_zone": _direction_dead_zone,
    "pi": _pi,
    "rate_dependent_pi": _rate_dependent_pi,
    "state_space": _state_space,
    "sections": _sections,
    "masing": _masing,
    "memory_element": _memory_element,
    "preisach": _preisach,
}
