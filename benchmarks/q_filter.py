"""What order and freedom of a Q-filter buy on the repaired example of S1, and at what noise.

    python -m benchmarks q_filter

Prints, for one machine and one run,
- the rows of "no observer", textbook filters 1/(tau s + 1)^n, the paper's observer with its best
  gain, and free filters of given order and relative degree with a bounded noise gain,
- the processor time of each, and of the rows that a report takes.

Every norm is computed from Q alone, the same way for all rows.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from hyst.control import compare_designs, design_disturbance_observer, design_q_filter
from hyst.control.q_filter import DesignRow, row_of, table_of
from hyst.control.q_filter.comparison import without_observer
from hyst.control.q_filter.problem import q_filter_problem

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
    for order, degree, noise in (
        (3, 3, 1.5),
        (3, 2, 1.0),
        (3, 2, 1.38),
        (4, 3, 1.38),
        (4, 2, 1.05),
        (4, 2, 1.38),
        (4, 2, 1.478),
        (5, 2, 29.0),
    ):
        design, seconds = timed(
            lambda order=order, degree=degree, noise=noise: design_q_filter(
                *PROBLEM, order, degree, family="free", most_noise=noise
            )
        )
        found.append((row_of(f"free, order {order} - {degree}, noise {noise}", design), seconds))
    return found


def main() -> None:
    rows = rows_of_the_example()
    lines = table_of(tuple(row for row, _ in rows)).splitlines()
    print(lines[0] + f"{'seconds':>11}")
    for line, (_, seconds) in zip(lines[1:], rows, strict=True):
        print(line + f"{seconds:>11.2f}")
    _, seconds = timed(lambda: compare_designs(*PROBLEM))
    print(f"\nrows of a report (no observer, classical, one more order): {seconds:.2f} s")
