"""The function block around the translated functions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst.export.c.block import Block
from hyst.export.iec61131.plan import Plan
from hyst.export.iec61131.statements import folded, section
from hyst.export.iec61131.words import Names
from hyst.export.translate.program import Named

HISTORY = 32
"""Drives of a history that a block takes at once."""


@final
@dataclass(frozen=True)
class BlockNames:
    """What the signals of a block are called.

    Parameters
    ----------
    inputs
        In the order of the step's.
    output
        What it gives.
    restart, clear_fault
        Inputs that go back to the start, and take the fault away.
    history, history_count
        Inputs with what drove the actuator before.
    fault, history_refused
        Further outputs.
    """

    inputs: tuple[str, ...]
    output: str
    restart: str
    clear_fault: str
    history: str
    history_count: str
    fault: str
    history_refused: str

    @classmethod
    def of(cls, block: Block, taken: frozenset[str]) -> BlockNames:
        """Give names for a ``block`` that are not ``taken`` by anything else in it."""
        names = Names(taken)
        # One letter alone would be "the" signal, which says nothing.
        wanted = ("scheduled_by" if each == "s" else each for each in block.inputs)
        inputs = tuple(names.fresh(each) for each in wanted)
        others = ("restart", "clear_fault", "history", "history_count", "fault", "history_refused")
        return cls(inputs, names.fresh(block.output), *(names.fresh(each) for each in others))


@final
@dataclass(frozen=True)
class Table:
    """A structure of constants: its name and type, and by which statements it is filled."""

    name: str
    type: str
    filled: tuple[str, ...]


def function_block(block: Block, plan: Plan, tables: list[Table], meanings: dict[str, str]) -> str:
    """Give the text of the function block.

    Parameters
    ----------
    block
        What is exported.
    plan
        Of its program; the functions have been written.
    tables
        Structures of constants.
    meanings
        What its signals mean, by their names in C.
    """
    names = BlockNames.of(block, taken_by(plan, tables))
    inputs = [
        (name, plan.real, meanings.get(role, ""))
        for name, role in zip(names.inputs, block.inputs, strict=True)
    ]
    inputs += [
        (names.restart, "BOOL", "back to the start, before this sample"),
        (names.clear_fault, "BOOL", "take back what fault has told"),
    ]
    outputs = [
        (names.output, plan.real, meanings.get(block.output, "")),
        (names.fault, "DWORD", "bits: 1 not finite, 2 never; README.md tells the others"),
    ]
    kept = [("state", plan.type_text(Named(plan.state)))]
    filled = [f"    {line}" for each in tables for line in each.filled]
    lines = ["IF NOT began THEN", *filled, "END_IF;"] if filled else []
    if f"{plan.name}_init_after" in plan.program.functions:
        inputs += [
            (names.history_count, "DINT", "with restart: so many drives of history came before"),
            (names.history, f"ARRAY [0..{HISTORY - 1}] OF {plan.real}", "in time order"),
        ]
        outputs.append((names.history_refused, "BOOL", "it was not finite or out of the limits"))
        lines += _restart_after(plan, names, bool(block.second))
        kept.append(("i", "DINT"))
    else:
        lines += _restart(plan, names)
    state_fault = f"state.{plan.field(Named(plan.state), 'fault')}"
    lines += [
        f"IF {names.clear_fault} THEN",
        f"    {state_fault} := DWORD#16#00000000;",
        "END_IF;",
        f"{names.output} := {_call(plan, f'{plan.name}_step', names.inputs)};",
        f"{names.fault} := {state_fault};",
    ]
    kept += [
        ("numbers", f"{plan.name}_numbers := {plan.numbers.initial()}"),
        *((each.name, each.type) for each in tables),
        ("began", "BOOL"),
        ("ignored", "BOOL"),
    ]
    head = [f"FUNCTION_BLOCK {plan.name}", *section("VAR_INPUT", inputs)]
    head += section("VAR_OUTPUT", outputs)
    parts = [*head, *folded(section("VAR", kept)), *folded(lines), "END_FUNCTION_BLOCK"]
    return "\n".join(parts)


def taken_by(plan: Plan, tables: list[Table]) -> frozenset[str]:
    """Give the names that the block of a ``plan`` has for itself and its ``tables``."""
    return frozenset(
        {plan.name, "numbers", "state", "ignored", "began", "i", *(each.name for each in tables)}
    )


def _restart(plan: Plan, names: BlockNames) -> list[str]:
    return [
        f"IF {names.restart} OR NOT began THEN",
        f"    ignored := {_call(plan, f'{plan.name}_init', ())};",
        "    began := TRUE;",
        "END_IF;",
    ]


def _restart_after(plan: Plan, names: BlockNames, has_second: bool) -> list[str]:
    first = plan.numbers.place("", "history", HISTORY)
    given = (str(first), names.history_count, *([names.inputs[1]] if has_second else []))
    after = _call(plan, f"{plan.name}_init_after", given)
    count = names.history_count
    return [
        f"IF {names.restart} OR NOT began THEN",
        f"    ignored := {_call(plan, f'{plan.name}_init', ())};",
        "    began := TRUE;",
        f"    {names.history_refused} := ({count} < 0) OR ({count} > {HISTORY});",
        f"    IF {names.restart} AND ({count} > 0) AND ({count} <= {HISTORY}) THEN",
        f"        FOR i := 0 TO {HISTORY - 1} DO",
        f"            numbers[{first} + i] := {names.history}[i];",
        "        END_FOR;",
        f"        {names.history_refused} := {after} <> 0;",
        "    END_IF;",
        "END_IF;",
    ]


def _call(plan: Plan, name: str, given: tuple[str, ...]) -> str:
    """Give the block's call of an entry point, the state before what is given."""
    names = plan.parameter_names(name)
    parameters = plan.program.functions[name].parameters
    roles = plan.usage.roles[name]
    values: list[str] = []
    references: list[str] = []
    for parameter, role, text in zip(parameters, roles, ("state", *given), strict=True):
        target = references if role.way == "reference" else values
        target.append(f"{names.of(parameter.name)} := {text}")
    if name in plan.usage.numbers:
        references.append("numbers := numbers")
    references += [f"{each} := {each}" for each in map(plan.name_of_table, plan.usage.tables[name])]
    return f"{plan.name_of_function(name)}({', '.join(values + references)})"
