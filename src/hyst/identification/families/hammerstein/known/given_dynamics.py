"""Linear dynamics that are known before: what may be given, and how it is at a sample time."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, final

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.hammerstein.impulse_response.first_dynamics import of_gain_one
from hyst.identification.families.hammerstein.known.response_fit import (
    FittedResponse,
    fitted_response,
)
from hyst.models import LinearDynamics
from hyst.operators import Composition, Operator
from hyst.signals import MeasuredResponse

Array = NDArray[np.float64]

WHAT = (
    "give a LinearDynamics, what hyst.load reads of a model file with one, a system of "
    "python-control or scipy.signal, or a frequency response (hyst.signals.MeasuredResponse, "
    "hyst.read_frequency_response, FRD)"
)


@final
@dataclass(frozen=True, eq=False)
class GivenDynamics:
    """Dynamics as they were given: at a sample time they are sampled, or fitted.

    Parameters
    ----------
    given
        A LinearDynamics, a MeasuredResponse, or the matrices (A, B, C, D) of continuous time.
    """

    given: LinearDynamics | MeasuredResponse | tuple[Array, Array, Array, float]

    @property
    def dt(self) -> float | None:
        """The sample time of dynamics that are sampled, s; None for others."""
        return self.given.dt if isinstance(self.given, LinearDynamics) else None

    def at(self, dt: float) -> LinearDynamics:
        """Give the dynamics at a sample time, of gain 1 at rest.

        Parameters
        ----------
        dt
            Sample time, s.

        Raises
        ------
        InputError
            If they are sampled with another sample time.
        NotIdentifiableError
            If they are not stable, pass no constant value, or a frequency response is none of
            linear dynamics.
        """
        return _at(self, dt)[0]

    @property
    def says_delay(self) -> bool:
        """Whether what was given knows its delay: rational functions of s have none."""
        return not isinstance(self.given, tuple)

    def told(self, dt: float) -> tuple[str, ...]:
        """Say what was made of what was given.

        Parameters
        ----------
        dt
            Sample time, s.
        """
        dynamics, gain, fitted = _at(self, dt)
        notes = [
            f"the dynamics were given and are held: order {dynamics.order}, delay "
            f"{dynamics.delay} samples; their gain at rest, {gain:.6g}, is taken as 1, for the "
            "hysteresis has the gain of both, and standard errors are those of the hysteresis alone"
        ]
        if fitted is not None:
            assert isinstance(self.given, MeasuredResponse), "it was fitted"
            notes.append(_fit_in_words(self.given, fitted))
        return tuple(notes)


def as_given_dynamics(value: Any, name: str) -> GivenDynamics | None:
    """Check dynamics that are given; None where there are none.

    Parameters
    ----------
    value, name
        What was given, and the option's name.

    Raises
    ------
    InputError
        If it is no linear dynamics with one input and one output.
    """
    if value is None or isinstance(value, GivenDynamics):
        return value
    if isinstance(value, MeasuredResponse):
        return GivenDynamics(value)
    operator = getattr(value, "dynamics", value)  # of a result with dynamics
    if isinstance(operator, Operator):
        return GivenDynamics(_linear_part(operator, name))
    if hasattr(value, "omega") and hasattr(value, "frdata"):
        return GivenDynamics(_frd(value, name))
    if hasattr(value, "frequency") and hasattr(value, "response"):  # as identification tells it
        return GivenDynamics(MeasuredResponse(value.frequency, value.response))
    if not isinstance(value, type) and (hasattr(value, "num") or hasattr(value, "A")):
        return GivenDynamics(_system(value, name))
    if not isinstance(value, type) and hasattr(value, "to_ss"):
        return GivenDynamics(_system(value, name))
    said = repr(value) if isinstance(value, str) else f"of type {type(value).__name__}"
    raise InputError(f"{name} is {said}; {WHAT}")


def _linear_part(operator: Operator, name: str) -> LinearDynamics:
    """Give the dynamics of an operator: itself, or its last stage."""
    last = operator.parts[-1] if isinstance(operator, Composition) else operator
    if not isinstance(last, LinearDynamics):
        raise InputError(f"{name} is a {last.kind} at its output, not linear-dynamics; {WHAT}")
    return last


def _frd(value: Any, name: str) -> MeasuredResponse:
    """Read frequency response data of python-control: rad/s, shape (1, 1, m)."""
    data = np.asarray(value.frdata)
    if data.ndim == 3 and data.shape[:2] != (1, 1):
        raise InputError(f"{name} has several inputs or outputs; give the response of one pair")
    return MeasuredResponse(np.asarray(value.omega) / (2.0 * np.pi), data.ravel())


def _system(value: Any, name: str) -> LinearDynamics | tuple[Array, Array, Array, float]:
    """Read a system of python-control or scipy.signal."""
    if getattr(value, "ninputs", 1) != 1 or getattr(value, "noutputs", 1) != 1:
        raise InputError(f"{name} has several inputs or outputs; give the system of one pair")
    dt = value.dt
    if dt is True:
        raise InputError(f"{name} is sampled and its dt is not known; set its dt in seconds")
    try:
        system = value if hasattr(value, "A") else _state_space(value)
        A, B, C, D = (np.asarray(each, dtype=np.float64) for each in _matrices(system))
    except (AttributeError, TypeError, ValueError) as error:
        raise InputError(f"{name} cannot be made a state space ({error}); {WHAT}") from None
    if B.size != len(A) or C.size != len(A) or D.size != 1:
        raise InputError(f"{name} has several inputs or outputs; give the system of one pair")
    matrices = A, B.ravel(), C.ravel(), float(D.ravel()[0])
    return LinearDynamics(*matrices, float(dt)) if dt else matrices


def _state_space(value: Any) -> Any:
    """Give the state space of a transfer function, or of zeros and poles."""
    if hasattr(value, "to_ss"):
        return value.to_ss()
    import scipy.signal  # slow, and not needed for the other kinds

    num, den = np.ravel(value.num[0][0]), np.ravel(value.den[0][0])
    return scipy.signal.TransferFunction(num, den).to_ss()


def _matrices(system: Any) -> tuple[Any, Any, Any, Any]:
    return np.atleast_2d(system.A), system.B, system.C, system.D


@functools.lru_cache(maxsize=8)
def _at(known: GivenDynamics, dt: float) -> tuple[LinearDynamics, float, FittedResponse | None]:
    """Give the dynamics at a sample time, the gain they had, and the fit they are of."""
    given, fitted = known.given, None
    if isinstance(given, MeasuredResponse):
        fitted = fitted_response(given, dt)
        dynamics = fitted.dynamics
    elif isinstance(given, LinearDynamics):
        if abs(given.dt - dt) > 1e-6 * dt:
            raise InputError(
                f"the dynamics that are given have the sample time {given.dt:.6g} s, the records "
                f"{dt:.6g} s; give dynamics of the records' sample time, a system in continuous "
                "time, or a frequency response"
            )
        dynamics = LinearDynamics(given.A, given.B, given.C, given.D, dt, given.delay)
    else:
        dynamics = _held_input(given, dt)
    if not dynamics.is_stable():
        raise NotIdentifiableError(
            f"the dynamics that are given are not stable: a pole has modulus "
            f"{abs(dynamics.poles()[0]):.6g}; a stage that is driven open loop is"
        )
    return of_gain_one(dynamics), dynamics.dc_gain(), fitted


def _held_input(matrices: tuple[Array, Array, Array, float], dt: float) -> LinearDynamics:
    """Sample continuous dynamics whose input is held between samples."""
    A, B, C, D = matrices
    n = len(A)
    both = np.zeros((n + 1, n + 1))
    both[:n, :n], both[:n, n] = A * dt, B * dt
    sampled = scipy.linalg.expm(both)
    return LinearDynamics(sampled[:n, :n], sampled[:n, n], C, D, dt)


def _fit_in_words(given: MeasuredResponse, fitted: FittedResponse) -> str:
    low, high = given.frequency[0], given.frequency[fitted.used - 1]
    beyond = "" if low == 0.0 else f"; what it is at rest is continued from {low:.6g} Hz"
    return (
        f"the frequency response that was given, {fitted.used} values from {low:.6g} to "
        f"{high:.6g} Hz, is described by order {fitted.dynamics.order} and delay "
        f"{fitted.dynamics.delay} to {100.0 * fitted.error:.3g} % rms, at worst "
        f"{100.0 * fitted.largest_error:.3g} % of its largest value, at {fitted.at:.6g} Hz{beyond}"
    )
