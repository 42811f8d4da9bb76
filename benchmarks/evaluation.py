"""Evaluation of play banks: our engines against peers, the memory's speed and each other."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from benchmarks.comparison import Better
from benchmarks.peers import compiled, compiled_into, numpy_time_loop
from benchmarks.timing import interleaved, ratio, report, report_times
from hyst import PrandtlIshlinskii, _engine
from hyst.operators.evaluation import explain

Array = NDArray[np.float64]
Works = dict[str, Callable[[], object]]

SAMPLES = 1_000_000
OURS = "hyst"


def bank(plays: int) -> PrandtlIshlinskii:
    weights = (0.2 + np.random.default_rng(0).random(plays)) / plays
    return PrandtlIshlinskii(weights, np.arange(1, plays + 1) / (plays + 1), 0.37)


def record(kind: str, samples: int) -> Array:
    if kind == "smooth":
        return np.asarray(np.sin(2.0 * np.pi * np.arange(samples) / 1000.37))
    return np.random.default_rng(1).uniform(-1.0, 1.0, samples)


def without_allocation(model: PrandtlIshlinskii, u: Array, y: Array) -> Callable[[], object]:
    """One evaluation into an array that is there, like the stream it is compared with."""
    chain, rows, out = model._chain, u.reshape(1, -1), y.reshape(1, -1)
    return lambda: chain.run(model.initial_state().reshape(1, -1), rows, out)


def against_peers(plays: int, kind: str) -> None:
    """Ours against everybody, as a user calls them: output allocated, input checked."""
    samples = min(SAMPLES, int(2e8) // plays)
    model, u = bank(plays), record(kind, samples)
    y = np.empty_like(u)
    works: Works = {OURS: lambda: model(u)}
    if plays <= 1000:
        for name, peer in compiled().items():
            works[name] = lambda peer=peer: peer(u, model.r, model.p, model.p0)
        works["C loop"] = lambda: model.run(u, engine="loop")
    works["stream"] = lambda: np.copyto(y, u)
    times = interleaved(works, seconds=2.0)
    cells = []
    for name in works:
        if name != OURS:
            told = f"{name} over ours, {plays} plays, {kind}, {_engine.instruction_set()}"
            cells.append(f"{name} {report_times(told, times, name, OURS):.3g}")
    if plays <= 100:
        short = record(kind, 5000)
        loop: Works = {
            "loop": lambda: numpy_time_loop(short, model.r, model.p, model.p0),
            OURS: lambda: model(u),
        }
        slow = interleaved(loop, rounds=3)
        cells.append(f"NumPy loop {ratio(slow, 'loop', OURS) * samples / short.size:.0f}")
    engine = explain(model, u)[0].engine
    cost = np.median(times[OURS]) / samples * 1e9
    print(f"| {plays} | {kind} | {engine} | {cost:.3g} | {', '.join(cells)} |", flush=True)


def line(what: str, value: float, demand: str, better: Better | None = None) -> None:
    """Print a number, and report it where it is a ratio that should get better."""
    if better is not None:
        report(f"{what}, {_engine.instruction_set()}", value, better=better)
    print(f"| {what} | {value:.3g} | {demand} |", flush=True)


def stream() -> None:
    model, u = bank(10), record("smooth", SAMPLES)
    y = np.empty_like(u)
    times = interleaved({OURS: without_allocation(model, u, y), "stream": lambda: np.copyto(y, u)})
    line(
        "10 plays, smooth, over reading u and writing y once",
        ratio(times, OURS, "stream"),
        "<= 2.5",
        "smaller",
    )


def into_given_output(kind: str) -> None:
    """Without the allocation of the output, which all share and which hides what is behind it."""
    model, u = bank(10), record(kind, SAMPLES)
    y = np.empty_like(u)
    works: Works = {OURS: without_allocation(model, u, y)}
    for name, peer in compiled_into().items():
        works[name] = lambda peer=peer: peer(u, model.r, model.p, model.p0, y)
    times = interleaved(works)
    demands = {"numba": ">= 4 AVX2, 7 AVX-512", "numba fastmath": ">= 2 AVX2, 4 AVX-512"}
    for name, demand in demands.items():
        if name in works:
            what = f"{name} over ours, 10 plays, {kind}, into a given output"
            line(what, ratio(times, name, OURS), demand, "larger")


def many_plays(kind: str) -> None:
    u = record(kind, SAMPLES)
    ours: Works = {str(n): without_allocation(bank(n), u, np.empty_like(u)) for n in (1000, 10_000)}
    line(
        f"10000 plays over 1000 plays, {kind}",
        ratio(interleaved(ours, seconds=2.0), "10000", "1000"),
        "<= 3",
        "smaller",
    )


def gradient(kind: str) -> None:
    model, u = bank(10), record(kind, SAMPLES)
    target = model(u) + 0.01
    works: Works = {
        "gradient": lambda: model.loss_gradient(u, target),
        "evaluation": lambda: model(u),
        "lanes": lambda: model.run(u, engine="lanes"),
    }
    times = interleaved(works)
    line(
        f"loss gradient over one evaluation, 10 plays, {kind}",
        ratio(times, "gradient", "evaluation"),
        "<= 4",
        "smaller",
    )
    line(
        f"loss gradient over one evaluation in lanes, {kind}", ratio(times, "gradient", "lanes"), ""
    )


def threads() -> None:
    model, u = bank(10), record("rough", 10_000_000)
    works: Works = {
        "one": lambda: model.run(u, threads=1),
        "two": lambda: model.run(u, threads=2),
    }
    times = interleaved(works, seconds=3.0, clock=time.perf_counter)
    line("one thread over two, 1e7 samples (median)", ratio(times, "one", "two"), "")
    best = min(times["one"]) / min(times["two"])
    line("one thread over two, 1e7 samples (best of each)", best, ">= 1.7 on a free core", "larger")


def step() -> None:
    one_step = bank(10).stepper()
    samples = record("smooth", 100_000).tolist()

    def stepping() -> None:
        for sample in samples:
            one_step(sample)

    def nothing() -> None:
        for _ in samples:
            pass

    times = interleaved({"step": stepping, "loop": nothing})
    cost = min(times["step"]) / len(samples) * 1e9
    line("step(u) from Python with its for loop, 10 plays, ns", cost, "<= 35")
    line("the for loop alone, ns", min(times["loop"]) / len(samples) * 1e9, "")


def main() -> None:
    print(
        f"Instruction sets: {', '.join(_engine.instruction_sets())}; in use: "
        f"{_engine.instruction_set()}. Numbers after names: how many times longer they take.\n"
    )
    print("| plays | record | engine | ns/sample | times ours |\n|---|---|---|---|---|")
    for plays in (1, 10, 100, 1000, 10_000):
        for kind in ("smooth", "rough"):
            against_peers(plays, kind)
    print("\n| what | ratio | goal |\n|---|---|---|")
    stream()
    for kind in ("smooth", "rough"):
        into_given_output(kind)
        many_plays(kind)
        gradient(kind)
    threads()
    step()
    for name in _engine.instruction_sets()[1:]:
        print(
            f"\nThe same with {name}:\n\n| plays | record | engine | ns/sample | times ours |\n"
            "|---|---|---|---|---|"
        )
        _engine.use_instruction_set(name)
        for kind in ("smooth", "rough"):
            against_peers(10, kind)
        print("\n| what | ratio | goal |\n|---|---|---|")
        for kind in ("smooth", "rough"):
            into_given_output(kind)
    _engine.use_instruction_set(_engine.instruction_sets()[0])


if __name__ == "__main__":
    main()
