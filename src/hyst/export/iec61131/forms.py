"""Small questions about expressions, and small changes of their text."""

from __future__ import annotations

from typing import Any

from hyst.export.iec61131.numbers import real_text
from hyst.export.iec61131.usage import nodes_in
from hyst.export.translate.program import (
    INT,
    SIZE,
    UNSIGNED,
    Binary,
    Call,
    Conditional,
    Convert,
    Element,
    Number,
    Pointer,
    Scalar,
)
from hyst.export.translate.refusal import refused

WHOLE = (INT, SIZE)


def number_text(of: Number, precision: str) -> str:
    """Give a constant ``of`` the program in a ``precision``.

    Raises
    ------
    UntranslatableError
        If it has no form in structured text.
    """
    if isinstance(of.type, Scalar) and of.type.is_real:
        return real_text(float(of.value), precision)
    if of.type == UNSIGNED:
        return f"DWORD#16#{of.value:08X}"
    if of.type not in WHOLE or of.value > 2**31 - 1:
        raise refused(f"the number {of.value}")
    return str(of.value)


def bare(text: str) -> str:
    """Give a text without parentheses around all of it."""
    if not (text.startswith("(") and text.endswith(")")):
        return text
    depth = 0
    for place, letter in enumerate(text):
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if depth == 0 and place < len(text) - 1:
            return text
    return text[1:-1]


def in_parentheses(text: str) -> str:
    """Give a condition that can stand beside AND, OR or NOT."""
    return text if text.isidentifier() or text in ("TRUE", "FALSE") else f"({text})"


def may_always_be_evaluated(of: Any) -> bool:
    """Tell whether an expression can do no harm where C does not evaluate it."""
    return not any(
        isinstance(each, Call | Conditional)
        or (isinstance(each, Element) and not isinstance(each.index, Number))
        or (isinstance(each, Binary) and each.operator in "/%" and each.type in WHOLE)
        for each in nodes_in(of)
    )


def changes(of: Any) -> bool:
    """Tell whether an expression calls what may change a variable that its neighbour reads."""
    return any(
        isinstance(each, Call) and any(isinstance(given.type, Pointer) for given in each.arguments)
        for each in nodes_in(of)
    )


def counted(of: Any) -> Any:
    """Give an unsigned number that C computes, as one that counts: none comes near 2^31.

    Raises
    ------
    UntranslatableError
        If it has no form in structured text.
    """
    match of:
        case Number():
            return Number(of.value, SIZE)
        case Conditional():
            return Conditional(of.condition, counted(of.then), counted(of.other), SIZE)
        case Binary(operator="+" | "-" | "*" | "/" | "%"):
            return Binary(of.operator, counted(of.left), counted(of.right), SIZE)
        case Convert(operand=operand) if operand.type in WHOLE:
            return operand
    raise refused("an unsigned number")
