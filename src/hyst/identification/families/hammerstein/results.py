"""Parameters of a Hammerstein identification with their standard errors, as a table."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.hammerstein.joint import Joint
from hyst.identification.families.hammerstein.uncertainty import (
    Uncertainty,
    coefficients,
    spread_of,
)

Array = NDArray[np.float64]


def parameter_table(
    joint: Joint, theta: Array, sure: Uncertainty
) -> tuple[tuple[str, ...], Array, Array, tuple[str, ...]]:
    """Give names, values and standard errors, and sentences on what is not determined.

    They belong to the theta of a joint refinement, and to how sure it is. The dynamics are told by
    the coefficients of ``sum b_i q^-i / (1 + sum a_i q^-i)``.
    """
    parametrization, size = joint.front.parametrization, joint.front_size
    operator = joint.hysteresis(theta)
    constants = operator.parameters()
    free = parametrization.transform.any(axis=1)
    variance = np.einsum(
        "ij,jk,ik->i",
        parametrization.transform,
        sure.covariance[:size, :size],
        parametrization.transform,
    )
    errors = np.sqrt(np.maximum(variance, 0.0))
    errors[parametrization.transform[:, ~sure.known[:size]].any(axis=1)] = np.nan
    dynamics = joint.dynamics(theta)
    n = dynamics.order
    names = [str(name) for name in np.array(constants.names)[free]]
    names += [f"dynamics.a[{i}]" for i in range(1, n + 1)]
    names += [f"dynamics.b[{i}]" for i in range(n + 1)]
    dynamic_errors = spread_of(joint, theta, sure.covariance, coefficients)
    if not joint.feedthrough:
        dynamic_errors[n] = np.nan
    return (
        tuple(names),
        np.concatenate([constants.values[free], coefficients(dynamics)]),
        np.concatenate([errors[free], dynamic_errors]),
        _not_known(joint, theta, sure),
    )


def _not_known(joint: Joint, theta: Array, sure: Uncertainty) -> tuple[str, ...]:
    lower, upper = joint.bounds()
    bound = (theta <= lower) | (theta >= upper)
    count = int((~sure.known & ~bound).sum())
    if count == 0:
        return ()
    return (
        f"the records do not determine {count} of {theta.size} parameters of the hysteresis; their "
        "values are one choice of many and have no standard error",
    )
