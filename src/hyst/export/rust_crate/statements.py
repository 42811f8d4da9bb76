"""Statements of a program in Rust."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from hyst.export.rust_crate.expressions import Expressions
from hyst.export.rust_crate.names import rust_name
from hyst.export.rust_crate.places import Places
from hyst.export.translate.facts import Slot
from hyst.export.translate.pointers import split
from hyst.export.translate.program import (
    VOID,
    AddressOf,
    Array,
    Assign,
    Block,
    Break,
    Call,
    CType,
    Decay,
    Declare,
    Element,
    Evaluate,
    Function,
    If,
    Initialiser,
    Loop,
    Member,
    Name,
    Named,
    Number,
    Pointer,
    Return,
    Scalar,
    Statement,
)
from hyst.export.translate.refusal import refused
from hyst.export.translate.walk import all_expressions, inside, statements_in


class Statements:
    """Writes the statements of one function."""

    def __init__(self, places: Places, function: Function) -> None:
        self.places = places
        self.expressions = Expressions(places, function)
        self.function = function
        self.changed = set(_changed(places, function))

    def all(self, body: tuple[Statement, ...]) -> Iterator[str]:
        """Give lines of Rust; the formatter indents them."""
        for each in body:
            yield from self._one(each)

    def _one(self, statement: Statement) -> Iterator[str]:
        write = self.expressions
        match statement:
            case Declare(variable, value):
                mark = "mut " if variable.name in self.changed else ""
                kind = self.places.value_type(variable.type)
                text = self.places.blank(variable.type) if value is None else write.value(value)
                yield f"let {mark}{rust_name(variable.name)}: {kind} = {text};"
            case Assign(place, value):
                yield self._assign(place, value)
            case Evaluate(call):
                discarded = "" if call.type == VOID else "let _ = "
                yield f"{discarded}{write.value(call)};"
            case If(condition, then, other):
                yield f"if {write.condition(condition)} {{"
                yield from self.all(then)
                if other:
                    yield "} else {"
                    yield from self.all(other)
                yield "}"
            case Loop(before, condition, step, inner):
                yield from self.all(before)
                yield f"while {write.condition(condition)} {{"
                yield from self.all(inner)
                yield from self.all(step)
                yield "}"
            case Break():
                yield "break;"
            case Return(None):
                yield "return;"
            case Return(value):
                yield f"return {write.value(value)};"
            case Block(inner):
                yield "{"
                yield from self.all(inner)
                yield "}"

    def _assign(self, place: Any, value: Any) -> str:
        write = self.expressions
        if (
            isinstance(place, Member)
            and isinstance(place.type, Pointer)
            and isinstance(place.of.type, Named)
        ):
            slot = (place.of.type.name, place.name)
            given = write.given(slot, place.type, value)
            return f"{self._inside(place.of)}.{rust_name(place.name)} = {given};"
        text = write.value(value)
        match place:
            case Name(name=name):
                return f"{rust_name(name)} = {text};"
            case Element(of=of, index=index) if isinstance(of.type, Pointer) and not isinstance(
                of, Decay
            ):
                if isinstance(of.type.to, Scalar):
                    return (
                        f"slices::set_cell({write.slice(of, True)}, {write.value(index)}, {text});"
                    )
                return f"*{write.whole(place)} = {text};"
            case Element(of=of, index=index):
                array = of.of if isinstance(of, Decay) else of
                return self._in_array(array, index, value)
            case Member(of=Element(of=of, index=index), name=name) if isinstance(of.type, Array):
                found = f"{write.value(of)}.get_mut({write.value(index)})"
                return f"if let Some(each) = {found} {{ each.{rust_name(name)} = {text}; }}"
            case Member(of=of, name=name):
                return f"{self._inside(of)}.{rust_name(name)} = {text};"
        raise refused("an assignment")

    def _inside(self, of: Any) -> str:
        if isinstance(of, Member):
            return f"{self._inside(of.of)}.{rust_name(of.name)}"
        return self.expressions.whole(of)

    def _in_array(self, array: Any, index: Any, value: Any) -> str:
        write = self.expressions
        text, place = write.value(value), write.value(array)
        if isinstance(index, Number) and index.value < array.type.count:
            return f"{place}[{index.value}] = {text};"
        if any(part == array for part in (*inside(value), *inside(index))):
            return (
                f"{{ let place = {write.value(index)}; let value = {text}; "
                f"slices::put(&mut {place}, place, value); }}"
            )
        return f"slices::put(&mut {place}, {write.value(index)}, {text});"


def _changed(places: Places, function: Function) -> Iterator[str]:
    """Give the variables that do not keep their first value, or are lent to be changed."""
    for statement in statements_in(function.body):
        if isinstance(statement, Assign):
            yield from _holder(statement.place)
            if isinstance(statement.place, Member) and isinstance(statement.place.of.type, Named):
                slot = (statement.place.of.type.name, statement.place.name)
                yield from _lent(places, slot, statement.place.type, statement.value)
    for each in all_expressions(function.body):
        if isinstance(each, Call):
            parameters = places.program.functions[each.function].parameters
            for parameter, argument in zip(parameters, each.arguments, strict=True):
                yield from _lent(places, (each.function, parameter.name), parameter.type, argument)
        elif isinstance(each, Initialiser) and isinstance(each.type, Named):
            members = places.program.structures[each.type.name].members
            for (name, kind), value in zip(members.items(), each.values, strict=True):
                yield from _lent(places, (each.type.name, name), kind, value)


def _lent(places: Places, slot: Slot, kind: CType, value: Any) -> Iterator[str]:
    """Give the variable that a pointer lets somebody change, if it does."""
    if not isinstance(kind, Pointer):
        return
    if isinstance(kind.to, Named):
        is_lent = slot[0] in places.program.functions and places.is_changed(slot)
    else:
        is_lent = places.is_cell(slot, kind)
    root, _ = split(value)
    if is_lent and isinstance(root, AddressOf | Decay):
        yield from _holder(root.of)


def _holder(place: Any) -> Iterator[str]:
    if isinstance(place, Name):
        yield place.name
    elif isinstance(place, Member):
        yield from _holder(place.of)
    elif isinstance(place, Element):
        if isinstance(place.of, Decay):
            yield from _holder(place.of.of)
        elif isinstance(place.of.type, Array):
            yield from _holder(place.of)
