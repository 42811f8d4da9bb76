"""Expressions of a program as structured text.

Both sides of AND and OR may be evaluated there, and nothing chooses between two values without
evaluating them; so what C evaluates on a condition goes into statements before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from hyst.export.structured_text.numbers import constant, real_text
from hyst.export.structured_text.plan import Plan
from hyst.export.structured_text.usage import (
    is_array_of_numbers,
    is_structure_table,
    nodes_in,
    plain,
    points_to_number,
    points_to_structure,
    size_of,
)
from hyst.export.structured_text.words import Names
from hyst.export.translate.program import (
    INT,
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
    Function,
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
    Scalar,
    Unary,
)
from hyst.export.translate.refusal import refused

_COMPARISONS = {"==": "=", "!=": "<>"}
_WHOLE = (INT, SIZE)


class Expressions:
    """Writes the expressions of one function.

    Parameters
    ----------
    plan
        What is known of the whole program.
    function
        The one that is written.
    """

    def __init__(self, plan: Plan, function: Function) -> None:
        self.plan = plan
        self.function = function
        self.names = Names(plan.names_of_functions())
        self.lines: list[str] = []
        self.temporaries: list[tuple[str, str]] = []
        self.aliases: dict[str, str] = {}
        self.roles = dict(
            zip((p.name for p in function.parameters), plan.usage.roles.get(function.name, ()), strict=True)
        )
        self.stored = plan.usage.stored.get(function.name, frozenset())

    # Statements before.

    @contextmanager
    def inside(self, head: str, tail: str = "") -> Iterator[None]:
        """Write what is written meanwhile between two lines, indented."""
        outer, self.lines = self.lines, []
        yield
        inner, self.lines = self.lines, outer
        self.lines.append(head)
        self.lines += [f"    {line}" for line in inner]
        if tail:
            self.lines.append(tail)

    def apart(self, written: Callable[[], str]) -> tuple[list[str], str]:
        """Give an expression, and the statements it needs before, unwritten."""
        outer, self.lines = self.lines, []
        text = written()
        needed, self.lines = self.lines, outer
        return needed, text

    def temporary(self, kind: str, name: str = "chosen") -> str:
        """Give a new variable of the function."""
        own = self.names.fresh(name)
        self.temporaries.append((own, kind))
        return own

    # Conditions.

    def condition(self, of: Any) -> str:
        """Give an expression as BOOL."""
        match of:
            case Comparison():
                return self._comparison(of)
            case Not(operand=operand):
                return f"NOT {_in_parentheses(self.condition(operand))}"
            case Logical():
                return self._logical(of)
        return f"{self.value(of)} <> 0"

    def _comparison(self, of: Comparison) -> str:
        if isinstance(of.right, Null):
            there = self._is_there(plain(of.left))
            return there if of.operator == "!=" else f"NOT {there}"
        if of.right == Number(0, INT) and isinstance(of.left, Comparison | Not | Logical):
            inner = self.condition(of.left)
            if of.operator in ("!=", "=="):
                return inner if of.operator == "!=" else f"NOT {_in_parentheses(inner)}"
        mark = _COMPARISONS.get(of.operator, of.operator)
        left, right = self.value(of.left), self.value(of.right)
        return f"{left} {mark} {right}"

    def _is_there(self, pointer: Any) -> str:
        if isinstance(pointer, Name) and pointer.name in self.roles:
            if self.roles[pointer.name].may_be_null:
                return self.names.of(f"{pointer.name}_given")
        if points_to_number(pointer.type):
            return f"({self.index(pointer)} >= 0)"
        raise refused("a comparison of a pointer with NULL")

    def _logical(self, of: Logical) -> str:
        left = self.condition(of.left)
        needed, right = self.apart(lambda: self.condition(of.right))
        word = "AND" if of.operator == "&&" else "OR"
        if not needed and _may_always_be_evaluated(of.right) and not _changes(of.left):
            return f"{_in_parentheses(left)} {word} {_in_parentheses(right)}"
        held = self.temporary("BOOL", "holds")
        self.lines.append(f"{held} := {left};")
        asks = held if word == "AND" else f"NOT {held}"
        with self.inside(f"IF {asks} THEN", "END_IF;"):
            self.lines += [*needed, f"{held} := {right};"]
        return held

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
        if isinstance(of.type, Scalar) and of.type.is_real:
            return real_text(float(of.value), self.plan.precision)
        if of.type == UNSIGNED:
            return f"DWORD#16#{of.value:08X}"
        if of.type not in _WHOLE or of.value > 2**31 - 1:
            raise refused(f"the number {of.value}")
        return str(of.value)

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
        if before == UNSIGNED and after in _WHOLE:
            return self.value(_counted(of.operand))
        inner = self.value(of.operand)
        if before == after or (before in _WHOLE and after in _WHOLE):
            return inner
        told = {each: self.plan.type_text(each) for each in (before, after)}
        if before in _WHOLE and after.is_real:  # type: ignore[union-attr]
            return f"DINT_TO_{told[after]}({inner})"
        if before.is_real and after in _WHOLE:  # type: ignore[union-attr]
            return f"{self.plan.whole_part()}(x := {inner})"
        if before.is_real and after.is_real:  # type: ignore[union-attr]
            return f"{told[before]}_TO_{told[after]}({inner})"
        raise refused(f"a conversion of {before} to {after}")

    # Places.

    def place(self, of: Any) -> str:
        """Give a variable, a member or an element."""
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
                return f"{self.place(of)}[{self.value(index)}]"
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
        """Give a pointer to real numbers as the index it is, ``more`` elements further on."""
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
                return str(self.plan.numbers.place(self.function.name, name, size_of(of.type))), None
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
        """Give the structure that a pointer points to."""
        of = plain(of)
        match of:
            case Name() | Member():
                return self.place(of)
            case AddressOf(of=inner):
                return self.place(inner)
            case Null() | Conditional():
                assert points_to_structure(of.type)
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
        """Give a call, its arguments by name."""
        values, references = [], []
        function = self.plan.program.functions[of.function]
        names = self.plan.parameter_names(of.function)
        roles = self.plan.usage.roles[of.function]
        for parameter, role, given in zip(function.parameters, roles, of.arguments, strict=True):
            name = names.of(parameter.name)
            if role.way == "value":
                values.append(f"{name} := {self._argument(given)}")
            elif role.way == "index":
                values.append(f"{name} := {self.index(given)}")
            elif role.way == "reference":
                if role.may_be_null:
                    there = self._whether_there(plain(given))
                    values.append(f"{names.of(f'{parameter.name}_given')} := {there}")
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
        if isinstance(pointer, Name) and pointer.name in self.roles:
            if self.roles[pointer.name].may_be_null:
                return self.names.of(f"{pointer.name}_given")
        if isinstance(pointer, Conditional):
            held = self.temporary("BOOL", "holds")
            self._choose(
                pointer.condition,
                lambda: self.lines.append(f"{held} := {self._whether_there(plain(pointer.then))};"),
                lambda: self.lines.append(f"{held} := {self._whether_there(plain(pointer.other))};"),
            )
            return held
        return "TRUE"

    # Assignments.

    def assign(self, target: str, kind: CType, value: Any) -> None:
        """Write an assignment of a value of a type."""
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
            self.lines.append(f"{target} := {self.value(value)};")

    def _assign_all(self, target: str, kind: CType, value: Initialiser) -> None:
        if isinstance(kind, Array):
            for place, each in enumerate(value.values):
                self.assign(f"{target}[{place}]", kind.of, each)
            return
        assert isinstance(kind, Named)
        members = self.plan.program.structures[kind.name].members
        for (name, of), each in zip(members.items(), value.values, strict=True):
            self.assign(f"{target}.{self.plan.field(kind, name)}", of, each)


def _in_parentheses(text: str) -> str:
    return text if text.isidentifier() or text in ("TRUE", "FALSE") else f"({text})"


def _may_always_be_evaluated(of: Any) -> bool:
    """Tell whether an expression can do no harm where C does not evaluate it."""
    return not any(
        isinstance(each, Call | Conditional)
        or (isinstance(each, Element) and not isinstance(each.index, Number))
        or (isinstance(each, Binary) and each.operator in "/%" and each.type in _WHOLE)
        for each in nodes_in(of)
    )


def _changes(of: Any) -> bool:
    """Tell whether an expression calls what may change a variable that its neighbour reads."""
    return any(
        isinstance(each, Call) and any(isinstance(given.type, Pointer) for given in each.arguments)
        for each in nodes_in(of)
    )


def _counted(of: Any) -> Any:
    """Give an unsigned number that C computes, as one that counts: none comes near 2^31."""
    match of:
        case Number():
            return Number(of.value, SIZE)
        case Conditional():
            return Conditional(of.condition, _counted(of.then), _counted(of.other), SIZE)
        case Binary(operator="+" | "-" | "*" | "/" | "%"):
            return Binary(of.operator, _counted(of.left), _counted(of.right), SIZE)
        case Convert(operand=operand) if operand.type in _WHOLE:
            return operand
    raise refused("an unsigned number")
