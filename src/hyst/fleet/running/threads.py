"""Jobs on threads of this process."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Any

from hyst.fleet.running.jobs import AHEAD, Done, Job, Work


def in_threads(workers: int, work: Work, jobs: Iterable[Job]) -> Iterator[Done]:
    """Work off jobs on threads.

    Parameters
    ----------
    workers
        Threads, at least 1.
    work
        Called with the argument of each job; it raises nothing.
    jobs
        Taken as there is room for them.

    Yields
    ------
    Done
    """
    waiting = iter(jobs)
    pool = ThreadPoolExecutor(workers)
    running: dict[Future[Any], str] = {}
    try:
        while True:
            for name, given in itertools.islice(waiting, AHEAD * workers - len(running)):
                running[pool.submit(work, given)] = name
            if not running:
                return
            for each in wait(running, return_when=FIRST_COMPLETED).done:
                yield Done(running.pop(each), each.result())
    finally:
        pool.shutdown(cancel_futures=True)
