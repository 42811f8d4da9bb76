"""What drives determine of a resonant actuator with hysteresis, and what limits leave of them.

The actuator has a resonance at 200 Hz of damping 0.03, three samples of delay at 10 kHz and plays
of 0.05 to 0.8 in front; drives of amplitude 1 have 20,000 samples, noise lies 40 dB below the
output. The first table has drives without limits, the second those of an amplifier of 500 units a
second and 2e6 a second squared. Standard errors are forecast, those of weights
and radii as shares.
``check`` is the scatter of hyst's own joint refinement from the truth, over 20 seeds, divided by
the forecast: rms over the constants of the hysteresis, 1 to a sixth where the forecast holds.

``python -m benchmarks drives [--check]``
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.identification import forecast_drive, sketched_plays, sketched_stage
from hyst.identification.families.hammerstein.joint import joint
from hyst.identification.fit.bounded_least_squares import minimize
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.used_samples import Data
from hyst.signals import Drive

Array = NDArray[np.float64]

DT, SAMPLES = 1e-4, 20_000
LIMITS = {"max_rate": 500.0, "max_acceleration": 2e6}
RADII, WEIGHTS = (0.05, 0.15, 0.3, 0.5, 0.8), (0.6, 0.12, 0.09, 0.08, 0.06, 0.05)


def main() -> None:
    """Print both tables."""
    stage = sketched_stage(DT, [(200.0, 0.03)], delay=3, front=sketched_plays(RADII, WEIGHTS))
    _table("without limits", _free(), stage)
    _table("within 500 a second and 2e6 a second squared", _limited(), stage)


def _free() -> dict[str, Drive]:
    return {
        **{
            f"multisine to {high} Hz": _multisine((1.0, float(high)))
            for high in (5000, 3300, 1000, 500, 60)
        },
        "chirp to 1000 Hz": hyst.signals.swept_sine(DT, SAMPLES, (1.0, 1000.0), 1.0),
        "log chirp to 1000 Hz": hyst.signals.swept_sine(
            DT, SAMPLES, (1.0, 1000.0), 1.0, spacing="logarithmic"
        ),
        "levels held 5": hyst.signals.levels(DT, SAMPLES, 1.0, hold=5),
        "prbs, clock 5": hyst.signals.prbs(DT, 1.0, register=12, clock=5),
        "noise below 1 kHz": hyst.signals.lowpassed_noise(DT, SAMPLES, 1000.0, amplitude=1.0),
        "triangle, 10 Hz": hyst.signals.triangle(DT, 1.0, 40.0, cycles=20),
        "three sines": Drive(_three_sines(), DT, "sines"),
    }


def _limited() -> dict[str, Drive]:
    band = (1.0, 1000.0)
    return {
        "multisine, scaled": _multisine(band, keep="spectrum", **LIMITS),
        "multisine, shaped": _multisine(band, **LIMITS),
        "multisine, even": _multisine(band, uniform=True, **LIMITS),
        "pink, shaped": _multisine(band, spectrum="pink", **LIMITS),
        "pink, even": _multisine(band, spectrum="pink", uniform=True, **LIMITS),
        "log chirp": hyst.signals.swept_sine(
            DT, SAMPLES, band, 1.0, spacing="logarithmic", **LIMITS
        ),
        "levels held 5": hyst.signals.levels(DT, SAMPLES, 1.0, hold=5, **LIMITS),
    }


def _multisine(band: tuple[float, float], **more: object) -> Drive:
    return hyst.signals.multisine(DT, SAMPLES, amplitude=1.0, band=band, **more)  # type: ignore[arg-type]


def _three_sines() -> Array:
    k = np.arange(SAMPLES) * DT
    return np.asarray(sum(np.sin(2.0 * np.pi * f * k + f) for f in (3.0, 11.0, 47.0)) / 3.0)


def _table(title: str, drives: dict[str, Drive], stage: hyst.Operator) -> None:
    checked = "--check" in sys.argv
    print(f"{title}\n")
    print(
        f"{'drive':22s} {'reaches':>8s} {'units/s':>9s} {'f0 [Hz]':>9s} {'damping':>9s} "
        f"{'p, worst':>9s} {'r, worst':>9s}  open{'    check' if checked else ''}"
    )
    for name, drive in drives.items():
        found = forecast_drive(drive, stage)
        frequency, damping = found.of_dynamics
        hertz = frequency.error if frequency.share < 1.0 else np.inf
        p, r = (
            max(each.share for each in found.of_front if each.name.startswith(letter))
            for letter in "pr"
        )
        print(
            f"{name:22s} {np.abs(drive.u).max():8.3f} {drive.max_rate:9.4g} "
            f"{_shown(hertz)} {_shown(damping.share, True)} {_shown(p, True)} "
            f"{_shown(r, True)}  {len(found.undetermined)}"
            + (f"    {_scatter(drive, stage):.2f}" if checked and found.sufficient else "")
        )
    print()


def _shown(value: float, in_percent: bool = False) -> str:
    if not np.isfinite(value) or (in_percent and value >= 1.0):
        return f"{'open':>9s}"
    return f"{100.0 * value:7.2g} %" if in_percent else f"{value:9.2g}"


def _scatter(drive: Drive, stage: hyst.Operator, runs: int = 20) -> float:
    """Give the scatter of the radii of fits that start from the truth, over the forecast."""
    front, dynamics = stage.parts
    constants = front.parameters()
    size = len(constants)
    free = Parametrization(front, np.eye(size), np.zeros(size), constants.lower, constants.upper)
    parametrization, theta = joint((free, constants.values), dynamics)
    found = forecast_drive(drive, stage)
    y = stage(drive.u)
    estimates = []
    for seed in range(runs):
        noise = found.noise_rms * np.random.default_rng(seed).normal(size=y.size)
        data = Data((hyst.Record(drive.u, y + noise, drive.dt),), (0,), 0.0, 1.0, True)
        estimates.append(minimize(problem_of(data, parametrization), theta, 30).theta[:size])
    expected = np.array([each.standard_error for each in found.of_front])
    return float(np.sqrt(np.mean(np.square(np.std(estimates, axis=0, ddof=1) / expected))))
