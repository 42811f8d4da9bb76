"""Sines that stand out of a spectrum."""

from __future__ import annotations

import numpy as np
import pytest
from simulated_actuators import DT

from hyst.diagnosis.spectral_lines import lines_of


@pytest.mark.parametrize(("frequency", "amplitude"), [(50.02, 0.5), (127.3, 2.0), (480.1, 0.3)])
def test_frequency_and_amplitude_of_a_sine_in_noise(frequency: float, amplitude: float) -> None:
    t = np.arange(5000) * DT
    noise = np.random.default_rng(1).standard_normal(t.size)
    line = lines_of(noise + amplitude * np.cos(2.0 * np.pi * frequency * t + 0.7), DT)[0]
    # Cramer-Rao: 2 / sqrt(N) sigma of the amplitude, sqrt(24 / N^3) / (2 pi dt a) of the frequency,
    # hence 0.02 and 0.002 / a Hz; four of each.
    assert line.amplitude == pytest.approx(amplitude, abs=0.08)
    assert line.frequency == pytest.approx(frequency, abs=0.01 / amplitude)


def test_two_lines_come_strongest_first() -> None:
    t = np.arange(4000) * DT
    signal = np.sin(2.0 * np.pi * 50.0 * t) + 3.0 * np.sin(2.0 * np.pi * 61.7 * t) + 0.1 * t
    noise = 0.1 * np.random.default_rng(2).standard_normal(t.size)
    found = lines_of(signal + noise, DT)
    assert [round(each.frequency, 1) for each in found] == [61.7, 50.0]


@pytest.mark.parametrize("samples", [100, 1000, 10_000])
def test_noise_has_no_lines(samples: int) -> None:
    rng = np.random.default_rng(samples)
    white = [lines_of(rng.standard_normal(samples), DT) for _ in range(100)]
    walks = [lines_of(np.cumsum(rng.standard_normal(samples)), DT) for _ in range(100)]
    assert sum(map(bool, white)) == 0
    # The spectrum of a walk falls steeply within a block; one in a hundred is let pass.
    assert sum(map(bool, walks)) <= 2


def test_nothing_and_little_have_none() -> None:
    assert lines_of(np.zeros(1000), DT) == ()
    assert lines_of(np.sin(np.arange(20.0)), DT) == ()


def test_powers_of_two_change_nothing_else() -> None:
    rng = np.random.default_rng(5)
    signal = rng.standard_normal(3000) + np.sin(0.3 * np.arange(3000))
    (line,), (scaled,) = lines_of(signal, DT), lines_of(1024.0 * signal, DT)
    assert (scaled.frequency, scaled.amplitude) == (line.frequency, 1024.0 * line.amplitude)
