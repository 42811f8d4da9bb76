"""Jobs on a Dask cluster: the one door to dask.distributed."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterable, Iterator
from typing import Any

from hyst.errors import InputError, MissingExtraError
from hyst.fleet.running.jobs import AHEAD, Done, Job, Work

SECONDS = 8
"""To wait for a scheduler to answer, and for a first worker."""

DIED = "the workers that had it died each time, also when they had nothing else to do"


class UnreachableError(OSError):
    """A cluster that does not answer, or no longer."""


def _distributed() -> Any:
    try:
        import distributed
    except ImportError:
        raise MissingExtraError(
            "a cluster needs dask.distributed; pip install 'hyst[fleet]', or use the scheduler "
            "'processes'"
        ) from None
    return distributed


def is_client(scheduler: object) -> bool:
    """Tell a client of a cluster by its class, without loading anything."""
    return any(each.__module__.startswith("distributed.") for each in type(scheduler).__mro__)


@contextlib.contextmanager
def connected(address: str) -> Iterator[Any]:
    """Give a client of the scheduler at an address, as ``"tcp://10.0.0.1:8786"``.

    Parameters
    ----------
    address
        Its address.

    Raises
    ------
    InputError
        If it is no address.
    UnreachableError
        If nobody answers there.
    MissingExtraError
        Without dask.distributed.
    """
    distributed = _distributed()
    try:
        client = distributed.Client(address, timeout=SECONDS, set_as_default=False)
    except (OSError, TimeoutError) as error:
        raise UnreachableError(
            f"the scheduler at {address} does not answer within {SECONDS} s; start it (dask "
            "scheduler), or correct its address"
        ) from error
    except ValueError as error:
        raise InputError(f"{address!r} is no address of a scheduler: {error}") from error
    with client:
        yield client


@contextlib.contextmanager
def local_cluster(workers: int) -> Iterator[Any]:
    """Give a client of a cluster of processes on this machine, made for this run.

    Parameters
    ----------
    workers
        Processes.
    """
    distributed = _distributed()
    with (
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client


def in_cluster(client: Any, work: Work, jobs: Iterable[Job]) -> Iterator[Done]:
    """Work off jobs on the workers of a cluster; what a dead worker had goes to another one.

    A job whose workers died as often as the cluster allows is done again at the end, alone: then
    no other job can be to blame.

    Parameters
    ----------
    client
        Of the cluster.
    work
        A function that the workers have, too: it raises nothing.
    jobs
        Taken as there is room for them.

    Yields
    ------
    Done

    Raises
    ------
    UnreachableError
        If the cluster has no worker, or the scheduler goes away.
    """
    threads = _threads_of(client)
    again: list[Job] = []
    yield from _worked_off(client, work, jobs, AHEAD * threads, again)
    for job in again:
        still: list[Job] = []
        yield from _worked_off(client, work, [job], 1, still)
        if still:
            yield Done(job[0], None, DIED)


def _threads_of(client: Any) -> int:
    try:
        client.wait_for_workers(1, timeout=SECONDS)
        return max(1, int(sum(client.nthreads().values())))
    except (OSError, TimeoutError) as error:
        raise UnreachableError(
            f"the scheduler has no worker within {SECONDS} s; start some (dask worker ADDRESS)"
        ) from error


def _worked_off(
    client: Any, work: Work, jobs: Iterable[Job], most: int, died: list[Job]
) -> Iterator[Done]:
    distributed = _distributed()
    waiting, running = iter(jobs), dict[str, Job]()
    ended = distributed.as_completed(loop=client.loop)

    def take(count: int) -> None:
        for job in itertools.islice(waiting, count):
            future = client.submit(work, job[1], pure=False)
            running[future.key] = job
            ended.add(future)

    take(most)
    for future in ended:
        job = running.pop(future.key)
        if future.status == "finished":
            yield Done(job[0], future.result())
        elif future.status == "error":
            failure = future.exception()
            if isinstance(failure, distributed.KilledWorker):
                died.append(job)
            else:
                # The function raises nothing: what failed was the way to the worker or there.
                yield Done(job[0], None, f"{type(failure).__name__} at the worker: {failure}")
        else:
            raise UnreachableError("the scheduler went away; start it and run the same again")
        future.release()
        take(1)
