"""What the pointers of a program are for: what is read, written, may be null, and where it lies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, final

from hyst.export.translate.pointers import split
from hyst.export.translate.program import (
    AddressOf,
    Assign,
    Call,
    Comparison,
    Conditional,
    Decay,
    Declare,
    Element,
    Expression,
    Function,
    Initialiser,
    Member,
    Name,
    Named,
    Null,
    Pointer,
    Program,
    Return,
)
from hyst.export.translate.walk import all_expressions, inside, statements_in

Slot = tuple[str, str]
"""A parameter, as function and name, or a member, as structure and name."""

TABLE, MEMORY, LOCAL = "table", "memory", "local"


@final
@dataclass
class Facts:
    """What is known of all pointers.

    Parameters
    ----------
    written
        Parameters that point to what is changed, by the function or by one that it calls.
    nullable
        Parameters and members that may be null.
    lies
        Where that to which a parameter or a member points can lie: ``table``, a constant of the
        file; ``memory``, the state of an entry point; ``local``, a variable of a function.
    """

    written: set[Slot] = field(default_factory=set)
    nullable: set[Slot] = field(default_factory=set)
    lies: dict[Slot, set[str]] = field(default_factory=dict)

    def is_one_number(self, program: Program, function: str, parameter: str) -> bool:
        """Tell whether a pointer to a number is only used for the one it points to.

        Parameters
        ----------
        program
            What it reaches.
        function
            The function it stands in or belongs to.
        parameter
            Name of the parameter.
        """
        body = program.functions[function].body
        for each in all_expressions(body):
            if isinstance(each, Element) and _is_parameter(each.of, parameter):
                if getattr(each.index, "value", None) != 0:
                    return False
            elif isinstance(each, Call):
                for name, argument in _passed(program, each):
                    root, index = split(argument)
                    if _is_parameter(root, parameter) and (
                        getattr(index, "value", None) != 0
                        or not self.is_one_number(program, each.function, name)
                    ):
                        return False
        return True


def facts_of(program: Program) -> Facts:
    """Find the facts of a program, by going over it until nothing new is found."""
    facts = Facts()
    for entry in program.entries:
        for each in program.functions[entry].parameters:
            if isinstance(each.type, Pointer):
                # What is read only, as a history, is the caller's.
                is_state = isinstance(each.type.to, Named)
                facts.lies[entry, each.name] = {MEMORY if is_state else LOCAL}
    before = -1
    while before != _known(facts):
        before = _known(facts)
        for table in program.tables.values():
            _take_values(facts, program, None, table.value)
        for function in program.functions.values():
            _take_function(facts, program, function)
    return facts


def _known(facts: Facts) -> int:
    return len(facts.written) + len(facts.nullable) + sum(len(each) for each in facts.lies.values())


def _take_function(facts: Facts, program: Program, function: Function) -> None:
    for statement in statements_in(function.body):
        if isinstance(statement, Assign):
            place = statement.place
            if isinstance(place, Member) and isinstance(place.of.type, Named):
                _flow(facts, function, (place.of.type.name, place.name), statement.value)
            for slot in _written_through(function, place):
                facts.written.add(slot)
        if isinstance(statement, Declare | Return) and statement.value is not None:
            _take_values(facts, program, function, statement.value)
    for each in all_expressions(function.body):
        if isinstance(each, Comparison) and isinstance(each.right, Null):
            facts.nullable |= set(_slots(function, each.left))
        if isinstance(each, Call):
            for name, argument in _passed(program, each):
                slot = (each.function, name)
                _flow(facts, function, slot, argument)
                if slot in facts.written:
                    facts.written |= set(_slots(function, split(argument)[0]))


def _take_values(
    facts: Facts, program: Program, function: Function | None, value: Expression
) -> None:
    for each in inside(value):
        if isinstance(each, Initialiser) and isinstance(each.type, Named):
            members = program.structures[each.type.name].members
            for member, given in zip(members, each.values, strict=True):
                _flow(facts, function, (each.type.name, member), given)


def _flow(facts: Facts, function: Function | None, slot: Slot, value: Any) -> None:
    """Note what a pointer that goes into a slot may point to."""
    if not isinstance(value.type, Pointer):
        return
    if isinstance(value, Null):
        facts.nullable.add(slot)
        return
    root, _ = split(value)
    if isinstance(root, Conditional):
        _flow(facts, function, slot, root.then)
        _flow(facts, function, slot, root.other)
        return
    facts.lies.setdefault(slot, set()).update(_home(facts, function, root))
    if function is None or not isinstance(root, Name | Member):
        return
    if any(each in facts.nullable for each in _slots(function, root)):
        facts.nullable.add(slot)


def _home(facts: Facts, function: Function | None, root: Any) -> set[str]:
    if isinstance(root, Decay | AddressOf):
        return _home_of_place(facts, function, root.of)
    if function is None:
        return {TABLE}
    return set().union(*(facts.lies.get(slot, set()) for slot in _slots(function, root)))


def _home_of_place(facts: Facts, function: Function | None, place: Any) -> set[str]:
    """Give where a place lies that is no pointer."""
    if isinstance(place, Member):
        return _home_of_place(facts, function, place.of)
    if isinstance(place, Element):
        if isinstance(place.of.type, Pointer):
            return _home(facts, function, place.of)
        return _home_of_place(facts, function, place.of)
    if isinstance(place, Name):
        if place.kind == "table":
            return {TABLE}
        return {LOCAL}
    return set()


def _slots(function: Function, pointer: Any) -> Iterator[Slot]:
    """Give the parameter or the member that a pointer is read from."""
    if isinstance(pointer, Name) and pointer.kind == "parameter":
        yield (function.name, pointer.name)
    elif isinstance(pointer, Member) and isinstance(pointer.of.type, Named):
        yield (pointer.of.type.name, pointer.name)
    elif isinstance(pointer, Decay | AddressOf):
        # Part of a structure behind a parameter.
        for each in _roots(pointer.of):
            yield from _slots(function, each)
    elif isinstance(pointer, Conditional):
        yield from _slots(function, pointer.then)
        yield from _slots(function, pointer.other)


def _roots(place: Any) -> Iterator[Any]:
    """Give the pointer through which a place is reached, if any."""
    if isinstance(place, Member):
        yield from _roots(place.of)
    elif isinstance(place, Element):
        if isinstance(place.of.type, Pointer):
            yield place.of
        else:
            yield from _roots(place.of)


def _written_through(function: Function, place: Any) -> Iterator[Slot]:
    for root in _roots(place):
        yield from _slots(function, root)


def _passed(program: Program, call: Call) -> Iterator[tuple[str, Any]]:
    parameters = program.functions[call.function].parameters
    return zip((each.name for each in parameters), call.arguments, strict=True)


def _is_parameter(expression: Any, name: str) -> bool:
    return (
        isinstance(expression, Name) and expression.kind == "parameter" and expression.name == name
    )
