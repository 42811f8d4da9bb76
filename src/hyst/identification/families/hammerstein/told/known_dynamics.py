"""All that a fit tells of its linear dynamics: poles, zeros, frequency response, with errors."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector
from hyst.errors import InputError
from hyst.identification.families.family import Fit
from hyst.identification.families.hammerstein.joint import joint_of
from hyst.identification.families.hammerstein.told.drive_band import DriveBand, drive_band
from hyst.identification.families.hammerstein.told.dynamics_by_theta import DynamicsByTheta
from hyst.identification.families.hammerstein.told.found_root import FoundRoot, roots_found
from hyst.identification.families.hammerstein.told.frequency_response import FrequencyResponse
from hyst.identification.record_use.used_samples import Data
from hyst.identification.result.fit_spread import FitSpread
from hyst.models import LinearDynamics

Array = NDArray[np.float64]

_POINTS = 400
_AROUND = np.linspace(-4.0, 4.0, 41)  # half-widths about a resonance


@dataclass(frozen=True, eq=False)
class KnownDynamics:
    """What a fit tells of G.

    Parameters
    ----------
    by_theta
        G with its derivatives.
    spread
        How sure the free parameters are.
    band
        Where the drive had power.
    poles, zeros
        By rising frequency, a complex pair as one.
    """

    by_theta: DynamicsByTheta = field(repr=False)
    spread: FitSpread = field(repr=False)
    band: DriveBand = field(repr=False)
    poles: tuple[FoundRoot, ...]
    zeros: tuple[FoundRoot, ...]

    @property
    def dynamics(self) -> LinearDynamics:
        """G."""
        return self.by_theta.dynamics

    @property
    def is_held(self) -> bool:
        """Whether G was known before the fit, which did not move it."""
        return self.by_theta.is_held

    def frequencies(self) -> Array:
        """Give frequencies to look at G, Hz: from below the drive's to half the sample rate."""
        nyquist = 0.5 / self.dynamics.dt
        bands = self.band.bands()
        low = min(bands[0][0] if bands else 1e-3 * nyquist, 0.1 * nyquist)
        grid = [np.geomspace(low, nyquist, _POINTS)]
        for each in (*self.poles, *self.zeros):
            if each.is_pair and abs(each.damping) < 0.3:
                grid.append(each.frequency * (1.0 + abs(each.damping) * _AROUND))
        frequency = np.unique(np.concatenate(grid))
        return frequency[(frequency >= low) & (frequency <= nyquist)]

    def frequency_response(self, frequencies: ArrayLike | None = None) -> FrequencyResponse:
        """Give the frequency response of G with its standard errors.

        Parameters
        ----------
        frequencies
            Shape (p,), Hz, from 0 to half the sample rate; None: ``frequencies()``.

        Returns
        -------
        FrequencyResponse

        Raises
        ------
        InputError
            If one of them is no such number.
        """
        frequency = self.frequencies() if frequencies is None else self._checked(frequencies)
        response, by_theta = self.by_theta.response(frequency)
        size = np.abs(response)
        with np.errstate(all="ignore"):
            by_logarithm = by_theta / response[:, None]
        errors = self._errors(np.concatenate([by_logarithm.real, by_logarithm.imag]))
        gain_error, phase_error = np.split(errors, 2)
        gain_error[size == 0.0] = np.inf
        return FrequencyResponse(
            frequency,
            response,
            gain_error,
            np.degrees(phase_error),
            self.band.excites(frequency) | self.is_held,
            self.dynamics.dt,
        )

    def _errors(self, rows: Array) -> Array:
        """Give standard errors: 0 of what nothing moves, infinity where there is none."""
        finite = np.isfinite(rows).all(axis=1)
        errors = np.where(finite, 0.0, np.inf)
        moves = finite & rows.any(axis=1)
        errors[moves] = np.nan_to_num(self.spread.of(rows[moves]), nan=np.inf)
        return errors

    def _checked(self, frequencies: ArrayLike) -> Array:
        frequency = finite_vector(np.atleast_1d(frequencies), "frequencies")
        nyquist = 0.5 / self.dynamics.dt
        wrong = frequency[(frequency < 0.0) | (frequency > nyquist * (1.0 + 1e-12))]
        if wrong.size:
            raise InputError(
                f"frequencies holds {wrong[0]:.6g} Hz; give some from 0 to half the sample rate, "
                f"{nyquist:.6g} Hz"
            )
        return frequency


def known_dynamics(fit: Fit, data: Data, spread: FitSpread) -> KnownDynamics:
    """Find out what a fit tells of its linear dynamics.

    Parameters
    ----------
    fit
        The final fit of hysteresis and dynamics, in units of the records.
    data
        The records.
    spread
        How sure its free parameters are.

    Returns
    -------
    KnownDynamics
    """
    theta, parametrization = fit.solution.theta, joint_of(fit)
    by_theta = DynamicsByTheta.of(parametrization, theta)
    G, hysteresis = by_theta.dynamics, parametrization.hysteresis(theta)
    u = max((each.u for each in data.records), key=np.ptp)
    gain = float(np.std(hysteresis(u)) / (np.std(u) or 1.0))
    band = drive_band(data.records, G, gain, spread.noise_rms)
    poles = roots_found("pole", *by_theta.poles(), G.dt, spread, band)
    zeros = roots_found("zero", *by_theta.zeros(), G.dt, spread, band)
    return KnownDynamics(by_theta, spread, band, poles, zeros)
