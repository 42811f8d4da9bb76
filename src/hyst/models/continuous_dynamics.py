"""Linear dynamics in continuous time, as sampled ones are taken back to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import InputError
from hyst.models.linear_properties import poles_of, values_at
from hyst.models.python_control import continuous_state_space_of
from hyst.models.realizations import Matrices

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_ROUNDING = 1e-10  # of the numerator at half the sample rate: a leading coefficient of less is none


@final
@dataclass(frozen=True, eq=False)
class ContinuousDynamics:
    """Linear dynamics ``dx/dt = A x + B u(t - delay), y = C x + D u(t - delay)``.

    ``LinearDynamics.to_continuous()`` gives it. No operator: hyst runs sampled systems.

    Parameters
    ----------
    A
        Shape (n, n), 1/s.
    B, C
        Shape (n,).
    D
        Feedthrough.
    delay
        Dead time, s.
    num, den
        Coefficients of ``num(s)/den(s)`` in descending powers of s; den begins with 1.
    """

    A: Array
    B: Array
    C: Array
    D: float
    delay: float
    num: Array
    den: Array

    def poles(self) -> Complex:
        """Give the poles, rad/s, the largest modulus first."""
        return poles_of(self.A)

    def zeros(self) -> Complex:
        """Give the finite zeros, rad/s, the largest modulus first."""
        zeros = np.roots(self.num).astype(np.complex128)
        return zeros[np.argsort(-np.abs(zeros), kind="stable")]

    def frequency_response(self, frequency: ArrayLike) -> Complex:
        """Give ``G(2 pi j f) exp(-2 pi j f delay)``.

        Parameters
        ----------
        frequency
            Shape (m,), Hz.
        """
        turns = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
        s: Complex = (2j * np.pi * turns).astype(np.complex128)
        values = values_at(s, self.A, self.B, self.C, self.D)
        return np.asarray(values * np.exp(-s * self.delay))

    def to_control(self, pade: int | None = None) -> Any:
        """Give a ``control.StateSpace``.

        Parameters
        ----------
        pade
            Order of Pade's approximation of the dead time, which python-control has no other form
            for; 0 leaves the dead time out.

        Raises
        ------
        InputError
            If there is a dead time, and ``pade`` is not given or no whole number from 0 to 20.
        MissingExtraError
            If python-control is not installed.
        """
        if self.delay > 0.0 and pade is None:
            raise InputError(
                f"the system has a dead time of {self.delay:.6g} s, which python-control has no "
                "form for; give pade=3, its approximation of that order, or pade=0 without it"
            )
        order = 0 if pade is None else whole_number(pade, "pade", 0, 20)
        return continuous_state_space_of(self.A, self.B, self.C, self.D, self.delay, order)


def in_seconds(matrices: Matrices, delay: float, dt: float) -> ContinuousDynamics:
    """Give a continuous system whose time is counted in samples in seconds.

    Parameters
    ----------
    matrices
        A, B, C, D.
    delay
        Samples.
    dt
        Sample time, s.
    """
    L, b, c, D = matrices
    # Coefficients in units of the fastest pole keep their digits.
    rate = float(np.abs(poles_of(L)[0])) if b.size else 1.0
    rate = rate if rate > 0.0 else 1.0
    n = b.size
    den = np.atleast_1d(np.poly(L / rate)).real if n else np.ones(1)
    powers, column = [np.zeros(n)], np.zeros(n)
    for each in den[:n]:
        column = (L / rate) @ column + each * (b / rate)
        powers.append(column)
    num = np.array([float(c @ each) for each in powers]) + D * den
    in_time = (rate / dt) ** np.arange(n + 1.0)
    at_nyquist = np.abs(num) * (np.pi / rate) ** np.arange(n, -1.0, -1.0)
    told = at_nyquist > _ROUNDING * at_nyquist.max(initial=0.0)
    first = int(told.argmax()) if told.any() else n
    return ContinuousDynamics(
        L / dt, b / dt, c, D, delay * dt, (num * in_time)[first:], den * in_time
    )
