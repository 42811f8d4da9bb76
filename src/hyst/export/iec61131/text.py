"""The file of a function block."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst import __version__
from hyst.errors import HystError
from hyst.export.c.block import Block
from hyst.export.c.names import plain_text
from hyst.export.iec61131.bit_functions import bit_functions, whole_part
from hyst.export.iec61131.expressions import Expressions
from hyst.export.iec61131.function_block import BlockNames, Table, function_block, taken_by
from hyst.export.iec61131.plan import Plan
from hyst.export.iec61131.statements import Statements
from hyst.export.iec61131.usage import is_structure_table
from hyst.export.translate.program import Function, Named, Pointer, Program


@final
@dataclass(frozen=True)
class Written:
    """A text, and the names of its block's signals."""

    text: str
    names: BlockNames


def structured_text_of(
    block: Block, program: Program, name: str, meanings: dict[str, str] | None = None
) -> Written:
    """Give the text of a function block.

    Parameters
    ----------
    block
        What is exported.
    program
        Its C, read.
    name
        Of the block, checked.
    meanings
        What its signals mean, for comments.

    Returns
    -------
    Written
        ASCII; types, functions and the block, each after what it uses.

    Raises
    ------
    HystError
        If something in the program has no form in structured text.
    """
    plan, meanings = Plan(program, name), meanings or {}
    functions = []
    for function in program.functions.values():
        if function.name in plan.usage.by_hand or isinstance(function.result, Pointer):
            continue  # what only gives a pointer is written out where it is called
        try:
            functions.append(Statements(plan, function).function_text())
        except HystError as error:
            raise HystError(f"in {function.name}: {error}") from error
    by_hand = bit_functions(plan)
    tables = _tables(plan)
    head = _head(block, plan)
    # After all that takes places among the numbers.
    own = function_block(block, plan, tables, meanings)
    parts = [
        head,
        _types(plan),
        whole_part(plan) if plan.uses_whole_part else "",
        by_hand,
        *functions,
        own,
    ]
    text = "\n\n".join(part.strip("\n") for part in parts if part) + "\n"
    return Written(text, BlockNames.of(block, taken_by(plan, tables)))


def _head(block: Block, plan: Plan) -> str:
    return (
        f"(* {plain_text(block.kind)} as structured text, {plan.precision} precision\n\n"
        f"   Written by hyst {plain_text(__version__)}; write it anew rather than edit it. "
        "README.md says how it is used.\n"
        f"   limits of the drive: {plain_text(block.drive.said())} *)"
    )


def _types(plan: Plan) -> str:
    count = len(plan.numbers.starts)
    parts = [f"TYPE {plan.name}_numbers : ARRAY [0..{count - 1}] OF {plan.real}; END_TYPE"]
    for name, structure in plan.program.structures.items():
        fields = [
            f"    {plan.field(Named(name), member)} : {plan.type_text(kind)};"
            for member, kind in structure.members.items()
            if plan.is_member_kept(name, member)
        ]
        parts.append(
            "\n".join(
                [f"TYPE {plan.type_text(Named(name))} : STRUCT", *fields, "END_STRUCT; END_TYPE"]
            )
        )
    return "\n".join(parts)


def _tables(plan: Plan) -> list[Table]:
    """Give the structures of constants that the entry points need."""
    used = {each for entry in plan.program.entries for each in plan.usage.tables[entry]}
    result = []
    for name, table in plan.program.tables.items():
        if name in used and is_structure_table(plan.program, name):
            own = plan.name_of_table(name)
            writer = Expressions(plan, Function("", (), plan.program.real, (), ()))
            writer.assign(own, table.type, table.value)
            result.append(Table(own, plan.type_text(table.type), tuple(writer.lines)))
    return result
