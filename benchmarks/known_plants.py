"""How often the true plant lies within what an identification says of it.

    python -m benchmarks known_plants [--records 30]

Records of a stage (120 Hz, two samples of delay, two plays) with noise, on drives of several bands,
are identified, and the true dynamics held against the result. Printed is, for one machine and run,
by drive and noise,
- the rms of the true |P/G - 1| over its standard error, at the frequencies that the drive shows,
- the share of records whose true plant lies within one, two and three standard errors at all of
  them,
- the share whose true plant lies within Wu at 400 frequencies up to half the sample rate, order and
  excess of that Wu in the median, and the processor time of making it.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.control import IdentifiedPlant, identification_weight, identified_plant
from hyst.control.uncertainty.left_unknown import within_bands

Array = NDArray[np.float64]

DT, W = 5e-4, 2.0 * np.pi * 120.0
STAGE = hyst.LinearDynamics.from_continuous([W * W], [1.0, 0.1 * W, W * W], DT, delay=2)
PLAYS = hyst.PrandtlIshlinskii([0.3, 0.2], [1.0, 3.0], 0.8)
EVERYWHERE = np.linspace(1.0, 0.999 * 0.5 / DT, 400)
CASES = [(None, 0.01), (None, 0.05), ((1.0, 400.0), 0.01), ((5.0, 150.0), 0.01)]


@dataclass(frozen=True)
class Held:
    """One record's plant beside the true one."""

    square: float
    within: tuple[bool, bool, bool]
    covered: bool
    order: int
    excess: float
    seconds: float


def held(band: tuple[float, float] | None, noise: float, seed: int) -> Held:
    u = hyst.signals.multisine(DT, 3000, amplitude=10.0, band=band, seed=seed).u
    y = (STAGE @ PLAYS)(u)
    y = y + noise * y.std() * np.random.default_rng(seed).normal(size=y.size)
    record = hyst.Record(u, y, DT)
    found = hyst.identify(record, family="hammerstein", hysteresis="pi", plays=2, state_order=2)
    plant = identified_plant(found)
    frequency, error, off = _shown(plant)
    within = [
        bool(np.all(off <= within_bands(plant.errors, frequency, count)))
        for count in (1.0, 2.0, 3.0)
    ]
    begin = time.process_time()
    Wu = identification_weight(plant)
    seconds = time.process_time() - begin
    gain = np.abs(Wu.system.response(np.exp(2j * np.pi * EVERYWHERE * DT))[:, 0, 0])
    covered = bool(np.all(_off(plant, EVERYWHERE) <= gain))
    square = float(np.mean(np.square(off / error)))
    return Held(square, tuple(within), covered, Wu.order, Wu.excess, seconds)


def _off(plant: IdentifiedPlant, frequency: Array) -> Array:
    true, found = (each.frequency_response(frequency) for each in (STAGE, plant.dynamics))
    return np.abs(true / found - 1.0)


def _shown(plant: IdentifiedPlant) -> tuple[Array, Array, Array]:
    frequency, error = np.array(plant.errors.frequency), np.array(plant.errors.standard_error)
    inside = [(frequency >= low) & (frequency <= high) for low, high in plant.errors.bands]
    kept = np.any(inside, axis=0)
    return frequency[kept], error[kept], _off(plant, frequency[kept])


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--records", type=int, default=30)
    count = parser.parse_known_args()[0].records
    print("drive [Hz]  noise   off/error  within 1, 2, 3 errors  within Wu  order  excess  seconds")
    for band, noise in CASES:
        rows = [held(band, noise, seed) for seed in range(count)]
        rms = np.sqrt(np.mean([each.square for each in rows]))
        shares = np.mean([each.within for each in rows], axis=0)
        covered = np.mean([each.covered for each in rows])
        order, excess, seconds = (
            np.median([getattr(each, name) for each in rows])
            for name in ("order", "excess", "seconds")
        )
        drive = "all" if band is None else f"{band[0]:g}-{band[1]:g}"
        print(
            f"{drive:<10} {100 * noise:>4.0f} %  {rms:>10.2f}  "
            f"{shares[0]:>6.2f}  {shares[1]:>5.2f}  {shares[2]:>5.2f}  {covered:>9.2f}  "
            f"{order:>5.0f}  {excess:>6.2f}  {seconds:>7.2f}"
        )
