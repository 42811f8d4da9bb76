"""The program in the README of an export: it compiles as printed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.export.c.block import Block
from hyst.export.c.selftest import SelfTest
from hyst.export.c.signal_names import identifier, variables
from hyst.operators import ModelDescription

_STEPS = 8


@final
@dataclass(frozen=True)
class Example:
    """What the example calls things, and the program.

    Parameters
    ----------
    variable
        By what the functions of the export call a signal.
    program
        C, at most twenty lines for two exports pasted into one.
    """

    variable: dict[str, str]
    program: str


def example_of(
    block: Block, name: str, precision: str, about: ModelDescription, test: SelfTest
) -> Example:
    """Give a program that steps a ``block`` over its range and prints what comes out.

    Parameters
    ----------
    block
        What is exported.
    name
        Its prefix; also what the program calls the state.
    precision
        Of the target.
    about
        What the numbers mean.
    test
        Its self-test, for a range where none is told.

    Returns
    -------
    Example
    """
    named = variables(((role, *meant) for role, meant in meanings(block, about).items()), name)
    number = "float" if precision == "single" else "double"
    low, high = _range(block, about, test)
    step = (high - low) / _STEPS
    if not np.float32(max(abs(low), abs(high))) + np.float32(0.5 * step) > max(abs(low), abs(high)):
        step = max(abs(low), abs(high))  # no number between: one sample, and the loop ends
    first, by, end = (_decimal(x, number) for x in (low, step, high))
    driven = named[_driven(block)]
    loop = f"for ({number} {driven} = {first}; {driven} <= {end}; {driven} += {by}) {{"
    lines = [
        "#include <stdio.h>",
        f'#include "{name}.h"',
        f"static {name}_state {name}; /* its memory: one for each actuator */",
        *_swept(block, name, number),
        "int main(void) {",
        f"    {_started(block, name, number)}",
        f"    {loop} /* every sample */",
        *(f"        {line}" for line in _sample(block, name, number, named)),
        "    }",
        "    return 0;",
        "}",
    ]
    return Example(named, "\n".join(lines))


def meanings(block: Block, about: ModelDescription) -> dict[str, tuple[str, str]]:
    """Give name and unit of every signal of a ``block`` by what its functions call it.

    One whose name is empty is called what the functions call it.

    Parameters
    ----------
    block
        What is exported.
    about
        What its numbers mean.
    """
    into, out = (about.input_name, about.input_unit), (about.output_name, about.output_unit)
    roles, meant = (*block.inputs, block.output), [("", "")] * (len(block.inputs) + 1)
    if block.is_estimator:
        wanted = f"wanted {out[0]}" if out[0].strip() else ""
        roles, meant = (*block.inputs, "y_ref"), [into, out, (wanted, out[1])]
    elif block.second:
        meant = [into, block.second_meaning, out]
    elif len(block.inputs) == 1:
        meant = [into, out]
    pairs = zip(roles, meant, strict=True)
    return {role: (name if name.strip() else role, unit) for role, (name, unit) in pairs}


def starts_from_extremes(block: Block) -> bool:
    """Tell whether a sweep over the limits of the drive is the start, and says all it needs."""
    known = block.following is not None and block.drive.limits is not None and not block.history
    return known and block.chain.dt is None


def swept_name(block: Block, name: str) -> str:
    """Give what the example calls the drives at which the sweep turned.

    Parameters
    ----------
    block, name
        What is exported, and its prefix.
    """
    unit = identifier(block.drive.unit)
    return f"{name}_swept_{unit}" if unit else f"{name}_swept"


def _swept(block: Block, name: str, number: str) -> list[str]:
    if not starts_from_extremes(block):
        return []
    drives = f"{{{name.upper()}_U_MAX, {name.upper()}_U_MIN}}"
    swept = swept_name(block, name)
    return [f"static const {number} {swept}[] = {drives}; /* where the sweep turned */"]


def middle_of_second(block: Block) -> float:
    """Give a value of the second signal of a ``block`` in the midst of those it knows."""
    return sorted(block.second)[len(block.second) // 2]


def _started(block: Block, name: str, number: str) -> str:
    if not starts_from_extremes(block):
        after = ", after the drives it was exported with" if block.history else ""
        return f"{name}_init(&{name}); /* once{after} */"
    at = f", {_decimal(middle_of_second(block), number)}" if block.second else ""
    call = f"{name}_init_after(&{name}, {swept_name(block, name)}, 2u{at})"
    return f"if ({call} != 0) {{ return 1; }} /* once, after it */"


def _driven(block: Block) -> str:
    return "y_ref" if block.is_estimator else block.inputs[0]


def _sample(block: Block, name: str, number: str, named: dict[str, str]) -> Iterator[str]:
    """Give the statements for one sample."""
    arguments = ", ".join(["&" + name, *(named[each] for each in block.inputs)])
    if block.is_estimator:
        u, y, wanted = named.values()
        yield f"const {number} {u} = {name}_command(&{name}, {wanted});"
        yield f"const {number} {y} = {wanted}; /* what was measured then */"
        yield f"const int used = {name}_update({arguments});"
        shown = f"{wanted}, {u}, used, (unsigned){name}_fault(&{name})"
        yield f'printf("%g: %g, used %d, fault %u\\n", {shown});'
        return
    for role in block.inputs[1:]:
        value = middle_of_second(block) if block.second else 0.0
        yield f"const {number} {named[role]} = {_decimal(value, number)}; /* as it is measured */"
    out = named[block.output]
    yield f"const {number} {out} = {name}_step({arguments});"
    driven = named[block.inputs[0]]
    yield f'printf("%g: %g, fault %u\\n", {driven}, {out}, (unsigned){name}_fault(&{name}));'


def _range(block: Block, about: ModelDescription, test: SelfTest) -> tuple[float, float]:
    low, high = about.input_low, about.input_high
    if block.is_estimator:
        low, high = about.output_low, about.output_high
    told = block.second or block.is_estimator or len(block.inputs) == 1
    if told and low is not None and high is not None and low < high:
        return low, high
    return test.drive.low * test.drive.unit, test.drive.high


def _decimal(value: float, number: str) -> str:
    """Give a literal of six digits that is of the type ``number``."""
    text = f"{value:.6g}"
    if not any(mark in text for mark in ".e"):
        text += ".0"
    return text + ("f" if number == "float" else "")
