"""The plant that a block samples: hold, delay and folding, against independent computations."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import scipy.integrate
import scipy.signal
from observer_cases import PLANT, TWO_MODES, WU

from hyst import LinearDynamics
from hyst.control import folded_uncertainty, sampled_plant
from hyst.errors import InputError

DT = 1e-3


@pytest.mark.parametrize("samples", [0.0, 0.25, 1.0, 1.7, 3.0])
def test_samples_are_those_of_the_differential_equation(samples: float) -> None:
    """Integrate the plant behind a drive that is held and comes late, by scipy's DOP853."""
    w = np.random.default_rng(3).uniform(-1.0, 1.0, 12)
    found = sampled_plant(PLANT, DT, samples * DT)
    x = np.zeros(found.system.order)
    ours = []
    for each in w:
        ours.append((found.system.C @ x).item())
        x = found.system.A @ x + found.system.B[:, 0] * each
    (b,), (_, a1, a0) = PLANT

    edges = np.unique(np.concatenate([np.arange(13) * DT, (np.arange(13) + samples) * DT]))
    state, true = np.zeros(2), {0: 0.0}
    for start, end in itertools.pairwise(edges):
        k = int(np.floor(0.5 * (start + end) / DT - samples))
        drive = b * w[k] if 0 <= k < w.size else 0.0
        run = scipy.integrate.solve_ivp(
            lambda t, s, d=drive: [s[1], d - a1 * s[1] - a0 * s[0]],
            (start, end),
            state,
            method="DOP853",
            rtol=1e-11,
            atol=1e-13,
        )
        state = run.y[:, -1]
        true[round(end / DT, 6)] = state[0]
    # The solver keeps 1e-11 a step.
    assert ours == pytest.approx([true[float(k)] if k else 0.0 for k in range(12)], abs=1e-8)


@pytest.mark.parametrize("samples", [0.0, 0.4, 2.0])
def test_response_is_the_sum_of_aliases(samples: float) -> None:
    """Poisson: the sampled response is the sum over aliases of plant and hold, signs included."""
    w = np.array([30.0, 700.0, 2500.0])
    z = np.exp(1j * w * DT)
    found = sampled_plant(PLANT, DT, samples * DT).system.response(z)[:, 0, 0]
    k = np.arange(-20_000, 20_001)
    s = 1j * (w[:, None] + 2.0 * np.pi * k / DT)
    P = np.polyval(PLANT[0], s) / np.polyval(PLANT[1], s)
    hold = (1.0 - np.exp(-s * DT)) / s * np.exp(-s * samples * DT)
    # Terms fall like 1/k^3.
    np.testing.assert_allclose(found, (P * hold).sum(axis=1) / DT, rtol=1e-7)


def test_folded_uncertainty_is_the_sum_of_magnitudes() -> None:
    """Against 40,000 aliases; never below, and hardly above."""
    w = np.array([5.0, 300.0, 1500.0, np.pi / DT])
    found = folded_uncertainty(sampled_plant(PLANT, DT), WU, w)
    k = np.arange(-20_000, 20_001)
    s = 1j * (w[:, None] + 2.0 * np.pi * k / DT)
    each = [np.polyval(num, s) / np.polyval(den, s) for num, den in (PLANT, WU)]
    true = np.abs(each[0] * each[1] * (1.0 - np.exp(-s * DT)) / s).sum(axis=1) / DT
    assert (found >= true * (1.0 - 1e-9)).all()
    # What is bounded instead of summed lies past eight times the fastest pole.
    assert (found <= true * 1.01).all()


def test_a_weight_with_fast_poles_and_a_resonance_above_half_the_rate_is_summed() -> None:
    resonance = 2.0 * np.pi * 930.0  # folds to 70 Hz
    Wu = ([0.01 * resonance**2], [1.0, 0.004 * resonance, resonance**2])
    at = 2.0 * np.pi * np.array([60.0, 70.0, 80.0])
    found = folded_uncertainty(sampled_plant(PLANT, DT), Wu, at)
    # At 930 Hz |Wu| is 2.5; the plant falls as (90 / 930)^2; the hold's share is sinc.
    folded = 2.5 * (90.0 / 930.0) ** 2 * abs(np.sin(0.93 * np.pi)) / (0.93 * np.pi)
    assert found[1] - 0.5 * (found[0] + found[2]) > 0.7 * folded
    fast = ([3e6], [1.0, 3e6])
    k = np.arange(-200_000, 200_001)
    s = 1j * (at[:, None] + 2.0 * np.pi * k / DT)
    value = np.polyval(PLANT[0], s) / np.polyval(PLANT[1], s) * 3e6 / (s + 3e6)
    true = np.abs(value * (1.0 - np.exp(-s * DT)) / s).sum(axis=1) / DT
    found = folded_uncertainty(sampled_plant(PLANT, DT), fast, at)
    assert (found >= true * (1.0 - 1e-9)).all()
    assert (found <= true * 1.01).all()


