"""Jobs on processes of this machine; one that dies takes no other job with it."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from threadpoolctl import threadpool_limits

from hyst.fleet.running.jobs import AHEAD, Done, Job, Work

DIED = "the process that worked on it died, also when it had nothing else to do"


class NoProcessesError(RuntimeError):
    """Processes cannot be started from here, as from a script without a guard of its main part."""


def in_processes(workers: int, work: Work, jobs: Iterable[Job]) -> Iterator[Done]:
    """Work off jobs on processes that are started anew (spawn), so any system will do.

    When a process dies, what was under way is done again, each job alone: the one that kills its
    process again is given up.

    Parameters
    ----------
    workers
        Processes, at least 1.
    work
        A function of a module, called with the argument of each job; it raises nothing.
    jobs
        Taken as there is room for them.

    Yields
    ------
    Done

    Raises
    ------
    NoProcessesError
        If the first processes die and one with nothing to do dies, too.
    """
    waiting, tried = iter(jobs), False
    while True:
        suspects: list[Job] = []
        yield from _until_one_dies(workers, work, waiting, suspects)
        if not suspects:
            return
        if not tried:
            _require_processes()
            tried = True
        for name, given in suspects:
            yield _alone(name, given, work)


def _pool(workers: int) -> ProcessPoolExecutor:
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(workers, mp_context=context, initializer=_begin)


def _begin() -> None:
    """Leave an interrupt to the process that started this one, and the cores to the others."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threadpool_limits(1, user_api="blas")
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """End when the process that started this one is killed: it would wait for ever for jobs."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _until_one_dies(
    workers: int, work: Work, waiting: Iterator[Job], suspects: list[Job]
) -> Iterator[Done]:
    """Work off jobs until all are done, or a process dies: what was under way is in suspects."""
    pool = _pool(workers)
    running: dict[Future[Any], Job] = {}
    try:
        while True:
            for job in itertools.islice(waiting, AHEAD * workers - len(running)):
                running[_submitted(pool, work, job)] = job
            if not running:
                return
            for each in wait(running, return_when=FIRST_COMPLETED).done:
                job = running.pop(each)
                try:
                    yield Done(job[0], each.result())
                except BrokenProcessPool:
                    suspects.append(job)
            if suspects:
                # A result that came before the death is in no other future.
                suspects.extend(running.values())
                return
    finally:
        pool.shutdown(cancel_futures=True)


def _submitted(pool: ProcessPoolExecutor, work: Work, job: Job) -> Future[Any]:
    try:
        return pool.submit(work, job[1])
    except BrokenProcessPool as error:
        broken: Future[Any] = Future()
        broken.set_exception(error)
        return broken


def _alone(name: str, given: Any, work: Work) -> Done:
    with _pool(1) as pool:
        try:
            return Done(name, pool.submit(work, given).result())
        except BrokenProcessPool:
            return Done(name, None, DIED)


def _require_processes() -> None:
    with _pool(1) as pool:
        try:
            pool.submit(int).result()
        except BrokenProcessPool:
            raise NoProcessesError(
                "no process could be started; in a script, guard its main part with "
                "if __name__ == '__main__':"
            ) from None
