"""Local pointers as what they point into and an index, for languages that have no pointers.

``const hyst_real *row = table + 4u * k`` becomes the number ``row_at = 4u * k``, and ``row[1]`` an
element of ``table`` at ``row_at + 1``. What is pointed into must stay the same while the function
runs: a parameter, an array, a table, or a member of one that nobody assigns.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from hyst.export.translate.program import (
    SIZE,
    AddressOf,
    Assign,
    Binary,
    Block,
    Call,
    Conditional,
    Convert,
    Declare,
    Element,
    Evaluate,
    Expression,
    Function,
    If,
    Loop,
    Member,
    Name,
    Null,
    Number,
    Offset,
    Pointer,
    Return,
    Statement,
    Variable,
)
from hyst.export.translate.refusal import refused
from hyst.export.translate.walk import changed, inside, statements_in

_ZERO = Number(0, SIZE)


def without_local_pointers(function: Function, functions: dict[str, Function]) -> Function:
    """Give a function that declares no pointers.

    Parameters
    ----------
    function
        As read.
    functions
        Those it calls, done already: one that only gives a pointer is written out at the call.

    Returns
    -------
    Function

    Raises
    ------
    UntranslatableError
        If a pointer points now here, now there.
    """
    work = _Work(function, functions)
    body = work.all(function.body)
    names = {each.name for each in function.parameters}
    local: dict[str, Variable] = {}
    for each in statements_in(body):
        if isinstance(each, Declare) and each.variable.name not in names:
            before = local.get(each.variable.name, each.variable)
            is_const = before.is_const and each.variable.is_const
            local[each.variable.name] = dataclasses.replace(each.variable, is_const=is_const)
    return dataclasses.replace(function, body=body, locals=tuple(local.values()))


class _Work:
    """What every local pointer stands for, while the statements are made anew."""

    def __init__(self, function: Function, functions: dict[str, Function]) -> None:
        self.functions = functions
        self.assigned = {
            each.place.name
            for each in statements_in(function.body)
            if isinstance(each, Assign) and isinstance(each.place, Name)
        }
        self.changed_members = {
            each.place.name
            for each in statements_in(function.body)
            if isinstance(each, Assign)
            and isinstance(each.place, Member)
            and isinstance(each.place.type, Pointer)
        }
        self.taken = {each.name for each in (*function.parameters, *function.locals)}
        self.meant: dict[str, Expression] = {}
        self.moved: list[Statement] = []
        for each in function.parameters:
            if isinstance(each.type, Pointer) and each.name in self.assigned:
                root = Name(each.name, each.type, "parameter")
                self.moved.append(self._begin(each.name, root, _ZERO, each.type))

    def all(self, body: tuple[Statement, ...]) -> tuple[Statement, ...]:
        first, self.moved = tuple(self.moved), []
        return (*first, *(new for each in body for new in self._one(each)))

    def _one(self, statement: Statement) -> tuple[Statement, ...]:
        match statement:
            case Declare(variable, value):
                if isinstance(variable.type, Pointer):
                    return self._declare(variable, value)
                return (Declare(variable, None if value is None else self._new(value)),)
            case Assign(Name() as place, value) if isinstance(place.type, Pointer):
                return (self._move(place, value),)
            case Assign(place, value):
                return (Assign(self._new(place), self._new(value)),)
            case Evaluate(call):
                return (Evaluate(self._new(call)),)
            case If(condition, then, other):
                return (If(self._new(condition), self.all(then), self.all(other)),)
            case Loop(before, condition, step, inner):
                first = self.all(before)
                return (Loop(first, self._new(condition), self.all(step), self.all(inner)),)
            case Return(value) if value is not None:
                return (Return(self._new(value)),)
            case Block(inner):
                return (Block(self.all(inner)),)
        return (statement,)

    def _declare(self, variable: Variable, value: Expression | None) -> tuple[Statement, ...]:
        if value is None:
            raise refused(f"the pointer {variable.name} without a value")
        root, index = split(self._new(value))
        if isinstance(root, AddressOf) and variable.name in self.assigned:
            raise refused(f"the pointer {variable.name} to one thing that moves")
        self._refuse_unsteady(root, variable.name)
        if variable.name not in self.assigned and _is_steady_index(index):
            self.meant[variable.name] = root if index == _ZERO else Offset(root, index, root.type)
            return ()
        return (self._begin(variable.name, root, index, variable.type),)

    def _begin(self, name: str, root: Expression, index: Expression, kind: Any) -> Statement:
        own, count = f"{name}_at", 1
        while own in self.taken:
            count += 1
            own = f"{name}_at{count}"
        self.taken.add(own)
        self.meant[name] = Offset(root, Name(own, SIZE, "local"), kind)
        return Declare(Variable(own, SIZE, name not in self.assigned), index)

    def _move(self, place: Name, value: Expression) -> Statement:
        root, index = split(self._new(value))
        own = self.meant[place.name]
        if not isinstance(own, Offset) or split(own)[0] != root:
            raise refused(f"the pointer {place.name}, which points now here, now there,")
        return Assign(own.index, index)

    def _new(self, expression: Expression) -> Any:
        return changed(expression, self._change)

    def _change(self, each: Any) -> Any:
        match each:
            case Name(name=name) if name in self.meant:
                return self.meant[name]
            case Element(of=AddressOf(of=of), index=index) if index == _ZERO:
                return of
            case Element(of=Offset(of=of, index=index), index=more):
                return Element(of, _sum(index, more), each.type)
            case Offset(of=Offset(of=of, index=index), index=more):
                return Offset(of, _sum(index, more), each.type)
            case Convert(operand=operand, type=Pointer()):
                return operand
            case Call(function=name, type=Pointer()):
                return self._written_out(each, name)
        return each

    def _written_out(self, call: Call, name: str) -> Expression:
        """Give what a function that only returns a pointer returns, its parameters replaced."""
        function = self.functions[name]
        if len(function.body) != 1 or not isinstance(function.body[0], Return):
            raise refused(f"a pointer from {name}, which does more than to give it,")
        names = (each.name for each in function.parameters)
        given = dict(zip(names, call.arguments, strict=True))

        def replaced(each: Any) -> Any:
            if isinstance(each, Name) and each.kind == "parameter":
                return given[each.name]
            return self._change(each)

        return changed(function.body[0].value, replaced)  # type: ignore[no-any-return]

    def _refuse_unsteady(self, root: Expression, name: str) -> None:
        """Refuse a pointer into what may be another thing later."""
        for each in inside(root):
            # A parameter that moved has become an index by now, so names are steady.
            unsteady = isinstance(each, Call | Null) or (
                isinstance(each, Member)
                and each.name in self.changed_members
                and isinstance(each.type, Pointer)
            )
            if unsteady:
                raise refused(f"the pointer {name}, which points now here, now there,")
            if isinstance(each, Conditional) and any(
                isinstance(part, Name) and part.name in self.assigned
                for part in inside(each.condition)
            ):
                raise refused(f"the pointer {name}, chosen by what changes,")


def with_plain_pointers(value: Expression) -> Any:
    """Give a value without conversions of pointers, which only make what they point to constant."""

    def change(each: Any) -> Any:
        if isinstance(each, Convert) and isinstance(each.type, Pointer):
            return each.operand
        return each

    return changed(value, change)


def split(pointer: Expression) -> tuple[Expression, Expression]:
    """Give what a pointer points into, and the index.

    Parameters
    ----------
    pointer
        Of a program without local pointers.

    Returns
    -------
    tuple
        A parameter, an array that decays, a member, the address of a place, or a choice of such;
        and a number of type size.
    """
    if isinstance(pointer, Offset):
        return pointer.of, pointer.index
    return pointer, _ZERO


def _is_steady_index(index: Expression) -> bool:
    return isinstance(index, Number)


def _sum(first: Expression, second: Expression) -> Expression:
    if isinstance(first, Number) and isinstance(second, Number):
        return Number(int(first.value) + int(second.value), SIZE)
    if second == _ZERO:
        return first
    return second if first == _ZERO else Binary("+", first, second, SIZE)
