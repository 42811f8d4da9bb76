"""Few samples and the shape of a fleet against many samples of a device alone.

Each fleet has 60 devices with 500 samples each, from which ``SharedShape`` is estimated; its first
shape is what ``hyst.identify`` finds in the first of these records, with 12 plays in families that
have them: a fleet tells more of them than a record of its own would pay for. Then new devices are
identified three ways: from 200 samples by the shape of the fleet, from 200 samples alone, from
5,000 samples alone (the last two: ``hyst.identify`` with the same family, which chooses its own
size). Errors are rms against the noise-free truth over the drive, after its first two fifths, as a
share of the output's range; the noise is 0.3 % of it. ``expected`` is what the result itself says
of its error: where the truth is in the class, no estimate from these 200 samples does better on
average. ``gain``: one scatter of 5 % of all of the output. ``each``: 5 % of every weight or
constant by itself.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import report
from hyst.errors import HystError
from hyst.fleet import SharedShape

Array = NDArray[np.float64]

DEVICES, FLEET_SAMPLES, FEW, MANY, NOISE, SCATTER = 60, 500, 200, 5000, 3e-3, 0.05
NEW_DEVICES, PLAYS = 6, 12
ALONE = 3
"""Of the new devices that are identified alone, too, which takes seconds each."""


@dataclass(frozen=True, eq=False)
class Kind:
    """Devices of one kind, and the family that is fitted to them."""

    name: str
    truth: hyst.Operator
    family: str
    each: bool = False

    def device(self, rng: np.random.Generator) -> hyst.Operator:
        if not self.each:
            return hyst.Affine(1.0 + SCATTER * rng.standard_normal(), 0.0) @ self.truth
        own = self.truth.parameters()
        shares = 1.0 + SCATTER * rng.standard_normal(own.values.size)
        is_scattered = ["r[" not in name and "thresholds" not in name for name in own.names]
        moved = np.where(is_scattered, own.values * shares, own.values)
        return self.truth.with_parameters(np.clip(moved, own.lower, own.upper))


def drive(samples: int) -> Array:
    phase = np.linspace(0.0, 5.0 * np.pi, samples)
    return np.asarray(np.sin(phase) * np.linspace(1.0, 0.4, samples))


def plays(p: list[float], r: list[float], p0: float = 1.0) -> hyst.PrandtlIshlinskii:
    return hyst.PrandtlIshlinskii(p, r, p0=p0)


def kinds() -> list[Kind]:
    few = plays([0.5, 0.4, 0.3, 0.2], [0.08, 0.22, 0.43, 0.71])
    radii = np.linspace(0.02, 0.9, 40)
    fine = plays((0.06 * np.exp(-2.0 * radii)).tolist(), radii.tolist(), 0.4)
    bent = hyst.DeadZone([1.0, 0.15, -0.2], [0.0, 0.7, -0.7])
    saturating = hyst.DeadZone([1.0, -0.15, -0.25], [0.0, 0.6, -0.6])
    bouc_wen = hyst.BoucWen(k=2.0, A=0.8, beta=1.5, gamma=0.6, n=1.3)
    wide = hyst.BoucWen(k=1.0, A=1.5, beta=3.0, gamma=-0.5, n=1.0)
    softer = hyst.RambergOsgood(1.0, 0.25, 3.0)
    return [
        Kind("4 plays", few, "pi"),
        Kind("40 plays", fine, "pi"),
        Kind("4 plays, map", bent @ few, "mpi"),
        Kind("40 plays, map", bent @ fine, "mpi"),
        Kind("40 plays, saturating", saturating @ fine, "mpi"),
        Kind("envelope, 40 plays", fine @ bent, "gpi"),
        Kind("envelope, 40 plays", fine @ bent, "mpi"),
        Kind("Bouc-Wen", bouc_wen, "bouc-wen"),
        Kind("Bouc-Wen", bouc_wen, "pi"),
        Kind("Bouc-Wen, wide", wide, "mpi"),
        Kind("Ramberg-Osgood", softer, "ramberg-osgood"),
        Kind("Ramberg-Osgood", softer, "pi"),
        Kind("4 plays", few, "pi", each=True),
        Kind("4 plays, map", bent @ few, "mpi", each=True),
        Kind("40 plays", fine, "pi", each=True),
        Kind("Bouc-Wen", bouc_wen, "bouc-wen", each=True),
        Kind("Bouc-Wen", bouc_wen, "pi", each=True),
    ]


def measured(device: hyst.Operator, samples: int, rng: np.random.Generator) -> hyst.Record:
    u = drive(samples)
    y = device(u)
    return hyst.Record(u, y + NOISE * np.ptp(y) * rng.standard_normal(samples), dt=1.0 / samples)


def error(predict: Callable[[Array], Array], device: hyst.Operator) -> float:
    u = drive(4000)
    y = device(u)
    missed = (predict(u) - y)[1600:]
    return float(np.sqrt(np.mean(missed**2)) / np.ptp(y))


def alone(record: hyst.Record, family: str, device: hyst.Operator) -> float:
    try:
        return error(hyst.identify(record, family=family, delay=0, drift=False).model, device)
    except HystError:
        return np.nan


def rms(values: list[float]) -> float:
    return float(np.sqrt(np.nanmean(np.square(values))))


def row(kind: Kind, seed: int) -> str:
    rng = np.random.default_rng(seed)
    records = [measured(kind.device(rng), FLEET_SAMPLES, rng) for _ in range(DEVICES)]
    size = {"plays": PLAYS} if kind.family in ("pi", "mpi", "gpi") else {}
    first = hyst.identify(records[0], family=kind.family, delay=0, drift=False, **size).model
    shape = SharedShape.estimate(first, records)
    shared, expected, few, many = [], [], [], []
    for number in range(NEW_DEVICES):
        device = kind.device(rng)
        found = shape.identify(measured(device, FEW, rng))
        shared.append(error(found.model, device))
        expected.append(found.predicted_error / float(np.ptp(device(drive(FEW)))))
        if number < ALONE:
            few.append(alone(measured(device, FEW, rng), kind.family, device))
            many.append(alone(measured(device, MANY, rng), kind.family, device))
    cells = [rms(shared), rms(expected), rms(few), rms(many)]
    scatter = "each" if kind.each else "gain"
    over = report(
        f"200 shared over 5,000 alone, {kind.name}, scatter {scatter}, by {kind.family}",
        cells[0] / cells[3],
        better="smaller",
    )
    told = " | ".join(f"{100.0 * each:.3f}" for each in cells)
    return f"| {kind.name} | {scatter} | {kind.family} | {told} | {over:.2f} |"


def main() -> None:
    wanted = [word for word in sys.argv[2:] if not word.startswith("-")]
    print(
        "| truth | scatter | family | 200 shared, % | expected | 200 alone | 5,000 alone | ratio |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for seed, kind in enumerate(kinds()):
        if not wanted or str(seed) in wanted:
            print(row(kind, seed), flush=True)


if __name__ == "__main__":
    main()
