"""References that repeat on a stage that no model of hyst is: repetitive controller and peers.

The stage: Bouc-Wen's hysteresis, a mode at 800 Hz with a damping of 0.02, creep of 6 % in three
time constants, noise of 0.05 % of the stroke, 10 kHz, one sample to compute. Models are identified
from one record of it. Errors are those of the stage itself, rms over a period, in percent of the
stroke; what a sensor adds to what can be seen of them is 0.05. The first period teaches nothing,
what is learned of the second is applied in the third.

The peer is what the literature builds without an inverse: an integrator as the loop, and in front
of it a memory with a lead and the same kind of low-pass, the widest that its own condition lets
pass. It learns from the first sample on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, ratio
from hyst import InputError
from hyst.control import (
    LinearSystem,
    RepetitiveCertificate,
    RepetitiveController,
    TrackingController,
    sampled_plant,
    simulate_closed_loop,
)
from hyst.operators import Affine

Array = NDArray[np.float64]

DT, MODE, DAMPING = 1e-4, 2.0 * np.pi * 800.0, 0.02
NOMINAL = ([MODE**2], [1.0, 2.0 * DAMPING * MODE, MODE**2])
CREEP = ((0.02, 0.01), (0.02, 0.1), (0.02, 1.0))
ACTUATOR = hyst.BoucWen(k=0.6, A=0.4, beta=1.5, gamma=0.5)
STROKE, NOISE = 1.5, 0.05e-2 * 1.5
UNKNOWN = 0.08  # of the plant: creep of 6 %, and what the mode is off
SHOWN = (1, 2, 3, 4, 5, 7, 12)
PERIODS = 12


def creeping_stage() -> LinearSystem:
    """The mode, and behind it ``1 + sum of c / (1 + tau s)``."""
    A = np.zeros((5, 5))
    A[:2, :2] = [[0.0, 1.0], [-(MODE**2), -2.0 * DAMPING * MODE]]
    C = np.array([[1.0, 0.0, 0.0, 0.0, 0.0]])
    for i, (share, tau) in enumerate(CREEP, start=2):
        A[i, 0], A[i, i], C[0, i] = 1.0 / tau, -1.0 / tau, share
    return LinearSystem(A, [[0.0], [MODE**2], [0.0], [0.0], [0.0]], C, [[0.0]])


STAGE = creeping_stage()


def record(seed: int = 0) -> hyst.Record:
    """A record of the stage as a user takes it: loops that grow, at 1 Hz."""
    t = np.arange(20_000) * DT
    u = np.sin(2.0 * np.pi * 2.0 * t) * np.linspace(0.2, 1.1, t.size)
    open_loop = TrackingController([], [], [], [1.0, 0.0], DT)
    run = simulate_closed_loop(u, DT, plant=STAGE, controller=open_loop, hysteresis=ACTUATOR)
    y = run.y + NOISE * np.random.default_rng(seed).normal(size=t.size)
    # At 1 kHz the lag of the mode and the sample are no part of the loop.
    return hyst.Record(u[::10], y[::10], 10.0 * DT)


def references(samples: int) -> dict[str, Array]:
    """A period of each."""
    place = np.arange(samples) / samples
    triangle = np.interp(place, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    sine = np.sin(2.0 * np.pi * place)
    mixed = 0.6 * sine + 0.4 * np.sin(2.0 * np.pi * 3.0 * place + 1.0)
    return {"triangle": 0.6 * triangle, "sine": 0.6 * sine, "mixed": 0.6 * mixed}


def rms_by_period(e: Array, samples: int) -> Array:
    """In percent of the stroke."""
    return np.asarray(100.0 / STROKE * np.sqrt((e.reshape(-1, samples) ** 2).mean(axis=1)))


@dataclass(frozen=True)
class Peer:
    """An integrator around the stage, and a memory with a lead in front of it."""

    rate: float
    smooth: Array
    lead: int
    gain: float

    @classmethod
    def of(cls, gain: float, samples: int) -> Peer:
        """The integrator with a gain margin of 2 at the mode, and the widest low-pass proven."""
        rate = DAMPING * MODE / gain
        P = sampled_plant(NOMINAL, DT, DT).system
        n = P.order
        A = np.block([[P.A, gain * P.B], [-rate * DT * P.C, np.ones((1, 1))]])
        B = np.vstack([np.zeros((n, 1)), [[rate * DT]]])
        closed = LinearSystem(A, B, np.hstack([P.C, np.zeros((1, 1))]), [[0.0]], DT)
        best = None
        for band in 2.0 * np.pi * np.geomspace(4e3, 5.0, 50):
            for lead in (1, 3, 10, 30, 60, 100):
                try:
                    wide = RepetitiveController.design(closed, samples, bandwidth=band)
                except InputError:
                    continue
                learn = np.zeros(lead + 1)
                learn[-1] = 1.0
                if wide.smooth.size - 1 + lead >= samples:
                    continue
                tried = RepetitiveController(samples, wide.smooth, learn, lead, DT)
                if tried.certificate(closed).contraction < 0.95:
                    best = cls(rate, wide.smooth, lead, gain)
                    break
            if best is not None:
                return best
        raise InputError("no peer is stable")

    def error(self, period: Array, periods: int, seed: int) -> Array:
        """Of the stage, with noise."""
        learn = np.zeros(self.lead + 1)
        learn[-1] = 1.0
        memory = RepetitiveController(
            period.size, self.smooth, learn, self.lead, DT, wait=0
        ).stepper()
        P = sampled_plant(STAGE, DT, DT).system
        A, B, C = P.A, P.B[:, 0], P.C[0]
        x, total, step = np.zeros(P.order), 0.0, ACTUATOR.stepper()
        r = np.tile(period, periods)
        noise = NOISE * np.random.default_rng(seed).normal(size=r.size)
        e = np.empty_like(r)
        for k in range(r.size):
            y = float(C @ x)
            e[k] = r[k] - y
            wanted = memory(r[k], y + noise[k])
            total += self.rate * DT * (wanted - y - noise[k])
            x = A @ x + B * step(total)
        return e


def inverses() -> dict[str, tuple[hyst.Operator, tuple[float, float]]]:
    """Identified from one record, with the slopes of the true hysteresis behind each."""
    data = record()
    models: dict[str, hyst.Operator] = {
        name: hyst.identify(data, family=name).model for name in ("pi", "mpi")
    }
    models["gain"] = Affine(float(np.ptp(data.y) / np.ptp(data.u)))
    found = {}
    for name, model in models.items():
        inverse = model.inverse()
        turns = np.array([0.0, 0.7, -0.7, 0.5, -0.3, 0.1, -0.7, 0.7])
        v = np.interp(np.linspace(0, turns.size - 1, 20_001), np.arange(turns.size), turns)
        slope = np.diff(ACTUATOR(inverse(v))) / np.diff(v)
        low, high = np.quantile(slope, [0.01, 0.99])
        found[name] = inverse, (float(low), float(high))
    return found


def table(rate: float, bandwidth: float, found: dict[str, Any]) -> None:
    """Follow all references at a rate, Hz, by all inverses.

    Parameters
    ----------
    rate, bandwidth
        Hz.
    found
        As ``inverses`` gives it.
    """
    samples = round(1.0 / (rate * DT))
    print(f"### {rate:g} Hz, period of {samples} samples, learned up to {bandwidth:g} Hz\n")
    block = designed(samples, bandwidth, *found["pi"])
    print(f"With the inverse pi {proof_of(block, found['pi'][1]).sentence()}; ", end="")
    h, taps = block.smooth.size - 1, block.learn.size
    print(f"Q has {h + 1} entries, L {taps}, the state {block.initial_state().size} numbers.\n")
    print("| reference | inverse | " + " | ".join(f"period {k}" for k in SHOWN) + " | no memory |")
    print("|---|---|" + "---|" * (len(SHOWN) + 1))
    peer = Peer.of(1.0, samples)
    for shape, period in references(samples).items():
        r = np.tile(period, PERIODS)
        for name, (inverse, slopes) in found.items():
            block = designed(samples, bandwidth, inverse, slopes)
            _row(shape, name, *_both(block, r, samples))
        e = rms_by_period(peer.error(period, PERIODS, 1), samples)
        _row(shape, "peer", e, float("nan"))
    print()


def designed(
    samples: int, bandwidth: float, inverse: hyst.Operator, slopes: tuple[float, float]
) -> RepetitiveController:
    """Design for the mode alone: creep is among what is not known."""
    return RepetitiveController.design(
        NOMINAL, samples, dt=DT, bandwidth=2.0 * np.pi * bandwidth, uncertainty=UNKNOWN,
        slopes=slopes, delay=DT, inverse=inverse,
    )  # fmt: skip


def proof_of(block: RepetitiveController, slopes: tuple[float, float]) -> RepetitiveCertificate:
    """Certify a block around the mode."""
    return block.certificate(NOMINAL, UNKNOWN, slopes=slopes, delay=DT)


def cost(found: dict[str, Any]) -> None:
    """Time steps of the core, a record at a time, against the inverse alone."""
    y = np.random.default_rng(0).normal(size=20_000)
    inverse, slopes = found["pi"]
    block = designed(200, 1200.0, inverse, slopes)
    alone = TrackingController([], [], [], [1.0, 0.0], DT, inverse)
    limited = RepetitiveController(
        200, block.smooth, block.learn, block.lead, DT, inverse, limits=(-2.0, 2.0)
    )
    works = {
        "inverse alone": lambda: alone.run(y, y),
        "repetitive controller": lambda: block.run(y, y),
        "the same, limited": lambda: limited.run(y, y),
    }
    times = interleaved(works)
    print("| block | ns per sample | to inverse alone |\n|---|---|---|")
    for name, each in times.items():
        nanoseconds = 1e9 * float(np.median(each)) / y.size
        print(f"| {name} | {nanoseconds:.0f} | {ratio(times, name, 'inverse alone'):.1f} |")
    print()


def _both(block: RepetitiveController, r: Array, samples: int) -> tuple[Array, float]:
    common = {"plant": STAGE, "hysteresis": ACTUATOR, "delay": DT, "noise": NOISE, "seed": 1}
    run = simulate_closed_loop(r, DT, controller=block, **common)
    alone = TrackingController([], [], [], [1.0, 0.0], DT, block.inverse)
    without = simulate_closed_loop(r, DT, controller=alone, **common)
    return rms_by_period(run.e, samples), float(rms_by_period(without.e, samples)[-1])


def _row(shape: str, name: str, e: Array, alone: float) -> None:
    last = "" if np.isnan(alone) else f"{alone:.3f}"
    print(f"| {shape} | {name} | " + " | ".join(f"{e[k - 1]:.3f}" for k in SHOWN) + f" | {last} |")


def main() -> None:
    found = inverses()
    for name, (_, slopes) in found.items():
        print(f"slopes behind the inverse {name}: {slopes[0]:.2f} to {slopes[1]:.2f}")
    print()
    table(50.0, 1200.0, found)
    table(1.0, 100.0, found)
    cost(found)


if __name__ == "__main__":
    main()
