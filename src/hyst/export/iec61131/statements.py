"""Statements and functions of a program as structured text."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from textwrap import wrap
from typing import Any

from hyst.export.iec61131.expressions import Expressions
from hyst.export.iec61131.usage import (
    is_array_of_numbers,
    nodes_in,
    points_to_structure,
    size_of,
)
from hyst.export.translate.program import (
    SIZE,
    VOID,
    AddressOf,
    Assign,
    Binary,
    Block,
    Break,
    Call,
    Comparison,
    Declare,
    Element,
    Evaluate,
    If,
    Initialiser,
    Loop,
    Member,
    Name,
    Number,
    Pointer,
    Return,
)
from hyst.export.translate.refusal import refused


class Statements(Expressions):
    """Writes one function."""

    def all(self, statements: tuple[Any, ...]) -> None:
        """Write statements one after the other."""
        for each in statements:
            self._one(each)

    def _one(self, of: Any) -> None:
        match of:
            case Declare(variable=variable, value=value):
                self._declared(variable, value)
            case Assign(place=place, value=value):
                if isinstance(place, Name) and points_to_structure(place.type):
                    raise refused("a pointer to a structure that moves")
                self.assign(self.place(place), place.type, value)
            case Evaluate(call=call):
                self._evaluated(call)
            case If():
                self._if(of)
            case Loop():
                self._loop(of)
            case Break():
                self.lines.append("EXIT;")
            case Return(value=value):
                if value is not None:
                    own = self.plan.name_of_function(self.function.name)
                    self.assign(own, self.function.result, value)
                self.lines.append("RETURN;")
            case Block(body=body):
                self.all(body)

    def _declared(self, variable: Any, value: Any) -> None:
        if value is None:
            return
        if points_to_structure(variable.type):
            # One name for what is pointed to; it does not move.
            self.aliases[variable.name] = self._steady(self.structure(value))
            return
        if is_array_of_numbers(variable.type):
            size = size_of(variable.type)
            first = self.plan.numbers.place(self.function.name, variable.name, size)
            for at, each in enumerate(_flat(value)):
                self.assign(f"numbers[{first + at}]", each.type, each)
            return
        place = self.place(Name(variable.name, variable.type, "local"))
        self.assign(place, variable.type, value)

    def _steady(self, text: str) -> str:
        if "[" in text:
            raise refused("a pointer to an element of an array of structures")
        return text

    def _evaluated(self, call: Call) -> None:
        kind = call.type
        target = "ignored" if kind == VOID else self.temporary(self.plan.type_text(kind), "unused")
        if kind == VOID and ("ignored", "BOOL") not in self.temporaries:
            self.temporaries.append(("ignored", "BOOL"))
        self.lines.append(f"{target} := {self.call(call)};")

    def _if(self, of: If) -> None:
        with self.inside(f"IF {self.condition(of.condition)} THEN"):
            self.all(of.then)
        other = of.other
        while len(other) == 1 and isinstance(other[0], If):
            needed, text = self.apart(functools.partial(self.condition, other[0].condition))
            if needed:
                break
            with self.inside(f"ELSIF {text} THEN"):
                self.all(other[0].then)
            other = other[0].other
        if other:
            with self.inside("ELSE"):
                self.all(other)
        self.lines.append("END_IF;")

    def _loop(self, of: Loop) -> None:
        counted = self._counted(of)
        if counted is not None:
            with self.inside(counted, "END_FOR;"):
                self.all(of.body)
            return
        self.all(of.before)
        needed, text = self.apart(lambda: self.condition(of.condition))
        with self.inside(f"WHILE {'TRUE' if needed else text} DO", "END_WHILE;"):
            if needed:
                self.lines += needed
                with self.inside(f"IF NOT ({text}) THEN", "END_IF;"):
                    self.lines.append("EXIT;")
            self.all(of.body)
            self.all(of.step)

    def _counted(self, of: Loop) -> str | None:
        """Give the head of a loop that counts, if this is one whose bound stays as it is."""
        match of:
            case Loop(
                before=(Declare(variable=variable, value=first),),
                condition=Comparison(operator="<" | ">" as mark, left=Name(name=name), right=bound),
                step=(Assign(place=Name(name=stepped), value=Binary(operator="+" | "-" as by)),),
            ) if variable.name == name == stepped and first is not None:
                pass
            case _:
                return None
        is_by_one = of.step[0].value.right == Number(1, variable.type)  # type: ignore[union-attr]
        if variable.type != SIZE or not is_by_one or (mark == "<") != (by == "+"):
            return None
        changed = set(_changed(of.body))
        if name in changed or not self._stays(bound, changed) or name in self.stored:
            return None
        last = bound.value - 1 if isinstance(bound, Number) else None
        if mark == "<":
            end = str(last) if last is not None else f"{self.value(bound)} - 1"
            return f"FOR {self.names.of(name)} := {self.value(first)} TO {end} DO"
        end = str(last + 2) if last is not None else f"{self.value(bound)} + 1"
        return f"FOR {self.names.of(name)} := {self.value(first)} TO {end} BY -1 DO"

    def _stays(self, bound: Any, changed: set[str]) -> bool:
        """Tell whether the end of a loop is the same after every turn."""
        if isinstance(bound, Number):
            return True
        if isinstance(bound, Name):
            return bound.name not in changed and bound.name not in self.stored
        if isinstance(bound, Member):
            base = bound.of
            return isinstance(base, Element) and isinstance(base.of, Name) and (
                isinstance(base.of.type, Pointer) and base.of.type.is_const
            )  # fmt: skip
        if isinstance(bound, Binary):
            return self._stays(bound.left, changed) and self._stays(bound.right, changed)
        return False

    # The function as a whole.

    def function_text(self) -> str:
        """Give the text of the function."""
        plan, function = self.plan, self.function
        own = plan.name_of_function(function.name)
        self.names = plan.parameter_names(function.name)
        for table in plan.usage.tables[function.name]:
            self.names.fresh(plan.name_of_table(table))
        values, references, copies = self._parameters()
        self.lines = copies
        self.all(function.body)
        if function.result == VOID:
            self.lines.append(f"{own} := TRUE;")
        while self.lines and self.lines[-1] == "RETURN;":
            self.lines.pop()
        local = [
            (self.names.of(each.name), plan.type_text(each.type))
            for each in function.locals
            if not self._has_a_place_elsewhere(each)
        ]
        parts = [f"FUNCTION {own} : {plan.type_text(function.result)}"]
        parts += section("VAR_INPUT", values) + section("VAR_IN_OUT", references)
        parts += section("VAR", local + self.temporaries)
        return "\n".join([*parts, *folded(self.lines), "END_FUNCTION"])

    def _has_a_place_elsewhere(self, variable: Any) -> bool:
        kind = variable.type
        return (
            is_array_of_numbers(kind) or points_to_structure(kind) or variable.name in self.stored
        )

    def _parameters(self) -> tuple[list[Any], list[Any], list[str]]:
        """Give inputs, references and the statements that copy inputs which change."""
        values, references, copies = [], [], []
        changed = set(_changed(self.function.body))
        for each in self.function.parameters:
            role, name = self.roles[each.name], self.names.of(each.name)
            if role.way == "reference":
                if role.may_be_null:
                    values.append((self.names.of(f"{each.name}_given"), "BOOL"))
                kind = each.type.to if isinstance(each.type, Pointer) else each.type
                references.append((name, self.plan.type_text(kind)))
            elif role.way in ("value", "index"):
                values.append((name, self.plan.type_text(each.type)))
                if each.name in self.stored or each.name in changed:
                    own = self._copied(each, name)
                    copies.append(f"{own} := {name};")
        if self.function.name in self.plan.usage.numbers:
            references.append(("numbers", f"{self.plan.name}_numbers"))
        for table in self.plan.usage.tables[self.function.name]:
            kind = self.plan.program.tables[table].type
            references.append((self.plan.name_of_table(table), self.plan.type_text(kind)))
        return values, references, copies

    def _copied(self, parameter: Any, name: str) -> str:
        if parameter.name in self.stored:
            return self.place(Name(parameter.name, parameter.type, "parameter"))
        own = self.temporary(self.plan.type_text(parameter.type), f"{parameter.name}_now")
        self.aliases[parameter.name] = own
        return own


def _flat(value: Any) -> list[Any]:
    if isinstance(value, Initialiser):
        return [each for inner in value.values for each in _flat(inner)]
    return [value]


def _changed(body: tuple[Any, ...]) -> list[str]:
    """Give the variables that statements change: by assignment, or through their address."""
    found = []
    for each in nodes_in(body):
        if isinstance(each, Assign):
            place = each.place
            while isinstance(place, Member | Element) and not isinstance(place.of.type, Pointer):
                place = place.of
            if isinstance(place, Name):
                found.append(place.name)
        elif isinstance(each, AddressOf):
            inner = each.of
            while isinstance(inner, Member):
                inner = inner.of
            if isinstance(inner, Name):
                found.append(inner.name)
        elif isinstance(each, Declare):
            found.append(each.variable.name)
    return found


def section(word: str, variables: Sequence[tuple[str, ...]]) -> list[str]:
    """Give a section that a ``word`` opens, with ``variables``; nothing where there are none."""
    if not variables:
        return []
    lines = []
    for name, kind, *comment in variables:
        behind = f" (* {comment[0]} *)" if comment and comment[0] else ""
        lines.append(f"    {name} : {kind};{behind}")
    return [word, *lines, "END_VAR"]


def folded(lines: list[str]) -> list[str]:
    """Give lines none of which is too long for an editor."""
    result = []
    for line in lines:
        space = " " * (len(line) - len(line.lstrip()))
        result += wrap(
            line, 98, subsequent_indent=f"{space}    ", break_long_words=False,
            break_on_hyphens=False, replace_whitespace=False, drop_whitespace=True,
        ) or [""]  # fmt: skip
    return result
