"""What is exported: signals, memory, and the C that takes one sample."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

from hyst.errors import InputError
from hyst.export.numbers import Precision
from hyst.export.recording import record_stages
from hyst.export.stage_code import StageCode
from hyst.export.stages import Stage
from hyst.operators import Operator


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
        What a signal passes, last input first, for the choice of a test signal.
    stepper
        Makes a function that gives the same numbers in Python, in double.
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
    stages: tuple[Stage, ...]
    stepper: Callable[[], Callable[..., float]]

    def sha256(self) -> str:
        """Give the hash of the model."""
        text = json.dumps(self.model, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    def identity(self, precision: Precision) -> int:
        """Give the number above 0 that marks the states of this model in a ``precision``."""
        digest = hashlib.sha256(f"hyst state 1 {precision} {self.sha256()}".encode()).digest()
        return int.from_bytes(digest[:4], "big") or 1


def block_of(model: Operator, precision: Precision) -> Block:
    """Give what is exported of a model.

    Parameters
    ----------
    model
        Any operator.
    precision
        Of the target.

    Returns
    -------
    Block

    Raises
    ------
    InputError
        If it is no operator, or a constant cannot be written in that precision.
    """
    if not isinstance(model, Operator):
        raise InputError(f"{type(model).__name__} cannot be exported; give an operator")
    code = StageCode(record_stages(model), precision)
    return Block(
        kind=model.kind,
        inputs=("u",),
        output="y",
        head=code.declarations(),
        body=code.calls(),
        signal="u",
        headers=code.headers(),
        start=tuple(model.initial_state().tolist()),
        dt=model.dt,
        model=model.to_dict(),
        stages=code.stages,
        stepper=model.stepper,
    )
