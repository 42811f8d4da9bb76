"""Expressions of a program as structured text.

Both sides of AND and OR may be evaluated there, and no choice between two values leaves one out; so
what C evaluates on a condition goes into statements before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hyst.export.iec61131.conditions import Conditions
from hyst.export.iec61131.forms import (
    WHOLE,
    bare,
    counted,
    number_text,
)
from hyst.export.iec61131.numbers import constant, real_text
from hyst.export.iec61131.usage import (
    is_array_of_numbers,
    is_structure_table,
    plain,
    points_to_number,
    points_to_structure,
    size_of,
)
from hyst.export.translate.program import (
    SIZE,
    UNSIGNED,
    AddressOf,
    Array,
    Binary,
    Call,
    Comparison,
    Conditional,
    Convert,
    CType,
    Decay,
    Element,
    Initialiser,
    Logical,
    Member,
    Name,
    Named,
    Not,
    Null,
    Number,
    Offset,
    Pointer,
    Unary,
)
from hyst.export.translate.refusal import refused


class Expressions(Conditions):
    """Writes the expressions of one function."""

    # Values.

    def value(self, of: Any) -> str:
        """Give an expression as the type it has."""
        match of:
            case Number():
                return self.number(of)
            case Comparison() | Not() | Logical():
                return f"BOOL_TO_DINT({self.condition(of)})"
            case Unary(operator="-", operand=operand):
                if isinstance(operand, Number):
                    return f"(-{self.number(operand)})"
                return f"(-{self.value(operand)})"
            case Unary(operator="~", operand=operand):
                return f"(NOT {self.value(operand)})"
            case Binary():
                return self._binary(of)
            case Conditional():
                return self._conditional(of)
            case Convert():
                return self._converted(of)
            case Call():
                return self.call(of)
            case Name(kind="table"):
                return self._constant(of.name)
        return self.place(of)

    def number(self, of: Number) -> str:
        """Give a constant."""
        return number_text(of, self.plan.precision)

    def _constant(self, name: str) -> str:
        table = self.plan.program.tables[name]
        if is_structure_table(self.plan.program, name):
            return self.plan.name_of_table(name)
        if isinstance(table.value, Number):
            return self.number(table.value)
        return real_text(constant(table.value), self.plan.precision)

    def _binary(self, of: Binary) -> str:
        left, right = of.left, of.right
        folded = self.plan.folded(of)
        if folded is not None:
            return self.number(folded)
        word = {"%": "MOD", "&": "AND", "|": "OR", "^": "XOR"}.get(of.operator, of.operator)
        is_bits = word in ("AND", "OR", "XOR")
        if of.operator in ("<<", ">>") or (of.type == UNSIGNED) != is_bits:
            raise refused(f"{of.operator} of {of.type}")
        return f"({self.value(left)} {word} {self.value(right)})"

    def _conditional(self, of: Conditional) -> str:
        held = self.temporary(self.plan.type_text(of.type))
        self._choose(of.condition, lambda: self.assign(held, of.type, of.then),
                     lambda: self.assign(held, of.type, of.other))  # fmt: skip
        return held

    def _choose(self, condition: Any, then: Callable[[], None], other: Callable[[], None]) -> None:
        text = self.condition(condition)
        with self.inside(f"IF {text} THEN"):
            then()
        with self.inside("ELSE", "END_IF;"):
            other()

    def _converted(self, of: Convert) -> str:
        folded = self.plan.folded(of)
        if folded is not None:
            return self.number(folded)
        before, after = of.operand.type, of.type
        if before == UNSIGNED and after in WHOLE:
            return self.value(counted(of.operand))
        inner = self.value(of.operand)
        if before == after or (before in WHOLE and after in WHOLE):
            return inner
        told = {each: self.plan.type_text(each) for each in (before, after)}
        if before in WHOLE and after.is_real:  # type: ignore[union-attr]
            return f"DINT_TO_{told[after]}({inner})"
        if before.is_real and after in WHOLE:  # type: ignore[union-attr]
            return f"{self.plan.whole_part()}(x := {inner})"
        if before.is_real and after.is_real:  # type: ignore[union-attr]
            return f"{told[before]}_TO_{told[after]}({inner})"
        raise refused(f"a conversion of {before} to {after}")

    # Places.

    def place(self, of: Any) -> str:
        """Give a variable, a member or an element.

        Raises
        ------
        UntranslatableError
            If it has no form in structured text.
        """
        match of:
            case Name(kind="table"):
                return self._constant(of.name)
            case Name(name=name):
                if name in self.stored:
                    return f"numbers[{self.plan.numbers.place(self.function.name, name, 1)}]"
                return self.aliases.get(name) or self.names.of(name)
            case Member(of=inner, name=name):
                return f"{self.structure_value(inner)}.{self.plan.field(inner.type, name)}"
            case Element(of=inner, index=index):
                return self._element(inner, index)
        raise refused(f"a place {type(of).__name__}")

    def structure_value(self, of: Any) -> str:
        """Give a structure so that a member can be named."""
        if isinstance(of, Call | Conditional):
            held = self.temporary(self.plan.type_text(of.type), "found")
            self.assign(held, of.type, of)
            return held
        return self.place(of)

    def _element(self, of: Any, index: Any) -> str:
        of = plain(of)
        if isinstance(of, Decay):
            of = of.of
        if isinstance(of.type, Array):
            if not is_array_of_numbers(of.type) or self.plan.is_inline(of):
                return f"{self.place(of)}[{bare(self.value(index))}]"
            return f"numbers[{self.index(of, index)}]"
        if points_to_number(of.type):
            if isinstance(of, Name) and self._is_reference(of):
                return self.names.of(of.name)
            return f"numbers[{self.index(of, index)}]"
        if not points_to_structure(of.type):
            return self._whole_element(of, index)
        if isinstance(index, Number) and index.value == 0:
            return self.structure(of)
        raise refused("an element of a pointer to structures")

    def _whole_element(self, of: Any, index: Any) -> str:
        if isinstance(of, Name) and isinstance(index, Number) and index.value == 0:
            return self.names.of(of.name)
        raise refused("an element of a pointer to whole numbers")

    def _is_reference(self, of: Name) -> bool:
        return of.name in self.roles and self.roles[of.name].way == "reference"

    # Pointers.

    def index(self, of: Any, more: Any = None) -> str:
        """Give the pointer ``of`` numbers as the index it is, ``more`` elements further on."""
        base, offset = self._split(of)
        parts = [each for each in (offset, more) if each is not None]
        first = int(base) if base.lstrip("-").isdigit() else 0
        first += sum(int(each.value) for each in map(self.plan.folded, parts) if each is not None)
        texts = [] if base.lstrip("-").isdigit() else [base]
        texts += [self.value(each) for each in parts if self.plan.folded(each) is None]
        if first or not texts:
            texts.append(str(first))
        return " + ".join(texts)

    def _split(self, of: Any) -> tuple[str, Any]:
        of = plain(of)
        match of:
            case Decay(of=inner):
                return self._split(inner)
            case Offset(of=inner, index=index):
                return f"{self.index(inner)}", index
            case Null():
                return "-1", None
            case Name(kind="table", name=name):
                return str(self.plan.numbers.table(name)), None
            case Name(name=name) if isinstance(of.type, Array):
                return str(
                    self.plan.numbers.place(self.function.name, name, size_of(of.type))
                ), None
            case Name(name=name):
                return self.aliases.get(name) or self.names.of(name), None
            case AddressOf(of=Name(name=name)) if name in self.stored:
                return str(self.plan.numbers.place(self.function.name, name, 1)), None
            case Element() if isinstance(of.type, Array):
                row = Number(size_of(of.type), SIZE)
                return self.index(of.of), Binary("*", of.index, row, SIZE)
            case Member() if isinstance(of.type, Array):
                return str(self.plan.array_member(of)), None
            case Member():
                return self.place(of), None
            case Conditional():
                return self._conditional(of), None
        raise refused(f"a pointer {type(of).__name__}")

    def structure(self, of: Any) -> str:
        """Give the structure that a pointer points to.

        Raises
        ------
        UntranslatableError
            If it has no form in structured text.
        """
        of = plain(of)
        match of:
            case Name() | Member():
                return self.place(of)
            case AddressOf(of=inner):
                return self.place(inner)
            case Null() | Conditional():
                assert isinstance(of.type, Pointer)
                held = self.temporary(self.plan.type_text(of.type.to), "nothing")
                if isinstance(of, Conditional):
                    self.assign(held, of.type, of)
                return held
            case Decay(of=inner):
                return f"{self.place(inner)}[0]"
            case Offset(of=Decay(of=inner), index=index):
                return f"{self.place(inner)}[{self.value(index)}]"
        raise refused(f"a pointer {type(of).__name__} to a structure")

    def _reference(self, of: Any) -> str:
        """Give what a parameter by reference is given."""
        of = plain(of)
        if points_to_structure(of.type):
            return self.structure(of)
        if isinstance(of, AddressOf):
            return self.place(of.of)
        if isinstance(of, Name) and self._is_reference(of):
            return self.names.of(of.name)
        if points_to_number(of.type):
            return f"numbers[{self.index(of)}]"
        raise refused(f"a pointer {type(of).__name__}")

    # Calls.

    def call(self, of: Call) -> str:
        """Give a call, its arguments by name.

        Raises
        ------
        UntranslatableError
            If it has no form in structured text.
        """
        values, references = [], []
        function = self.plan.program.functions[of.function]
        names = self.plan.parameter_names(of.function)
        roles = self.plan.usage.roles[of.function]
        for parameter, role, given in zip(function.parameters, roles, of.arguments, strict=True):
            name = names.of(parameter.name)
            if role.way == "value":
                values.append(f"{name} := {bare(self._argument(given))}")
            elif role.way == "index":
                values.append(f"{name} := {self.index(given)}")
            elif role.way == "reference":
                if role.may_be_null:
                    there = self._whether_there(plain(given))
                    values.append(f"{names.of(f'{parameter.name}_given')} := {there}")
                is_const = isinstance(parameter.type, Pointer) and parameter.type.is_const
                if isinstance(plain(given), Conditional) and not is_const:
                    raise refused(f"a choice of what {of.function} changes")  # a copy here
                references.append(f"{name} := {self._reference(given)}")
        if of.function in self.plan.usage.numbers:
            references.append("numbers := numbers")
        for table in self.plan.usage.tables[of.function]:
            own = self.plan.name_of_table(table)
            references.append(f"{own} := {own}")
        return f"{self.plan.name_of_function(of.function)}({', '.join(values + references)})"

    def _argument(self, given: Any) -> str:
        if isinstance(given.type, Named):
            return self.structure_value(given)
        return self.value(given)

    def _whether_there(self, pointer: Any) -> str:
        if isinstance(pointer, Null):
            return "FALSE"
        if self._may_be_null(pointer):
            return self.names.of(f"{pointer.name}_given")
        if isinstance(pointer, Conditional):
            held = self.temporary("BOOL", "holds")
            self._choose(
                pointer.condition,
                lambda: self.lines.append(f"{held} := {self._whether_there(plain(pointer.then))};"),
                lambda: self.lines.append(
                    f"{held} := {self._whether_there(plain(pointer.other))};"
                ),
            )
            return held
        return "TRUE"

    # Assignments.

    def assign(self, target: str, kind: CType, value: Any) -> None:
        """Write that a ``target`` of a ``kind`` gets a ``value``."""
        value = plain(value)
        if isinstance(value, Initialiser):
            self._assign_all(target, kind, value)
        elif points_to_number(kind):
            self.lines.append(f"{target} := {self.index(value)};")
        elif points_to_structure(kind):
            if isinstance(value, Conditional):
                self._choose(value.condition, lambda: self.assign(target, kind, value.then),
                             lambda: self.assign(target, kind, value.other))  # fmt: skip
            elif not isinstance(value, Null):
                self.lines.append(f"{target} := {self.structure(value)};")
        elif isinstance(value, Conditional):
            self._choose(value.condition, lambda: self.assign(target, kind, value.then),
                         lambda: self.assign(target, kind, value.other))  # fmt: skip
        elif not self.plan.is_left_out(kind):
            self.lines.append(f"{target} := {bare(self.value(value))};")

    def _assign_all(self, target: str, kind: CType, value: Initialiser) -> None:
        if isinstance(kind, Array):
            for place, each in enumerate(value.values):
                self.assign(f"{target}[{place}]", kind.of, each)
            return
        assert isinstance(kind, Named)
        members = self.plan.program.structures[kind.name].members
        for (name, of), each in zip(members.items(), value.values, strict=True):
            self.assign(f"{target}.{self.plan.field(kind, name)}", of, each)
