"""Work in another process: steps, refusals, cancelling, and processes that die."""

import asyncio
import os
import signal
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import hyst
from hyst.identification.progress import Step
from hyst.studio.work.worker import CancelledError, Worker, WorkError


def add(a: int, b: int, tell: Callable[[Step], None]) -> int:
    tell(Step("adding", 0.5))
    return a + b


def refuse(tell: Callable[[Step], None]) -> None:
    raise hyst.InputError("this will not do;\n give repair=True")


def fail(tell: Callable[[Step], None]) -> None:
    raise KeyError("inside")


def wait(tell: Callable[[Step], None]) -> None:
    tell(Step("waiting", 0.1))
    time.sleep(60.0)


def die(tell: Callable[[Step], None]) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.fixture(scope="module")
def worker() -> Iterator[Worker]:
    made = Worker(modules=())
    yield made
    made.stop()


def run(worker: Worker, job: Any, *given: Any, **more: Any) -> Any:
    worker._turn = None  # of the loop of another test
    return asyncio.run(worker.run(job, *given, **more))


def test_results_and_steps_come_back(worker: Worker) -> None:
    told: list[tuple[str, float]] = []
    assert run(worker, add, 2, 3, tell=lambda *step: told.append(step)) == 5
    assert told == [("adding", 0.5)]


def test_a_refusal_is_one_sentence_in_the_words_of_the_page(worker: Worker) -> None:
    with pytest.raises(WorkError, match=r"^this will not do; give the box “Repair”$"):
        run(worker, refuse)


def test_a_fault_of_hyst_is_a_sentence_too(worker: Worker) -> None:
    with pytest.raises(WorkError, match=r"^hyst itself failed, KeyError: 'inside'; report it"):
        run(worker, fail)


def test_what_is_cancelled_ends_at_once_and_the_next_is_done(worker: Worker) -> None:
    async def cancelled() -> Any:
        return await worker.run(wait, tell=lambda *step: worker.cancel())

    worker._turn = None
    with pytest.raises(CancelledError, match="nothing was changed"):
        asyncio.run(cancelled())
    assert run(worker, add, 1, 1) == 2


def test_a_process_that_dies_is_told_and_replaced(worker: Worker) -> None:
    with pytest.raises(WorkError, match="memory"):
        run(worker, die)
    assert run(worker, add, 1, 1) == 2
