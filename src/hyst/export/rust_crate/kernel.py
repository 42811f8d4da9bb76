"""A program as one module of Rust."""

from __future__ import annotations

from collections.abc import Iterator

from hyst.export.rust_crate.expressions import Expressions, MismatchError
from hyst.export.rust_crate.names import constant_name, rust_name, type_name
from hyst.export.rust_crate.places import Places
from hyst.export.rust_crate.statements import Statements
from hyst.export.translate.facts import facts_of
from hyst.export.translate.program import VOID, Function, Pointer, Program, Scalar
from hyst.export.translate.refusal import UntranslatableError


def kernel(program: Program, head: str) -> str:
    """Give the module of a program.

    Parameters
    ----------
    program
        What is translated.
    head
        Comment at the beginning.

    Returns
    -------
    str
        Rust, not yet in lines of one width.

    Raises
    ------
    HystError
        If something cannot be written in Rust; the message names the function.
    """
    places = Places(program, facts_of(program))
    while True:
        try:
            body = "\n".join(_parts(places))
        except MismatchError as mismatch:
            if mismatch.slot in places.forced:
                raise
            places.forced.add(mismatch.slot)
            continue
        uses = "use core::cell::Cell;\n" if "Cell<" in body else ""
        more = "use crate::slices;\n" if "slices::" in body else ""
        return f"{head}{uses}{more}\n{body}"


def _parts(places: Places) -> Iterator[str]:
    for name in places.program.structures:
        yield _structure(places, name)
    write = Expressions(places, None)
    for table in places.program.tables.values():
        word = "pub const" if isinstance(table.type, Scalar) else "static"
        kind = places.value_type(table.type, "'static")
        yield f"{word} {constant_name(table.name)}: {kind} = {write.value(table.value)};\n"
    for function in places.program.functions.values():
        # One that only gives a pointer is written out where it is called.
        if isinstance(function.result, Pointer):
            continue
        try:
            yield _function(places, function)
        except UntranslatableError as error:
            raise UntranslatableError(f"in {function.name}: {error}") from error


def _structure(places: Places, name: str) -> str:
    members = list(places.members(name))
    has_lifetime = any(places.has_lifetime(kind) for _, kind in members)
    of, by = ("<'a>", "impl<'a>") if has_lifetime else ("", "impl")
    declared = "".join(
        f"pub {rust_name(each)}: {places.member_type(name, each, kind)},\n"
        for each, kind in members
    )
    blank = ", ".join(
        f"{rust_name(each)}: {places.blank(kind, (name, each))}" for each, kind in members
    )
    own = type_name(name)
    return (
        f"#[derive(Clone, Copy)]\npub struct {own}{of} {{\n{declared}}}\n\n"
        f"{by} {own}{of} {{\npub const BLANK: Self = Self {{ {blank} }};\n}}\n"
    )


def _function(places: Places, function: Function) -> str:
    statements = Statements(places, function)
    moved = statements.changed
    parameters = ", ".join(
        f"{'mut ' if each.name in moved and not isinstance(each.type, Pointer) else ''}"
        f"{rust_name(each.name)}: {places.parameter_type(function, each.name, each.type)}"
        for each in function.parameters
    )
    inner = places.lifetimes(function)[1]
    result = "" if function.result == VOID else f" -> {places.value_type(function.result, inner)}"
    of = "<'a>" if "'a" in parameters + result else ""
    public = "pub " if function.name in places.program.entries else ""
    lines = "\n".join(statements.all(function.body))
    return f"{public}fn {rust_name(function.name)}{of}({parameters}){result} {{\n{lines}\n}}\n"
