"""Free parameters and the operator they make.

The constants of the operator are an affine function of the free parameters,
``constants = fixed + transform @ theta``, so the Jacobian by theta is the operator's own Jacobian
times ``transform``, and bounds on theta keep every iterate in the family.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.fit.nuisance import Nuisances
from hyst.operators import Operator

Array = NDArray[np.float64]

SMALLEST_SLOPE = 1e-3
"""Least slope of an increasing model as a share of the mean slope of the records: it bounds the
gain of the inverse."""


def unchanged(theta: Array) -> Array:
    """Give theta itself: the form of a family whose parameters have one order only."""
    return theta


@dataclass(frozen=True, eq=False)
class Parametrization:
    """Free parameters of a model and the operator they make.

    Parameters
    ----------
    template
        An operator of the family; its constants are replaced.
    transform, fixed
        Shapes (constants, m) and (constants,).
    lower, upper
        Shape (m,), bounds of theta.
    canonical
        Gives an equivalent theta in the form the operator takes, as with sorted radii.
    gauges
        Gives what must be zero, shape (g,), and its derivative by theta, shape (g, m): scales that
        no record can determine. None where there are none.
    gauge_count
        How many there are, g.
    is_allowed
        Tells whether theta makes an operator at all, where bounds alone do not say it.
    prior
        Shape (q, m): what is small before any record is seen, over the norm of the centred output;
        its square is added to the cost. None where nothing is known before.
    is_linear
        Whether the constants only weight what the operator answers, so that one step solves it.
    nuisances
        Columns that records have beside the model, as a drift: fitted with it and none of it. None
        where there are none.
    """

    template: Operator
    transform: Array
    fixed: Array
    lower: Array
    upper: Array
    canonical: Callable[[Array], Array] = unchanged
    gauges: Callable[[Array], tuple[Array, Array]] | None = None
    gauge_count: int = 0
    is_allowed: Callable[[Array], bool] | None = None
    prior: Array | None = None
    is_linear: bool = False
    nuisances: Nuisances | None = None

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return int(self.lower.size)

    @property
    def free_count(self) -> int:
        """Number of parameters that can move, less those the gauges hold."""
        return int((self.lower < self.upper).sum()) - self.gauge_count

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which constants of the operator depend on theta, shape (constants,)."""
        return np.asarray(self.transform.any(axis=1))

    def constants(self, theta: Array) -> Array:
        """Give the operator's parameter vector."""
        vector: Array = self.fixed + self.transform @ theta
        return vector

    def operator(self, theta: Array) -> Operator:
        """Give the operator for canonical theta."""
        return self.as_template(theta)

    @final
    def as_template(self, theta: Array) -> Operator:
        """Give the operator in the form of the template, which is what is fitted."""
        made: Operator = self.template.with_parameters(self.constants(theta))
        return made

    @property
    def radii(self) -> tuple[int, ...]:
        """Places in theta of the radii of plays, past which the output bends; none here."""
        return ()

    def inside(self, theta: Array) -> NDArray[np.bool_]:
        """Tell which parameters lie on neither of their bounds."""
        return np.asarray((theta > self.lower) & (theta < self.upper))

    def in_units(self, theta: Array, input_scale: float, output_scale: float) -> Self:
        """Give the same free parameters for signals that are larger by these factors.

        Parameters
        ----------
        theta
            Where the scales are taken, which may depend on it; it keeps its values, for the scales
            go into ``transform`` and ``fixed``.
        input_scale, output_scale
            By which the numbers of input and output grow.
        """
        operator = self.as_template(theta)
        scales = operator.parameter_scales(input_scale, output_scale)
        return replace(
            self,
            template=operator.in_units(input_scale, output_scale),
            transform=scales[:, None] * self.transform,
            fixed=scales * self.fixed,
        )


def selection(constants: int, places: list[int]) -> Array:
    """Give the transform of theta that are single constants of an operator.

    Parameters
    ----------
    constants
        How many constants the operator has.
    places
        Which of them is each entry of theta.
    """
    transform = np.zeros((constants, len(places)))
    transform[places, range(len(places))] = 1.0
    return transform
