"""What an identification gives back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.diagnosis import Diagnosis
from hyst.identification.record_use.used_samples import UsedSamples
from hyst.operators import ModelDescription, Operator, Verdict
from hyst.signals import Metrics

Array = NDArray[np.float64]


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


@dataclass(frozen=True, eq=False)
class Identified:
    """A model identified from records, and how far it can be trusted.

    Parameters
    ----------
    model
        The operator, without delay, so that it has an exact inverse.
    family
        Its name in ``hyst.families``; empty for a model of no family, as of ``hyst.fit``.
    delay
        Whole samples by which the measured output lags the model's output.
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
    """

    model: Operator
    family: str
    delay: int
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

    def predict(self, u: ArrayLike) -> Array:
        """Give the output as it would be measured: the model's output, delayed.

        Parameters
        ----------
        u
            Shape (N,), input units.

        Returns
        -------
        numpy.ndarray
            Shape (N,). The first ``delay`` samples repeat the first output.
        """
        y = self.model(u)
        if self.delay == 0:
            return y
        return np.concatenate([np.full(min(self.delay, y.size), y[0]), y])[: y.size]

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as plain numbers and text, for metrics.json.

        Returns
        -------
        dict
            NaN standard errors are given as None.
        """
        errors = [None if np.isnan(each) else float(each) for each in self.standard_errors]
        return {
            "family": self.family,
            "status": self.status,
            "iterations": self.iterations,
            "delay": self.delay,
            "metrics": {name: each.to_dict() for name, each in self.metrics.items()},
            "parameters": [
                {"name": name, "value": float(value), "standard_error": error}
                for name, value, error in zip(
                    self.parameter_names, self.parameter_values, errors, strict=True
                )
            ],
            "undetermined": list(self.undetermined),
            "candidates": [vars(each) for each in self.candidates],
            "used_samples": [vars(each) for each in self.used],
        }

    def summary(self) -> str:
        """Give a table of a page or less for people.

        Returns
        -------
        str
        """
        unit = f" {self.description.output_unit}" if self.description.output_unit else ""
        what = f"family {self.family}" if self.family else self.model.kind
        lines = [f"{what}, delay {self.delay} samples, {self.status}", ""]
        for name, each in self.metrics.items():
            lines.append(
                f"{name:28s} rms {each.rms:.4g}{unit} ({each.rms_percent:.3f} % of range)   "
                f"max {each.max_abs:.4g}{unit}   fit {each.nrmse_fit_percent:.2f} %"
            )
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
