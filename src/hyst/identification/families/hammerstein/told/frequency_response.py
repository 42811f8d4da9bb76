"""Frequency response of identified dynamics, and between which values it lies."""

from __future__ import annotations

import io
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.result.bands import as_level
from hyst.models.python_control import frequency_response_data_of

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@final
@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """Frequency response of G with its band, as ``found.frequency_response()`` gives it.

    Errors are linearised in the logarithm ``ln G = ln |G| + j arg G``, from the covariance of the
    fit of hysteresis and dynamics together. They count noise, not what a model of too low an order
    leaves out, and take whole samples of delay as known. G is 1 at rest by its definition, which no
    noise moves.

    Parameters
    ----------
    frequency
        Shape (p,), Hz.
    response
        Shape (p,), complex, the delay included.
    gain_error
        Shape (p,), standard error of the gain as a share of it; infinity where the records do not
        determine it.
    phase_error
        Shape (p,), standard error of the phase, degrees.
    excited
        Shape (p,): whether the drive had power within an octave; elsewhere the response is an
        extrapolation by the model. Of dynamics that were given it is nowhere.
    dt
        Sample time, s.
    """

    frequency: Array
    response: Complex
    gain_error: Array
    phase_error: Array
    excited: NDArray[np.bool_]
    dt: float

    @property
    def gain(self) -> Array:
        """Gain, 1 at rest."""
        return np.abs(self.response)

    @property
    def phase(self) -> Array:
        """Phase, degrees, without jumps of whole turns from one frequency to the next."""
        return np.degrees(np.unwrap(np.angle(self.response)))

    def gain_band(self, level: float = 0.95) -> tuple[Array, Array]:
        """Give between which gains G lies.

        Parameters
        ----------
        level
            Share of such bands that hold the value at a frequency, above 0 and below 1.

        Returns
        -------
        low, high : numpy.ndarray
            Shape (p,).

        Raises
        ------
        InputError
            If the level is not between 0 and 1.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            factor = np.exp(_deviations(level) * self.gain_error)
            return self.gain / factor, self.gain * factor

    def phase_band(self, level: float = 0.95) -> tuple[Array, Array]:
        """Give between which phases G lies, degrees, as ``gain_band``."""
        half = _deviations(level) * self.phase_error
        return self.phase - half, self.phase + half

    def to_frd(self) -> Any:
        """Give a ``control.FrequencyResponseData`` of the sampled G; the band is not in it.

        Raises
        ------
        MissingExtraError
            If python-control is not installed.

        Examples
        --------
        ::

            plant = found.frequency_response().to_frd()
        """
        return frequency_response_data_of(self.response, self.frequency, self.dt)

    def to_csv(self, level: float = 0.95) -> str:
        """Give a table with a header: frequency, gain and phase with their bands, excited (1 or 0).

        Parameters
        ----------
        level
            Of the bands.
        """
        columns = (
            self.frequency,
            self.gain,
            *self.gain_band(level),
            self.phase,
            *self.phase_band(level),
            self.excited.astype(np.float64),
        )
        names = (
            "frequency [Hz],gain,gain low,gain high,phase [deg],phase low [deg],phase high [deg]"
        )
        text = io.StringIO()
        np.savetxt(text, np.column_stack(columns), "%.10g", ",", header=f"{names},excited")
        return text.getvalue().removeprefix("# ")


def _deviations(level: float) -> float:
    """Give the standard deviations on either side that hold a share of a normal distribution."""
    return NormalDist().inv_cdf(0.5 + 0.5 * as_level(level))
