"""Work in another process, so that the page never waits and what is cancelled ends at once."""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import multiprocessing
import os
import signal
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from hyst.errors import HystError
from hyst.identification.progress import Step
from hyst.studio.work.sentences import sentence_of

_POLITE = 5
_LOOK = 0.02  # seconds between looks at what the process says


class CancelledError(HystError):
    """The user ended the work."""


class WorkError(HystError):
    """The work was refused or failed, in one sentence."""


class Worker:
    """A process that does one thing after another, and is ready for the next before it is asked.

    Parameters
    ----------
    modules
        To load at its start.
    """

    def __init__(self, modules: tuple[str, ...] = ("hyst.studio.work.jobs",)) -> None:
        self._modules = modules
        self._turn: asyncio.Lock | None = None
        self._cancelled = False
        self._start()

    async def run(
        self, job: Callable[..., Any], *given: Any, tell: Callable[[str, float], None] | None = None
    ) -> Any:
        """Do a job, after those asked for before.

        Parameters
        ----------
        job
            A function of a module; it gets what is given, and a function to tell steps.
        given
            Its arguments.
        tell
            Told the steps with the share of the way behind them.

        Raises
        ------
        WorkError
            If it was refused or failed; its text is a sentence.
        CancelledError
            If the user cancelled it.
        """
        self._turn = self._turn or asyncio.Lock()
        async with self._turn:
            self._cancelled = False
            connection = self._connection
            connection.send((job, given))
            while True:
                try:
                    while not connection.poll():
                        await asyncio.sleep(_LOOK)
                    kind, value = connection.recv()
                except (EOFError, OSError):
                    raise self._ended() from None
                if kind == "step":
                    if tell is not None:
                        tell(str(value), value.share)
                elif kind == "done":
                    return value
                else:
                    raise WorkError(value)

    def cancel(self) -> None:
        """End what is being done, at once, and be ready for the next."""
        self._cancelled = True
        self._process.kill()
        self._process.join()

    def stop(self) -> None:
        """End the process for good."""
        self._process.kill()
        self._process.join()
        self._connection.close()

    def _ended(self) -> HystError:
        self.stop()
        self._start()
        if self._cancelled:
            return CancelledError("cancelled; nothing was changed")
        return WorkError(
            "the work ended without a word, as where the memory does not suffice; choose a "
            "shorter record or a family of fewer constants"
        )

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._connection, there = context.Pipe()
        self._process = context.Process(
            target=_work, args=(there, self._modules), daemon=True, name="hyst studio work"
        )
        self._process.start()
        there.close()


def _work(connection: Connection, modules: tuple[str, ...]) -> None:
    """Do what comes through the pipe until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server ends its processes
    if hasattr(os, "nice"):
        os.nice(_POLITE)  # the page comes first
    for each in modules:
        importlib.import_module(each)
    with contextlib.suppress(EOFError, OSError, KeyboardInterrupt):
        while True:
            job, given = connection.recv()
            connection.send(_outcome(job, given, connection))


def _outcome(job: Callable[..., Any], given: tuple[Any, ...], connection: Connection) -> Any:
    last = [float("-inf")]

    def tell(step: Step) -> None:
        now = time.monotonic()
        if now - last[0] > _LOOK:  # a page shows no more
            last[0] = now
            connection.send(("step", step))

    try:
        return "done", job(*given, tell)
    except Exception as error:
        return "refused", sentence_of(error)
