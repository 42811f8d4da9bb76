"""From what was asked for to a scheduler."""

from __future__ import annotations

import contextlib
import functools
import os
from collections.abc import Iterator
from typing import Any

from hyst.checks.numbers import whole_number
from hyst.errors import InputError
from hyst.fleet.running.cluster import connected, in_cluster, is_client, local_cluster
from hyst.fleet.running.jobs import Run
from hyst.fleet.running.processes import in_processes
from hyst.fleet.running.threads import in_threads

THREADS, PROCESSES, DASK = "threads", "processes", "dask"


def cores() -> int:
    """Give the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextlib.contextmanager
def running_on(scheduler: Any, workers: int | None) -> Iterator[Run]:
    """Give a scheduler, and take down afterwards what was made for it.

    Parameters
    ----------
    scheduler
        ``"threads"``, ``"processes"``, ``"dask"``, an address or a client of a Dask cluster.
    workers
        Threads or processes; as many as there are cores if None.

    Raises
    ------
    InputError
        If it is none of these.
    """
    count = cores() if workers is None else whole_number(workers, "workers", 1)
    if scheduler == THREADS:
        yield functools.partial(in_threads, count)
    elif scheduler == PROCESSES:
        yield functools.partial(in_processes, count)
    elif scheduler == DASK:
        with local_cluster(count) as client:
            yield functools.partial(in_cluster, client)
    elif isinstance(scheduler, str) and "://" in scheduler:
        with connected(scheduler) as client:
            yield functools.partial(in_cluster, client)
    elif is_client(scheduler):
        yield functools.partial(in_cluster, scheduler)
    else:
        raise InputError(
            f"the scheduler is {scheduler!r}; give threads, processes, dask, an address as "
            "tcp://HOST:8786, or a client of dask.distributed"
        )
