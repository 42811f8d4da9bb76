"""What an identification gives back."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.diagnosis import Diagnosis
from hyst.errors import InputError
from hyst.identification.record_use.part_of_a_sample import (
    by_whole_samples,
    lag_in_samples,
    later,
)
from hyst.identification.record_use.used_samples import UsedSamples
from hyst.identification.result.bands import NEW, Bands, as_level
from hyst.identification.result.late_output import late_output
from hyst.identification.result.motion import OutputPart, motion_lines
from hyst.identification.result.part_of_file import PartOfFile
from hyst.identification.result.record_errors import (
    RecordErrors,
    record_line,
    run_at_several_rates,
)
from hyst.identification.result.what_is_kept import Kept
from hyst.models import Delay, Lag
from hyst.operators import ModelDescription, Operator, Verdict
from hyst.operators.composition import leaves_of
from hyst.operators.plain_data import as_number
from hyst.signals import Metrics, Record

Array = NDArray[np.float64]

LAG = "lag.time_constant"
"""Name of the parameter that is the time constant of a lag of the drive."""


@dataclass(frozen=True)
class Candidate:
    """One family and size that was compared.

    Parameters
    ----------
    family
        Its name in ``hyst.families``; empty for a model of no family, as of ``hyst.fit``.
    plays
        Number of plays.
    parameters
        Number of free parameters, the offset included.
    score
        Root mean square error on left-out blocks, in output units, each stretch with a free offset
        so that slow drift does not decide.
    standard_error
        Of the score, from its scatter over the blocks.
    chosen
        Whether this is the one the result holds.
    tied
        Whether the left-out blocks do not tell it from the best, by the standard error of the
        difference to it.
    """

    family: str
    plays: int
    parameters: int
    score: float
    standard_error: float
    chosen: bool
    tied: bool = False


@dataclass(frozen=True, eq=False, repr=False)
class Identified(Kept):
    """A model identified from records, and how far it can be trusted.

    Parameters
    ----------
    model
        The operator, without delay, so that it has an exact inverse.
    family
        Its name in ``hyst.families``; empty for a model of no family, as of ``hyst.fit``.
    delay
        Samples by which the measured output lags the model's output; parts of one count, and it is
        negative where the output is ahead of the input.
    parameter_names, parameter_values, standard_errors
        The free parameters with their standard errors, which take the autocorrelation of the
        residual into account; NaN where a value lies on a bound or is not determined.
    undetermined
        One sentence for each thing the records cannot determine, and what was done; and for what
        makes them doubtful, as a saturated sensor.
    metrics
        Errors by record: ``training``, ``training (free offset)``, ``validation 1``, ...
    candidates
        All families and sizes compared; empty if there was nothing to choose.
    status
        ``converged`` or how else it ended.
    iterations
        Of the final fit.
    used
        Samples of each training record that took part.
    description
        Names, units and ranges, for the model file.
    verdict
        How far the model can be trusted, and why.
    delay_interval
        Lowest and highest delay that the records do not exclude, samples; both the delay itself
        where it was given.
    diagnosis
        What the records showed before any model.
    bands
        What ``band`` is made of.
    per_record
        Errors over each of the records it was identified from, in their order.
    motion
        What moves the output, part by part: hysteresis, creep, drift and what is left; empty where
        neither creep nor drift came up.
    part
        Of a record that stays in its file: the samples from which all but the constants was found;
        None where all samples were in memory.
    records
        What it was identified from, or the part of it in memory; see ``kept_records``.
    """

    model: Operator
    family: str
    delay: float
    parameter_names: tuple[str, ...]
    parameter_values: Array
    standard_errors: Array
    undetermined: tuple[str, ...]
    metrics: dict[str, Metrics]
    candidates: tuple[Candidate, ...]
    status: str
    iterations: int
    used: tuple[UsedSamples, ...]
    description: ModelDescription
    verdict: Verdict
    delay_interval: tuple[float, float]
    diagnosis: Diagnosis
    bands: Bands = field(repr=False)
    per_record: tuple[RecordErrors, ...]
    motion: tuple[OutputPart, ...]
    part: PartOfFile | None = field(default=None, kw_only=True)
    records: tuple[Record, ...] = field(default=(), kw_only=True, repr=False)

    @property
    def used_of_shown(self) -> tuple[UsedSamples, ...]:
        """Which samples took part, of the records or the part of one that figures can show."""
        return self.used if self.part is None else (self.part.used,)

    def delay_in_words(self) -> str:
        """Give the delay beside the model, with its interval."""
        low, high = self.delay_interval
        open_to = "" if low == high else f" ({low:.3g} to {high:.3g})"
        return f"delay {self.delay:.4g}{open_to} samples"

    def __repr__(self) -> str:
        what = self.family or self.model.kind
        training = self.metrics.get("training")
        missed = "" if training is None else f", {training.rms_percent:.3g} % of range"
        return (
            f"{type(self).__name__}({self.verdict.level}: {self.verdict.sentences[0]!r}; "
            f"{what}{missed}, {self.delay_in_words()}, {self.status})"
        )

    @property
    def lag(self) -> float | None:
        """Time constant of the first-order lag of the drive in the model, s; None without one."""
        lags = [each for each in leaves_of(self.model) if isinstance(each, Lag)]
        return lags[0].time_constant if lags else None

    @property
    def lag_interval(self) -> tuple[float, float] | None:
        """Two standard errors either side of ``lag``, s; both the lag itself where it was given."""
        if self.lag is None or LAG not in self.parameter_names:
            return None if self.lag is None else (self.lag, self.lag)
        error = 2.0 * float(self.standard_errors[self.parameter_names.index(LAG)])
        return None if math.isnan(error) else (max(self.lag - error, 0.0), self.lag + error)

    def with_delay(self) -> Operator:
        """Give the model with its delay as a stage of its drive.

        An inverse that answers late undoes it: ``with_delay().inverse(preview=N)``. The part of a
        sample is taken from the line between two samples.

        Returns
        -------
        Operator
            The model itself where the delay is 0. Its description has no delay beside it any more.

        Raises
        ------
        InputError
            If the delay is negative: no stage answers before its input.

        Examples
        --------
        >>> import numpy as np, hyst
        >>> u = np.sin(np.linspace(0.0, 20.0, 2000)) * np.linspace(1.0, 0.5, 2000)
        >>> y = hyst.PrandtlIshlinskii(p=[0.5], r=[0.2], p0=1.0)(u)
        >>> found = hyst.identify(hyst.Record(u, y, dt=1e-3), family="pi", plays=1, delay=2)
        >>> found.with_delay().inverse(preview=3)(u).shape
        (2000,)
        """
        if self.delay == 0:
            return self.model
        if self.delay < 0:
            raise InputError(
                f"the output is {-self.delay:.4g} samples ahead of the input, which no stage is; "
                "align the channels and identify again"
            )
        about = replace(self.model.description, delay=0, delay_interval=None)
        late = self.model @ Delay(float(self.delay), self.description.dt)
        return late.with_description(about)

    def predict(self, u: ArrayLike, dt: float | None = None) -> Array:
        """Give the output as it would be measured: the model's output, delayed.

        Parameters
        ----------
        u
            Shape (N,), input units.
        dt
            Sample time of ``u``, s; that of the (first) record it was identified from if left out.

        Returns
        -------
        numpy.ndarray
            Shape (N,). The first ``delay`` samples repeat the first output; where the output is
            ahead of the input, the last ones repeat the last.

        Raises
        ------
        InputError
            If the drive is no finite vector.
        """
        return late_output(self._model_at(dt), u, self._delay_at(dt))

    def band(
        self, u: ArrayLike, level: float = 0.95, dt: float | None = None
    ) -> tuple[Array, Array]:
        """Give between which outputs most samples will be measured, slow drift left aside.

        The band holds the noise of the records, what the model leaves beside it, how sure its
        constants are, how far rival models go apart that fit the records equally well, and, where
        the drive leads the memory to states that no record contained, how much more may be wrong
        there (``is_new``).

        Parameters
        ----------
        u
            Drive, shape (N,), input units, from the state of rest.
        level
            Share of the samples to hold, above 0 and below 1.
        dt
            Sample time of ``u``, as for ``predict``.

        Returns
        -------
        low, high : numpy.ndarray
            Shape (N,), output units.

        Raises
        ------
        InputError
            If the drive is no finite vector, or the level is not between 0 and 1.
        """
        share, given = as_level(level), self._input(u, dt)
        y = self._model_at(dt)(given)
        half = self.bands.half_width(given, y, share)
        late = math.floor(self._delay_at(dt))
        return by_whole_samples(y - half, late), by_whole_samples(y + half, late)

    def is_new(self, u: ArrayLike) -> NDArray[np.bool_]:
        """Tell where a drive leads the memory to states that no record contained.

        Parameters
        ----------
        u
            Drive, shape (N,), input units, from the state of rest.

        Returns
        -------
        numpy.ndarray
            Shape (N,): where the output is extrapolated.

        Raises
        ------
        InputError
            If the drive is no finite vector.
        """
        new = self.bands.distances(self._input(u, None)) > NEW
        return by_whole_samples(new, math.floor(self.delay))

    def _lag_line(self) -> list[str]:
        if self.lag is None:
            return []
        low, high = self.lag_interval or (math.nan, math.nan)
        how = f" ({low:.3g} to {high:.3g})" if low < high else " (held)" if low == high else ""
        return [f"first-order lag of the drive, a stage of the model: {self.lag:.4g}{how} s"]

    def _input(self, u: ArrayLike, dt: float | None) -> Array:
        """Give an input later by the part of a sample that the delay has beyond whole ones."""
        delay = self._delay_at(dt)
        keeps = bool(self.model.traits().rate_independent)
        return later(finite_vector(u, "u"), delay - math.floor(delay), keeps)

    def _delay_at(self, dt: float | None) -> float:
        own = self.description.dt
        return self.delay if dt is None or own is None else lag_in_samples(self.delay, own, dt)

    def _model_at(self, dt: float | None) -> Operator:
        return self.model if dt is None else self.model.at_sample_time(dt)

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as plain numbers and text, for metrics.json.

        Returns
        -------
        dict
            The verdict first; NaN standard errors are given as None.
        """
        errors = [None if np.isnan(each) else float(each) for each in self.standard_errors]
        return {
            "verdict": self.verdict.to_dict(),
            "family": self.family,
            "status": self.status,
            "iterations": self.iterations,
            "delay": as_number("delay", self.delay),
            "delay_interval": [as_number("delay_interval", each) for each in self.delay_interval],
            "lag": self.lag,
            "lag_interval": None if self.lag_interval is None else list(self.lag_interval),
            "metrics": {name: each.to_dict() for name, each in self.metrics.items()},
            "per_record": [each.to_dict() for each in self.per_record],
            **({"motion": [each.to_dict() for each in self.motion]} if self.motion else {}),
            "parameters": [
                {"name": name, "value": float(value), "standard_error": error}
                for name, value, error in zip(
                    self.parameter_names, self.parameter_values, errors, strict=True
                )
            ],
            **({} if (driver := self.description.driver) is None else {"driver": driver.to_dict()}),
            "undetermined": list(self.undetermined),
            "candidates": [vars(each) for each in self.candidates],
            "used_samples": [vars(each) for each in self.used],
            **({} if self.part is None else {"part": [self.part.start, self.part.stop]}),
            **self.diagnosis.to_dict(),
        }

    def summary(self) -> str:
        """Give a table of a page or less for people, the verdict first.

        Returns
        -------
        str
        """
        unit = f" {self.description.output_unit}" if self.description.output_unit else ""
        what = f"family {self.family}" if self.family else self.model.kind
        lines = [self.verdict.told()]
        lines += [f"{what}, {self.delay_in_words()}, {self.status}"]
        lines += [*self._lag_line(), ""]
        for name, each in self.metrics.items():
            lines.append(
                f"{name:28s} rms {each.rms:.4g}{unit} ({each.rms_percent:.3f} % of range)   "
                f"max {each.max_abs:.4g}{unit}   fit {each.nrmse_fit_percent:.2f} %"
            )
        if len(self.per_record) > 1:
            several = run_at_several_rates(self.per_record)
            lines += [record_line(each, unit, several) for each in self.per_record]
        if self.motion:
            lines += ["", *motion_lines(self.motion, unit)]
        lines += ["", f"{'parameter':36s} {'value':>13s} {'standard error':>15s}"]
        for name, value, error in zip(
            self.parameter_names, self.parameter_values, self.standard_errors, strict=True
        ):
            shown = "-" if np.isnan(error) else f"{error:.3g}"
            lines.append(f"{name:36s} {value:13.6g} {shown:>15s}")
        if np.isnan(self.standard_errors).any():
            lines.append("(-: on a bound, or not determined by the records)")
        lines += [f"note: {sentence}" for sentence in self.undetermined]
        return "\n".join(lines)