@pytest.mark.parametrize("damping", [1e-6, 1e-2])
def test_a_resonance_thousands_of_rates_away_is_summed(damping: float) -> None:
    """A slow loop around a light structure: neither missed nor taken to be everywhere."""
    resonance = 2.0 * np.pi * 1692.345
    plant = ([resonance**2], [1.0, 2.0 * damping * resonance, resonance**2])
    folded = 2.0 * np.pi * 0.345
    w = np.array([0.5, folded, np.pi])
    found = folded_uncertainty(sampled_plant(plant, 1.0), 0.3, w)
    s = 1j * (w[:, None] + 2.0 * np.pi * np.arange(-100_000, 100_001))
    value = 0.3 * np.polyval(plant[0], s) / np.polyval(plant[1], s)
    true = np.abs(value * (1.0 - np.exp(-s)) / s).sum(axis=1)
    # Terms past these fall like 1/k^3; the bound counts the largest one of each lump twice.
    assert (found >= true * (1.0 - 1e-9)).all()
    assert (found <= true * 1.2).all()


def test_of_a_plant_known_at_its_samples_wu_is_of_the_samples() -> None:
    stage = LinearDynamics.from_transfer_function([0.5], [1.0, -0.5], dt=DT, delay=2)
    w = np.array([10.0, 1000.0])
    found = folded_uncertainty(sampled_plant(stage), 0.2, w)
    z = np.exp(1j * w * DT)
    np.testing.assert_allclose(found, np.abs(0.1 / (z - 0.5)), rtol=1e-12)


def test_delays_add_up_and_whole_ones_are_states() -> None:
    known = sampled_plant(sampled_plant(TWO_MODES, DT).system, delay=2 * DT)
    late = sampled_plant(TWO_MODES, DT, 2 * DT)
    z = np.exp(1j * np.array([100.0, 2000.0]) * DT)
    np.testing.assert_allclose(known.system.response(z), late.system.response(z), rtol=1e-9)
    assert late.system.order == 6
    assert sampled_plant(late) is late


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ((PLANT,), "the plant is continuous; give dt"),
        ((PLANT, DT, -1e-4), "delay is -0.0001"),
        ((PLANT, DT, 2.0), "2000 samples; at most 100 "),
        ((LinearDynamics([], [], [], 1.0, DT), 2 * DT), "the plant has dt = 0.001 s, the loop"),
        ((LinearDynamics([], [], [], 1.0, DT), DT, 0.5 * DT), "give whole samples"),
        ((([1.0], [1.0, -1.0]), DT), "is unstable"),
        ((sampled_plant(PLANT, DT), 2 * DT), "sample it anew"),
        ((sampled_plant(PLANT, DT, DT), DT, 2 * DT), "has a delay of 0.001 s already"),
    ],
)
def test_refused(given: tuple[object, ...], says: str) -> None:
    with pytest.raises(InputError, match=says):
        sampled_plant(*given)  # type: ignore[arg-type]


def test_what_never_falls_off_has_no_bound() -> None:
    with pytest.raises(InputError, match="has no bound"):
        folded_uncertainty(sampled_plant(([1.0, 2.0], [1.0, 1.0]), DT), 0.1, np.array([1.0]))


def test_a_delay_of_a_hundred_samples_is_a_delay() -> None:
    lag = sampled_plant(([400.0], [1.0, 400.0]), DT).system
    late = sampled_plant(([400.0], [1.0, 400.0]), DT, 100 * DT).system
    z = np.exp(1j * np.linspace(1e-3, np.pi, 1000))
    # Powers of z to the 100th carry the rounding of z 100 times.
    wanted = lag.response(z)[:, 0, 0] * z**-100
    np.testing.assert_allclose(late.response(z)[:, 0, 0], wanted, rtol=1e-11)
