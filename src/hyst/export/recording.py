"""Write down the stages of an operator, with what the core derives from its constants.

The derived constants are formed by the same operations in the same order as in ``engine/``, so they
have the same bits; tests hold both to each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import final

import numpy as np

from hyst import _engine
from hyst.export.stages import Stage
from hyst.operators.base import Operator


def record_stages(operator: Operator) -> tuple[Stage, ...]:
    """Give the stages of an operator in the order the signal passes them.

    Parameters
    ----------
    operator
        Any operator.

    Returns
    -------
    tuple of Stage

    Examples
    --------
    >>> from hyst import Affine, Play
    >>> [stage.kind for stage in record_stages(Affine(2.0) @ Play(0.5))]
    ['play', 'affine']
    """
    recorder = Recorder()
    operator.append_to(recorder)
    return tuple(recorder.stages)


@final
class Recorder:
    """A ``StageSink`` that keeps what it is given; see ``hyst.operators.stage_sink``."""

    def __init__(self) -> None:
        self.stages: list[Stage] = []

    def add_affine(self, gain: float, offset: float) -> None:
        """Record ``y = gain u + offset``."""
        self.stages.append(Stage("affine", {"gain": gain, "offset": offset}))

    def add_play(self, r: float) -> None:
        """Record a play."""
        self.stages.append(Stage("play", {"r": r}, state_length=1))

    def add_stop(self, r: float) -> None:
        """Record a stop."""
        self.stages.append(Stage("stop", {"r": r}, state_length=1))

    def add_dead_zone(
        self, weights: Sequence[float], thresholds: Sequence[float], by_direction: bool
    ) -> None:
        """Record dead zones of ``weights`` and ``thresholds``, two-sided or ``by_direction``."""
        tables = {"weight": tuple(weights), "threshold": tuple(thresholds)}
        kind = "direction_dead_zone" if by_direction else "dead_zone"
        self.stages.append(Stage(kind, tables=tables, state_length=int(by_direction)))

    def add_pi(self, p0: float, p: Sequence[float], r: Sequence[float]) -> None:
        """Record plays of weights ``p`` and thresholds ``r``, and ``p0``."""
        tables = {"p": tuple(p), "r": tuple(r)}
        self.stages.append(Stage("pi", {"p0": p0}, tables, state_length=len(p)))

    def add_rate_dependent_pi(
        self,
        p0: float,
        p: Sequence[float],
        r: Sequence[float],
        beta: float,
        powers: Sequence[float],
        slopes: Sequence[float],
        knees: Sequence[float],
        dt: float,
    ) -> None:
        """Record ``p0``, ``p``, ``r`` and the curve of the rate.

        The core's curve is over the change of the input in one sample, so ``beta``, ``powers``,
        ``slopes`` and ``knees`` are scaled by ``dt``.
        """
        scale, scaled = dt, []
        for power in powers:
            scale *= dt
            scaled.append(power / scale)
        tables = {
            "p": tuple(p),
            "r": tuple(r),
            "power": tuple(scaled),
            "weight": tuple(slope / dt for slope in slopes),
            "threshold": tuple(knee * dt for knee in knees),
        }
        numbers = {"p0": p0, "growth": beta / dt}
        self.stages.append(
            Stage("rate_dependent_pi", numbers, tables, state_length=len(p) + 2, dt=dt)
        )

    def add_state_space(
        self, delay: int, a: Sequence[float], b: Sequence[float], c: Sequence[float], d: float
    ) -> None:
        """Record ``a`` (column after column), ``b``, ``c``, ``d`` and ``delay``."""
        tables = {"a": tuple(a), "b": tuple(b), "c": tuple(c)}
        self.stages.append(
            Stage("state_space", {"d": d}, tables, {"delay": delay}, state_length=len(b) + delay)
        )

    def add_sections(self, coefficients: Sequence[float]) -> None:
        """Record sections."""
        length = 2 * (len(coefficients) // 5)
        tables = {"coefficient": tuple(coefficients)}
        self.stages.append(Stage("sections", tables=tables, state_length=length))

    def add_masing(
        self,
        curve: str,
        constants: Sequence[float],
        least_slope: float,
        inverse: bool,
        last_reversal: bool,
        depth: int,
        dead_band: float,
    ) -> None:
        """Record a ``curve`` of ``constants`` and ``least_slope``, and its memory.

        The memory is ``inverse``, ``last_reversal``, ``depth`` and ``dead_band``.
        """
        choices = {"inverse": int(inverse), "last_reversal": int(last_reversal), "depth": depth}
        numbers, tables = _loading_curve(curve, constants, least_slope)
        self.stages.append(
            Stage(
                "masing",
                {"dead_band": dead_band, **numbers},
                tables,
                choices,
                _CURVES[curve],
                state_length=_MASING_STACK + 2 * depth,
            )
        )

    def add_memory_element(
        self,
        function: str,
        knots: Sequence[float],
        constants: Sequence[float],
        inverse: bool,
        absolute: bool,
        is_reset: bool,
        reset_to: float,
        dt: float,
    ) -> None:
        """Record a ``function`` of ``knots`` and ``constants``, and its momentum.

        The momentum is ``inverse``, ``absolute``, ``is_reset``, ``reset_to`` and ``dt``.
        """
        self.stages.append(
            Stage(
                "memory_element",
                {"reset_to": reset_to, "dt": dt},
                {"knot": tuple(knots), "value": tuple(constants)},
                {"inverse": int(inverse), "absolute": int(absolute), "is_reset": int(is_reset)},
                _FUNCTIONS[function],
                state_length=2,
                dt=dt,
            )
        )


_CURVES = {
    "power-law": "HYST_POWER_LAW",
    "plays": "HYST_PLAYS",
    "polynomial": "HYST_POLYNOMIAL",
}
_FUNCTIONS = {
    "power-law": "HYST_MEMORY_POWER",
    "polynomial": "HYST_MEMORY_POLYNOMIAL",
    "table": "HYST_MEMORY_TABLE",
}
_MASING_STACK = 4  # HYST_MASING_STACK

Tables = dict[str, tuple[float, ...]]


def _loading_curve(
    curve: str, constants: Sequence[float], least_slope: float
) -> tuple[dict[str, float], Tables]:
    if curve == "power-law":
        linear, c2, c3 = constants
        exponent = c3 + 1.0
        factor = _core_power(2.0, c3) * c2 / exponent
        return {"linear": linear, "factor": factor, "exponent": exponent}, {}
    if curve == "plays":
        return {}, _pieces(constants)
    return {"least_slope": least_slope}, {"coefficient": tuple(constants)}


def _pieces(constants: Sequence[float]) -> Tables:
    """Knots, values and slopes of ``f(x) = p0 x + sum_i p_i max(x - r_i, 0)``."""
    plays = len(constants) // 2
    p0, p, r = constants[0], constants[1 : 1 + plays], constants[1 + plays :]
    knot, value, slope = [0.0], [0.0], [p0]
    for weight, threshold in zip(p, r, strict=True):
        value.append(value[-1] + slope[-1] * (threshold - knot[-1]))
        knot.append(threshold)
        slope.append(slope[-1] + weight)
    return {"knot": tuple(knot), "value": tuple(value), "slope": tuple(slope)}


def _core_power(x: float, exponent: float) -> float:
    """Give x to a power with the core's own bits: M(p) = 0 + 1 |p|^exponent at p = x."""
    chain = _engine.Chain()
    chain.add_memory_element("power-law", [], [0.0, 1.0, exponent], False, False, False, 0.0, 1.0)
    y = np.empty((1, 1))
    chain.run(np.array([[x, 0.0]]), np.array([[1.0]]), y)
    return float(y[0, 0])
