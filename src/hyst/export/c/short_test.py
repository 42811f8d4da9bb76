"""The self-test that a target runs by itself: a step response, compared by its bits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.export.c.block import Block, stepper_of
from hyst.export.c.drive import Array, Drive
from hyst.export.c.numbers import Precision, rounded, table
from hyst.export.c.selftest import SelfTest
from hyst.export.c.templating import filled

KEPT = 4  # outputs compared while one level is held
# Levels as parts of the range: its ends, beyond them, and loops inside.
_LEVELS = tuple(n / 16 for n in (0, 16, 0, 8, 12, 4, 20, 10, -4, 6, 14, 2, 16, 7, 0, 8))
SHORT_SAMPLES = KEPT * len(_LEVELS)
_ENOUGH = 8  # different outputs, below which the levels are held longer: a long delay shows nothing
_LONGEST_HOLD = 256
_MOST_ON_STACK = 1024  # bytes of state


@final
@dataclass(frozen=True, eq=False)
class ShortTest:
    """Levels and what they are answered with.

    Parameters
    ----------
    levels
        Shape (inputs, 16), in numbers of the target; held one after the other.
    every
        Samples from one output that is compared to the next.
    expected
        Shape (64,), those outputs.
    """

    levels: Array
    every: int
    expected: Array

    @classmethod
    def of(cls, block: Block, precision: Precision, test: SelfTest) -> ShortTest:
        """Make that of a ``block`` in a ``precision``, over the range of its long ``test``."""
        levels = _levels(block, precision, test.drive)
        every, found = 1, _outputs(block, precision, levels, 1)
        longer = found
        while np.unique(longer).size < _ENOUGH and every < _LONGEST_HOLD:
            every *= 4
            longer = _outputs(block, precision, levels, every)
        if np.unique(longer).size < _ENOUGH:
            return cls(levels, 1, found)
        return cls(levels, every, longer)


def short_test_cost(block: Block, places: dict[str, str]) -> str:
    """Give what the short test takes on a target, in words.

    Parameters
    ----------
    block
        What is exported.
    places
        What stands at every place.
    """
    word, state = int(places["word_bytes"]), _state_bytes(block, places)
    numbers = SHORT_SAMPLES + len(_LEVELS) * len(_signals(block))
    kept = "memory" if state > _MOST_ON_STACK else "stack"
    return f"{numbers * word} bytes of constants and {state} of {kept}"


def short_test_source(
    block: Block, test: SelfTest, places: dict[str, str], precision: Precision
) -> str:
    """Give the source file of the short test.

    Parameters
    ----------
    block, test
        What is exported, and its long self-test.
    places
        What stands at every place.
    precision
        Of the target.
    """
    short = ShortTest.of(block, precision, test)
    signals = _signals(block)
    tables = [
        f"static const hyst_real level_{signal}[{values.size}] = "
        f"{table(values.tolist(), precision, 'level')};"
        for signal, values in zip(signals, short.levels, strict=True)
    ]
    name, levels = places["name"], [f"level_{each}[level]" for each in signals]
    if block.is_estimator:
        u, y = levels
        call = (
            f"(void){name}_update(&state, {u}, {y});\n"
            f"            result.number = {name}_command(&state, {y});"
        )
    else:
        call = f"result.number = {name}_step(&state, {', '.join(levels)});"
    return filled(
        "step_response.c",
        places
        | {
            "tables": "\n".join(tables),
            "short_expected": table(short.expected.tolist(), precision, "expected"),
            "short_samples": str(SHORT_SAMPLES),
            "kept": str(KEPT),
            "every": str(short.every),
            "call": call,
            "storage": "static " if _state_bytes(block, places) > _MOST_ON_STACK else "",
        },
    )


def _signals(block: Block) -> tuple[str, ...]:
    return ("u", "y") if block.is_estimator else block.inputs


def _state_bytes(block: Block, places: dict[str, str]) -> int:
    return int(places["word_bytes"]) * (max(len(block.start), 1) + 1) + 8


def _levels(block: Block, precision: Precision, drive: Drive) -> Array:
    """Give the levels of every signal; a second one goes another way through the same range."""
    places = drive.low + np.round(np.array(_LEVELS) * (drive.count - 1))
    first = [rounded(float(each), precision, "level") for each in places * drive.unit]
    if block.is_estimator:
        # A plant that the estimate does not fit.
        second = (1.1 * block.chain(np.array(first))).tolist()
    elif block.second:
        second = list(block.second)
    elif len(block.inputs) == 2:
        second = first[5:] + first[:5]
    else:
        return np.array([first])
    return np.array([first, [rounded(each, precision, "level") for each in second]])


def _outputs(block: Block, precision: Precision, levels: Array, every: int) -> Array:
    step = stepper_of(block, precision)
    found = []
    for level in levels.T.tolist():
        arguments = (*level, level[1]) if block.is_estimator else level
        for _ in range(KEPT):
            for _ in range(every):
                output = step(*arguments)
            found.append(output)
    return np.array(found)
