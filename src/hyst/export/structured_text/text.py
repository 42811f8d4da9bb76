"""The file of a function block."""

from __future__ import annotations

from hyst import __version__
from hyst.errors import HystError
from hyst.export.c.block import Block
from hyst.export.c.names import plain_text
from hyst.export.structured_text.bit_functions import bit_functions, whole_part
from hyst.export.structured_text.expressions import Expressions
from hyst.export.structured_text.plan import Plan
from hyst.export.structured_text.statements import Statements, folded, section
from hyst.export.structured_text.usage import is_structure_table
from hyst.export.structured_text.words import Names
from hyst.export.translate.program import Function, Initialiser, Named, Pointer, Program


def structured_text_of(block: Block, program: Program, name: str) -> str:
    """Give the text of a function block.

    Parameters
    ----------
    block
        What is exported.
    program
        Its C, read.
    name
        Of the block, checked.

    Returns
    -------
    str
        ASCII; types, functions and the block, each after what it uses.

    Raises
    ------
    HystError
        If something in the program has no form in structured text.
    """
    plan = Plan(program, name)
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
    parts = [
        _head(block, plan),
        _types(plan),
        whole_part(plan) if plan.uses_whole_part else "",
        by_hand,
        *functions,
        _block(block, plan, tables),
    ]
    text = "\n\n".join(part.strip("\n") for part in parts if part) + "\n"
    return text


def _head(block: Block, plan: Plan) -> str:
    return (
        f"(* {plain_text(block.kind)} as structured text, {plan.precision} precision\n\n"
        f"   Written by hyst {plain_text(__version__)}; write it anew rather than edit it. "
        "README.md says how it is used. *)"
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
            "\n".join([f"TYPE {plan.type_text(Named(name))} : STRUCT", *fields, "END_STRUCT; END_TYPE"])
        )
    return "\n".join(parts)


def _tables(plan: Plan) -> list[tuple[str, str]]:
    """Give the structures of constants, with the types and values of their declarations."""
    used = {each for entry in plan.program.entries for each in plan.usage.tables[entry]}
    result = []
    for name, table in plan.program.tables.items():
        if name in used and is_structure_table(plan.program, name):
            start = _initial(plan, table.value)
            result.append((plan.name_of_table(name), f"{plan.type_text(table.type)} := {start}"))
    return result


def _initial(plan: Plan, value: object) -> str:
    """Give the initial value of a structure or an array of them."""
    writer = Expressions(plan, Function("", (), plan.program.real, (), ()))
    if not isinstance(value, Initialiser):
        if getattr(value, "type", None) is not None and writer.plan.is_left_out(value.type):  # type: ignore[attr-defined]
            return ""
        target: list[str] = writer.lines
        writer.assign("x", value.type, value)  # type: ignore[attr-defined]
        if not target:
            return ""
        return target[0].removeprefix("x := ").removesuffix(";").strip("()")
    if not isinstance(value.type, Named):
        return "[" + ", ".join(_initial(plan, each) for each in value.values) + "]"
    members = plan.program.structures[value.type.name].members
    parts = []
    for member, each in zip(members, value.values, strict=True):
        text = _initial(plan, each)
        if text:
            parts.append(f"{plan.field(value.type, member)} := {text}")
    return f"({', '.join(parts)})"


def _block(block: Block, plan: Plan, tables: list[tuple[str, str]]) -> str:
    names = Names(frozenset({plan.name, "numbers", "state", "ignored", *(name for name, _ in tables)}))
    inputs = [names.of(each) for each in block.inputs]
    output, restart, clear, began = (
        names.of(each) for each in (block.output, "restart", "clear_fault", "began")
    )
    fault = names.of("fault")
    step = f"{plan.name}_step"
    lines = [
        f"IF {restart} OR NOT {began} THEN",
        f"    ignored := {_entry(plan, f'{plan.name}_init', [])};",
        f"    {began} := TRUE;",
        "END_IF;",
        f"IF {clear} THEN",
        f"    state.{plan.field(Named(plan.state), 'fault')} := DWORD#16#00000000;",
        "END_IF;",
        f"{output} := {_entry(plan, step, inputs)};",
        f"{fault} := state.{plan.field(Named(plan.state), 'fault')};",
    ]
    kept = [("state", plan.type_text(Named(plan.state))), ("numbers", f"{plan.name}_numbers := {plan.numbers.initial()}"), *tables, (began, "BOOL"), ("ignored", "BOOL")]
    parts = [f"FUNCTION_BLOCK {plan.name}"]
    parts += section("VAR_INPUT", [(each, plan.real) for each in inputs] + [(restart, "BOOL"), (clear, "BOOL")])
    parts += section("VAR_OUTPUT", [(output, plan.real), (fault, "DWORD")])
    parts += folded(section("VAR", kept))
    return "\n".join([*parts, *folded(lines), "END_FUNCTION_BLOCK"])


def _entry(plan: Plan, name: str, inputs: list[str]) -> str:
    """Give the block's call of an entry point."""
    names = plan.parameter_names(name)
    parameters = plan.program.functions[name].parameters
    values = [
        f"{names.of(each.name)} := {given}"
        for each, given in zip(parameters[1:], inputs, strict=True)
    ]
    values.append(f"{names.of(parameters[0].name)} := state")
    if name in plan.usage.numbers:
        values.append("numbers := numbers")
    values += [f"{each} := {each}" for each in map(plan.name_of_table, plan.usage.tables[name])]
    return f"{plan.name_of_function(name)}({', '.join(values)})"
