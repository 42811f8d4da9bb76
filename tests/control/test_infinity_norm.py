"""The H-infinity norm against slycot, against formulas, and at its corners."""

from __future__ import annotations

import numpy as np
import pytest
import slycot

import control
from hyst.control import LinearSystem, hinf_norm
from hyst.errors import InputError


def random_stable(rng: np.random.Generator) -> LinearSystem:
    """Poles down to 1e-4 of the axis, states scaled over 8 decades, time over 7."""
    n, m, q = int(rng.integers(1, 9)), int(rng.integers(1, 4)), int(rng.integers(1, 4))
    A = rng.normal(size=(n, n))
    A -= (max(np.linalg.eigvals(A).real.max(), 0.0) + 10 ** rng.uniform(-4, 0.5)) * np.eye(n)
    scales, rate = 10.0 ** rng.uniform(-4, 4, size=n), 10 ** rng.uniform(-3, 4)
    D = rng.normal(size=(q, m)) * 10 ** rng.uniform(-2, 2) * rng.integers(0, 2)
    return LinearSystem(
        rate * (scales[:, None] * A / scales),
        scales[:, None] * rng.normal(size=(n, m)),
        rng.normal(size=(q, n)) / scales,
        D,
    )


@pytest.mark.parametrize("seed", range(60))
def test_agrees_with_slycot(seed: int) -> None:
    system = random_stable(np.random.default_rng(seed))
    norm, frequency = hinf_norm(system)
    theirs, _ = slycot.ab13dd(
        "C", "I", "S", "D", system.order, system.inputs, system.outputs, system.A,
        np.eye(system.order), system.B, system.C, system.D, tol=1e-10,
    )  # fmt: skip
    # 1e-8 is what is promised. slycot may miss a peak: then a gain that is reached decides.
    assert norm >= theirs * (1.0 - 1e-8)
    if norm > theirs * (1.0 + 1e-8):
        response = control.ss(system.A, system.B, system.C, system.D)(1j * frequency, squeeze=False)
        assert np.linalg.norm(response, 2) == pytest.approx(norm, rel=1e-7)


@pytest.mark.parametrize("seed", range(20))
def test_no_frequency_of_a_sampled_system_is_above(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    A = rng.normal(size=(n, n))
    A *= rng.uniform(0.3, 0.999) / np.abs(np.linalg.eigvals(A)).max()
    system = LinearSystem(A, rng.normal(size=(n, 2)), rng.normal(size=(2, n)), np.eye(2), 0.01)
    norm, frequency = hinf_norm(system)
    theirs, _ = slycot.ab13dd(
        "D", "I", "S", "D", n, 2, 2, A, np.eye(n), system.B, system.C, system.D, tol=1e-10
    )
    assert norm == pytest.approx(theirs, rel=1e-8)
    assert 0.0 <= frequency <= np.pi / 0.01 * (1.0 + 1e-12)


def test_resonance_by_the_formula() -> None:
    omega, zeta = 3000.0, 1e-4
    norm, frequency = hinf_norm(control.tf([omega**2], [1.0, 2 * zeta * omega, omega**2]))
    # 1 / (2 zeta sqrt(1 - zeta^2)); 1e-8 is what is promised
    assert norm == pytest.approx(1.0 / (2 * zeta * np.sqrt(1 - zeta**2)), rel=1e-8)
    assert frequency == pytest.approx(omega * np.sqrt(1 - 2 * zeta**2), rel=1e-6)


def test_gain_alone() -> None:
    D = np.array([[3.0, 0.0], [0.0, 4.0]])
    norm, _ = hinf_norm(control.ss([], [], [], D))
    assert norm == pytest.approx(4.0, rel=1e-12)
    assert hinf_norm(-2.5)[0] == 2.5


def test_high_pass_reaches_its_norm_at_infinity() -> None:
    assert hinf_norm(([2.0, 0.0], [1.0, 1.0])) == (pytest.approx(2.0, rel=1e-8), np.inf)


def test_integrator_is_infinite_at_zero() -> None:
    assert hinf_norm(([1.0], [1.0, 0.0])) == (np.inf, 0.0)


def test_undamped_resonance_is_infinite_at_its_frequency() -> None:
    norm, frequency = hinf_norm(([1.0], [1.0, 0.0, 49.0]))
    assert norm == np.inf
    assert frequency == pytest.approx(7.0)


def test_unstable_is_infinite() -> None:
    assert hinf_norm(([1.0], [1.0, -1.0]))[0] == np.inf


@pytest.mark.parametrize("pole", [1.0, -1.0])
def test_sampled_pole_on_the_circle_is_infinite(pole: float) -> None:
    assert hinf_norm(control.tf([1.0], [1.0, -pole], 0.1))[0] == np.inf


def test_zero_system() -> None:
    assert hinf_norm(([0.0], [1.0, 1.0]))[0] == 0.0


def test_several_inputs_and_outputs_of_a_transfer_function() -> None:
    system = control.tf(
        [[[1.0], [2.0]], [[0.0], [5.0]]], [[[1.0, 1.0], [1.0, 2.0]], [[1.0], [1.0, 9.0]]]
    )
    grid = np.geomspace(1e-3, 1e3, 4001)
    largest = max(np.linalg.norm(system(1j * w), 2) for w in grid)
    # the grid is within 0.2 % of any frequency, and the gain falls slowly from w = 0
    assert hinf_norm(system)[0] == pytest.approx(largest, rel=1e-5)


def test_improper_is_refused() -> None:
    with pytest.raises(InputError, match="improper"):
        hinf_norm(([1.0, 0.0, 0.0], [1.0, 1.0]))


def test_not_a_number_is_refused() -> None:
    with pytest.raises(InputError, match="must be finite"):
        hinf_norm(([np.nan], [1.0, 1.0]))


def test_something_else_is_refused() -> None:
    with pytest.raises(InputError, match="python-control"):
        hinf_norm("1/(s+1)")
