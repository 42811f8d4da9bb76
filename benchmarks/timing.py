"""Interleaved timings: what is compared runs in turn, so that a busy machine slows all alike.

What a benchmark reports by name is compared with what was recorded last; see README.md beside this.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

import numpy as np

from benchmarks.comparison import Better, Ratio

REPORTED: dict[str, Ratio] = {}


def interleaved(
    works: Mapping[str, Callable[[], object]],
    *,
    seconds: float = 1.0,
    rounds: int = 15,
    clock: Callable[[], float] = time.process_time,
) -> dict[str, list[float]]:
    """Time works in turn, at most `rounds` times each and for some `seconds` altogether.

    The clock counts the time this process had on processors, so a peer that spreads over threads is
    charged for all of them; take `time.perf_counter` to see what threads gain.
    """
    times: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        work()  # compiles, and warms the caches
    stop = time.perf_counter() + seconds
    for turn in range(rounds):
        for name, work in works.items():
            start = clock()
            work()
            times[name].append(clock() - start)
        if turn >= 2 and time.perf_counter() > stop:
            break
    return times


def ratio(times: Mapping[str, list[float]], slower: str, faster: str) -> float:
    """Median over the turns of how many times longer one took than the other."""
    return float(np.median(np.divide(times[slower], times[faster])))


def spread(times: Mapping[str, list[float]], slower: str, faster: str) -> float:
    """Half the range of the middle half of the turns' ratios, over their median."""
    low, middle, high = np.quantile(np.divide(times[slower], times[faster]), [0.25, 0.5, 0.75])
    return float((high - low) / 2.0 / middle)


def report(name: str, value: float, *, better: Better = "larger", spread: float = 0.0) -> float:
    """Hand over a ratio under a name that stays, and give it back to be printed."""
    if name in REPORTED:
        raise ValueError(f"'{name}' is reported twice; give every ratio a name of its own")
    REPORTED[name] = Ratio(float(value), float(spread), better)
    return value


def report_times(
    name: str,
    times: Mapping[str, list[float]],
    slower: str,
    faster: str,
    *,
    better: Better = "larger",
) -> float:
    """Report how many times longer one took than the other, with the spread over the turns."""
    value = ratio(times, slower, faster)
    return report(name, value, better=better, spread=spread(times, slower, faster))
