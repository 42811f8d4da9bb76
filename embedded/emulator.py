"""Runs a program on the emulated processor and reads its report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from embedded.target import (
    EMULATOR,
    ICOUNT_SHIFT,
    TICKS_PER_INSTRUCTION,
    Processor,
    run,
)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Report:
    """Outputs (as they are, single or double), instructions of every step, bytes, and flags."""

    y: NDArray[np.floating]
    instructions: NDArray[np.int64]
    stack: int
    state: int
    fault: int


def on_processor(program: Path, processor: Processor, precision: str) -> Report:
    """Run a program on an emulated board."""
    command = [EMULATOR, "-M", processor.board, "-nographic", "-monitor", "none", "-serial", "none"]
    command += ["-semihosting-config", "enable=on,target=native"]
    command += ["-icount", f"shift={ICOUNT_SHIFT}", "-kernel", str(program)]
    return read_report(run(command), precision)


def read_report(text: str, precision: str) -> Report:
    """Read what the program wrote; a count that cannot be right is an error."""
    numbers: dict[str, list[int]] = {}
    for line in text.splitlines():
        word, _, number = line.partition(" ")
        try:
            numbers.setdefault(word, []).append(int(number, 16))
        except ValueError:
            raise RuntimeError(f"the program reports: {line}") from None
    if numbers["unsaved"] != [0]:
        raise RuntimeError("a state that was saved and loaded does not go on as before")
    ticks = np.array(numbers["ticks"])
    hundred = (numbers["hundred"][0] - numbers["return"][0]) / TICKS_PER_INSTRUCTION
    if round(hundred) != 100:
        raise RuntimeError(f"100 instructions are counted as {hundred:g}")
    counts = np.rint((ticks - numbers["nothing"][0]) / TICKS_PER_INSTRUCTION).astype(np.int64)
    y: NDArray[np.floating] = (
        np.array(numbers["y"], np.uint32).view(np.float32)
        if precision == "single"
        else np.array(numbers["y"], np.uint64).view(np.float64)
    )
    (stack,), (state,), (fault,) = numbers["stack"], numbers["state"], numbers["fault"]
    return Report(y, counts, stack, state, fault)
