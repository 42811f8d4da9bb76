"""Move the memory of a block to that of an actuator whose drive went through given values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from hyst import _engine, _single
from hyst.errors import InputError
from hyst.export.c.core_stage import CoreStage, stages_as_core
from hyst.export.c.numbers import Precision
from hyst.export.c.stage_code import StageCode
from hyst.operators.stage import Stage

Memory = tuple[float, ...]
Moved = Callable[[Memory, Sequence[float], float, Precision], tuple[Memory, float]]


@final
@dataclass(frozen=True)
class Passed:
    """Stages that the drive passes, one after the other.

    Parameters
    ----------
    stages
        As the operator has them.
    first
        Place of the first one among the stages of the block's C.
    place
        Of their memory in that of the block; None if it is needed for the start alone.
    start
        Their memory before the first sample, where it is needed for the start alone.
    call
        C that takes the place of the call of the one stage there is; "" for that of its kind.
    """

    stages: tuple[Stage, ...]
    first: int
    place: int | None
    start: Memory = ()
    call: str = ""

    def statements(self, code: StageCode) -> str:
        """Give C that takes ``v`` through them."""
        if self.call:
            place = f"memory + {self.place}" if self.place else "memory"
            return code.call(self.first, self.call, "v", place)
        only = range(self.first, self.first + len(stages_as_core(self.stages)))
        memory = "actuator" if self.place is None else "memory"
        return code.calls("v", memory, only, apart=self.place is None)


@final
@dataclass(frozen=True)
class Following:
    """What moves the memory, and what is answered afterwards.

    Parameters
    ----------
    passed
        From the drive on.
    last
        Place of the last drive in the memory; None if it is not kept.
    answers
        "drive", or "signal" for what the last of ``passed`` gives.
    statements
        C that takes a drive in ``v`` through them.
    prepared
        C before the first drive that takes the constants at a second signal: declarations, and
        statements; empty where there is none.
    moved
        What gives memory and answer after drives at a second signal; None where there is none.
    """

    passed: tuple[Passed, ...]
    last: int | None
    answers: str
    statements: str
    prepared: tuple[str, str] = ("", "")
    moved: Moved | None = None

    @classmethod
    def of(
        cls,
        code: StageCode,
        passed: Sequence[Passed],
        last: int | None = None,
        answers: Literal["drive", "signal"] = "drive",
        prepared: tuple[str, str] = ("", ""),
        moved: Moved | None = None,
    ) -> Following:
        """Write the C of it.

        Parameters
        ----------
        code
            It has the constants.
        passed, last, answers, prepared, moved
            As the fields.
        """
        statements = "".join(each.statements(code).rstrip("\n") + "\n" for each in passed)
        return cls(tuple(passed), last, answers, statements, prepared, moved)

    @property
    def apart(self) -> Memory:
        """Memory that is needed for the start alone, before the first drive."""
        return tuple(value for each in self.passed if each.place is None for value in each.start)

    def after(
        self,
        memory: Memory,
        drives: Sequence[float],
        precision: Precision,
        second: float | None = None,
    ) -> tuple[Memory, float]:
        """Give the memory and the answer after an actuator's ``drives``, in time order.

        Parameters
        ----------
        memory
            Before them.
        drives
            At least one, numbers of the target.
        precision
            Of the target.
        second
            The second signal meanwhile, where there is one.

        Raises
        ------
        InputError
            If one of them overflows on its way.
        """
        if self.moved is not None and second is not None:
            return self.moved(memory, drives, second, precision)
        moved = np.array(memory, dtype=np.float64)
        signal = np.array(drives, dtype=np.float64)
        for each in self.passed:
            start = each.start if each.place is None else moved[each.place :].tolist()
            signal, end = _run(each.stages, start, signal, precision)
            _require_finite(signal, drives)
            if each.place is not None:
                moved[each.place : each.place + end.size] = end
        if self.last is not None:
            moved[self.last] = drives[-1]
        answer = float(signal[-1]) if self.answers == "signal" else float(drives[-1])
        return tuple(moved.tolist()), answer


def _run(
    stages: tuple[Stage, ...], start: Sequence[float], signal: np.ndarray, precision: Precision
) -> tuple[np.ndarray, np.ndarray]:
    chain = _engine.Chain(stages)
    memory = np.array(start[: chain.state_length], dtype=np.float64)
    if precision == "double":
        y, ends = np.empty((1, signal.size)), memory[None, :].copy()
        bad = chain.run(ends, signal[None, :].copy(), y)
        if bad >= 0:
            y[0, bad:] = np.nan
        return y[0], ends[0]
    step = _single.Stepper([told(each) for each in stages_as_core(stages)], memory.tolist())
    y = np.array([step(float(each)) if not step.fault else np.nan for each in signal])
    return np.where(step.fault, np.nan, y), np.array(step.state)


def _require_finite(signal: np.ndarray, drives: Sequence[float]) -> None:
    if not np.isfinite(signal).all():
        raise overflows(drives, int(np.argmin(np.isfinite(signal))))


def overflows(drives: Sequence[float], k: int) -> InputError:
    """Give the error that the ``drives`` of a history cannot be followed, for that at ``k``."""
    return InputError(
        f"the history cannot be followed: {drives[k]:.6g}, value {k + 1} of it, overflows in "
        "the model; give drives that the actuator can have had"
    )


def told(stage: CoreStage) -> tuple[str, str, dict[str, float], dict[str, Memory], dict[str, int]]:
    """Give a ``stage`` as the twin in single precision takes it."""
    choices = {**stage.choices, **({"inside": stage.inside} if stage.inside else {})}
    return stage.kind, stage.form, dict(stage.numbers), dict(stage.tables), choices
