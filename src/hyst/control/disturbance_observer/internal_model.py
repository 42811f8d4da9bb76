"""Models of the disturbance: dx_d/dt = A_d x_d, d = C_d x_d."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_array
from hyst.checks.numbers import as_positive, whole_number
from hyst.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class InternalModel:
    """The autonomous system that a disturbance is thought to come from.

    ``dx_d/dt = A_d x_d, d = C_d x_d``: what it can produce, the observer follows without error.
    Models are joined by ``+``.

    Parameters
    ----------
    A_d
        (n_d, n_d), 1/s; one eigenvalue at 0 gives Q(0) = 1.
    C_d
        (1, n_d) or (n_d,).

    Raises
    ------
    InputError
        If the shapes do not fit or a number is not finite.

    Source
    ------
    El-Shaer, Al Janaideh, Krejci and Tomizuka 2013, eq. 29.

    Examples
    --------
    >>> both = InternalModel.integrator() + InternalModel.sinusoid(300.0)
    >>> both.order, both.C_d.tolist()
    (3, [[1.0, 1.0, 0.0]])
    """

    A_d: Array
    C_d: Array

    def __post_init__(self) -> None:
        A_d = np.atleast_2d(finite_array(self.A_d, "A_d"))
        C_d = np.atleast_2d(finite_array(self.C_d, "C_d"))
        if A_d.ndim != 2 or A_d.shape[0] != A_d.shape[1] or A_d.size == 0:
            raise InputError(f"A_d has shape {A_d.shape}; give a square matrix")
        if C_d.shape != (1, A_d.shape[0]):
            raise InputError(
                f"C_d has shape {C_d.shape}; with A_d of {A_d.shape[0]} states and one disturbance "
                f"it needs (1, {A_d.shape[0]})"
            )
        for name, matrix in (("A_d", A_d), ("C_d", C_d)):
            matrix.setflags(write=False)
            object.__setattr__(self, name, matrix)

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A_d)

    @classmethod
    def integrator(cls) -> InternalModel:
        """Disturbances that are constant for long: A_d = 0, C_d = 1 (eq. 45)."""
        return cls.polynomial(0)

    @classmethod
    def ramp(cls) -> InternalModel:
        """Disturbances that grow evenly for long."""
        return cls.polynomial(1)

    @classmethod
    def polynomial(cls, degree: int) -> InternalModel:
        """Disturbances that are polynomials of time.

        Parameters
        ----------
        degree
            At least 0.

        Raises
        ------
        InputError
            If the degree is negative.
        """
        order = whole_number(degree, "the degree", 0) + 1
        C_d = np.zeros((1, order))
        C_d[0, 0] = 1.0
        return cls(np.eye(order, k=1), C_d)

    @classmethod
    def sinusoid(cls, frequency: float) -> InternalModel:
        """Disturbances that are a sine of known frequency and any amplitude and phase.

        Parameters
        ----------
        frequency
            rad/s, positive.

        Raises
        ------
        InputError
            If the frequency is not positive.
        """
        as_positive(frequency, "the frequency", "a finite number of rad/s")
        return cls(np.array([[0.0, frequency], [-frequency, 0.0]]), np.array([[1.0, 0.0]]))

    def __add__(self, other: InternalModel) -> InternalModel:
        """Join two models: sums of their disturbances."""
        A_d = scipy.linalg.block_diag(self.A_d, other.A_d)
        return InternalModel(A_d, np.hstack([self.C_d, other.C_d]))


def as_internal_model(given: Any) -> InternalModel:
    """Read an internal model.

    Parameters
    ----------
    given
        InternalModel, a pair (A_d, C_d), or ``"integrator"`` or ``"ramp"``.

    Raises
    ------
    InputError
        If it is none of these.
    """
    if isinstance(given, InternalModel):
        return given
    if given == "integrator":
        return InternalModel.integrator()
    if given == "ramp":
        return InternalModel.ramp()
    if isinstance(given, tuple | list) and len(given) == 2:
        A_d, C_d = given
        return InternalModel(_matrix(A_d), _matrix(C_d))
    raise InputError(
        f"internal_model is {given!r}; give 'integrator', 'ramp', a pair (A_d, C_d) or an "
        "InternalModel"
    )


def _matrix(values: ArrayLike) -> Array:
    return np.atleast_2d(np.asarray(values, dtype=np.float64))
