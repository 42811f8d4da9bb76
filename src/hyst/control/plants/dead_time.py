"""A plant and its dead time, however it is written."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hyst.checks.numbers import as_not_negative
from hyst.control.linear_system import LinearSystem, as_linear_system
from hyst.errors import InputError
from hyst.models import ContinuousDynamics, LinearDynamics

_A_SAMPLE = 1e-6  # as a share: nearer to a whole number of samples than this is one


def plant_and_delay(
    plant: Any, delay: float = 0.0, name: str = "the plant"
) -> tuple[LinearSystem, float]:
    """Read a plant and its dead time: of a sampled one it becomes states, of a continuous one not.

    Parameters
    ----------
    plant
        As ``as_linear_system`` takes it, or a ``ContinuousDynamics`` with dead time.
    delay
        Further dead time, s, >= 0.
    name
        What messages call it.

    Returns
    -------
    system : LinearSystem
        Sampled with all its delay, or continuous without it.
    delay : float
        Dead time of a continuous plant, s; 0 of a sampled one.

    Raises
    ------
    InputError
        If it cannot be read, the delay is below 0, or that of a sampled plant no whole number of
        samples.

    Examples
    --------
    >>> import hyst
    >>> lag = hyst.LinearDynamics.from_continuous([100.0], [1.0, 100.0], dt=0.01, delay=2)
    >>> plant_and_delay(lag)[0].order, plant_and_delay(lag.to_continuous())[1]
    (3, 0.02)
    """
    further = as_not_negative(delay, f"delay of {name}", "a dead time in seconds")
    if isinstance(plant, ContinuousDynamics):
        rational = replace(plant, delay=0.0)
        return as_linear_system(rational, name), plant.delay + further
    system = as_linear_system(plant, name)
    if system.dt == 0.0 or further == 0.0:
        return system, further
    samples = further / system.dt
    if abs(samples - round(samples)) > _A_SAMPLE:
        raise InputError(
            f"the delay of {name} is {further:.6g} s, {samples:.4g} samples of its dt; give a "
            "whole number of samples, or the continuous plant"
        )
    A, B, C, D = system.A, system.B, system.C, system.D
    return as_linear_system(LinearDynamics(A, B, C, D, system.dt, round(samples)), name), 0.0
