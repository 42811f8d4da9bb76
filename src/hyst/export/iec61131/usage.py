"""What a program does with its pointers: which are indices, which are references.

Structured text has no pointers. A pointer to a real number that walks over an array becomes an
index into the one array of numbers that a block has; one that only stands for a variable is a
parameter by reference, as is a pointer to a structure.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, final

from hyst.export.translate.program import (
    AddressOf,
    Array,
    Call,
    Comparison,
    Convert,
    CType,
    Element,
    FromBits,
    Function,
    FunctionPointer,
    Name,
    Named,
    Null,
    Number,
    Pointer,
    Program,
    Scalar,
    ToBits,
)


@final
@dataclass(frozen=True)
class Role:
    """The way a parameter is passed: value, index, reference, or nothing.

    ``may_be_null`` adds a parameter that tells whether there is one.
    """

    way: str
    may_be_null: bool = False


@final
@dataclass
class Usage:
    """What functions do.

    Parameters
    ----------
    roles
        Of every parameter by function.
    numbers
        Functions that reach into the array of numbers.
    tables
        Structures of constants that a function reads, itself or by those it calls.
    stored
        Local variables that have a place in the array of numbers, by function.
    by_hand
        Functions on the bits of a number, which are written by hand.
    """

    roles: dict[str, tuple[Role, ...]] = field(default_factory=dict)
    numbers: set[str] = field(default_factory=set)
    tables: dict[str, tuple[str, ...]] = field(default_factory=dict)
    stored: dict[str, frozenset[str]] = field(default_factory=dict)
    by_hand: set[str] = field(default_factory=set)


def nodes_in(tree: Any) -> Iterator[Any]:
    """Give a tree's nodes, statements and expressions, outer before inner."""
    if isinstance(tree, tuple):
        for each in tree:
            yield from nodes_in(each)
    elif dataclasses.is_dataclass(tree) and not isinstance(tree, CType):
        yield tree
        for each in dataclasses.fields(tree):
            yield from nodes_in(getattr(tree, each.name))


def points_to_number(kind: CType) -> bool:
    """Tell whether a type is a pointer to a real number."""
    return isinstance(kind, Pointer) and isinstance(kind.to, Scalar) and kind.to.is_real


def points_to_structure(kind: CType) -> bool:
    """Tell whether a type is a pointer to a structure."""
    return isinstance(kind, Pointer) and isinstance(kind.to, Named)


def plain(value: Any) -> Any:
    """Give a pointer without the conversions that change no bit."""
    while isinstance(value, Convert) and isinstance(value.type, Pointer):
        value = value.operand
    return value


def usage_of(program: Program) -> Usage:
    """Give what the functions of a program do; they call only those before them."""
    usage = Usage()
    for name, function in program.functions.items():
        body = list(nodes_in(function.body))
        if any(isinstance(each, ToBits | FromBits) for each in body):
            usage.by_hand.add(name)
        usage.roles[name] = tuple(
            _role(each.name, each.type, body, usage) for each in function.parameters
        )
        usage.stored[name] = _stored(function, body, usage)
        usage.tables[name] = _tables(program, body, usage)
        if usage.stored[name] or _reaches_numbers(function, body, usage):
            usage.numbers.add(name)
    return usage


def _role(name: str, kind: CType, body: list[Any], usage: Usage) -> Role:
    if isinstance(kind, FunctionPointer):
        return Role("nothing")
    if not isinstance(kind, Pointer):
        return Role("value")
    passed = list(_passed(name, body, usage))
    compared = any(
        isinstance(each, Comparison) and isinstance(each.right, Null) and _is(each.left, name)
        for each in body
    )
    if not points_to_number(kind):
        return Role("reference", compared or any(role.may_be_null for role in passed))
    mentions = sum(_is(each, name) for each in body if isinstance(each, Name))
    alone = sum(
        isinstance(each, Element) and _is(each.of, name) and _is_first(each.index) for each in body
    )
    alone += sum(role.way == "reference" for role in passed)
    return Role("reference" if alone == mentions and mentions else "index")


def _is(value: Any, name: str) -> bool:
    value = plain(value)
    return isinstance(value, Name) and value.name == name


def _is_first(index: Any) -> bool:
    return isinstance(index, Number) and index.value == 0


def _passed(name: str, body: list[Any], usage: Usage) -> Iterator[Role]:
    for call in body:
        if isinstance(call, Call):
            for role, given in zip(usage.roles[call.function], call.arguments, strict=True):
                if _is(given, name):
                    yield role


def _stored(function: Function, body: list[Any], usage: Usage) -> frozenset[str]:
    """Find the real variables whose address goes where an index is needed."""
    by_reference = {
        id(plain(given))
        for call in body
        if isinstance(call, Call)
        for role, given in zip(usage.roles[call.function], call.arguments, strict=True)
        if role.way == "reference"
    }
    return frozenset(
        each.of.name
        for each in body
        if isinstance(each, AddressOf)
        and points_to_number(each.type)
        and isinstance(each.of, Name)
        and id(each) not in by_reference
    )


def _tables(program: Program, body: list[Any], usage: Usage) -> tuple[str, ...]:
    found: dict[str, None] = {}
    for each in body:
        if (
            isinstance(each, Name)
            and each.kind == "table"
            and is_structure_table(program, each.name)
        ):
            found[each.name] = None
        if isinstance(each, Call):
            found |= dict.fromkeys(usage.tables[each.function])
    return tuple(found)


def is_structure_table(program: Program, name: str) -> bool:
    """Tell whether the constant ``name`` of a ``program`` stays whole.

    So does a structure, and an array of them or of counts.
    """
    kind = program.tables[name].type
    return isinstance(kind, Named) or (isinstance(kind, Array) and not is_array_of_numbers(kind))


def innermost(kind: CType) -> CType:
    """Give what an array of arrays is made of in the end."""
    return innermost(kind.of) if isinstance(kind, Array) else kind


def is_array_of_numbers(kind: CType) -> bool:
    """Tell whether a type is an array of real numbers, or of such arrays."""
    inner = innermost(kind)
    return isinstance(kind, Array) and isinstance(inner, Scalar) and inner.is_real


def size_of(kind: CType) -> int:
    """Give how many numbers an array of arrays has."""
    return kind.count * size_of(kind.of) if isinstance(kind, Array) else 1


def _reaches_numbers(function: Function, body: list[Any], usage: Usage) -> bool:
    by_reference = {
        each.name
        for each, role in zip(function.parameters, usage.roles[function.name], strict=True)
        if role.way == "reference"
    }
    for each in body:
        if isinstance(each, Call) and each.function in usage.numbers:
            return True
        if isinstance(each, Element) and isinstance(each.type, Scalar) and each.type.is_real:
            base = plain(each.of)
            if not (isinstance(base, Name) and base.name in by_reference):
                return True
        if isinstance(each, Call):
            for role, given in zip(usage.roles[each.function], each.arguments, strict=True):
                given = plain(given)
                is_number = role.way == "reference" and points_to_number(given.type)
                if is_number and not isinstance(given, AddressOf | Name):
                    return True
    return False
