"""From sampled dynamics back to continuous ones, with a dead time of any part of a sample."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from hyst.errors import InputError, NotInvertibleError
from hyst.models import LinearDynamics

W, V = 2.0 * np.pi * 200.0, 2.0 * np.pi * 520.0
RESONANCE = [1.0, 0.06 * W, W * W]
MODES = np.convolve(RESONANCE, [1.0, 0.04 * V, V * V])
SYSTEMS = {
    "lag": ([5.0], [1.0, 5.0], 0.1),
    "integrator": ([1.0], [1.0, 0.0], 0.1),
    "with a zero": ([2.0, 30.0], [1.0, 4.0, 900.0], 0.02),
    "resonance": ([W * W], RESONANCE, 1e-4),
    "nonminimum phase": ([-2.0 * W, W * W], RESONANCE, 1e-4),
    "two modes": ([W * W * V * V], MODES, 1e-4),
    "modes and notch": (V * V * np.array([1.0, 8.0, 9e6]), MODES, 1e-4),
    "S0 eq. 48": ([3.391e10], [1.0, 3759.0, 2.063e7, 7.514e10], 5e-4),
}


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize("delay", [0.0, 3.0, 2.4, 0.7, 0.05])
def test_what_was_sampled_comes_back(name: str, delay: float) -> None:
    num, den, dt = SYSTEMS[name]
    back = LinearDynamics.from_continuous(num, den, dt, delay).to_continuous()
    # Poles next to 1 keep 1e-16 / |ln z| of themselves, clusters of four less: 1e-10 has room.
    assert back.num == pytest.approx(np.asarray(num), rel=1e-10)
    assert back.den == pytest.approx(np.asarray(den), rel=1e-10, abs=1e-10)
    assert back.delay / dt == pytest.approx(delay, abs=1e-9)
    assert back.D == 0.0


@pytest.mark.parametrize("name", ["lag", "resonance", "two modes"])
def test_a_part_of_a_sample_is_what_a_faster_simulation_shows(name: str) -> None:
    """Whole samples of a tenth of the sample time, of an input held for ten of them."""
    num, den, dt = SYSTEMS[name]
    u = np.random.default_rng(1).normal(size=60)
    late = LinearDynamics.from_continuous(num, den, dt, 2.4)
    fast = LinearDynamics.from_continuous(num, den, dt / 10.0, 24)
    expected = fast(np.repeat(u, 10))[::10]
    assert late.delay == 3
    assert late(u) == pytest.approx(expected, abs=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("name", ["with a zero", "nonminimum phase", "modes and notch"])
def test_matrices_are_the_logarithm_of_the_whole_block(name: str) -> None:
    num, den, dt = SYSTEMS[name]
    G = LinearDynamics.from_continuous(num, den, dt)
    n = G.order
    block = np.eye(n + 1)
    block[:n, :n], block[:n, n] = G.A, G.B
    rates = np.real(scipy.linalg.logm(block)) / dt
    back = G.to_continuous()
    f = np.linspace(0.01, 0.5, 30) / dt
    s = 2j * np.pi * f
    expected = [G.C @ np.linalg.solve(x * np.eye(n) - rates[:n, :n], rates[:n, n]) for x in s]
    assert np.abs(back.frequency_response(f) / expected - 1.0).max() < 1e-8
    by_polynomials = np.polyval(back.num, s) / np.polyval(back.den, s)
    assert np.abs(back.frequency_response(f) / by_polynomials - 1.0).max() < 1e-8
    true = np.sort_complex(np.roots(den))
    assert np.sort_complex(back.poles()) == pytest.approx(true, rel=1e-9)
    assert np.sort_complex(back.zeros()) == pytest.approx(np.sort_complex(np.roots(num)), rel=1e-7)


def test_python_control_samples_it_to_what_it_was() -> None:
    control = pytest.importorskip("control")
    num, den, dt = SYSTEMS["two modes"]
    G = LinearDynamics.from_continuous(num, den, dt)
    sampled = control.sample_system(G.to_continuous().to_control(), dt)
    f = np.linspace(1.0, 4999.0, 50)
    ours = G.frequency_response(f)
    # Two exponentials of matrices of norm 1e7 dt, each to some hundred roundings.
    assert sampled(np.exp(2j * np.pi * f * dt)) == pytest.approx(ours, rel=1e-8)
    late = LinearDynamics.from_continuous(num, den, dt, 2.5).to_continuous()
    w = 2.0 * np.pi * 100.0
    # Pade of order 3 is right to (w T / 2)^7 of some thousandths: 1e-12 at w T = 0.16; a logarithm
    # and an exponential of matrices of norm 1e7 dt leave some 1e-9, by the kernels of the BLAS.
    assert late.to_control(pade=3)(1j * w) == pytest.approx(
        late.frequency_response(100.0)[0], rel=1e-8
    )
    assert late.to_control(pade=0)(1j * w) == pytest.approx(
        late.frequency_response(100.0)[0] * np.exp(1j * w * 2.5 * dt), rel=1e-8
    )
    with pytest.raises(InputError, match=r"dead time of 0\.00025 s"):
        late.to_control()


def test_random_dynamics_are_sampled_to_themselves() -> None:
    """Any feedthrough behind a delay: whatever is told, its hold is the same system."""
    rng = np.random.default_rng(3)
    splits = 0
    for _ in range(40):
        n = int(rng.integers(1, 5))
        half = np.exp(rng.uniform(-1.0, -0.01, n // 2) + 1j * rng.uniform(0.1, 2.9, n // 2))
        poles = np.concatenate([half, half.conj(), rng.uniform(0.1, 0.99, n % 2)])
        G = LinearDynamics.from_transfer_function(
            rng.normal(size=n + 1), np.poly(poles).real, 0.01, delay=2
        )
        back = G.to_continuous()
        again = LinearDynamics.from_continuous(back.num, back.den, 0.01, back.delay / 0.01)
        f = np.linspace(0.1, 50.0, 40)
        expected = G.frequency_response(f)
        size = np.abs(expected).max()
        assert again.frequency_response(f) == pytest.approx(expected, abs=1e-8 * size)
        whole = G.to_continuous(split_delay=False)
        assert whole.delay == pytest.approx(0.02, rel=1e-12)
        assert abs(whole.D - G.D) <= 1e-12 * abs(G.D)
        splits += back.delay < 0.02 - 1e-6
    assert 5 < splits < 35  # both ways were taken


def test_a_gain_stays_a_gain() -> None:
    back = LinearDynamics.from_continuous([5.0], [2.0], 0.1, 2.4).to_continuous()
    assert (back.num.tolist(), back.den.tolist()) == ([2.5], [1.0])
    assert back.delay == pytest.approx(0.3, rel=1e-12)  # a held input changes at samples alone


@pytest.mark.parametrize(
    ("poles", "error", "says"),
    [
        ([0.5, -0.2], NotInvertibleError, "pole -0.2 lies on the negative real axis"),
        ([0.5, 0.0], NotInvertibleError, "at 0"),
        ([-0.3, -0.3], NotInvertibleError, "negative real axis"),
    ],
)
def test_what_is_no_sampled_system_is_refused(
    poles: list[float], error: type[Exception], says: str
) -> None:
    G = LinearDynamics.from_transfer_function([1.0], np.poly(poles), 0.1)
    with pytest.raises(error, match=says):
        G.to_continuous()
    with pytest.raises(InputError, match="give 'zoh'"):
        G.to_continuous("tustin")  # type: ignore[arg-type]


@pytest.mark.parametrize("delay", [-0.5, np.nan, "2", 1e7])
def test_a_dead_time_is_a_number_of_samples(delay: object) -> None:
    with pytest.raises(InputError, match="delay is"):
        LinearDynamics.from_continuous([1.0], [1.0, 1.0], 0.1, delay)  # type: ignore[arg-type]
