"""Identification of a power law by variable projection over its exponent alone.

The output of the model is ``c1 u + c2 g(u; c3) + offset`` with g the operator of c1 = 0, c2 = 1:
for each c3 the other constants follow by linear least squares, and what is left is a function of c3
alone. It is evaluated over a grid that covers every shape a record can tell apart, and refined
around each of its minima, so that the global one is found.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import NotIdentifiableError
from hyst.identification.fit.shape_search import least_over, saved_beside_a_line, shares
from hyst.identification.record_use.used_samples import Data
from hyst.models import MasingOperator, PowerLaw
from hyst.models.masing import as_mode
from hyst.signals import Record, estimate_noise, reversals, suggest_dead_band

Array = NDArray[np.float64]

SMALLEST_POWER, LARGEST_POWER = 0.02, 30.0
"""Of c3: below, a line and c2 p^c3 are one; beyond, the curve is a line with a jump at its end.
Coarse records tell even less; see ``largest_power``."""

SMALLEST_SHARE = 1e-9
"""Of c2 p^c3 at the end of the largest branch in c1: below, there is no hysteresis but rounding."""
SMALLEST_GAIN = 15.0
"""Squared residual a power law must save against a line, in residual variances."""

FEWEST_SLOPES = 10


@dataclass(frozen=True)
class PowerLawFit:
    """Constants of ``y = sign (c1 u + c2 g(u; c3)) + offset``.

    Parameters
    ----------
    c1, c2, c3
        As in ``RambergOsgood``.
    offset
        Output units.
    dead_band
        Of the memory, input units.
    evaluations
        How many exponents were tried.
    largest_power
        The largest c3 the records could tell.
    """

    c1: float
    c2: float
    c3: float
    offset: float
    dead_band: float
    evaluations: int
    largest_power: float = LARGEST_POWER


def largest_power(data: Data) -> float:
    """Give the largest c3 that records tell from a line with a jump at its end.

    The curve bends within about ``1/(c3 + 1)`` of the end of a branch; a step of the input, the
    median of those that are one, must be shorter than that.

    Parameters
    ----------
    data
        The records.
    """
    windows = zip(data.records, data.windows(), strict=True)
    steps = np.abs(np.concatenate([np.diff(record.u[window]) for record, window in windows]))
    share = float(np.median(steps[steps > 0.0])) / (2.0 * data.half_range)
    return float(np.clip(1.0 / share - 1.0, 2.0, LARGEST_POWER))


def fit_power_law(
    data: Data,
    sign: float = 1.0,
    *,
    memory: str = "masing",
    regression: str = "output",
    signal_to_noise: float = 3.0,
) -> PowerLawFit:
    """Find the constants of a power law by variable projection over c3.

    Parameters
    ----------
    data
        The records.
    sign
        +1, or -1 for an actuator whose output falls as its input rises.
    memory
        ``"masing"`` or ``"last-reversal"``.
    regression
        ``"output"``: y itself, with the integrated regressor. ``"slope"``: dy/du, as S3 has it.
    signal_to_noise
        Of the differences of y that take part in a regression of slopes.

    Returns
    -------
    PowerLawFit

    Raises
    ------
    NotIdentifiableError
        If the slope does not grow with the way since a reversal, or not beyond the noise, or too
        few differences of y stand out of the noise.

    Notes
    -----
    S3 theorem 5, whose eq. 12 means ``(I - Phi Phi^+) z``; Golub and Pereyra, Inverse Problems 19
    (2003), R1.
    """
    band = _dead_band(data.records, memory)
    regressor = _Regressor(data, memory, band)
    if regression == "slope":
        table = _slope_table(data, regressor, sign, signal_to_noise)
    else:
        table = _output_table(data, regressor, sign)
    largest = largest_power(data)
    c3, evaluations = least_over(lambda power: shares(*table(power))[1], SMALLEST_POWER, largest)
    (c1, c2), left = shares(*table(c3))
    # In these units a full branch of the largest loop is p = 2.
    if not c2 * 2.0**c3 > SMALLEST_SHARE * c1:
        raise NotIdentifiableError(
            "the slope of the loop does not grow with the way since a reversal, so that no power "
            "law with c2 > 0 fits; use family 'masing', 'pi' or 'linear'"
        )
    if regression == "output":
        _require_a_loop(*table(c3), left)
    c2 *= regressor.unit**-c3
    modelled = sign * (c1 * regressor.input() + c2 * regressor(c3) * regressor.unit**c3)
    offset = float(np.mean(data.measured() - modelled))
    return PowerLawFit(float(c1), float(c2), c3, offset, band, evaluations, largest)


def _require_a_loop(matrix: Array, target: Array, left: float) -> None:
    """Refuse a power law that describes the records no better than a line, but for noise.

    Two constants more, and the best of many exponents, always save some multiples of the residual
    variance; of white noise less than ``SMALLEST_GAIN`` in all but one of some thousand records.
    """
    if saved_beside_a_line(matrix[:, 0], target, left) < SMALLEST_GAIN:
        raise NotIdentifiableError(
            "a power law describes the records no better than a straight line, but for noise; use "
            "family 'linear'"
        )


class _Regressor:
    """g(u; c3) over the samples used, in units in which half the input range is 1."""

    def __init__(self, data: Data, memory: str, dead_band: float) -> None:
        self._data, self._memory, self._dead_band = data, memory, dead_band
        self.unit = data.half_range

    def __call__(self, c3: float) -> Array:
        return self._data.joined(self.by_record(c3))

    def by_record(self, c3: float) -> list[Array]:
        curve = PowerLaw(0.0, self.unit**-c3, c3)
        operator = MasingOperator(curve, as_mode(self._memory), dead_band=self._dead_band)
        windows = zip(self._data.records, self._data.windows(), strict=True)
        return [operator(record.u[: window.stop])[window] for record, window in windows]

    def inputs(self) -> list[Array]:
        windows = zip(self._data.records, self._data.windows(), strict=True)
        return [record.u[window] for record, window in windows]

    def input(self) -> Array:
        return self._data.inputs()


Table = Callable[[float], tuple[Array, Array]]
"""c3 -> regressors (N, 2), target (N,)"""


def _output_table(data: Data, regressor: _Regressor, sign: float) -> Table:
    """Regress y on u and g, the offset taken out by their means."""
    y = sign * data.measured()
    u, target = regressor.input(), y - y.mean()
    centred = u - u.mean()

    def table(c3: float) -> tuple[Array, Array]:
        g = regressor(c3)
        return np.column_stack([centred, g - g.mean()]), target

    return table


def _slope_table(data: Data, regressor: _Regressor, sign: float, signal_to_noise: float) -> Table:
    """Regress dy/du on 1 and dg/du where the difference of y stands out of its noise (S3 III-D).

    The secant of g takes the place of p^c3 in the middle, which it is up to second order, and is
    right in both memories.
    """
    outputs = [sign * each for each in data.outputs()]
    inputs = regressor.inputs()
    du = np.concatenate([np.diff(each) for each in inputs])
    dy = np.concatenate([np.diff(each) for each in outputs])
    noise = np.sqrt(2.0) * max(estimate_noise(each) for each in outputs)
    mean_slope = np.ptp(np.concatenate(outputs)) / (2.0 * data.half_range)
    used = (
        _both_count(data) & (np.abs(du) > 0.0) & (np.abs(du) * mean_slope > signal_to_noise * noise)
    )
    if used.sum() < FEWEST_SLOPES:
        raise NotIdentifiableError(
            f"only {int(used.sum())} differences of the output are {signal_to_noise:g} times their "
            "noise; lower the option signal-to-noise, sample less often, or fit the output itself"
        )
    target = dy[used] / du[used]

    def table(c3: float) -> tuple[Array, Array]:
        dg = np.concatenate([np.diff(each) for each in regressor.by_record(c3)])
        return np.column_stack([np.ones(target.size), dg[used] / du[used]]), target

    return table


def _both_count(data: Data) -> NDArray[np.bool_]:
    """Tell of which differences both samples count."""
    counted = zip(data.counted(), data.windows(), strict=True)
    each = [
        np.ones(w.stop - w.start, dtype=np.bool_) if counts is None else counts
        for counts, w in counted
    ]
    return np.concatenate([counts[1:] & counts[:-1] for counts in each])


def _dead_band(records: Sequence[Record], memory: str) -> float:
    """Give the dead band that keeps small turns of a measured input from resetting the memory."""
    if memory == "masing":
        return 0.0
    bands = [suggest_dead_band(record.u) for record in records]
    has_small_turns = any(
        reversals(record.u, 0.0).size != reversals(record.u, band).size
        for record, band in zip(records, bands, strict=True)
    )
    return max(bands) if has_small_turns else 0.0
