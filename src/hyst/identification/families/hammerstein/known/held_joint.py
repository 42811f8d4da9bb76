"""Free parameters of the hysteresis alone, before dynamics that are known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Start
from hyst.identification.families.hammerstein.joint import JointParametrization
from hyst.models import LinearDynamics

Array = NDArray[np.float64]


def joint_held(front: Start, dynamics: LinearDynamics) -> Start:
    """Give the free parameters of a hysteresis before dynamics that are held.

    Parameters
    ----------
    front
        Of the hysteresis.
    dynamics
        Known, of gain 1 at rest.

    Returns
    -------
    JointParametrization
    theta : numpy.ndarray
    """
    own, theta = front
    constants = dynamics.parameters().values
    parametrization = JointParametrization(
        template=dynamics @ own.template,
        transform=np.concatenate([own.transform, np.zeros((constants.size, own.size))]),
        fixed=np.concatenate([own.fixed, constants]),
        lower=own.lower,
        upper=own.upper,
        canonical=own.canonical,
        gauges=own.gauges,
        gauge_count=own.gauge_count,
        is_allowed=own.is_allowed,
        prior=own.prior,
        is_linear=own.is_linear,
        front=own,
        base=dynamics,
        feedthrough=dynamics.D != 0.0,
        held=True,
    )
    return parametrization, theta
