"""A magnet with eddy currents against Radau's method, laws of loss, and its inverse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from hyst import DynamicJilesAtherton, InputError, JilesAtherton, NotInvertibleError, fit
from hyst.signals import Record

Array = NDArray[np.float64]

MAGNET = JilesAtherton(Ms=2.0, a=1.5, k=1.0, c=0.2, alpha=0.8)


def langevin(x: float) -> float:
    return x / 3.0 if abs(x) < 1e-4 else float(1.0 / np.tanh(x) - 1.0 / x)


def langevin_slope(x: float) -> float:
    return 1.0 / 3.0 if abs(x) < 1e-4 else float(1.0 / x**2 - 1.0 / np.sinh(x) ** 2)


def integrated(of: DynamicJilesAtherton, field: Array) -> Array:
    """Solve dM/dt = g(H - Hw), dHw/dt = (dM/dt) / (dM/dHw) by Radau, H a line between samples.

    g undoes k_cl v + k_ex v^(1/2), and dM/dHw is the equation of the effective field as printed.
    """
    still = of.magnet
    at, last, found = [0.0, 0.0], 0.0, []

    def rate(lack: float) -> float:
        size = abs(lack)
        if of.k_ex == 0.0:
            return lack / of.k_cl
        root = 2.0 * size / (of.k_ex + np.sqrt(of.k_ex**2 + 4.0 * of.k_cl * size))
        return float(np.copysign(root**2, lack))

    for each in field.tolist():
        slope = (each - last) / of.dt

        def change(t: float, at: Array, last: float = last, slope: float = slope) -> Array:
            within, m = at.tolist()
            v = rate(last + slope * t - within)
            x = (within + still.alpha * m) / still.a
            free = still.Ms * langevin(x)
            pinned = (m - still.c * free) / (1.0 - still.c)
            s = 1.0 if v > 0.0 else -1.0
            moved = max((free - pinned) / (s * still.k), 0.0)
            chi = (1.0 - still.c) * moved + still.c * still.Ms * langevin_slope(x) / still.a
            return np.array([v * (1.0 - still.alpha * chi) / chi, v])

        solved = solve_ivp(change, (0.0, of.dt), at, "Radau", rtol=1e-8, atol=1e-10)
        at, last = solved.y[:, -1].tolist(), each
        found.append(at[1])
    return np.array(found)


@pytest.mark.parametrize(("k_cl", "k_ex"), [(0.05, 0.0), (0.02, 0.3)])
def test_it_converges_to_the_equation_in_continuous_time(k_cl: float, k_ex: float) -> None:
    dt, samples = 0.02, 100
    turns = [0.0, 4.0, -4.0, 1.0]
    field = np.interp(np.arange(1, samples + 1), [0.0, 30.0, 80.0, samples], turns)
    expected = integrated(DynamicJilesAtherton(MAGNET, k_cl, k_ex, dt), field)
    found = []
    for parts in (16, 32):
        knots = np.arange(samples + 1) * parts
        fine = np.interp(np.arange(1, knots[-1] + 1), knots, [0.0, *field])
        model = DynamicJilesAtherton(MAGNET, k_cl, k_ex, dt / parts)
        found.append(model(fine)[parts - 1 :: parts])
    coarse, finer = (np.abs(each - expected).max() for each in found)
    # First order: half the step, half the error; what both leave out is a tenth of that.
    assert 0.4 < finer / coarse < 0.6
    assert np.abs(2.0 * found[1] - found[0] - expected).max() < 0.2 * finer
    still = np.abs(MAGNET(field) - expected).max()
    assert finer < 0.02 * still  # the losses matter: without them it is off by much more


@pytest.mark.parametrize("output", ["M", "B"])
def test_losses_of_a_sine_are_those_of_the_field_s_laws(output: str) -> None:
    """Beside the loop at rest a cycle loses k_cl 2 pi^2 f Y^2, and 8.76 k_ex f^(1/2) Y^(3/2)."""
    magnet = replace(MAGNET, output=output, mu0=1.0)
    samples, frequency, y_peak = 4000, 50.0, 0.9
    phase = 2.0 * np.pi * np.arange(2 * samples) / samples
    y = y_peak * np.sin(phase)
    dt = 1.0 / (frequency * samples)

    def loss(field: Array) -> float:
        last = slice(samples - 1, 2 * samples)
        steps = 0.5 * (field[last][1:] + field[last][:-1])
        return float(np.sum(steps * np.diff(y[last])))

    still = loss(magnet.inverse()(y))
    classical = loss(DynamicJilesAtherton(magnet, 1e-3, 0.0, dt).inverse()(y)) - still
    excess = loss(DynamicJilesAtherton(magnet, 0.0, 1e-2, dt).inverse()(y)) - still
    # Rates are those of chords of 4000 in a cycle: second order, 1e-6; 8.76 has three digits.
    assert classical == pytest.approx(1e-3 * 2.0 * np.pi**2 * frequency * y_peak**2, rel=1e-4)
    assert excess == pytest.approx(1e-2 * 8.76 * frequency**0.5 * y_peak**1.5, rel=1e-3)


@pytest.mark.parametrize("magnet", [MAGNET, replace(MAGNET, output="B", mu0=0.5)], ids="MB")
@pytest.mark.parametrize("variant", ["jiles-thoelke-devine-1992", "jiles-atherton-1986"])
@pytest.mark.parametrize(("k_cl", "k_ex"), [(0.1, 0.0), (0.0, 0.2), (0.05, 0.1)])
def test_the_inverse_gives_the_field_back(
    magnet: JilesAtherton, variant: str, k_cl: float, k_ex: float
) -> None:
    model = DynamicJilesAtherton(replace(magnet, variant=variant), k_cl, k_ex, 0.01)
    field = 3.0 * np.random.default_rng(4).normal(size=600)
    error = np.abs(model.inverse()(model(field)) - field).max()
    # Excess fields of rates next to 0 are known to the root of a rounding: 0.2 (1e-16 / dt)^(1/2).
    assert error <= (1e-6 if k_ex else 1e-9)


def test_without_losses_it_is_the_magnet_to_the_bit() -> None:
    field = 3.0 * np.random.default_rng(6).normal(size=300)
    still = DynamicJilesAtherton(MAGNET, 0.0, 0.0, 0.01)
    assert (still(field) == MAGNET(field)).all()
    assert (still.inverse()(MAGNET(field)) == MAGNET.inverse()(MAGNET(field))).all()


def test_slow_fields_are_followed_as_at_rest() -> None:
    t = np.linspace(0.0, 4.0 * np.pi, 4000)
    slow = DynamicJilesAtherton(MAGNET, 0.1, 0.1, dt=1e6)
    lag = np.abs(slow(4.0 * np.sin(t)) - MAGNET(4.0 * np.sin(t))).max()
    # Rates of some 0.01 a sample of 1e6 s: an excess field of 0.1 (1e-8)^(1/2) at a slope of 2.
    assert 0.0 < lag < 1e-4


def test_a_fit_finds_losses_from_two_frequencies() -> None:
    """Fields of wanted outputs: those of the magnet at rest, and what rates add by the formula."""
    dt, rng, records = 1e-3, np.random.default_rng(8), []
    for cycles in (2.0, 10.0):
        y = 1.5 * np.sin(2.0 * np.pi * cycles * np.arange(1, 401) / 400.0)
        rate = np.diff(y, prepend=0.0) / dt
        losses = 0.02 * rate + 0.05 * np.sign(rate) * np.sqrt(np.abs(rate))
        noise = 0.02 * rng.normal(size=y.size)
        records.append(Record(MAGNET.inverse()(y) + losses, y + noise, dt))
    start = DynamicJilesAtherton(replace(MAGNET, k=1.3, a=1.2), 0.01, 0.02, dt)
    found = fit(start, records, free=["a", "k", "k_cl", "k_ex"])
    truth = np.array([MAGNET.a, MAGNET.k, 0.02, 0.05])
    # Four normal errors: beyond four of their size once in 4000 records.
    assert (np.abs(found.parameter_values - truth) <= 4.0 * found.standard_errors).all()
    assert (found.standard_errors < 0.3 * truth).all()


def test_what_it_cannot_do_is_refused() -> None:
    with pytest.raises(NotInvertibleError, match="c is 0: right after a turn"):
        DynamicJilesAtherton(replace(MAGNET, c=0.0), 0.1, 0.1, 0.01).inverse()
    with pytest.raises(InputError, match=r"k_cl is -0\.1; give .* 0 or more"):
        DynamicJilesAtherton(MAGNET, -0.1, 0.0, 0.01)
    with pytest.raises(InputError, match="give a hyst"):
        DynamicJilesAtherton(MAGNET.inverse(), 0.1, 0.0, 0.01)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="sample time"):
        DynamicJilesAtherton(MAGNET, 0.1, 0.0, 0.01).require_sample_time(0.02)
