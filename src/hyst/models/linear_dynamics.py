"""Linear dynamics with one input and one output, sampled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_constants
from hyst.checks.numbers import as_sample_time, whole_number
from hyst.errors import InputError
from hyst.models.continuous_dynamics import ContinuousDynamics, in_seconds
from hyst.models.hold import held_late, released
from hyst.models.linear_properties import causal_inverse, settling_samples
from hyst.models.matrices import LARGEST_DELAY, checked_matrices
from hyst.models.python_control import matrices_of, state_space_of
from hyst.models.realizations import cascade, companion, sections_of
from hyst.models.state_space import StateSpace
from hyst.operators.parameters import Parameters, as_parameter_vector, numbered
from hyst.operators.portrait import NOTHING, Portrait
from hyst.operators.registry import entries, register
from hyst.operators.stage import Stage
from hyst.operators.traits import Degree, Traits

Array = NDArray[np.float64]


@register
@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class LinearDynamics(StateSpace):
    """Linear dynamics: ``x_{k+1} = A x_k + B w_k, y_k = C x_k + D w_k, w_k = u_{k-delay}``.

    Parameters
    ----------
    A
        Shape (n, n), n <= 64.
    B, C
        Shape (n,), or (n, 1) and (1, n).
    D
        Feedthrough, output units per input unit; a number, or (1, 1).
    dt
        Sample time, s, > 0. It says what a sample means; the equations do not need it.
    delay
        Whole samples, 0 to 10^6.
    x0
        Shape (n,), state before the first sample; zeros if left out. The delay line starts at 0.

    Raises
    ------
    InputError
        If shapes do not fit, a number is not finite, n is above 64 or the delay too long.

    Examples
    --------
    >>> lag = LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], dt=1e-3)
    >>> lag([1.0, 1.0, 1.0]).tolist()
    [0.0, 0.5, 0.75]
    """

    A: Array
    B: Array
    C: Array
    D: float
    _dt: float
    delay: int
    x0: Array

    kind = "linear-dynamics"

    def __init__(
        self,
        A: ArrayLike,
        B: ArrayLike,
        C: ArrayLike,
        D: ArrayLike,
        dt: float,
        delay: int = 0,
        x0: ArrayLike | None = None,
    ) -> None:
        a, b, c, feedthrough = checked_matrices(A, B, C, D)
        start = as_constants(np.zeros(b.size) if x0 is None else x0, "x0")
        if start.size != b.size:
            raise InputError(f"x0 has {start.size} entries; the order is {b.size}")
        names = ("A", "B", "C", "D", "_dt", "delay", "x0")
        numbers = (as_sample_time(dt), whole_number(delay, "delay", 0, LARGEST_DELAY))
        values = (a, b, c, feedthrough, *numbers, as_constants(start + 0.0, ""))
        for name, value in zip(names, values, strict=True):
            object.__setattr__(self, name, value)

    @property
    def dt(self) -> float:
        """Sample time, s."""
        return self._dt

    @classmethod
    def from_transfer_function(
        cls, num: ArrayLike, den: ArrayLike, dt: float, delay: int = 0
    ) -> Self:
        """Make ``G(z) = z^-delay num(z)/den(z)``.

        Parameters
        ----------
        num, den
            Coefficients in descending powers of z, the numerator's degree not above the
            denominator's.
        dt, delay
            Sample time, s, and whole samples.

        Raises
        ------
        InputError
            If the denominator is zero or of lower degree than the numerator.

        Examples
        --------
        >>> round(LinearDynamics.from_transfer_function([1.0, 0.5], [1.0, -0.9], 0.01).dc_gain(), 9)
        15.0
        """
        return cls(*companion(num, den), dt, delay)

    @classmethod
    def from_continuous(cls, num: ArrayLike, den: ArrayLike, dt: float, delay: float = 0) -> Self:
        """Sample ``num(s)/den(s)`` with the input held between samples (zero-order hold).

        Parameters
        ----------
        num, den
            Coefficients in descending powers of s.
        dt, delay
            Sample time, s, and dead time in samples, whole or not.

        Raises
        ------
        InputError
            As ``from_transfer_function``.

        Examples
        --------
        >>> lag = LinearDynamics.from_continuous([100.0], [1.0, 100.0], dt=0.01)
        >>> bool(abs(lag.poles()[0] - np.exp(-1.0)) < 1e-15)
        True
        """
        matrices, whole = held_late(num, den, dt, delay)
        return cls(*matrices, dt, whole)

    def to_continuous(
        self, method: Literal["zoh"] = "zoh", *, split_delay: bool = True
    ) -> ContinuousDynamics:
        """Give the continuous system whose zero-order hold this is, slower than half the rate.

        Parameters
        ----------
        method
            ``"zoh"``: the input is held between samples.
        split_delay
            Tell a feedthrough behind a delay as a part of a sample of dead time, if one has it.

        Raises
        ------
        InputError
            If there is no such method.
        NotInvertibleError
            If a pole lies at 0 or on the negative real axis.

        Examples
        --------
        >>> lag = LinearDynamics.from_continuous([100.0], [1.0, 100.0], dt=0.01, delay=1.4)
        >>> back = lag.to_continuous()
        >>> np.round(back.den, 9).tolist(), round(back.delay, 12)
        ([1.0, 100.0], 0.014)
        """
        if method != "zoh":
            raise InputError(f"method is {method!r}; give 'zoh'")
        parts = released(self.A, self.B, self.C, self.D, self.delay, split_delay)
        return in_seconds(*parts, self.dt)

    @classmethod
    def from_zeros_poles_gain(
        cls, zeros: ArrayLike, poles: ArrayLike, gain: float, dt: float, delay: int = 0
    ) -> Self:
        """Make ``G(z) = z^-delay gain prod(z - z_i) / prod(z - p_i)``.

        Parameters
        ----------
        zeros, poles
            Complex ones in conjugate pairs; no more zeros than poles.
        gain
            Factor of the whole.
        dt, delay
            Sample time, s, and whole samples.

        Returns
        -------
        LinearDynamics
            A cascade of second-order sections, so that high orders stay accurate.

        Raises
        ------
        InputError
            If there are more zeros than poles, or a complex one lacks its conjugate.

        Examples
        --------
        >>> G = LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.4], 2.0, dt=1.0)
        >>> np.round(G.zeros().real, 9).tolist()
        [1.6]
        """
        return cls(*cascade(sections_of(zeros, poles, gain)), dt, delay)

    @classmethod
    def from_control(cls, system: Any, dt: float | None = None) -> Self:
        """Take over a system of python-control: a state space or a transfer function.

        Parameters
        ----------
        system
            With one input and one output. A continuous one is sampled with zero-order hold.
        dt
            Sample time, s, if the system has none (``dt=True`` or continuous).

        Returns
        -------
        LinearDynamics

        Raises
        ------
        InputError
            If it is something else, has several inputs or outputs, or no sample time is known.

        Examples
        --------
        ::

            LinearDynamics.from_control(control.tf([1.0], [1.0, -0.5], 0.01))
        """
        A, B, C, D, time = matrices_of(system, dt)
        return cls(A, B, C, D, time)

    def to_control(self) -> Any:
        """Give a ``control.StateSpace`` with the delay written as poles at 0.

        Raises
        ------
        MissingExtraError
            If python-control is not installed.
        """
        return state_space_of(self.A, self.B, self.C, self.D, self.dt, self.delay)

    def traits(self) -> Traits:
        """Give the traits of a linear system; with order and delay 0 it is a gain."""
        is_gain = self.order == 0 and self.delay == 0
        return Traits(
            memoryless=is_gain,
            rate_independent=Degree.EXACTLY if is_gain else Degree.NO,
            return_point_memory=is_gain,
            congruent_loops=is_gain,
            monotone=is_gain and self.D >= 0.0,
            invertible=self.is_invertible,
        )

    def initial_state(self) -> Array:
        """Give x0, then a delay line of zeros, shape (n + delay,)."""
        return np.concatenate([self.x0, np.zeros(self.delay)])

    def exact_inverse(self) -> LinearDynamics:
        """Give the causal inverse ``(A - B C/D, B/D, -C/D, 1/D)``.

        Raises
        ------
        NotInvertibleError
            If G is delayed or strictly proper, or a zero does not lie inside the unit circle; use
            ``hyst.models.StableInverse``, which looks ahead, for a whole trajectory then.
        """
        matrices = causal_inverse(self.A, self.B, self.C, self.D, self.relative_degree())
        return LinearDynamics(*matrices, self.dt, 0, self.x0)

    def parameters(self) -> Parameters:
        """Give A row after row, B, C, D."""
        n = self.order
        values = np.concatenate([self.A.ravel(), self.B, self.C, [self.D]])
        entries_of_a = [f"A[{i},{j}]" for i in range(1, n + 1) for j in range(1, n + 1)]
        free = np.full(values.size, np.inf)
        names = (*entries_of_a, *numbered("B", n), *numbered("C", n), "D")
        return Parameters(values, names, -free, free)

    def with_parameters(self, theta: Sequence[float] | Array) -> LinearDynamics:
        """Give a system with other matrices; order, delay, sample time and x0 stay."""
        n = self.order
        vector = as_parameter_vector(theta, (n + 2) * n + 1)
        A, B, C, D = np.split(vector, [n * n, n * n + n, n * n + 2 * n])
        return LinearDynamics(A.reshape(n, n), B, C, D, dt=self.dt, delay=self.delay, x0=self.x0)

    def parameter_scales(self, input_scale: float, output_scale: float) -> Array:
        """Give the factors of A, B, C and D; the states have the unit of the input."""
        n, ratio = self.order, output_scale / input_scale
        return np.repeat([1.0, ratio], [n * n + n, n + 1])

    def in_units(self, input_scale: float, output_scale: float) -> LinearDynamics:
        """Give the system, and its initial state, in other units."""
        C, D = (each * (output_scale / input_scale) for each in (self.C, self.D))
        return LinearDynamics(self.A, self.B, C, D, self.dt, self.delay, self.x0 * input_scale)

    def keeps_unit(self) -> bool:
        """Tell whether the gain at rest is 1."""
        return bool(np.isclose(self.dc_gain(), 1.0, rtol=1e-6))

    def portrait(self) -> Portrait:
        """Show nothing: dynamics are seen over frequency, not over the input."""
        return NOTHING

    def lipschitz_constant(self) -> float:
        """Give the sum of the absolute impulse response; infinity if G is not stable."""
        if not self.is_stable():
            return math.inf
        response = np.abs(self.impulse_response(settling_samples(self.A) + self.delay))
        return float(response.sum()) * (1.0 + 1e-9)

    def to_dict(self) -> dict[str, Any]:
        """Give kind, sample time, matrices and, where there are any, delay and x0."""
        more: dict[str, Any] = {"delay": self.delay} if self.delay else {}
        if self.x0.any():
            more["x0"] = self.x0.tolist()
        matrices = {"A": self.A.tolist(), "B": self.B.tolist(), "C": self.C.tolist(), "D": self.D}
        return {"kind": self.kind, "dt": self.dt, **matrices, **more}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> LinearDynamics:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        return cls(**entries(data, ("dt", "A", "B", "C", "D"), ("delay", "x0")))

    def stages(self) -> tuple[Stage, ...]:
        """Give the one stage of this operator."""
        rows = self.A.ravel().tolist()
        constants = (*rows, *self.B.tolist(), *self.C.tolist(), self.D)
        choices = {"order": self.order, "delay": self.delay}
        return (Stage("state_space", constants, choices=choices),)

    def impulse_response(self, samples: int) -> Array:
        """Give the Markov parameters ``H_0 .. H_{samples - 1}``, from rest.

        Parameters
        ----------
        samples
            How many, >= 1.

        Raises
        ------
        InputError
            If ``samples`` is no whole number above 0, or the response overflows, as that of an
            unstable system does in the end.
        """
        impulse = np.zeros(whole_number(samples, "samples", 1))
        impulse[0] = 1.0
        return self.run(impulse, np.zeros(self.order + self.delay))[0]

    def __repr__(self) -> str:
        late = f", delay={self.delay}" if self.delay else ""
        return (
            f"LinearDynamics(A={self.A.tolist()}, B={self.B.tolist()}, C={self.C.tolist()}, "
            f"D={self.D!r}, dt={self.dt!r}{late})"
        )
