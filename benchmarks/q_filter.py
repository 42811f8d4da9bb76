"""What order and freedom of a Q-filter buy on the repaired example of S1, and at what noise.

    python -m benchmarks q_filter

Prints, for one machine and one run,
- the rows of "no observer", textbook filters 1/(tau s + 1)^n, the paper's observer with its best
  gain, and free filters of given order and relative degree with a bounded noise gain,
- the processor time of each, and of the rows that a report takes,
- the sampled block: the continuous design sampled, against a design for the sampled plant,
- on random stable plants, with weights and controllers at random: the norm of the textbook filter
  over that of the paper's observer with its best gain.

HYST_Q_FILTER_CASES shortens the last. Norms are computed from Q alone, the same way for all rows.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.observer import random_problem
from hyst.control import (
    TrackingController,
    compare_designs,
    design_disturbance_observer,
    design_q_filter,
    design_sampled_q_filter,
    sampled_certificate,
)
from hyst.control.q_filters import DesignRow, row_of, table_of
from hyst.control.q_filters.comparison import without_observer
from hyst.control.q_filters.problem import q_filter_problem

OMEGA = 2.0 * np.pi * 90.0
PLANT = ([OMEGA**2], [1.0, 1.6 * OMEGA, OMEGA**2])
WU = ([-1.0, -960.0, 0.0], [1.0, 960.0, 2400.0**2])
WP = ([0.5, 64.0 * np.pi], [1.0, 0.2])
PROBLEM = (PLANT, ([4.0, 8.0], [1.0, 0.0]), WU, WP)


def timed(make: Callable[[], Any]) -> tuple[Any, float]:
    begin = time.process_time()
    made = make()
    return made, time.process_time() - begin


def rows_of_the_example() -> list[tuple[DesignRow, float]]:
    found = [(without_observer(q_filter_problem(*PROBLEM)), 0.0)]
    for order in (2, 3, 4, 5):
        design, seconds = timed(lambda order=order: design_q_filter(*PROBLEM, order))
        found.append((row_of(design.name, design), seconds))
    paper, seconds = timed(lambda: design_disturbance_observer(*PROBLEM))
    found.append((row_of("paper's observer", paper), seconds))
    for order, degree, noise, objective in (
        (3, 3, 1.5, "stacked"),
        (3, 2, 1.0, "stacked"),
        (3, 2, 1.38, "stacked"),
        (4, 3, 1.38, "stacked"),
        (4, 2, 1.05, "stacked"),
        (4, 2, 1.38, "stacked"),
        (4, 2, 1.478, "stacked"),
        (5, 2, 29.0, "stacked"),
        (3, 2, 1.5, "robust"),
        (4, 2, 1.5, "robust"),
        (4, 2, 3.0, "robust"),
        (4, 2, 5.0, "robust"),
        (5, 2, 1.5, "robust"),
    ):
        options = {"family": "free", "most_noise": noise, "objective": objective}
        design, seconds = timed(
            lambda order=order, degree=degree, options=options: design_q_filter(
                *PROBLEM, order, degree, **options
            )
        )
        name = f"{objective}, free {order} - {degree}, noise {noise}"
        found.append((row_of(name, design), seconds))
    return found


def sampled() -> None:
    print("\nsampled:  dt, delay         continuous design    design of the sampled plant")
    continuous = design_q_filter(*PROBLEM)
    for dt, delay in ((2e-5, 0.0), (1e-4, 0.0), (1e-4, 1e-4), (1e-4, 1.5e-4), (8e-4, 0.0)):
        block = TrackingController.from_continuous(PROBLEM[1], dt, observer=continuous)
        as_it_is = sampled_certificate(block, PLANT, WU, WP, delay=delay)
        design = design_sampled_q_filter(*PROBLEM, dt, delay=delay)
        print(
            f"{dt:>10g} {delay:>10g} {as_it_is.stacked_norm:>20.4f} {design.gamma:>20.4f}, "
            f"noise to v {as_it_is.noise_gain:.3g} and {design.certificate.noise_gain:.3g}"
        )


def random_plants(cases: int) -> None:
    rng = np.random.default_rng(7)
    ratios, noise = [], []
    for _ in range(cases):
        p = random_problem(rng)
        systems = (p.plant, p.controller, p.Wu, p.Wp)
        paper = row_of("", design_disturbance_observer(*systems))
        tried = [row_of("", design_q_filter(*systems, order)) for order in (None, "auto")]
        ratios.append([each.stacked_norm / paper.stacked_norm for each in tried])
        noise.append([each.noise_gain / paper.noise_gain for each in tried])
    print(f"\n{cases} random plants, over the paper's observer (least, median, 9 in 10, most):")
    for i, name in enumerate(("one above the least order", "order at best, to three more")):
        told = np.quantile(np.array(ratios)[:, i], [0.0, 0.5, 0.9, 1.0])
        loud = np.quantile(np.array(noise)[:, i], [0.0, 0.5, 0.9, 1.0])
        print(f"{name:<30} norm " + " ".join(f"{each:.3f}" for each in told), end="")
        print("   noise to v " + " ".join(f"{each:.3g}" for each in loud) + "")


def main() -> None:
    rows = rows_of_the_example()
    lines = table_of(tuple(row for row, _ in rows)).splitlines()
    print(lines[0] + f"{'seconds':>11}")
    for line, (_, seconds) in zip(lines[1:], rows, strict=True):
        print(line + f"{seconds:>11.2f}")
    _, seconds = timed(lambda: compare_designs(*PROBLEM))
    print(f"\nrows of a report (no observer, classical, one more order): {seconds:.2f} s")
    sampled()
    random_plants(int(os.environ.get("HYST_Q_FILTER_CASES", "20")))
