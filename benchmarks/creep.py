"""Creep and lag with hysteresis: time of a record against that of the hysteresis, and round trips.

The bar is (1 + n / 2) times ten plays alone, for n lags of creep. Ten plays alone are timed three
ways: as the core steps through them, sample by sample; in exact time lanes, with the same bits;
and as a record takes them by default. Creep is a recursion in which every sample waits for the one
before, with the bits of the core, so it has no lanes over time.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, report_times

Array = NDArray[np.float64]

SAMPLES = 100_000
DT = 1e-3
COUNTS = (1, 2, 3, 5, 8)


def creep(lags: int) -> hyst.Operator:
    return hyst.Creep(np.full(lags, 0.06 / lags), np.geomspace(0.013, 17.0, lags), DT)


def plays() -> hyst.PrandtlIshlinskii:
    return hyst.PrandtlIshlinskii(np.full(10, 0.1), np.linspace(0.05, 0.8, 10), p0=1.0)


def record(seed: int = 0, samples: int = SAMPLES) -> Array:
    steps = np.random.default_rng(seed).normal(size=samples + 200).cumsum()
    smooth = np.convolve(steps, np.hanning(101) / 50.0, mode="valid")[:samples]
    return np.asarray((smooth - smooth[0]) / np.ptp(smooth))


def times_of_records() -> None:
    print("| lags | bar | inverse | to the core's steps | to exact lanes | to the default |")
    print("|---|---|---|---|---|---|")
    for lags in COUNTS:
        for backwards in (False, True):
            bank, model = plays(), creep(lags) @ plays()
            if backwards:
                bank, model = bank.inverse(), model.inverse()
            u = record()
            works: dict[str, Callable[[], object]] = {
                "both": lambda model=model, u=u: model.run(u),
                "steps": lambda bank=bank, u=u: bank.run(u, engine="loop"),
                "lanes": lambda bank=bank, u=u: bank.run(u, engine="lanes"),
                "default": lambda bank=bank, u=u: bank.run(u),
            }
            times = interleaved(works, seconds=2.0, rounds=400)
            way = "inverse" if backwards else "forward"
            cells = []
            for each in list(works)[1:]:
                name = f"{lags} lags over {each}, {way}"
                over = report_times(name, times, "both", each, better="smaller")
                cells.append(f"{over:.2f}")
            print(
                f"| {lags} | {1 + lags / 2:.1f} | {backwards} | {' | '.join(cells)} |", flush=True
            )
    u = record()
    stages = {
        "creep of 3": creep(3), "its inverse": creep(3).inverse(),
        "lag": hyst.Lag(0.42 * DT, DT), "its inverse ": hyst.Lag(0.42 * DT, DT).inverse(),
        "delay": hyst.Delay(2.3, DT), "ten plays": plays(),
    }  # fmt: skip
    alone = interleaved({name: (lambda s=s: s.run(u)) for name, s in stages.items()}, rounds=400)
    for name, seconds in alone.items():
        print(f"{name.strip()}: {min(seconds) / u.size * 1e9:.2f} ns a sample at best")


def models() -> dict[str, hyst.Operator]:
    before = hyst.Lag(0.42 * DT, DT)
    bank = plays()
    outer = hyst.DeadZone.odd([1.0, 0.2, -0.1], [0.0, 0.3, 0.6])
    after = hyst.Affine(12.0, -3.0) @ creep(3)
    return {
        "plays": after @ bank @ before,
        "gpi": after @ hyst.GeneralizedPrandtlIshlinskii(outer, bank) @ before,
        "mpi": after @ hyst.ModifiedPrandtlIshlinskii(bank, outer) @ before,
    }


def round_trips() -> None:
    print("\n| model with creep of 3 and a lag | commands reached | commands found again |")
    print("|---|---|---|")
    for name, model in models().items():
        inverse = model.inverse()
        there, back = [], []
        for seed in range(10):
            u = record(seed)
            y = model(u)
            there.append(np.abs(model(inverse(y)) - y).max() / np.ptp(y))
            back.append(np.abs(inverse(y) - u).max() / np.ptp(u))
        print(f"| {name} | {max(there):.1e} of range | {max(back):.1e} of range |")


def main() -> None:
    times_of_records()
    round_trips()
