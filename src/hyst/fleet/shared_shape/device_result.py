"""What is known of one device from its record and its fleet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.special
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.fleet.shared_shape.free_constants import FreeConstants
from hyst.fleet.shared_shape.signals_used import drive_of
from hyst.identification import UsedSamples, late_output
from hyst.identification.result.bands import as_level
from hyst.operators import ModelDescription, Operator, Verdict
from hyst.signals import Metrics

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class SharedIdentified:
    """A device's model from a short record and the shape of its fleet.

    Parameters
    ----------
    model
        The operator, without delay.
    family
        Name of the shape's family in ``hyst.families``; empty if it has none.
    delay
        Samples by which the measured output lags the model's, as given for the fleet.
    parameter_names, parameter_values, standard_errors
        The constants that may differ from device to device, with the standard deviations of what is
        known of them after record and fleet; one that all devices share has that of the fleet.
    distance
        From the middle of the population, where 1 is the distance of its middle device; NaN where
        there is no population.
    probability
        That a device of the population lies as far or farther.
    predicted_error
        Rms error of the model's output to the truth that is to be expected over the record, output
        units.
    noise
        Rms of what the device's own best constants leave, output units.
    told_by_record
        How many constants the record itself tells; the rest is the fleet's.
    metrics
        Errors by record: ``training``, ``training (free offset)``.
    status
        ``converged`` or ``iteration limit``.
    iterations
        How often it was linearised.
    used
        Samples that took part.
    description
        Names, units, ranges and verdict, for the model file.
    verdict
        How far the model can be trusted, and why.
    undetermined
        Sentences; empty.
    """

    model: Operator
    family: str
    delay: float
    parameter_names: tuple[str, ...]
    parameter_values: Array
    standard_errors: Array
    distance: float
    probability: float
    predicted_error: float
    noise: float
    told_by_record: float
    metrics: dict[str, Metrics]
    status: str
    iterations: int
    used: tuple[UsedSamples, ...]
    description: ModelDescription
    verdict: Verdict
    undetermined: tuple[str, ...]
    spread: Spread = field(repr=False)

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({self.verdict.level}: {self.verdict.sentences[0]!r}; "
            f"{self.family or self.model.kind})"
        )

    def predict(self, u: ArrayLike) -> Array:
        """Give the output as it would be measured: the model's output, delayed.

        Parameters
        ----------
        u
            Shape (N,), input units.

        Returns
        -------
        numpy.ndarray
            Shape (N,).

        Raises
        ------
        InputError
            If the drive is no finite vector.
        """
        return late_output(self.model, u, self.delay)

    def band(self, u: ArrayLike, level: float = 0.95) -> tuple[Array, Array]:
        """Give between which outputs the device's true output lies, as far as the shape is right.

            y +- t sqrt(J C J' + what the shape lacks)

        Parameters
        ----------
        u
            Drive, shape (N,), input units, from the state of rest.
        level
            Probability, above 0 and below 1.

        Returns
        -------
        low, high : numpy.ndarray
            Shape (N,), output units, without the delay.

        Raises
        ------
        InputError
            If the drive is no finite vector, or the level is not between 0 and 1.
        """
        return self.spread.band(finite_vector(u, "u"), level)

    def to_dict(self) -> dict[str, Any]:
        """Give everything but the model as plain numbers and text, for metrics.json.

        Returns
        -------
        dict
            The verdict first; numbers that do not exist are given as None.
        """
        pairs = zip(self.parameter_names, self.parameter_values, self.standard_errors, strict=True)
        return {
            "verdict": self.verdict.to_dict(),
            "family": self.family,
            "status": self.status,
            "iterations": self.iterations,
            "delay": self.delay,
            "distance": _or_none(self.distance),
            "probability": _or_none(self.probability),
            "predicted_error": self.predicted_error,
            "noise": self.noise,
            "told_by_record": self.told_by_record,
            "metrics": {name: each.to_dict() for name, each in self.metrics.items()},
            "parameters": [
                {"name": name, "value": float(value), "standard_error": float(error)}
                for name, value, error in pairs
            ],
            "undetermined": list(self.undetermined),
            "used_samples": [vars(each) for each in self.used],
        }

    def summary(self) -> str:
        """Give a table of a page or less for people, the verdict first.

        Returns
        -------
        str
        """
        unit = f" {self.description.output_unit}" if self.description.output_unit else ""
        lines = [self.verdict.told()]
        lines += [f"{self.family or self.model.kind}, delay {self.delay:.4g} samples, by the fleet"]
        if not np.isnan(self.distance):
            lines += [
                f"distance from the fleet {self.distance:.3g} times that of its middle device, "
                f"probability {self.probability:.2g}"
            ]
        lines += [
            f"error to be expected {self.predicted_error:.3g}{unit} rms; the record tells "
            f"{self.told_by_record:.1f} of {len(self.parameter_names)} constants, the fleet the "
            "rest",
            "",
        ]
        lines += [
            f"{name:28s} rms {each.rms:.4g}{unit} ({each.rms_percent:.3f} % of range)   "
            f"max {each.max_abs:.4g}{unit}"
            for name, each in self.metrics.items()
        ]
        lines += ["", f"{'parameter':36s} {'value':>13s} {'standard error':>15s}"]
        pairs = zip(self.parameter_names, self.parameter_values, self.standard_errors, strict=True)
        lines += [f"{name:36s} {value:13.6g} {error:15.3g}" for name, value, error in pairs]
        return "\n".join(lines)


@dataclass(frozen=True, eq=False)
class Spread:
    """What is known of a device: a normal distribution of its constants.

    Parameters
    ----------
    constants, z, covariance
        The fleet's mean, and where the device lies, shapes (q,) and (q, q).
    freedom
        Samples its noise was estimated from.
    lacking
        Variance of what the shape lacks, squared output units.
    dt
        Sample time, s.
    """

    constants: FreeConstants
    z: Array
    covariance: Array
    freedom: float
    lacking: float
    dt: float

    def standard_errors(self) -> Array:
        """Give those of all constants of the model."""
        basis = self.constants.basis
        variance = np.einsum("ij,jk,ik->i", basis, self.covariance, basis)
        return np.asarray(np.sqrt(np.maximum(variance, 0.0)))

    def of_output(self, jacobian: Array) -> Array:
        """Give the standard deviation of the output.

        Parameters
        ----------
        jacobian
            Shape (N, q), its derivative by z.
        """
        variance = np.einsum("ij,ij->i", jacobian @ self.covariance, jacobian)
        return np.asarray(np.sqrt(np.maximum(variance, 0.0) + self.lacking))

    def band(self, u: Array, level: float) -> tuple[Array, Array]:
        """Give the band of ``SharedIdentified.band``.

        Parameters
        ----------
        u, level
            As there.
        """
        share = as_level(level)
        modelled, jacobian = self.constants.linearized(drive_of(u, self.dt), self.z)
        times = float(scipy.special.stdtrit(self.freedom, 0.5 + share / 2.0))
        half = times * self.of_output(jacobian)
        return modelled - half, modelled + half


def _or_none(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
