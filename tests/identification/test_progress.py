"""What an identification says of itself on its way, and that saying no ends it."""

import pickle
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from threadpoolctl import threadpool_info

import hyst
from hyst.identification.progress import Progress, Step

TRUE = hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.1, 0.3], p0=1.0)


class CancelledError(Exception):
    """What a user's program may raise."""


def record() -> hyst.Record:
    u = np.sin(np.linspace(0.0, 20.0, 600)) * np.linspace(1.0, 0.4, 600)
    return hyst.Record(u, TRUE(u), dt=1e-3)


def identify(progress: object) -> hyst.Identified:
    return hyst.identify(record(), family="pi,gpi", progress=progress)  # type: ignore[arg-type]


def test_steps_are_words_in_the_order_of_the_work() -> None:
    steps: list[Step] = []
    identify(steps.append)
    stages = [each.partition(":")[0].partition(" with ")[0] for each in steps]
    assert list(dict.fromkeys(stages)) == [
        "diagnosis",
        "delay",
        "pi",
        "gpi",
        "final fit",
        "verdict",
    ]


def test_shares_go_from_nothing_up_to_the_verdict_and_never_back() -> None:
    steps: list[Step] = []
    identify(steps.append)
    shares = [each.share for each in steps]
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    assert 0.9 < shares[-1] < 1.0


def test_the_second_of_two_families_begins_in_the_middle_of_the_comparison() -> None:
    steps: list[Step] = []
    identify(steps.append)
    first = {each.partition(" with ")[0]: each.share for each in reversed(steps)}
    # The comparison lies between 0.1 and 0.6.
    assert first["pi"] == pytest.approx(0.1)
    assert first["gpi"] == pytest.approx(0.35)


def test_progress_changes_no_number() -> None:
    told, untold = identify(lambda step: None), identify(None)
    assert told.parameter_values.tolist() == untold.parameter_values.tolist()


def test_what_a_callback_raises_at_any_step_reaches_the_caller_and_leaves_nothing_behind() -> None:
    steps: list[Step] = []
    whole = identify(steps.append)
    blas = [each["num_threads"] for each in threadpool_info()]
    for last in range(0, len(steps), 3):

        def stop(step: Step, last: int = last) -> None:
            if step == steps[last] and step.share == steps[last].share:
                raise CancelledError(step)

        with pytest.raises(CancelledError, match=steps[last].split("(")[0]):
            identify(stop)
    assert [each["num_threads"] for each in threadpool_info()] == blas
    again = identify(None)
    assert again.parameter_values.tolist() == whole.parameter_values.tolist()


def test_fit_and_schedules_tell_shares_too() -> None:
    fit, schedule = list[Step](), list[Step]()
    hyst.fit(TRUE, record(), progress=fit.append)
    assert [(str(each), each.share) for each in fit] == [
        ("diagnosis", 0.0),
        ("fit", 0.1),
        ("verdict", 0.95),
    ]
    hyst.identify_scheduled(
        [record(), record()], [20.0, 40.0], family="pi", plays=2, progress=schedule.append
    )
    shares = [each.share for each in schedule]
    assert shares == sorted(shares)
    assert schedule[-1] == "fit at all values"


@dataclass(frozen=True)
class Stream:
    """A record longer than what is searched in memory, made anew whenever it is read."""

    dt: float = 1e-3
    u_unit: str = "V"
    y_unit: str = "um"

    def __len__(self) -> int:
        return 600_000

    def chunks(self, samples: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        k = np.arange(len(self))
        u = np.sin(k / 100) * (1.0 - k / 1e6)
        y = TRUE(u) + 1e-3 * np.cos(1e4 * u)
        for begin in range(0, len(self), samples):
            yield u[begin : begin + samples], y[begin : begin + samples]


def test_a_record_in_a_file_tells_when_all_its_samples_are_fitted() -> None:
    steps: list[Step] = []

    def stop(step: Step) -> None:
        steps.append(step)
        if step.startswith("fit to all"):
            raise CancelledError(step)

    with pytest.raises(CancelledError, match="fit to all 600000 samples"):
        hyst.identify(Stream(), family="linear", delay=0, creep=None, drift=False, progress=stop)
    assert max(each.share for each in steps) == steps[-1].share == 0.5


def test_a_part_of_a_part_lies_between_its_shares() -> None:
    told: list[Step] = []
    part = Progress(told.append).part(0.2, 0.6, "20 C: ").part(0.5, 1.0)
    part("halfway", 0.5)
    assert told == ["20 C: halfway"]
    assert told[0].share == pytest.approx(0.5)  # 0.2 + 0.4 (0.5 + 0.5 / 2)


def test_a_step_goes_from_process_to_process_with_its_share() -> None:
    step = pickle.loads(pickle.dumps(Step("delay", 0.05)))
    assert (step, step.share) == ("delay", 0.05)
