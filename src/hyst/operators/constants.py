"""The constants of an operator: as one vector, with other values, and in other units."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError
from hyst.operators.inequalities import Inequalities, of_bounds
from hyst.operators.parameters import Parameters

Array = NDArray[np.float64]


class Constants(ABC):
    """What has constants: one vector of them, other values, other units."""

    kind: ClassVar[str]
    is_map: ClassVar[bool] = False
    """Whether it is a memoryless map, which may keep the unit of its signal."""

    @abstractmethod
    def parameters(self) -> Parameters:
        """Give the constants as one flat vector with names and bounds."""

    @abstractmethod
    def with_parameters(self, theta: Sequence[float] | Array) -> Any:
        """Give the same operator with other constants.

        Parameters
        ----------
        theta
            Shape (m,), in the order and the units of ``parameters()``.

        Raises
        ------
        InputError
            If the length is wrong or a value is not allowed.
        """

    def nearest_parameters(self, theta: Array) -> Array:
        """Give the nearest parameter vector that keeps an order the constructor demands.

        Parameters
        ----------
        theta
            Shape (m,), within the bounds of ``parameters()``.

        Returns
        -------
        numpy.ndarray
            ``theta`` itself where the order of the constants is free.
        """
        return theta

    def inequalities(self) -> Inequalities:
        """Give linear inequalities that hold where constants near these can be inverted.

        What else must hold, ``inverse()`` refuses.

        Returns
        -------
        Inequalities
            The bounds of ``parameters()``, unless the operator knows better.
        """
        return of_bounds(self.parameters())

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of the parameters in units in which signals have larger numbers.

        The operator of these parameters, ``in_units``, gives ``output_scale f(u / input_scale)``.

        Parameters
        ----------
        input_scale, output_scale
            By which the numbers of input and output grow; powers of two keep all bits.

        Returns
        -------
        numpy.ndarray
            Shape (m,).

        Raises
        ------
        InputError
            If this kind of operator has no constants that could take the change.
        """
        raise InputError(
            f"a {self.kind} cannot be brought to other units by its constants; compose it with "
            "Affine operators that do"
        )

    def in_units(self, input_scale: float, output_scale: float) -> Any:
        """Give the same operator in units in which signals have larger numbers.

        Parameters
        ----------
        input_scale, output_scale
            By which the numbers of input and output grow.

        Returns
        -------
        Operator
            ``output_scale f(u / input_scale)``, of the same kind.

        Raises
        ------
        InputError
            As ``parameter_scales``.
        """
        scales = self.parameter_scales(input_scale, output_scale)
        return self.with_parameters(scales * self.parameters().values)
