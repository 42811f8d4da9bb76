"""Turn structured text into C: strict types, arrays with bounds, no lazy operators.

A function block becomes a C structure and a function. The rules are those of a compiler that
forgives nothing: no conversion is implied, every name is declared before it is used and differs
from its neighbours by more than case, AND and OR evaluate both sides, an index out of bounds or a
loop without an end stops the run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from structured_text_parser import (
    ELEMENTARY,
    ArrayOf,
    StructuredTextError,
    Unit,
    Variable,
    units_of,
)
from structured_text_standard import BITWISE, C_TYPES, CONVERSIONS, PRELUDE, STANDARD_NAMES


@dataclass(frozen=True)
class Literal:
    """A number without a type of its own: whole, or real."""

    kind: str


class Compiler:
    """Text to C, by one walk."""

    def __init__(self, text: str) -> None:
        self.types: dict[str, Any] = {}
        self.functions: dict[str, Unit] = {}
        self.blocks: dict[str, Unit] = {}
        self.lines: list[str] = [PRELUDE]
        self.scope: dict[str, Variable] = {}
        self.unit: Unit | None = None
        self.loops = 0
        taken: set[str] = set()
        for unit in units_of(text):
            self._new_name(unit.name, taken)
            self._take(unit)

    def _new_name(self, name: str, taken: set[str]) -> None:
        low = name.lower()
        if low in taken or low in STANDARD_NAMES:
            raise StructuredTextError(f"{name} is taken")
        taken.add(low)

    def _take(self, unit: Unit) -> None:
        low = unit.name.lower()
        taken = {low}
        for each in unit.variables:
            self._new_name(each.name, taken)
            self._declared(each.type)
        if unit.kind == "ALIAS":
            self._declared(unit.result)
            self.types[low] = self.resolved(unit.result)
            return
        if unit.kind == "STRUCT":
            fields = "".join(
                f"{self.c_variable(f.type, self.c_name(f.name))};" for f in unit.variables
            )
            self.types[low] = unit
            self.lines.append(f"typedef struct {{{fields}}} t_{low};")
            return
        self.unit, self.scope = unit, {each.name.lower(): each for each in unit.variables}
        if unit.kind == "FUNCTION":
            self._function(unit)
            self.functions[low] = unit
        else:
            self._block(unit)
            self.blocks[low] = unit

    def _declared(self, of: Any) -> None:
        if isinstance(of, ArrayOf):
            self._declared(of.of)
        elif of not in ELEMENTARY and of not in self.types:
            raise StructuredTextError(f"type {of} is not declared")

    def resolved(self, of: Any) -> Any:
        return self.types.get(of, of) if isinstance(of, str) else of

    # Declarations.

    def c_name(self, name: str) -> str:
        return f"v_{name.lower()}"

    def c_variable(self, of: Any, name: str) -> str:
        of = self.resolved(of)
        if isinstance(of, ArrayOf):
            return self.c_variable(of.of, f"{name}[{of.high - of.low + 1}]")
        if isinstance(of, Unit):
            return f"t_{of.name.lower()} {name}"
        return f"{C_TYPES[of]} {name}"

    def c_parameter(self, variable: Variable) -> str:
        name, of = self.c_name(variable.name), self.resolved(variable.type)
        if variable.role == "VAR_INPUT":
            if isinstance(of, ArrayOf):
                raise StructuredTextError(f"{variable.name}: an array by value")
            return self.c_variable(of, name)
        return self.c_variable(of, f"(*{name})")

    def _function(self, unit: Unit) -> None:
        parameters = [self.c_parameter(v) for v in unit.variables if v.role != "VAR"]
        head = self.c_variable(unit.result, f"f_{unit.name.lower()}")
        self.lines.append(f"static {head}({', '.join(parameters) or 'void'})\n{{")
        self.lines.append(f"{self.c_variable(unit.result, 'result')} = {{0}};")
        for each in unit.variables:
            if each.role == "VAR":
                name = self.c_name(each.name)
                self.lines.append(f"{self.c_variable(each.type, name)} = {self.started(each)};")
        self.body(unit.body)
        self.lines.append("return result;\n}")

    def _fields(self, unit: Unit) -> str:
        named = ((each.type, self.c_name(each.name)) for each in unit.variables)
        return "".join(f"{self.c_variable(of, name)};\n" for of, name in named)

    def _block(self, unit: Unit) -> None:
        low = unit.name.lower()
        fields = "".join(
            f"{self.c_variable(v.type, self.c_name(v.name))};\n" for v in unit.variables
        )
        starts = ", ".join(self.started(v) for v in unit.variables)
        self.lines.append(f"typedef struct {{{fields}}} t_{low};")
        self.lines.append(f"const t_{low} start_{low} = {{{starts}}};")
        self.lines.append(f"static void f_{low}(t_{low} *self)\n{{")
        self.body(unit.body)
        self.lines.append("}")

    def started(self, variable: Variable) -> str:
        return self.initial(variable.start, self.resolved(variable.type), variable.name)

    def initial(self, value: Any, of: Any, what: str) -> str:
        of = self.resolved(of)
        if isinstance(of, ArrayOf):
            items = [] if value is None else value[1]
            if value is not None and (value[0] != "array" or len(items) != of.high - of.low + 1):
                raise StructuredTextError(f"{what}: another number of initial values")
            return "{" + (", ".join(self.initial(v, of.of, what) for v in items) or "0") + "}"
        if isinstance(of, Unit):
            given = {} if value is None else dict(value[1])
            parts = [
                self.initial(given.pop(f.name.lower(), None), f.type, what) for f in of.variables
            ]
            if given:
                raise StructuredTextError(f"{what} has no {', '.join(given)}")
            return "{" + ", ".join(parts) + "}"
        if value is None:
            return "0"
        return self.as_type(value, of)

    # Statements.

    def body(self, statements: list[Any]) -> None:
        for each in statements:
            getattr(self, f"do_{each[0]}")(*each[1:])

    def do_assign(self, target: Any, value: Any, line: int) -> None:
        place, of = self.place(target, line, written=True)
        if isinstance(of, ArrayOf):
            raise StructuredTextError(f"line {line}: an array is assigned")
        self.lines.append(f"{place} = {self.as_type(value, of)};")

    def do_if(self, branches: list[Any], line: int) -> None:
        word = "if"
        for condition, inside in branches:
            if condition is None:
                self.lines.append("else {")
            else:
                # An own block, so that nothing of a later condition is evaluated before.
                self.lines.append(f"{word} ({self.as_type(condition, 'BOOL')}) {{")
            word = "else if"
            self.body(inside)
            self.lines.append("}")

    def do_case(self, value: Any, rows: list[Any], rest: list[Any], line: int) -> None:
        self.lines.append(f"{{ const int32_t chosen = {self.as_type(value, 'DINT')};")
        word = "if"
        for labels, inside in rows:
            test = " || ".join(f"chosen == {label}" for label in labels)
            self.lines.append(f"{word} ({test}) {{")
            self.body(inside)
            self.lines.append("}")
            word = "else if"
        self.lines.append("else {")
        self.body(rest)
        self.lines.append("} }")

    def do_while(self, condition: Any, inside: list[Any], line: int) -> None:
        self.lines.append(f"while (burn({line}) && {self.as_type(condition, 'BOOL')}) {{")
        self.loops += 1
        self.body(inside)
        self.loops -= 1
        self.lines.append("}")

    def do_for(self, name: str, first: Any, last: Any, step: Any, inside: Any, line: int) -> None:
        place, of = self.place(("variable", name, line), line, written=True)
        if of != "DINT" or step[0] not in ("literal", "unary"):
            raise StructuredTextError(f"line {line}: counted by {of}")
        by = self.as_type(step, "DINT")
        self.lines.append(f"{{ const int32_t last = {self.as_type(last, 'DINT')};")
        self.lines.append(
            f"for ({place} = {self.as_type(first, 'DINT')}; "
            f"{by} > 0 ? {place} <= last : {place} >= last; {place} += {by}) {{"
        )
        self.loops += 1
        self.body(inside)
        self.loops -= 1
        self.lines.append("} }")

    def do_exit(self, line: int) -> None:
        self._leaves("break", line)

    def do_continue(self, line: int) -> None:
        self._leaves("continue", line)

    def _leaves(self, word: str, line: int) -> None:
        if not self.loops:
            raise StructuredTextError(f"line {line}: {word} outside a loop")
        self.lines.append(f"{word};")

    def do_return(self, line: int) -> None:
        is_function = self.unit is not None and self.unit.kind == "FUNCTION"
        self.lines.append("return result;" if is_function else "return;")

    # Expressions: C and type.

    def place(self, node: Any, line: int, written: bool = False) -> tuple[str, Any]:
        if node[0] == "variable":
            return self._variable(node[1], line, written)
        if node[0] == "member":
            base, of = self.place(node[1], line, written)
            fields = {f.name.lower(): f for f in of.variables} if isinstance(of, Unit) else {}
            if node[2] not in fields:
                raise StructuredTextError(f"line {line}: no field {node[2]}")
            return f"{base}.{self.c_name(node[2])}", self.resolved(fields[node[2]].type)
        if node[0] != "index":
            raise StructuredTextError(f"line {line}: {node[0]} is no variable")
        base, of = self.place(node[1], line, written)
        if not isinstance(of, ArrayOf):
            raise StructuredTextError(f"line {line}: an index of what is no array")
        index = self.as_type(node[2], "DINT")
        return f"{base}[at({index}, {of.low}, {of.high}, {line})]", self.resolved(of.of)

    def _variable(self, name: str, line: int, written: bool) -> tuple[str, Any]:
        assert self.unit is not None
        low = name.lower()
        if self.unit.kind == "FUNCTION" and low == self.unit.name.lower():
            return "result", self.resolved(self.unit.result)
        found = self.scope.get(low)
        if found is None:
            raise StructuredTextError(f"line {line}: {name} is not declared")
        if written and found.role == "VAR_INPUT":
            raise StructuredTextError(f"line {line}: the input {name} is written")
        of = self.resolved(found.type)
        if self.unit.kind == "FUNCTION_BLOCK":
            return f"self->{self.c_name(name)}", of
        return (f"(*{self.c_name(name)})" if found.role == "VAR_IN_OUT" else self.c_name(name)), of

    def as_type(self, node: Any, of: Any) -> str:
        code, found = self.expression(node)
        if isinstance(found, Literal):
            return self.literal(code, found, of)
        if found is not of and found != of:
            raise StructuredTextError(f"line {node[-1]}: {_told(found)} where {_told(of)} is asked")
        return code

    def literal(self, code: str, found: Literal, of: Any) -> str:
        if found.kind == "whole" and of in ("DINT", "UDINT", "DWORD"):
            number = int(code.strip("()"), 0)
            top = {"DINT": 2**31 - 1}.get(of, 2**32 - 1)
            if number > top or (number < 0 and of != "DINT"):
                raise StructuredTextError(f"{number} is no {of}")
            return f"((int32_t){code})" if of == "DINT" else f"{code}u"
        if found.kind == "real" and of == "LREAL":
            return code
        if found.kind == "real" and of == "REAL":
            return f"((float){code})"
        raise StructuredTextError(f"the literal {code} where {_told(of)} is asked")

    def expression(self, node: Any) -> tuple[str, Any]:
        return getattr(self, f"of_{node[0]}")(node)  # type: ignore[no-any-return]

    def of_variable(self, node: Any) -> tuple[str, Any]:
        return self.place(node, node[-1])

    of_member = of_index = of_variable

    def of_literal(self, node: Any) -> tuple[str, Any]:
        _, kind, text, _ = node
        if kind == "bool":
            return str(int(text == "TRUE")), "BOOL"
        head, _, rest = text.rpartition("#") if not text.startswith("16#") else ("", "", text)
        if text.count("#") == 2 or (head and kind == "whole" and "16" in head.split("#")):
            head, rest = text.split("#", 1)
        number = f"0x{rest[3:]}" if rest.startswith("16#") else rest
        if kind == "whole" and not number.startswith("0x"):
            number = str(int(number))
        plain = Literal(kind)
        if head:
            return self.literal(number, plain, head), head
        return number, plain

    def of_unary(self, node: Any) -> tuple[str, Any]:
        _, mark, inner, line = node
        code, of = self.expression(inner)
        if mark == "NOT":
            if of == "BOOL":
                return f"(!{code})", of
            if of == "DWORD":
                return f"(~{code})", of
        elif isinstance(of, Literal) or of in ("DINT", "REAL", "LREAL"):
            return f"(-{code})", of
        raise StructuredTextError(f"line {line}: {mark} of {_told(of)}")

    def of_binary(self, node: Any) -> tuple[str, Any]:
        _, mark, a, b, line = node
        left, of = self.expression(a)
        right, other = self.expression(b)
        if isinstance(of, Literal) and isinstance(other, Literal):
            raise StructuredTextError(f"line {line}: both sides of {mark} are literals")
        if isinstance(of, Literal):
            left, of = self.literal(left, of, other), other
        elif isinstance(other, Literal):
            right, other = self.literal(right, other, of), of
        if of != other or isinstance(of, ArrayOf | Unit):
            raise StructuredTextError(f"line {line}: {_told(of)} {mark} {_told(other)}")
        if mark in ("=", "<>", "<", ">", "<=", ">="):
            if of in ("BOOL", "DWORD") and mark not in ("=", "<>"):
                raise StructuredTextError(f"line {line}: {mark} of {of}")
            c_mark = {"=": "==", "<>": "!="}.get(mark, mark)
            return f"({left} {c_mark} {right})", "BOOL"
        if mark in ("AND", "&", "OR", "XOR"):
            if of not in ("BOOL", "DWORD"):
                raise StructuredTextError(f"line {line}: {mark} of {of}")
            return f"({left} {BITWISE[mark]} {right})", of
        if of in ("BOOL", "DWORD") or (mark == "MOD" and of in ("REAL", "LREAL")):
            raise StructuredTextError(f"line {line}: {mark} of {of}")
        if mark in ("/", "MOD") and of in ("DINT", "UDINT"):
            right = f"divisor({right}, {line})"
        return f"({left} {'%' if mark == 'MOD' else mark} {right})", of

    def of_call(self, node: Any) -> tuple[str, Any]:
        _, name, given, line = node
        if name.upper() in CONVERSIONS:
            taken, result, code = CONVERSIONS[name.upper()]
            if len(given) != 1 or given[0][0] is not None:
                raise StructuredTextError(f"line {line}: arguments of {name}")
            return code.format(self.as_type(given[0][1], taken)), result
        unit = self.functions.get(name.lower())
        if unit is None:
            raise StructuredTextError(f"line {line}: {name} is no function declared before")
        wanted = [v for v in unit.variables if v.role != "VAR"]
        if [label for label, _ in given] != [v.name.lower() for v in wanted]:
            raise StructuredTextError(f"line {line}: arguments of {name}")
        arguments = []
        for variable, (_, value) in zip(wanted, given, strict=True):
            of = self.resolved(variable.type)
            if variable.role == "VAR_INPUT":
                arguments.append(self.as_type(value, of))
                continue
            place, found = self.place(value, line, written=True)
            if found is not of and found != of:
                raise StructuredTextError(f"line {line}: {_told(found)} for {_told(of)}")
            arguments.append(f"&{place}")
        return f"f_{name.lower()}({', '.join(arguments)})", self.resolved(unit.result)


def _told(of: Any) -> str:
    return of.name if isinstance(of, Unit) else str(of)
