"""Interleaved timings: what is compared runs in turn, so that a busy machine slows all alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

import numpy as np


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
