"""What richer models leave of the records: the yardstick for hysteresis with dynamics behind it.

All of them are linear least squares on what the final model leaves, so they cost no search: another
hysteresis before the same dynamics, other dynamics behind the same hysteresis, both, and, what is
no Hammerstein system any more, plays with dynamics of their own and plays of the output. Each is
held to stretches it was not fitted to. Where the drive repeats, the noise from one period to the
next is the best yardstick of all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.interpolation import earlier, first_comparable
from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import dynamics_of
from hyst.identification.families.hammerstein.yardstick.left_out_stretches import LeftOutStretches
from hyst.identification.families.hammerstein.yardstick.local_dynamics import left_by_dynamics
from hyst.identification.families.hammerstein.yardstick.richer_models import (
    columns_behind,
    columns_of_front,
    columns_of_output,
    columns_of_own_dynamics,
)
from hyst.identification.judgement.repetition import repeats_after
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics

Array = NDArray[np.float64]
Missing = Literal["nothing", "dynamics", "hysteresis", "both", "structure", "unknown"]

MOST_SAMPLES = 40_000
"""Of all records together that richer models take: more would cost time and change no verdict."""

MOST_PERIODIC = 200_000
"""Of all records together in which a period of the drive is looked for."""

LEAD = 10_000
"""Samples before the first that counts, in which plays and dynamics get under way."""

TELLS = 1.3
"""Ratio from which something is missing: of true models, fitted, it was never above 1.25."""

NEARLY_ALL = 0.9
"""Share of what the richest model explains with which a simpler one explains it as well."""

EXPLAINED = 0.5
"""Share of what is left beside noise that the richest model must explain to give it a name."""

_DRIFT = 4  # degree of the polynomial in time that is no concern of a yardstick
_EXACT = 1e-9  # of the output's deviation: two periods nearer than this are copies of each other


@dataclass(frozen=True)
class Yardstick:
    """What a model leaves beside what richer ones leave; rms, output units.

    Parameters
    ----------
    model
        Of the model.
    linear
        Of linear dynamics of any order without hysteresis.
    other_hysteresis
        Of any hysteresis before the dynamics of the model.
    other_dynamics
        Of dynamics of any order behind the hysteresis of the model.
    both
        Of any hysteresis before dynamics of any order.
    generous
        Of plays with dynamics of their own, of plays of the output, or of the best of the others.
    noise
        From one period of the drive to the next; NaN where it does not repeat.
    deviation
        Of the output from its mean.
    """

    model: float
    linear: float
    other_hysteresis: float
    other_dynamics: float
    both: float
    generous: float
    noise: float
    deviation: float

    @property
    def best(self) -> float:
        """The least of what anything but the model leaves."""
        return float(np.nanmin([self.linear, self.generous, self.noise]))

    @property
    def ratio(self) -> float:
        """What the model leaves over the best of the yardsticks: 1 where nothing is missing."""
        rounding = max(_EXACT * self.deviation, math.ulp(0.0))
        return max(self.model, rounding) / max(self.best, rounding)

    @property
    def missing(self) -> Missing:
        """What the model lacks, as far as these yardsticks tell it."""
        if self.ratio < TELLS:
            return "nothing"
        whole = self.model**2 - self.generous**2
        if whole < EXPLAINED * (self.model**2 - self.best**2):
            return "unknown"
        if self.model**2 - self.both**2 < NEARLY_ALL * whole:
            return "structure"
        simpler = min(self.other_dynamics, self.other_hysteresis)
        if self.model**2 - simpler**2 < NEARLY_ALL * whole:
            return "both"
        return "dynamics" if simpler == self.other_dynamics else "hysteresis"

    def beside_noise(self, rms: float) -> float:
        """Give the part of an rms that the best yardstick does not leave, over the deviation."""
        return math.sqrt(max(rms**2 - self.best**2, 0.0)) / max(self.deviation, math.ulp(0.0))

    def to_dict(self) -> dict[str, Any]:
        """Give all as plain numbers and text; None where the drive does not repeat."""
        return {
            "ratio": self.ratio,
            "missing": self.missing,
            "model": self.model,
            "linear": self.linear,
            "other_hysteresis": self.other_hysteresis,
            "other_dynamics": self.other_dynamics,
            "other_hysteresis_and_dynamics": self.both,
            "beyond_hammerstein": self.generous,
            "period_to_period": None if math.isnan(self.noise) else self.noise,
            "deviation": self.deviation,
        }


@dataclass(frozen=True, eq=False)
class Stretch:
    """A record as a yardstick takes it.

    Parameters
    ----------
    u
        Shape (n,), the input.
    y, modelled
        Shape (n,), measured, and the model's output.
    start
        First sample that counts.
    """

    u: Array
    y: Array
    modelled: Array
    start: int

    @property
    def error(self) -> Array:
        """What the model leaves of the samples that count."""
        return (self.y - self.modelled)[self.start :]

    @property
    def measured(self) -> Array:
        """Measured, of the samples that count."""
        return self.y[self.start :]

    def shortened(self, samples: int) -> Stretch:
        """Keep so many samples that count, and those that lead up to them."""
        first = max(self.start - LEAD, 0)
        kept = slice(first, self.start + samples)
        return Stretch(self.u[kept], self.y[kept], self.modelled[kept], self.start - first)


def yardstick_of(fit: Fit, data: Data) -> Yardstick:
    """Compare what a fit of hysteresis and dynamics leaves with what richer models leave.

    Parameters
    ----------
    fit
        The final fit.
    data
        Its records, in its units.
    """
    return yardstick(stretches_of(fit, data), dynamics_of(fit))


def stretches_of(fit: Fit, data: Data) -> list[Stretch]:
    """Give the records as a yardstick takes them, with the output of a fit of them.

    Parameters
    ----------
    fit
        The final fit.
    data
        Its records, in its units.
    """
    stretches = []
    passes = zip(data.records, data.windows(), data.brought_forward(), data.counted(), strict=True)
    most = max(MOST_PERIODIC // len(data.records), 1)
    for record, window, y, counts in passes:
        stop = min(window.stop, window.start + most)
        modelled = np.asarray(fit.operator(record.u[:stop]))
        y = np.array(y[:stop])
        if counts is not None:  # nothing is left of what is no measurement
            out = window.start + np.flatnonzero(~counts[: stop - window.start])
            y[out] = modelled[out]
        if stop - window.start > 1:
            stretches.append(Stretch(record.u[:stop], y, modelled, window.start))
    return stretches


def yardstick(stretches: Sequence[Stretch], dynamics: LinearDynamics) -> Yardstick:
    """Compare what a model leaves with what richer models leave.

    Parameters
    ----------
    stretches
        Of the records.
    dynamics
        Those of the model.
    """
    noise = _from_period_to_period(stretches)
    short = [each.shortened(max(MOST_SAMPLES // len(stretches), 1)) for each in stretches]
    error, y = [_without_drift(each.error) for each in short], [each.measured for each in short]
    blocks = [_columns(each, dynamics) for each in short]
    names = ("line", "behind line")
    of_line = LeftOutStretches.of([{name: each[name] for name in names} for each in blocks], y)
    of_error = LeftOutStretches.of(blocks, error)
    lines, behind = ([each[name][:, 0] for each in blocks] for name in ("line", "modelled"))
    model = _rms(error)
    front = min(math.sqrt(of_error.left(("modelled", "front"))[0]), model)
    own = ("modelled", "behind model")
    dynamic = min(_left(of_error, own, behind), model)
    both = min(_left(of_error, (*own, "front"), behind), front, dynamic)
    beyond = [("output",), ("own dynamics", "output")]
    generous = [_left(of_error, (*own, "front", *more), behind) for more in beyond]
    linear = _left(of_line, names, lines)
    deviation = _rms([each - each.mean() for each in y])
    return Yardstick(model, linear, front, dynamic, both, min(*generous, both), noise, deviation)


def _columns(stretch: Stretch, dynamics: LinearDynamics) -> dict[str, Array]:
    """Give the regressors of all yardsticks by name, over the samples that count."""
    u = stretch.u - stretch.u[0]
    modelled = stretch.modelled - stretch.modelled[0]
    front = columns_of_front(u, dynamics)
    line = np.ascontiguousarray(front[:, 0])
    columns = {
        "modelled": modelled[:, None],
        "behind model": columns_behind(dynamics, modelled),
        "front": front,
        "own dynamics": columns_of_own_dynamics(u, dynamics),
        "output": columns_of_output(modelled, dynamics),
        "line": line[:, None],
        "behind line": columns_behind(dynamics, line),
    }
    return {name: each[stretch.start :] for name, each in columns.items()}


def _left(regression: LeftOutStretches, groups: Sequence[str], inputs: Sequence[Array]) -> float:
    """Give the rms that columns, and then dynamics of any order behind the inputs, leave."""
    squared, rest = regression.left(groups)
    plain = sum(float(each @ each) for each in rest)
    if plain == 0.0:
        return 0.0
    parts = zip(rest, inputs, strict=True)
    local = sum(left_by_dynamics(each, [signal]) * each.size for each, signal in parts)
    return math.sqrt(squared * local / plain)


def _without_drift(error: Array) -> Array:
    """Take out what changes as slowly as the record is long: it follows time, not the drive."""
    time = np.linspace(-1.0, 1.0, error.size)
    shapes = np.linalg.qr(np.polynomial.legendre.legvander(time, _DRIFT))[0]
    return np.asarray(error - shapes @ (shapes.T @ error))


def _rms(parts: Sequence[Array]) -> float:
    squares = sum(float(each @ each) for each in parts)
    return math.sqrt(squares / sum(each.size for each in parts))


def _from_period_to_period(stretches: Sequence[Stretch]) -> float:
    """Give the rms of the noise that two periods of the drive do not share; NaN without two."""
    squares, count = 0.0, 0
    for each in stretches:
        period = repeats_after(each.u[each.start :])
        if not period:
            continue
        first = first_comparable(period)
        again = each.measured[first:] - earlier(each.measured, period)[0]
        if np.abs(again).max(initial=0.0) > _EXACT * float(each.measured.std()):
            before, kept = earlier(each.error, period)
            change = each.error[first:] - before
            change = change - change.mean()
            squares += float(change @ change) / (1.0 + kept)
            count += change.size
    return math.sqrt(squares / count) if count else math.nan
