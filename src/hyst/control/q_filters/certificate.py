"""What a Q-filter achieves, computed from the filter alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.infinity_norm import hinf_norm
from hyst.control.linear_system import LinearSystem
from hyst.control.q_filters.family import QFilter
from hyst.control.q_filters.loops import filtered_inverse, noise_loop, weighted_stack
from hyst.control.q_filters.problem import QFilterProblem
from hyst.control.q_filters.rejection import robust_performance_of
from hyst.control.q_filters.responses import (
    grid_of,
    rejection_bandwidth,
    responses_of,
)

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class QFilterCertificate:
    """What a Q-filter achieves in the loop it was designed for.

    Frequencies in rad/s, poles in 1/s. Names as in ``Certificate``, where they mean the same.

    Parameters
    ----------
    stacked_norm, stacked_frequency
        H-infinity norm of [Wu T; Wp (1 - Q)], S1 eq. 36, and where it is reached.
    uncertainty_norm, uncertainty_frequency
        Those of Wu T, eq. 26: below 1 the loop stays stable for every plant within Wu.
    performance_norm, performance_frequency
        Those of Wp (1 - Q), eq. 27.
    robust_performance, robust_performance_frequency
        Largest |Wp (1 - Q)| + |Wu T|: below 1 what Wp asks holds for every plant within Wu.
    worst_performance, worst_frequency
        Largest |Wp (1 - Q)| / (1 - |Wu T|): how much is left of a disturbance, times Wp, with the
        worst plant within Wu; inf if one of them makes the loop unstable.
    limited_by
        ``"Wu T"`` or ``"Wp (1 - Q)"``: the larger part at the peak of the stack.
    robust_stability_margin
        Factor by which Wu may grow before stability is no longer sure.
    observer_noise_gain, observer_noise_gain_frequency
        Norm of Q/Pn, from sensor noise to the estimate.
    noise_gain, noise_gain_frequency
        Norm of T/Pn, from sensor noise to v in the loop.
    bandwidth
        Where |1 - Q| first reaches 0.707, rad/s; inf if it does nowhere.
    Q_numerator, Q_denominator
        Polynomials in s, highest power first.
    Q_at_zero
        Q(0); 1 as (Q2) wants.
    Q_relative_degree, plant_relative_degree
        The first at least the second, as (Q1) wants.
    observer_poles
        Those of Q and the zeros of the plant that the observer inverts.
    nominal_poles
        Poles of the whole loop around the nominal plant.
    """

    stacked_norm: float
    stacked_frequency: float
    uncertainty_norm: float
    uncertainty_frequency: float
    performance_norm: float
    performance_frequency: float
    robust_performance: float
    robust_performance_frequency: float
    worst_performance: float
    worst_frequency: float
    limited_by: str
    robust_stability_margin: float
    observer_noise_gain: float
    observer_noise_gain_frequency: float
    noise_gain: float
    noise_gain_frequency: float
    bandwidth: float
    Q_numerator: Array
    Q_denominator: Array
    Q_at_zero: float
    Q_relative_degree: int
    plant_relative_degree: int
    observer_poles: ComplexArray
    nominal_poles: ComplexArray

    @property
    def nominal_stable(self) -> bool:
        """Whether the loop around the nominal plant is stable."""
        return bool(self.nominal_poles.real.max(initial=-1.0) < 0.0)

    @property
    def robustly_stable(self) -> bool:
        """(Q3): whether the loop is stable for every plant within Wu, eq. 26."""
        return self.nominal_stable and self.uncertainty_norm < 1.0

    @property
    def proper(self) -> bool:
        """(Q1): whether Q/Pn can be realized."""
        return self.Q_relative_degree >= self.plant_relative_degree

    @property
    def unity_at_zero(self) -> bool:
        """(Q2): whether Q(0) = 1, to 1e-6."""
        return abs(self.Q_at_zero - 1.0) < 1e-6

    def to_dict(self) -> dict[str, Any]:
        """Give plain numbers and lists; poles as pairs of real and imaginary part, inf as text."""
        given: dict[str, Any] = {
            name: _plain(getattr(self, name)) for name in self.__dataclass_fields__
        }
        for name in ("nominal_stable", "robustly_stable", "proper", "unity_at_zero"):
            given[name] = getattr(self, name)
        return given


def certify_filter(problem: QFilterProblem, Q: QFilter) -> QFilterCertificate:
    """Compute what the filter achieves in the loop of the problem.

    Parameters
    ----------
    problem
        Plant, controller and weights.
    Q
        Of at least the plant's relative degree, with the zeros it must keep.
    """
    stack = weighted_stack(problem, Q.system)
    w = grid_of(problem, Q)
    at = responses_of(problem, Q, w)
    stacked, stacked_at = exact_norm(stack, at.stacked, w)
    uncertain, uncertain_at = exact_norm(_output(stack, 0), at.Wu_T, w)
    performance, performance_at = exact_norm(_output(stack, 1), at.Wp_E, w)
    noise, noise_at = exact_norm(filtered_inverse(problem, Q), at.Q_over_plant, w)
    drive, drive_at = exact_norm(noise_loop(problem, Q), at.T_over_plant, w)
    robust = robust_performance_of(problem, Q, w)
    peak = responses_of(problem, Q, np.array([min(stacked_at, 1e3 * w[-1])]))
    return QFilterCertificate(
        stacked_norm=stacked,
        stacked_frequency=stacked_at,
        uncertainty_norm=uncertain,
        uncertainty_frequency=uncertain_at,
        performance_norm=performance,
        performance_frequency=performance_at,
        robust_performance=robust.value,
        robust_performance_frequency=robust.frequency,
        worst_performance=robust.worst,
        worst_frequency=robust.worst_frequency,
        limited_by="Wu T" if peak.Wu_T[0] >= peak.Wp_E[0] else "Wp (1 - Q)",
        robust_stability_margin=1.0 / uncertain if uncertain > 0.0 else np.inf,
        observer_noise_gain=noise,
        observer_noise_gain_frequency=noise_at,
        noise_gain=drive,
        noise_gain_frequency=drive_at,
        bandwidth=rejection_bandwidth(Q),
        Q_numerator=Q.numerator,
        Q_denominator=Q.denominator,
        Q_at_zero=float(Q.system.response(np.zeros(1, complex))[0, 0, 0].real),
        Q_relative_degree=Q.relative_degree,
        plant_relative_degree=problem.plant_relative_degree,
        observer_poles=np.concatenate([Q.factors.poles, problem.inverted_zeros]),
        # Eq. 33: the loop of the controller alone, and the observer.
        nominal_poles=np.concatenate(
            [problem.sensitivity.poles, Q.factors.poles, problem.inverted_zeros]
        ),
    )


def exact_norm(system: LinearSystem, seen: Array, w: Array) -> tuple[float, float]:
    """Give the norm of system by the Hamiltonian, unless what was seen on the grid w is above it.

    That happens where poles are so far apart that eigenvalues lose their digits; the gain on the
    grid comes from factors, not from the matrices.
    """
    norm, frequency = hinf_norm(system)
    top = int(np.argmax(seen))
    if np.isfinite(norm) and seen[top] > norm * (1.0 + 1e-7):
        return float(seen[top]), float(w[top])
    return norm, frequency


def _output(system: LinearSystem, i: int) -> LinearSystem:
    return LinearSystem(system.A, system.B, system.C[i : i + 1], system.D[i : i + 1])


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray) and np.iscomplexobj(value):
        return [[float(each.real), float(each.imag)] for each in value]
    if isinstance(value, np.ndarray):
        return [_plain(float(each)) for each in value]
    if isinstance(value, float) and np.isinf(value):
        return "inf"
    return value
