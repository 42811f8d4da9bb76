"""Pointers of structures that no function reads, and structures that nothing uses."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Any

from hyst.export.translate.program import (
    Array,
    CType,
    FunctionPointer,
    Initialiser,
    Member,
    Named,
    Pointer,
    Program,
    Structure,
)
from hyst.export.translate.walk import all_expressions, changed, with_expressions


def without_unread_pointers(program: Program, structures: Mapping[str, Structure]) -> Program:
    """Give a program without members that point to something and are never read.

    Such are the rows of a chain, which exports do without, and functions, which are called by name.

    Parameters
    ----------
    program
        Its own structures do not count yet.
    structures
        All that the text declares.

    Returns
    -------
    Program
        With the structures that it uses, inner before outer.
    """
    read = _read(program)
    kept = {
        name: Structure(
            name,
            {
                member: kind
                for member, kind in each.members.items()
                if (name, member) in read or not isinstance(kind, Pointer | FunctionPointer)
            },
        )
        for name, each in structures.items()
    }

    def change(each: Any) -> Any:
        if not isinstance(each, Initialiser) or not isinstance(each.type, Named):
            return each
        name = each.type.name
        pairs = zip(structures[name].members, each.values, strict=True)
        values = tuple(value for member, value in pairs if member in kept[name].members)
        return Initialiser(values, each.type)

    functions = {
        name: dataclasses.replace(
            each, body=with_expressions(each.body, lambda part: changed(part, change))
        )
        for name, each in program.functions.items()
    }
    tables = {
        name: dataclasses.replace(each, value=changed(each.value, change))
        for name, each in program.tables.items()
    }
    smaller = dataclasses.replace(program, functions=functions, tables=tables)
    return dataclasses.replace(smaller, structures=_used(smaller, kept))


def _read(program: Program) -> set[tuple[str, str]]:
    """Find the members that are read or, behind a place, assigned."""
    found: set[tuple[str, str]] = set()
    for function in program.functions.values():
        for each in all_expressions(function.body):
            if isinstance(each, Member) and isinstance(each.of.type, Named):
                found.add((each.of.type.name, each.name))
    return found


def _used(program: Program, structures: Mapping[str, Structure]) -> dict[str, Structure]:
    used: dict[str, Structure] = {}

    def use(kind: CType) -> None:
        if isinstance(kind, Pointer):
            use(kind.to)
        elif isinstance(kind, Array):
            use(kind.of)
        elif isinstance(kind, Named) and kind.name not in used:
            for each in structures[kind.name].members.values():
                use(each)
            used[kind.name] = structures[kind.name]

    for kind in _types(program):
        use(kind)
    return used


def _types(program: Program) -> Iterator[CType]:
    for function in program.functions.values():
        for variable in (*function.parameters, *function.locals):
            yield variable.type
        yield function.result
    for table in program.tables.values():
        yield table.type
