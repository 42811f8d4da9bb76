"""A period that is no whole number of samples is refused with the one to give."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.errors import InputError
from hyst.identification.families.hammerstein import average_periods
from hyst.signals import Record, multisine

K = np.arange(8000)


def record_of(u: np.ndarray) -> Record:
    return Record(u, 0.5 * u, 1e-3)


def sine(frequency: float, rate: float, noise: float = 0.0, seed: int = 0) -> np.ndarray:
    u = 5.0 * np.sin(2.0 * np.pi * frequency / rate * K + 0.3)
    return np.asarray(u + noise * np.random.default_rng(seed).normal(size=K.size))


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.3], ids="noise {}".format)
@pytest.mark.parametrize(
    ("frequency", "rate", "period", "right", "which"),
    [
        (6.0, 2000.0, 333, 1000, "three periods of 333.333"),
        (6.0, 2000.0, 334, 1000, "three periods of 333.333"),
        (6.0, 2000.0, 332, 1000, "three periods of 333.333"),
        (7.0, 1000.0, 143, 1000, "seven periods of 142.857"),
        (17.0, 1000.0, 59, 1000, "17 periods of 58.8235"),
        (8.0, 1000.0, 130, 125, ""),
    ],
)
def test_the_right_period_is_told(
    frequency: float, rate: float, period: int, right: int, which: str, noise: float
) -> None:
    """Rate over frequency is the true period; its least whole multiple repeats."""
    said = f"not repeat after {period} samples but after {right}"
    with pytest.raises(InputError) as refused:
        average_periods(record_of(sine(frequency, rate, noise)), period)
    assert said in str(refused.value)
    assert f"({which})" in str(refused.value) if which else "periods of" not in str(refused.value)
    assert str(refused.value).endswith(f"give period={right} (--period {right})")
    averaged = average_periods(record_of(sine(frequency, rate, noise)), right)
    assert len(averaged) == 2 * right


def test_noise_of_the_drive_is_averaged_and_hides_no_wrong_period() -> None:
    u = multisine(1e-3, 500, amplitude=3.0, periods=8).u
    noisy = u + 0.05 * np.random.default_rng(1).normal(size=u.size)
    averaged = average_periods(record_of(noisy), 500)
    # Seven periods are left: 0.05 / sqrt(7) = 0.019, known to a twentieth by 500 samples.
    assert (averaged.u[:500] - u[:500]).std() == pytest.approx(0.0189, rel=0.15)
    for wrong in (499, 501):
        with pytest.raises(InputError, match="but after 500: give period=500"):
            average_periods(record_of(noisy), wrong)


def test_a_drive_that_never_repeats_says_so() -> None:
    random = np.random.default_rng(2).normal(size=5000)
    chirp = np.sin(2.0 * np.pi * np.cumsum(np.linspace(1.0, 50.0, 5000)) * 1e-3)
    for u in (random, np.cumsum(random), chirp):
        with pytest.raises(InputError, match="nor after any other number of them up to 2250; leav"):
            average_periods(record_of(u), 500)


def test_the_recorded_case_says_which_period_to_give(cases: Path) -> None:
    path = cases / "period-not-whole" / "loop.csv"
    record = hyst.read_record(path, input="drive", output="pos", time="time")
    with pytest.raises(InputError, match=r"but after 1000 \(three periods of 333.333\)"):
        hyst.identify(record, family="hammerstein", hysteresis="pi", period=333)
