"""What a design of a repetitive controller proves, against simulations and roots of its own."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.signal
from repetitive_cases import DT, STAGE, N, by_period, difference_equation, loop, wanted

from hyst import InputError, NotInvertibleError, PrandtlIshlinskii
from hyst.compensation import slope_range
from hyst.control import RepetitiveController, simulate_closed_loop
from hyst.control.repetitive.filters import low_pass
from hyst.models import LinearDynamics
from hyst.operators import Affine

Design = RepetitiveController.design


@pytest.mark.parametrize(("passed", "stopped"), [(0.2, 0.4), (0.7, 1.4), (1.0, 3.0), (2.0, 3.14)])
def test_the_low_pass_is_between_nothing_and_all(passed: float, stopped: float) -> None:
    smooth = low_pass(passed, stopped)
    whole = np.concatenate([smooth[:0:-1], smooth])
    angle, Q = scipy.signal.freqz(whole, worN=1 << 14)
    Q = (Q * np.exp(1j * angle * (smooth.size - 1))).real
    assert Q[0] == pytest.approx(1.0, abs=1e-14)
    # Sharpening leaves 3 x^2 of a ripple x near 0.01, which Kaiser's formula meets within a half.
    assert Q.min() >= -1e-15
    assert Q.max() <= 1.0 + 1e-14
    assert Q[angle <= passed].min() >= 1.0 - 1e-3
    assert Q[angle >= stopped].max() <= 5e-4


def condition(block: RepetitiveController, b: np.ndarray, a: np.ndarray) -> np.ndarray:
    """``Q (1 - L P)`` on a fine grid, by SciPy alone."""
    angle = np.linspace(1e-6, np.pi, 200_001)
    _, P = scipy.signal.freqz(b, a, worN=angle)
    z = np.exp(1j * angle)
    h, taps = block.smooth.size - 1, block.learn.size
    _, Q = scipy.signal.freqz(np.concatenate([block.smooth[:0:-1], block.smooth]), worN=angle)
    _, L = scipy.signal.freqz(block.learn[::-1], worN=angle)
    return Q * z**h * (1.0 - L * z**block.lead * P) if taps else Q


@pytest.mark.parametrize("delay", [0, 1, 5])
@pytest.mark.parametrize("bandwidth", [150.0, 600.0, 1500.0])
def test_the_certificate_is_the_largest_value(delay: int, bandwidth: float) -> None:
    block = Design(STAGE, N, dt=DT, bandwidth=bandwidth, delay=delay * DT)
    b, a = difference_equation(STAGE, delay)
    found = block.certificate(STAGE, delay=delay * DT)
    expected = np.abs(condition(block, b, a)).max()
    assert found.holds
    # The grid of the test is finer than any peak of these filters; the certificate closes in.
    assert found.contraction == pytest.approx(expected, rel=1e-6)
    assert found.nominal == found.contraction
    more = block.certificate(STAGE, 0.1, slopes=(0.9, 1.1), delay=delay * DT)
    assert more.contraction > found.contraction


def test_what_is_left_shrinks_by_no_less_than_was_proven() -> None:
    """And ends where it is said to end, harmonic by harmonic."""
    block = Design(STAGE, N, dt=DT, bandwidth=500.0, delay=DT, gain=0.5)
    proof = block.certificate(STAGE, delay=DT)
    b, a = difference_equation(STAGE, 1)
    r = np.tile(scipy.signal.sawtooth(2 * np.pi * np.arange(N) / N, 0.5), 60)
    e = loop(block, b, a, r).reshape(-1, N)
    away = np.sqrt(((e - e[-1]) ** 2).mean(axis=1))
    ratios = away[3:14] / away[2:13]
    # A period is 31 time constants of the plant's poles over 20 rad/s: e^-2 of its transients are
    # left after one, which is 5 % of what a period leaves.
    assert ratios.max() <= 1.05 * proof.contraction
    assert ratios.max() > 0.9 * proof.contraction
    assert proof.periods(0.01) == math.ceil(math.log(0.01) / math.log(proof.contraction))
    alone, last = np.fft.rfft(loop(block, b, a, r[: 2 * N])[:N]), np.fft.rfft(e[-1])
    _, P = scipy.signal.freqz(b, a, worN=2 * np.pi * np.arange(1, 20, 2) / N)
    R = np.fft.rfft(r[:N])[1:20:2]
    assert np.abs(alone).max() > 0.0
    np.testing.assert_allclose(
        np.abs(last[1:20:2]), proof.left(np.arange(1, 20, 2)) * np.abs((1 - P) * R), rtol=1e-4,
        atol=1e-7,
    )  # fmt: skip


def growth(block: RepetitiveController, b: np.ndarray, a: np.ndarray) -> float:
    """Largest modulus of the roots of ``a z^N - z^h.. Q (a - L b)``, of any plant b/a, a period."""
    whole = np.concatenate([block.smooth[:0:-1], block.smooth])
    n, h = max(a.size, b.size), block.smooth.size - 1
    b, a = np.pad(b, (0, n - b.size)), np.pad(a, (0, n - a.size))
    taps, lead = block.learn.size, block.lead
    behind = taps - 1 - lead
    # In powers of z, all multiplied by z^(behind + h), highest first.
    first = np.concatenate([a, np.zeros(block.period + h + behind)])
    L = np.concatenate([block.learn[::-1]])  # z^lead .. z^-behind
    inner = np.convolve(L, b)
    same = np.concatenate([np.zeros(lead), a, np.zeros(behind)])
    second = np.convolve(whole, same - inner)
    second = np.concatenate([np.zeros(first.size - second.size), second])
    return float(np.abs(np.roots(first - second)).max()) ** block.period


def test_every_plant_within_the_uncertainty_is_stable() -> None:
    Wu, rng = 0.35, np.random.default_rng(3)
    block = Design(STAGE, 40, dt=DT, uncertainty=LinearDynamics([], [], [], Wu, DT), delay=DT)
    proof = block.certificate(STAGE, LinearDynamics([], [], [], Wu, DT), delay=DT)
    assert proof.contraction < 0.9
    b, a = difference_equation(STAGE, 1)
    assert growth(block, b, a) < 1.0
    for _ in range(40):
        # P (1 + Wu A) with an all-pass A of any phase.
        pole, sign = rng.uniform(-0.95, 0.95), rng.choice([-1.0, 1.0])
        up, down = sign * np.array([-pole, 1.0]), np.array([1.0, -pole])
        other = np.convolve(b, down + Wu * up), np.convolve(a, down)
        assert growth(block, *other) < 1.0


def test_an_unstable_choice_is_refused_and_diverges() -> None:
    """A lead alone and no low-pass, which the mode turns round."""
    block = RepetitiveController(N, [1.0], [0.0, 0.0, 1.0], 2, DT)
    b, a = difference_equation(STAGE, 1)
    proof = block.certificate(STAGE, delay=DT)
    assert not proof.holds
    assert proof.contraction == pytest.approx(np.abs(condition(block, b, a)).max(), rel=1e-6)
    assert "not proven" in proof.sentence()
    assert proof.periods(0.1) == math.inf
    e = by_period(loop(block, b, a, wanted(40)))
    assert e[-1] > 1e3 * e[0]
    found = simulate_closed_loop(wanted(400), DT, plant=STAGE, controller=block, delay=DT)
    assert found.diverged_at is not None


@pytest.mark.parametrize("more", [1.0 / 1.6, 2.4])
def test_a_plant_outside_is_refused_and_one_that_is_far_diverges(more: float) -> None:
    block = Design(STAGE, N, dt=DT, bandwidth=900.0, delay=DT)
    plant = ([more * 4e5], STAGE[1])
    e = by_period(loop(block, *difference_equation(plant, 1), wanted(30)))
    proof = block.certificate(plant, delay=DT)
    # |1 - more| of what is left of the nominal plant, which is 0.01.
    assert proof.contraction == pytest.approx(abs(1.0 - more), abs=0.03)
    assert proof.holds == (more < 2.0)
    assert (e[-1] < 1e-3 * e[0]) == (more < 2.0)
    assert (e[-1] > 1e2 * e[0]) == (more > 2.0)


def test_gains_that_are_refused_by_design() -> None:
    with pytest.raises(InputError, match=r"no band can be proven: at .* rad/s"):
        Design(STAGE, N, dt=DT, uncertainty=1.2)
    rising = ([2e-3, 0.1], [1e-5, 1.0])  # above 1 from 450 rad/s on
    with pytest.raises(InputError, match="a bandwidth of 900 rad/s can be proven"):
        Design(STAGE, N, dt=DT, bandwidth=900.0, uncertainty=rising, delay=DT)
    chosen = Design(STAGE, N, dt=DT, uncertainty=rising, delay=DT)
    assert chosen.certificate(STAGE, rising, delay=DT).contraction <= 0.9
    # Where nothing is known nothing is learned, by a hundredth.
    assert np.abs(chosen.filters.Q(np.linspace(1.0, np.pi, 200))).max() < 0.5


def test_slopes_of_an_inexact_inverse() -> None:
    """The actuator's plays are half as wide again, and its weights others, than the model's."""
    model = PrandtlIshlinskii([0.3, 0.2, 0.1], [0.1, 0.3, 0.6], p0=0.7)
    true = PrandtlIshlinskii([0.7, 0.5, 0.05], [0.15, 0.4, 0.8], p0=0.5)
    slopes = slope_range(true, model.inverse(), 2.0)
    assert slopes[0] == pytest.approx(0.5)
    assert slopes[1] > 1.4
    block = Design(
        STAGE, N, dt=DT, bandwidth=900.0, slopes=slopes, delay=DT, inverse=model.inverse()
    )
    assert block.certificate(STAGE, slopes=slopes, delay=DT).holds
    found = simulate_closed_loop(
        wanted(40), DT, plant=STAGE, controller=block, delay=DT, hysteresis=true
    )
    e = by_period(found.e)
    assert e[-1] < 1e-3 * e[0]
    # One gain that the slopes do not hold is another matter.
    assert not block.certificate(STAGE, slopes=(0.5, 4.0), delay=DT).holds
    for gain, diverges in ((slopes[0], False), (slopes[1], False), (4.0, True)):
        found = simulate_closed_loop(
            wanted(300), DT, plant=STAGE, controller=block, delay=DT,
            hysteresis=Affine(gain) @ model,
        )  # fmt: skip
        assert (found.diverged_at is not None) == diverges


def test_noise_in_the_drive_is_what_was_said() -> None:
    block = Design(STAGE, N, dt=DT, bandwidth=500.0, delay=DT, gain=0.5)
    said = block.certificate(STAGE, delay=DT).noise_rms
    noise = np.random.default_rng(1).normal(size=400 * N)
    found = simulate_closed_loop(
        np.zeros(400 * N), DT, plant=STAGE, controller=block, delay=DT, noise=noise, limit=1e9
    )
    # 400 periods of 100 samples that are half independent know a deviation to about 1 %.
    assert found.v[20 * N :].std() == pytest.approx(said, rel=0.05)
    less = Design(STAGE, N, dt=DT, bandwidth=500.0, delay=DT, gain=0.2)
    assert less.certificate(STAGE, delay=DT).noise_rms < 0.8 * said


def test_a_delay_alone_is_undone_by_a_lead() -> None:
    late = LinearDynamics([], [], [], 1.0, DT, delay=7)
    block = Design(late, N, bandwidth=900.0, gain=0.75)
    assert block.dt == DT
    assert block.lead >= 7
    proof = block.certificate(late)
    assert proof.contraction == pytest.approx(0.25, abs=1e-3)
    e = by_period(simulate_closed_loop(wanted(9), DT, plant=late, controller=block).e)
    # What is learned of the second period comes in the third, but for its first samples.
    np.testing.assert_allclose(e[3:7] / e[2:6], 0.25, atol=0.02)


def test_a_model_with_hysteresis_is_taken_apart() -> None:
    actuator = PrandtlIshlinskii([0.3, 0.2], [0.1, 0.3], p0=0.7)
    dynamics = LinearDynamics.from_transfer_function([0.0, 0.3], [1.0, -0.7], DT)
    block = Design(dynamics @ actuator, N, uncertainty=0.2)
    assert block.dt == DT
    assert block.inverse == actuator.inverse()
    assert block.certificate(dynamics @ actuator, 0.2).contraction <= 0.9
    assert block.certificate(dynamics, 0.2).contraction <= 0.9
    alone = Design(actuator, N, dt=DT, uncertainty=0.2)
    assert alone.inverse == actuator.inverse()
    with pytest.raises(NotInvertibleError):
        Design(dynamics @ PrandtlIshlinskii([1.0], [0.5], p0=0.0), N, uncertainty=0.2)


@pytest.mark.parametrize(
    ("plant", "changed", "said"),
    [
        (STAGE, {"bandwidth": None}, "neither uncertainty nor bandwidth"),
        (STAGE, {"period": 33.4}, "5 periods as one, 167 samples"),
        (STAGE, {"period": 6}, "shorter than the filter"),
        (STAGE, {"bandwidth": 3000.0}, "give at most 0.9"),
        (STAGE, {"bandwidth": -1.0}, "bandwidth"),
        (STAGE, {"gain": 1.5}, "at most 1"),
        (STAGE, {"gain": 0.0}, "gain"),
        (STAGE, {"slopes": (1.2, 0.8)}, "the smaller one first"),
        (STAGE, {"slopes": (-0.1, 1.0)}, "above 0"),
        (STAGE, {"slopes": 1.0}, "least and the largest"),
        (STAGE, {"dt": None}, "give dt"),
        (STAGE, {"delay": -1.0}, "delay"),
        (STAGE, {"uncertainty": ([1.0], [1.0, -1.0])}, "uncertainty is not stable"),
        (([1.0], [1.0, 0.0]), {}, "does not come to rest"),
        (([0.0], [1.0, 1.0]), {}, "passes nothing"),
        (([1.0], [1.0, -1.0]), {}, "unstable"),
    ],
)
def test_what_a_design_refuses(plant: tuple, changed: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        Design(plant, **({"period": N, "dt": DT, "bandwidth": 900.0} | changed))


def test_a_bandwidth_below_every_frequency_looked_at() -> None:
    made = Design(STAGE, N, dt=DT, bandwidth=1e-9)
    assert made.certificate(STAGE).holds


def test_a_certificate_as_plain_numbers() -> None:
    proof = Design(STAGE, N, dt=DT, bandwidth=500.0).certificate(STAGE)
    told = proof.to_dict()
    assert told["holds"] is True
    assert set(told) == {"contraction", "frequency", "nominal", "noise_rms", "holds"}
    assert "proven" in proof.sentence()
    with pytest.raises(InputError, match="between 0 and 1"):
        proof.periods(1.0)
