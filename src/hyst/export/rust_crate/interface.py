"""The public part of a crate: constants, and a type with the steps as methods."""

from __future__ import annotations

import re

from hyst.errors import HystError
from hyst.export.c.exported import Block
from hyst.export.c.numbers import Precision
from hyst.export.c.templating import filled
from hyst.export.rust_crate.expressions import real_text
from hyst.export.rust_crate.names import rust_name, type_name
from hyst.export.translate.conversions import real_literal
from hyst.export.translate.program import Program

REALS = {"double": "f64", "single": "f32"}

_SIZES = ("STATE_LENGTH", "SAVED_BYTES", "THETA", "PARAMETERS")
_REAL = re.compile(r"\(?(-?)\(?HYST_REAL\((-?)([\w.+-]+)\)\)?\)?")
_LITERAL = re.compile(r"\(?(-?)([\d.][\w.+-]*|0[xX][\w.+-]+)\)?")


def constants(header: str, name: str, precision: Precision) -> str:
    """Give the constants of a C header as those of Rust.

    Parameters
    ----------
    header
        Of the export.
    name
        Its prefix.
    precision
        Of its numbers.

    Returns
    -------
    str

    Raises
    ------
    HystError
        If one is neither a whole number nor a real one.
    """
    pattern = rf"^#define {name.upper()}_(\w+)[ ]+(\S.*?)[ ]*(?:/\*[ ]*(.*?)[ ]*\*/)?$"
    lines = []
    for found in re.finditer(pattern, header, re.MULTILINE):
        key, value, comment = found.groups()
        kind, text = _constant(key, value, precision)
        said = (comment or _MEANING.get(key, "See README.md")).replace(f"{name}_", "")
        lines.append(f"/// {said[:1].upper()}{said[1:]}.\npub const {key}: {kind} = {text};\n")
    return "".join(lines)


_MEANING = {
    "SAVED_BYTES": "bytes of a saved state",
    "THETA": "where the estimate begins in the memory",
    "PARAMETERS": "numbers of the estimate",
}


def _constant(key: str, value: str, precision: Precision) -> tuple[str, str]:
    if key in _SIZES and re.fullmatch(r"\d+u?", value):
        return "usize", value.rstrip("u")
    if re.fullmatch(r"\d+u", value):
        return "u32", value.rstrip("u")
    suffix = "f" if precision == "single" else ""
    found = _REAL.fullmatch(value) or _LITERAL.fullmatch(value)
    if found is None:
        raise HystError(f"the constant {key} of the C header, {value}, cannot be translated")
    *signs, digits = found.groups()
    number = real_literal(digits.rstrip("fF") + suffix if "x" not in digits else digits + suffix)
    negative = (signs.count("-") % 2) == 1
    return "Real", ("-" if negative else "") + real_text(float(number.value), REALS[precision])[0]


def methods(block: Block, program: Program, name: str, places: dict[str, str]) -> str:
    """Give the methods that step a block, as far as its program has them.

    Parameters
    ----------
    block
        What is exported.
    program
        What it reaches.
    name
        Its name.
    places
        What stands at every place of the templates.
    """
    steps = filled("rust/estimator.rs" if block.is_estimator else "rust/step.rs", places)
    more = [
        filled(f"rust/{each}.rs", places)
        for each in ("init_after", "reset")
        if f"{name}_{each}" in program.functions
    ]
    return steps + "".join(more)


def interface_places(block: Block, name: str, precision: Precision) -> dict[str, str]:
    """Give what the templates of a crate have beside those of C.

    Parameters
    ----------
    block
        What is exported.
    name
        Its name.
    precision
        Of the target.
    """
    inputs = [rust_name(each) for each in block.inputs]
    one = len(inputs) == 1
    number = "*number"
    finite = f"(if number.is_finite() {{ {number} }} else {{ 0.0 }})"
    first, *rest = (f"{each}.iter()" for each in inputs)
    return {
        "Type": type_name(name),
        "State": type_name(f"{name}_state"),
        "real": REALS[precision],
        "arguments": ", ".join(f"{each}: Real" for each in inputs),
        "inputs": ", ".join(inputs),
        "records": ", ".join(f"{each}: &[Real]" for each in inputs),
        "output": rust_name(block.output),
        "zipped": first + "".join(f".zip({each})" for each in rest),
        "pattern": inputs[0] if one else f"({', '.join(inputs)})",
        "elements": ", ".join(f"*{each}" for each in inputs),
        "saved": finite if block.is_estimator else "number",
        **_after(inputs[1] if block.second else ""),
    }


def _after(second: str) -> dict[str, str]:
    """Give what a start after a history takes beside it: a ``second`` signal, if there is one."""
    return {
        "after_argument": f", {second}: Real" if second else "",
        "after_value": f", {second}" if second else "",
        "after_refused": f", or {second} is not finite" if second else "",
        "after_meaning": f" The second signal was {second} all the while." if second else "",
    }
