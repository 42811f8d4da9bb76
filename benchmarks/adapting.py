"""Scale and offset followed for any family: error frozen against adapted, coverage, time an update.

Prints, for one machine and one run,
- for each of several plants, whose gain falls by 30 % in 20 s while the offset wanders by 5 % of
  the output's range, with noise of 0.1 % of it: the prediction error of the frozen model and of the
  estimate over the last half, and the tracking error through the frozen inverse and through the
  guarded one, in percent of the range,
- the share of truths within two standard errors over 400 runs: white noise, noise that follows
  itself, noise of which a sixth of the power follows itself for 50 samples, with and without
  forgetting,
- the time of one update: of scale and offset in C, of the model besides, and from Python, each over
  that of the joint estimator of five plays.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

import hyst
from hyst.online import AdaptiveInverse, JointEstimator, ScaleEstimator
from hyst.operators import Operator

Array = NDArray[np.float64]

DT = 1e-3
SECONDS = 20.0
PLAYS = hyst.PrandtlIshlinskii([0.5, 0.3, 0.2], [0.5, 1.5, 3.0], 1.0)
BOUC_WEN = hyst.BoucWen(0.6, 0.35, 0.12, 0.06, h=-1.0)
DYNAMICS = hyst.LinearDynamics.from_transfer_function([0.2, 0.1], [1.0, -1.4, 0.7], DT)


def relays() -> hyst.Preisach:
    edges = np.linspace(-6.0, 6.0, 13)
    middle = (edges[1:] + edges[:-1]) / 2.0
    beta, alpha = np.meshgrid(middle, middle)
    weights = np.tril(np.exp(-(((alpha - beta) / 4.0 - 0.5) ** 2) - ((alpha + beta) / 6.0) ** 2))
    return hyst.Preisach(weights / weights.sum(), edges, 0.1)


PLANTS: dict[str, Operator] = {
    "Prandtl-Ishlinskii": PLAYS,
    "Bouc-Wen": BOUC_WEN,
    "Preisach": relays(),
    "Jiles-Atherton": hyst.JilesAtherton(2.0, 1.5, 1.0, 0.2, 0.3),
    "Ramberg-Osgood": hyst.RambergOsgood(1.0, 0.1, 0.8),
    "creep behind plays": hyst.Creep([0.03, 0.02], [0.05, 0.5], dt=DT) @ PLAYS,
    "rate-dependent": hyst.RateDependentPrandtlIshlinskii(
        [0.5, 0.3], [0.5, 1.5], beta=0.002, dt=DT, p0=1.0
    ),
    "resonance behind plays": DYNAMICS @ PLAYS,
}


def drift(span: float) -> tuple[Array, Array]:
    """Give gain and offset over time."""
    t = np.arange(round(SECONDS / DT)) * DT
    gain = 1.0 - 0.3 * t / SECONDS
    return np.asarray(gain), np.asarray(0.05 * span * np.sin(2.0 * np.pi * t / SECONDS))


def sine(amplitude: float) -> Array:
    t = np.arange(round(SECONDS / DT)) * DT
    return np.asarray(amplitude * np.sin(2.0 * np.pi * 5.0 * t))


def percent(error: Array, span: float) -> float:
    return 100.0 * float(np.sqrt(np.mean(error**2))) / span


def predicted(model: Operator) -> tuple[float, float]:
    """Give the prediction errors of the frozen model and of the estimate, percent of the range."""
    u = sine(5.0)
    w = model(u)
    span = float(np.ptp(w))
    gain, offset = drift(span)
    noise = 1e-3 * span * np.random.default_rng(0).standard_normal(u.size)
    y = gain * w + offset + noise
    error = ScaleEstimator(model, memory=0.2, dt=DT).run(hyst.Record(u, y, DT)).error
    half = u.size // 2
    return percent((y - w)[half:], span), percent(error[half:], span)


def tracked(model: Operator) -> tuple[float, float] | None:
    """Give the tracking errors through the frozen and the guarded inverse; None without one."""
    if not model.is_invertible():
        return None
    w = model(sine(5.0))
    span, middle = float(np.ptp(w)), float(w.max() + w.min()) / 2.0
    y_ref = middle + sine(0.3 * span)
    gain, offset = drift(span)
    scatter = 1e-3 * span * np.random.default_rng(1).standard_normal(y_ref.size)
    guarded = AdaptiveInverse(ScaleEstimator(model, memory=0.2, dt=DT))
    frozen, plants = model.inverse().stepper(), (model.stepper(), model.stepper())
    ways: tuple[Callable[[float], float], ...] = (frozen, guarded.command)
    errors = np.zeros((2, y_ref.size))
    for k, wanted in enumerate(y_ref.tolist()):
        for way, command in enumerate(ways):
            u = command(wanted)
            y = gain[k] * plants[way](u) + offset[k]
            errors[way, k] = y - wanted
            if way == 1:
                guarded.update(u, y + scatter[k])
    half = y_ref.size // 2
    return percent(errors[0, half:], span), percent(errors[1, half:], span)


def errors_by_plant() -> None:
    print("percent of the range      predicted: frozen  adapted   tracked: frozen  adapted")
    for name, model in PLANTS.items():
        one, other = predicted(model), tracked(model)
        last = "   no exact inverse" if other is None else f"{other[0]:18.2f} {other[1]:8.2f}"
        print(f"{name:25s} {one[0]:17.2f} {one[1]:8.2f}{last}")


def noise_of(kind: str, white: Array, rng: np.random.Generator) -> Array:
    if kind == "white":
        return white
    if kind == "follows itself":
        return np.asarray(lfilter([math.sqrt(1.0 - 0.9**2)], [1.0, -0.9], white))
    slow = lfilter([math.sqrt(1.0 - 0.98**2)], [1.0, -0.98], rng.standard_normal(white.size))
    return np.asarray(math.sqrt(5.0 / 6.0) * white + math.sqrt(1.0 / 6.0) * slow)


def coverage(runs: int = 400, samples: int = 3000) -> None:
    print("within two standard errors   memory     scale  offset   standard errors over scatter")
    for kind in ("white", "follows itself", "below the noise"):
        for memory in (math.inf, 400.0):
            rng = np.random.default_rng(5)
            found, errors = np.empty((runs, 2)), np.empty((runs, 2))
            for run in range(runs):
                period, phase = rng.uniform(40.0, 400.0), rng.uniform(0.0, 6.0)
                u = 8.0 * np.sin(2.0 * np.pi * np.arange(samples) / period + phase)
                truth = np.array([rng.uniform(0.7, 1.4), rng.uniform(-2.0, 2.0)])
                noise = noise_of(kind, rng.standard_normal(samples), rng)
                y = truth[0] * BOUC_WEN(u) + truth[1] + 0.2 * noise
                estimator = ScaleEstimator(BOUC_WEN, memory=memory)
                estimator.run(hyst.Record(u, y, 1.0), samples)
                found[run] = estimator.parameters - truth
                errors[run] = estimator.standard_errors
            share = (np.abs(found) < 2.0 * errors).mean(axis=0)
            size = np.sqrt((errors**2).mean(axis=0) / (found**2).mean(axis=0))
            print(
                f"{kind:28s} {memory:6g} {share[0]:9.3f} {share[1]:7.3f} {size[0]:15.2f} "
                f"{size[1]:5.2f}"
            )


def nanoseconds(work: Callable[[], object], samples: int) -> float:
    best = math.inf
    for _ in range(5):
        begin = time.process_time()
        work()
        best = min(best, time.process_time() - begin)
    return 1e9 * best / samples


def update_all(guarded: AdaptiveInverse, samples: list[tuple[float, float]]) -> None:
    for each in samples:
        guarded.update(*each)


def cost() -> None:
    samples = 100_000
    u = 8.0 * np.sin(2.0 * np.pi * np.arange(samples) / 200.0)
    record = hyst.Record(u, 1.2 * BOUC_WEN(u) + 0.1, DT)
    scale = ScaleEstimator(BOUC_WEN, dt=DT, memory=1.0)
    p = np.array([0.3, 0.5, 0.8, 0.3, 0.2])
    joint = JointEstimator(
        hyst.PrandtlIshlinskii(p, [0.4, 1.0, 1.5, 2.0, 3.6]), dt=DT, memory=1.0, search=False
    )
    model = nanoseconds(lambda: BOUC_WEN.run(u, engine="loop"), samples)
    core, state, w = scale.core, scale.state.copy(), BOUC_WEN(u)
    theta, error = np.empty((1, 2)), np.empty(samples)
    alone = nanoseconds(
        lambda: core.run(state, w, record.y, samples, theta, theta.copy(), error), samples
    )
    both = nanoseconds(lambda: scale.run(record, samples), samples)
    of_joint = nanoseconds(lambda: joint.run(record, samples), samples)
    some = list(zip(u[:20_000].tolist(), record.y[:20_000].tolist(), strict=True))
    python = nanoseconds(lambda: [scale.update(*each) for each in some], len(some))
    guarded = AdaptiveInverse(ScaleEstimator(BOUC_WEN, dt=DT, memory=1.0))
    guard = nanoseconds(lambda: update_all(guarded, some), len(some))
    command = nanoseconds(lambda: [guarded.command(each[1]) for each in some], len(some))
    print("CPU time, ns an update                       over the joint one of five plays")
    for what, value in (
        ("scale and offset alone, in C", alone),
        ("the model (Bouc-Wen) alone, in C", model),
        ("model, its inverse's memory and both, in C", both),
        ("the same from Python", python),
        ("under the guard, from Python", guard),
        ("a command, from Python", command),
        ("joint estimator of five plays, in C", of_joint),
    ):
        print(f"{what:44s} {value:8.0f} {value / of_joint:10.2f}")
    print(f"bytes of state: {scale.state.nbytes}, and the memory of the model and its inverse")


def main() -> None:
    errors_by_plant()
    print()
    coverage()
    print()
    cost()


if __name__ == "__main__":
    main()
