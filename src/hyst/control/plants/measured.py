"""A plant fitted to a measured frequency response."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from hyst.checks.numbers import as_number, as_sample_time
from hyst.control.linear_system import LinearSystem
from hyst.control.loop_system import plant_of
from hyst.control.other_systems import is_frequency_response
from hyst.control.uncertainty.responses import values_of_response
from hyst.errors import InputError
from hyst.models import LinearDynamics
from hyst.signals import MeasuredResponse


@final
@dataclass(frozen=True, eq=False)
class MeasuredPlant:
    """A sampled plant that describes a measured frequency response.

    Parameters
    ----------
    dynamics
        With their whole delay, of the gain asked for.
    measured_gain
        Their gain at rest as it was measured, or continued from the lowest frequency.
    error
        Rms of what they leave of the response, over its own rms.
    """

    dynamics: LinearDynamics
    measured_gain: float
    error: float

    @property
    def system(self) -> LinearSystem:
        """The same, the delay among its states: what a design takes."""
        return plant_of(self.dynamics)

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self.dynamics.dt


def measured_plant(response: Any, dt: float, gain: float | None = None) -> MeasuredPlant:
    """Fit a sampled plant to a measured frequency response, of the least order that pays.

    Parameters
    ----------
    response
        ``hyst.read_frequency_response(...)``, a MeasuredResponse, or frequency response data of
        python-control, with one input and one output.
    dt
        Sample time of the block, s, > 0: the response is that of the plant with the hold, up to
        half the sample rate.
    gain
        What the plant's gain at rest is set to. Left out it is as measured. Behind a hysteresis in
        units of the output it is 1, for a response that is measured from the drive has the slope
        of the hysteresis in it.

    Returns
    -------
    MeasuredPlant
        How far the true plants may be off is for ``uncertainty_weight`` with this response and
        others.

    Raises
    ------
    InputError
        If the response or the gain cannot be used.
    NotIdentifiableError
        If too few points lie below half the sample rate, or no order up to 12 describes them.

    Examples
    --------
    >>> from hyst.models import LinearDynamics
    >>> stage = LinearDynamics.from_continuous([4e5], [1.0, 60.0, 4e5], 1e-3, delay=2)
    >>> f = np.geomspace(2.0, 450.0, 80)
    >>> found = measured_plant(MeasuredResponse(f, 3.0 * stage.frequency_response(f)), 1e-3, 1.0)
    >>> found.dynamics.order, round(found.measured_gain, 6), found.error < 1e-6
    (2, 3.0, True)
    """
    time = as_sample_time(dt)
    if not is_frequency_response(response):
        raise InputError(
            f"the response is {type(response).__name__}; give a MeasuredResponse or frequency "
            "response data of python-control"
        )
    # Identification loads much that no controller needs.
    from hyst.identification.families.hammerstein.known.response_fit import fitted_response

    w, values = values_of_response(response, "the response")
    fitted = fitted_response(MeasuredResponse(w / (2.0 * np.pi), values), time)
    at_rest = float(np.real(fitted.dynamics.frequency_response(np.zeros(1))[0]))
    if gain is None:
        return MeasuredPlant(fitted.dynamics, at_rest, fitted.error)
    wanted = as_number(gain, "gain")
    if at_rest == 0.0 or wanted == 0.0:
        raise InputError(
            f"the plant has a gain of {at_rest:g} at rest and is to have {wanted:g}; leave gain out"
        )
    d, share = fitted.dynamics, wanted / at_rest
    scaled = LinearDynamics(d.A, d.B, share * d.C, share * d.D, d.dt, d.delay)
    return MeasuredPlant(scaled, at_rest, fitted.error)
