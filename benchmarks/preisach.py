"""Preisach 40 x 40: a sample in times of ten plays in numba, forwards and backwards.

Prints, for one machine and one run, on a smooth input (20 periods of two sines), on a rough one
(white noise) and on a nested one (a hundred times a hundred ever smaller loops),
- the time of a sample through the model and through its inverse, beside numba's loop of ten plays
  on the same input,
- the ratios that have goals: 6 on smooth input, 24 on rough, the inverse 6 of its own forward;
and the time of the Jacobian by 821 parameters.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks import peers
from benchmarks.timing import interleaved, report_times

SAMPLES = 400_000
CELLS = 40

Array = NDArray[np.float64]


def main() -> None:
    """Print all tables."""
    for spacing in ("even", "uneven"):
        for name, u in records().items():
            print_record(spacing, name, u)
    print_jacobian()


def model(spacing: str) -> hyst.Preisach:
    """Give a smooth density on 40 x 40 cells with a small linear part."""
    edges = np.linspace(-1.0, 1.0, CELLS + 1)
    if spacing == "uneven":
        edges = np.sign(edges) * np.abs(edges) ** 1.5
    centre = 0.5 * (edges[1:] + edges[:-1])
    alpha, beta = centre[:, None], centre[None, :]
    density = np.exp(-2.0 * (alpha - beta - 0.3) ** 2 - 3.0 * (alpha + beta) ** 2)
    weights = np.tril(density * np.outer(np.diff(edges), np.diff(edges)))
    return hyst.Preisach(weights / weights.sum(), edges, p0=0.05)


def records() -> dict[str, Array]:
    """Give the inputs, within the thresholds."""
    time = np.linspace(0.0, 1.0, SAMPLES)
    smooth = 0.6 * np.sin(40.0 * np.pi * time) + 0.35 * np.sin(17.0 * np.pi * time)
    rough = np.random.default_rng(0).uniform(-0.95, 0.95, SAMPLES)
    nested = 0.95 * (1.0 - (100.0 * time) % 1.0) * np.sin(2e4 * np.pi * time)
    return {"smooth": smooth, "rough": rough, "nested": nested}


def print_record(spacing: str, name: str, u: Array) -> None:
    """Print nanoseconds a sample and the ratios."""
    relays = model(spacing)
    inverse, y = relays.inverse(), relays(u)
    r, p = np.linspace(0.05, 0.9, 10), np.full(10, 0.1)
    works = {"forward": lambda: relays(u), "inverse": lambda: inverse(y)}
    numba = peers.compiled().get("numba")
    if numba is not None:
        works["numba, ten plays"] = lambda: numba(u, r, p, 1.0)
    times = interleaved(works, seconds=4.0)
    each = ", ".join(
        f"{work} {1e9 * float(np.median(spent)) / SAMPLES:.1f}" for work, spent in times.items()
    )
    print(f"{spacing} thresholds, {name} input, ns a sample: {each}")
    pairs = [("inverse", "forward")]
    if numba is not None:
        pairs += [("forward", "numba, ten plays"), ("inverse", "numba, ten plays")]
    for work, other in pairs:
        told = f"{work} over {other}, {spacing}, {name}"
        over = report_times(told, times, work, other, better="smaller")
        print(f"  {work} / {other} {over:.2f}")


def print_jacobian() -> None:
    """Print the time of the Jacobian by all masses."""
    relays, u = model("even"), records()["smooth"][::200]
    works = {"jacobian": lambda: relays.jacobian(u), "forward": lambda: relays(u)}
    times = interleaved(works, seconds=2.0)
    for work, spent in times.items():
        print(f"{u.size} samples, {work} {1e3 * float(np.median(spent)):.3g} ms")


if __name__ == "__main__":
    main()
