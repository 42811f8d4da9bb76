"""A block: signals, memory, and the C that takes one sample."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hyst import _single
from hyst.export.c.core_stage import CoreStage
from hyst.export.c.drive_range import DriveRange
from hyst.export.c.following import Following, told
from hyst.export.c.numbers import Precision
from hyst.export.c.stage_code import StageCode
from hyst.operators import Operator

Array = NDArray[np.float64]
Memory = tuple[float, ...]


@final
@dataclass(frozen=True)
class Block:
    """Something that gives one number for every sample.

    Parameters
    ----------
    kind
        Of the model, for people.
    inputs
        Names of the signals it takes, as C has them.
    output
        Name of the signal it gives.
    head
        C declarations of constants for the head of the file.
    body
        C statements that take the inputs and leave the output in ``signal``.
    signal
        The variable they leave it in.
    headers
        Of the core, that they need.
    start
        Memory before the first sample.
    dt
        Sample time, seconds; None if any will do.
    model
        Plain data that say all there is to know of the model.
    stages
        What the statements take a sample through.
    chain
        What a signal passes, for the choice of a test signal.
    stepper
        Makes of a memory a function that gives the same numbers in Python, in double.
    single_stepper
        The same in single, for what is no chain of stages.
    is_estimator
        Whether it takes in samples and gives commands instead of one output a sample.
    more
        What else the templates of an estimator need.
    second
        Values of a second signal for the self-test; empty where there is none.
    second_meaning
        Its name and unit.
    schedule
        Its lowest and its highest value at which the constants are known.
    faults
        C that defines further bits of the fault.
    written
        Makes the body anew of the stages' C, for constants in another place; where the body is not
        one call of the stages after the other.
    source_template
        Of the source file, where it is another one than that of its header.
    forgets
        Numbers at the start of the memory that its reset makes 0; none has no reset.
    tells
        Bits of the fault, without the prefix, that no bad sample raises.
    drive
        What the actuator's drive may be, and which signal it is.
    rest
        The answer before the first sample.
    following
        What moves the memory to that of an actuator with a history; None where nothing can.
    no_start
        Why nothing can.
    before
        Memory and answer before the history that ``start`` comes after; None without a history.
    history
        The drives the memory comes after.
    history_at
        The second signal meanwhile; None where there is none.
    tested
        Lowest and highest input of the self-test; None for that of the record, or what passes all.
    codes
        The ``DriverCodes`` of a driver that is commanded in codes; None without one.
    """

    kind: str
    inputs: tuple[str, ...]
    output: str
    head: str
    body: str
    signal: str
    headers: tuple[str, ...]
    start: tuple[float, ...]
    dt: float | None
    model: dict[str, Any]
    stages: tuple[CoreStage, ...]
    chain: Operator
    stepper: Callable[[Array], Callable[..., float]]
    single_stepper: Callable[[Memory], Callable[..., float]] | None = None
    is_estimator: bool = False
    more: Mapping[str, str] = field(default_factory=dict)
    second: tuple[float, ...] = ()
    second_meaning: tuple[str, str] = ("", "")
    schedule: tuple[float, float] = (0.0, 0.0)
    faults: str = ""
    written: Callable[[StageCode], str] | None = None
    source_template: str = ""
    forgets: int = 0
    tells: tuple[str, ...] = ()
    drive: DriveRange = field(default_factory=DriveRange)
    rest: float = 0.0
    following: Following | None = None
    no_start: str = ""
    before: tuple[Memory, float] | None = None
    history: Memory = ()
    history_at: float | None = None
    tested: tuple[float, float] | None = None
    codes: Any = None

    @property
    def limits(self) -> tuple[float, float] | None:
        """Lowest and highest output, in numbers of the target, where the output is a drive."""
        return self.drive.limits if self.drive.side == "output" else None

    @property
    def virgin(self) -> tuple[Memory, float]:
        """Memory and answer before any history."""
        return (self.start, self.rest) if self.before is None else self.before

    def sha256(self) -> str:
        """Give the hash of the model."""
        text = json.dumps(self.model, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    def identity(self, precision: Precision) -> int:
        """Give the number above 0 that marks the states of this model in a ``precision``."""
        digest = hashlib.sha256(f"hyst state 1 {precision} {self.sha256()}".encode()).digest()
        return int.from_bytes(digest[:4], "big") or 1


def stepper_of(block: Block, precision: Precision) -> Callable[..., float]:
    """Give what takes one sample at a time with the numbers of a target.

    Parameters
    ----------
    block
        What is exported.
    precision
        Of the target.

    Returns
    -------
    callable
        From the inputs to the output, guarded, from the initial state.
    """
    if precision == "double":
        return block.stepper(np.array(block.start))
    if block.single_stepper is not None:
        return block.single_stepper(block.start)
    return _single.Stepper([told(stage) for stage in block.stages], block.start)
