"""The C of a start: virgin, after the history of the export, or after one that the caller tells."""

from __future__ import annotations

import re

from hyst.export.c.exported import Block, Memory
from hyst.export.c.following import Following
from hyst.export.c.numbers import Precision, literal, table
from hyst.export.c.templating import indented


def answer(value: float, precision: Precision) -> str:
    """Give as C, in a ``precision``, the ``value`` that answers a sample before any other."""
    return f"({literal(value, precision, 'start')})" if value else "HYST_REAL(0.0)"


def start_tables(block: Block, precision: Precision) -> str:
    """Give the memory that a start of a ``block`` sets, in a ``precision``, if it is not all 0."""
    tables = {"start_memory": block.start, "virgin_memory": block.virgin[0]}
    if block.before is None:
        del tables["virgin_memory"]
    if block.following is not None:
        tables["actuator_memory"] = block.following.apart
    return "".join(
        f"static const hyst_real {name}[{len(values)}] = {table(values, precision, name)};\n"
        for name, values in tables.items()
        if any(values)
    )


def beginning(block: Block, name: str, precision: Precision) -> str:
    """Give the functions that set a state: ``init`` and ``init_after``, and what they call.

    Parameters
    ----------
    block
        What is exported.
    name
        The prefix.
    precision
        Of the target.
    """
    init = _setting(f"void {name}_init", block.start, block.rest, "start_memory", name, precision)
    if block.following is None:
        return init
    memory, rest = block.virgin
    virgin = f"{name}_init"
    if block.before is not None:
        virgin = f"{name}_init_virgin"
        init += "\n" + _setting(
            f"static void {virgin}", memory, rest, "virgin_memory", name, precision
        )
    return init + "\n" + _init_after(block, block.following, name, virgin)


def declared(block: Block, name: str) -> str:
    """Give the declaration of ``init_after`` of a ``block`` called ``name``, if it has one."""
    if block.following is None:
        return ""
    limits = ""
    if block.drive.limits is not None:
        limits = f", or outside {name.upper()}_U_MIN to {name.upper()}_U_MAX"
    return (
        "\n/* Instead of it, where it is known what drove the actuator: the state after `count`\n"
        " * drives in time order; where it turned is enough unless time counts. 0; or 1, and the\n"
        f" * state before any drive, if one is not finite{limits}.{_meanwhile(block, name)} */\n"
        f"int {name}_init_after({_arguments(block, name)});\n"
    )


def _setting(
    signature: str, memory: Memory, rest: float, table_name: str, name: str, precision: Precision
) -> str:
    memory_set = indented(_set("state->memory", memory, table_name))
    return (
        f"{signature}({name}_state *state)\n{{\n{memory_set}\n"
        f"    state->y_last = {answer(rest, precision)};\n"
        "    state->fault = 0u;\n    state->ready = model_identity;\n}\n"
    )


def _set(target: str, memory: Memory, table_name: str) -> str:
    if not memory:
        return f"{target}[0] = HYST_REAL(0.0);"
    value = f"{table_name}[i]" if any(memory) else "HYST_REAL(0.0)"
    return f"size_t i;\nfor (i = 0; i < {len(memory)}u; ++i) {{\n    {target}[i] = {value};\n}}"


def _meanwhile(block: Block, name: str) -> str:
    if not block.second:
        return ""
    return (
        " `s` is the second\n * signal meanwhile, one value for all of them; outside its schedule "
        f"{name.upper()}_OFF_SCHEDULE\n * is raised, not finite is answered with 1, too."
    )


def _arguments(block: Block, name: str) -> str:
    more = f", hyst_real {block.inputs[1]}" if block.second else ""
    return f"{name}_state *state, const hyst_real *extremes, size_t count{more}"


def _init_after(block: Block, following: Following, name: str, virgin: str) -> str:
    prefix = name.upper()
    outside = ["!hyst_is_finite(drive)"]
    if block.drive.limits is not None:
        outside += [f"(drive < {prefix}_U_MIN)", f"(drive > {prefix}_U_MAX)"]
    apart, last = following.apart, following.last
    declarations, statements = (each.replace("@{NAME}", prefix) for each in following.prepared)
    uses_actuator = re.search(r"\bactuator\b", following.statements) is not None
    uses_memory = last is not None or re.search(r"\bmemory\b", following.statements) is not None
    lines = [
        f"int {name}_init_after({_arguments(block, name)})",
        "{",
        *["    hyst_real *const memory = state->memory;"] * uses_memory,
        *[f"    hyst_real actuator[{max(len(apart), 1)}]; /* its memory */"] * uses_actuator,
        indented(declarations) if declarations else "",
        "    size_t k;",
        *([indented(_set("actuator", apart, "actuator_memory"))] if uses_actuator else []),
        f"    {virgin}(state);",
        indented(statements) if statements else "",
        "    for (k = 0; k < count; ++k) {",
        "        const hyst_real drive = extremes[k];",
        "        hyst_real v = drive;",
        f"        if ({' || '.join(outside)}) {{",
        f"            {virgin}(state);",
        "            return 1;",
        "        }",
        indented(following.statements, 8) if following.statements else "",
        "        if (!hyst_is_finite(v)) {",
        f"            {virgin}(state);",
        "            return 1;",
        "        }",
        f"        memory[{last}] = drive;" if last is not None else "",
        f"        state->y_last = {'v' if following.answers == 'signal' else 'drive'};",
        "    }",
        "    return 0;",
        "}",
    ]
    return "\n".join(line for line in lines if line) + "\n"
