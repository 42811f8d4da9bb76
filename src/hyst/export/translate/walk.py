"""Trees of expressions and statements, gone through or made anew."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

from hyst.export.translate.program import (
    Assign,
    Block,
    Declare,
    Evaluate,
    Expression,
    If,
    Loop,
    Return,
    Statement,
)

_LEAVES = (str, int, float, bool, type(None))


def children(expression: Any) -> Iterator[Any]:
    """Give the expressions an expression is made of."""
    for field in dataclasses.fields(expression):
        value = getattr(expression, field.name)
        if field.name == "type" or isinstance(value, _LEAVES):
            continue
        yield from value if isinstance(value, tuple) else (value,)


def inside(expression: Any) -> Iterator[Any]:
    """Give an expression and all it is made of."""
    yield expression
    for each in children(expression):
        yield from inside(each)


def changed(expression: Any, change: Callable[[Any], Any]) -> Any:
    """Give an expression made anew: its parts first, then ``change`` of itself."""
    values = {}
    for field in dataclasses.fields(expression):
        value = getattr(expression, field.name)
        if field.name == "type" or isinstance(value, _LEAVES):
            continue
        if isinstance(value, tuple):
            values[field.name] = tuple(changed(each, change) for each in value)
        else:
            values[field.name] = changed(value, change)
    return change(dataclasses.replace(expression, **values) if values else expression)


def statements_in(body: tuple[Statement, ...]) -> Iterator[Statement]:
    """Give all statements, those inside others too, in the order of the text."""
    for each in body:
        yield each
        for part in _bodies(each):
            yield from statements_in(part)


def expressions_of(statement: Statement) -> tuple[Expression, ...]:
    """Give the expressions of a statement itself, without those of statements inside it."""
    match statement:
        case Declare(value=value) | Return(value=value):
            return () if value is None else (value,)
        case Assign(place=place, value=value):
            return (place, value)
        case Evaluate(call=call):
            return (call,)
        case If(condition=condition) | Loop(condition=condition):
            return (condition,)
    return ()


def all_expressions(body: tuple[Statement, ...]) -> Iterator[Any]:
    """Give every expression in statements, parts of others too."""
    for statement in statements_in(body):
        for each in expressions_of(statement):
            yield from inside(each)


def with_expressions(
    body: tuple[Statement, ...], change: Callable[[Any], Any]
) -> tuple[Statement, ...]:
    """Give statements whose expressions are changed as wholes.

    Parameters
    ----------
    body
        Statements.
    change
        Gives what takes the place of an expression.
    """
    return tuple(_with_expressions(each, change) for each in body)


def _with_expressions(statement: Statement, change: Callable[[Any], Any]) -> Statement:
    match statement:
        case Declare(variable, value) if value is not None:
            return Declare(variable, change(value))
        case Assign(place, value):
            return Assign(change(place), change(value))
        case Evaluate(call):
            return Evaluate(change(call))
        case If(condition, then, other):
            return If(
                change(condition), with_expressions(then, change), with_expressions(other, change)
            )
        case Loop(before, condition, step, inner):
            return Loop(
                with_expressions(before, change),
                change(condition),
                with_expressions(step, change),
                with_expressions(inner, change),
            )
        case Return(value) if value is not None:
            return Return(change(value))
        case Block(inner):
            return Block(with_expressions(inner, change))
    return statement


def _bodies(statement: Statement) -> tuple[tuple[Statement, ...], ...]:
    match statement:
        case If(then=then, other=other):
            return (then, other)
        case Loop(before=before, step=step, body=body):
            return (before, body, step)
        case Block(body=body):
            return (body,)
    return ()
