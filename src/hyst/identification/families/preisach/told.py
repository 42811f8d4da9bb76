"""The few numbers that hundreds of weights come to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.estimates import Estimates
from hyst.identification.families.preisach.layout import cells_of, weights_of
from hyst.identification.fit.parametrization import Parametrization
from hyst.operators import Operator

Array = NDArray[np.float64]

SWITCHED, COERCIVE, BIAS = "preisach.switched", "preisach.coercive", "preisach.bias"


def estimates_of(operator: Operator, parametrization: Parametrization) -> Estimates:
    """Give mass and mean thresholds of the relays beside the constants that are none of weights.

    ``switched = 2 sum w``, ``coercive = sum w (alpha - beta) / 2 / sum w``,
    ``bias = sum w (alpha + beta) / 2 / sum w``.

    Parameters
    ----------
    operator, parametrization
        Of the fit, in the user's units.
    """
    constants = operator.parameters()
    at = [i for i, name in enumerate(constants.names) if ".w[" in name]
    weights, (alpha, beta) = weights_of(operator), cells_of(operator).centres()
    total = max(float(weights.sum()), np.finfo(float).tiny)
    means = [float(weights @ each) / total for each in ((alpha - beta) / 2.0, (alpha + beta) / 2.0)]
    by_weights = np.stack(
        [
            np.full(weights.size, 2.0),
            ((alpha - beta) / 2.0 - means[0]) / total,
            ((alpha + beta) / 2.0 - means[1]) / total,
        ]
    )
    others = [i for i in np.flatnonzero(parametrization.free) if i not in set(at)]
    return Estimates(
        (SWITCHED, COERCIVE, BIAS, *(constants.names[i] for i in others)),
        np.array([2.0 * total, *means, *constants.values[others]]),
        np.concatenate(
            [by_weights @ parametrization.transform[at], parametrization.transform[others]]
        ),
    )
