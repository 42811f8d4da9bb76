"""Read IEC 61131-3 structured text: the plain part of it that an export writes, and nothing else.

It knows nothing of how such text is made, and takes no word that only one vendor's tool knows.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

_KEYWORDS = """
    array of begin by case constant continue do else elsif end_case end_for end_function
    end_function_block end_if end_repeat end_struct end_type end_var end_while exit false for
    function function_block if mod not and or xor repeat return struct then to true type until var
    var_input var_in_out var_output var_temp while program end_program retain at
"""
KEYWORDS = frozenset(_KEYWORDS.split())
ELEMENTARY = ("BOOL", "DINT", "UDINT", "DWORD", "REAL", "LREAL")
_TOKEN = re.compile(
    r"""(?P<comment>\(\*.*?\*\))|(?P<space>\s+)
    |(?P<real>(?:REAL\#|LREAL\#)?\d+\.\d+(?:[Ee][+-]?\d+)?)
    |(?P<whole>(?:(?:DINT|UDINT|DWORD)\#)?(?:16\#[0-9A-Fa-f]+|\d+))(?![\w.]*\#)
    |(?P<name>[A-Za-z_]\w*)|(?P<mark>:=|=>|<=|>=|<>|\.\.|[-+*/()\[\]:;,.<>=&])""",
    re.VERBOSE | re.DOTALL,
)


class StructuredTextError(Exception):
    """The text is none that a compiler would take."""


@dataclass(frozen=True)
class Token:
    kind: str
    text: str
    line: int


@dataclass(frozen=True)
class ArrayOf:
    low: int
    high: int
    of: Any


@dataclass(frozen=True)
class Variable:
    name: str
    type: Any
    start: Any
    role: str


@dataclass
class Unit:
    """A structure, a function or a function block."""

    kind: str
    name: str
    variables: list[Variable]
    result: Any = None
    body: list[Any] = field(default_factory=list)


def tokens_of(text: str) -> list[Token]:
    found, place, line = [], 0, 1
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            raise StructuredTextError(f"line {line}: {text[place : place + 20]!r} is no token")
        kind = match.lastgroup or ""
        if kind == "name" and match[0].lower() in KEYWORDS:
            kind = "keyword"
        if kind not in ("space", "comment"):
            found.append(Token(kind, match[0], line))
        line += match[0].count("\n")
        place = match.end()
    return [*found, Token("end", "", line)]


def units_of(text: str) -> list[Unit]:
    """Give all units of a file in the order they stand."""
    if not text.isascii():
        raise StructuredTextError("characters beyond ASCII")
    return _Parser(tokens_of(text)).file()


class _Parser:
    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self.place = 0

    @property
    def now(self) -> Token:
        return self.tokens[self.place]

    def sees(self, *texts: str) -> bool:
        return self.now.kind in ("keyword", "mark") and self.now.text.upper() in texts

    def take(self, *texts: str) -> str:
        if not self.sees(*texts):
            raise StructuredTextError(
                f"line {self.now.line}: {self.now.text!r} instead of {' or '.join(texts)}"
            )
        self.place += 1
        return self.tokens[self.place - 1].text.upper()

    def takes(self, text: str) -> bool:
        if self.sees(text):
            self.place += 1
            return True
        return False

    def name(self) -> str:
        token = self.now
        if token.kind != "name":
            raise StructuredTextError(f"line {token.line}: {token.text!r} is no name")
        if "__" in token.text or token.text.endswith("_") or token.text.startswith("_"):
            raise StructuredTextError(f"line {token.line}: underscores of {token.text}")
        self.place += 1
        return token.text

    def file(self) -> list[Unit]:
        units: list[Unit] = []
        while self.now.kind != "end":
            kind = self.take("TYPE", "FUNCTION", "FUNCTION_BLOCK")
            if kind == "TYPE":
                while not self.takes("END_TYPE"):
                    units.append(self.type_unit())
                continue
            unit = Unit(kind, self.name(), [])
            if kind == "FUNCTION":
                self.take(":")
                unit.result = self.type()
            while self.sees("VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT"):
                unit.variables += self.declarations()
            unit.body = self.statements(f"END_{kind}")
            units.append(unit)
        return units

    def type_unit(self) -> Unit:
        name = self.name()
        self.take(":")
        if not self.takes("STRUCT"):
            unit = Unit("ALIAS", name, [], result=self.type())
            self.take(";")
            return unit
        unit = Unit("STRUCT", name, [])
        while not self.takes("END_STRUCT"):
            unit.variables += self.declaration("FIELD")
        self.take(";")
        return unit

    def declarations(self) -> list[Variable]:
        role, result = self.take("VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT"), []
        while not self.takes("END_VAR"):
            result += self.declaration(role)
        return result

    def declaration(self, role: str) -> list[Variable]:
        names = [self.name()]
        while self.takes(","):
            names.append(self.name())
        self.take(":")
        of = self.type()
        start = self.initial() if self.takes(":=") else None
        self.take(";")
        return [Variable(name, of, start, role) for name in names]

    def type(self) -> Any:
        if self.takes("ARRAY"):
            self.take("[")
            low = self.whole()
            self.take("..")
            high = self.whole()
            self.take("]")
            self.take("OF")
            return ArrayOf(low, high, self.type())
        name = self.name()
        return name.upper() if name.upper() in ELEMENTARY else name.lower()

    def whole(self) -> int:
        token = self.now
        if token.kind != "whole":
            raise StructuredTextError(f"line {token.line}: {token.text!r} is no whole number")
        self.place += 1
        return int(token.text)

    def initial(self) -> Any:
        """A number, an array in brackets with repetitions, or a structure in parentheses."""
        if self.takes("["):
            items = [*self.repeated()]
            while self.takes(","):
                items += self.repeated()
            self.take("]")
            return ("array", items)
        if self.sees("(") and self.tokens[self.place + 2].text == ":=":
            self.take("(")
            fields = [self.field()]
            while self.takes(","):
                fields.append(self.field())
            self.take(")")
            return ("structure", dict(fields))
        return self.expression()

    def repeated(self) -> list[Any]:
        if self.now.kind == "whole" and self.tokens[self.place + 1].text == "(":
            count = self.whole()
            self.take("(")
            value = self.initial()
            self.take(")")
            return [value] * count
        return [self.initial()]

    def field(self) -> tuple[str, Any]:
        name = self.name().lower()
        self.take(":=")
        return name, self.initial()

    def statements(self, *ends: str) -> list[Any]:
        result = []
        while not self.sees(*ends):
            result.append(self.statement())
        if len(ends) == 1:
            self.take(*ends)
        return result

    def statement(self) -> Any:
        line = self.now.line
        if self.takes("IF"):
            return ("if", self.branches(), line)
        if self.takes("CASE"):
            return self.case(line)
        if self.takes("WHILE"):
            condition = self.expression()
            self.take("DO")
            body = self.statements("END_WHILE")
            self.take(";")
            return ("while", condition, body, line)
        if self.takes("FOR"):
            return self.counted(line)
        for word in ("EXIT", "CONTINUE", "RETURN"):
            if self.takes(word):
                self.take(";")
                return (word.lower(), line)
        target = self.reference()
        self.take(":=")
        value = self.expression()
        self.take(";")
        return ("assign", target, value, line)

    def counted(self, line: int) -> Any:
        name = self.name()
        self.take(":=")
        first = self.expression()
        self.take("TO")
        last = self.expression()
        step = self.expression() if self.takes("BY") else ("literal", "whole", "1", line)
        self.take("DO")
        body = self.statements("END_FOR")
        self.take(";")
        return ("for", name, first, last, step, body, line)

    def branches(self) -> list[tuple[Any, list[Any]]]:
        condition = self.expression()
        self.take("THEN")
        result = [(condition, self.statements("ELSIF", "ELSE", "END_IF"))]
        while not self.takes("END_IF"):
            if self.takes("ELSE"):
                result.append((None, self.statements("END_IF")))
                break
            self.take("ELSIF")
            condition = self.expression()
            self.take("THEN")
            result.append((condition, self.statements("ELSIF", "ELSE", "END_IF")))
        self.take(";")
        return result

    def case(self, line: int) -> Any:
        value, rows, rest = self.expression(), [], []
        self.take("OF")
        while not self.sees("ELSE", "END_CASE"):
            labels = [self.whole()]
            while self.takes(","):
                labels.append(self.whole())
            self.take(":")
            body = []
            while not self.sees("ELSE", "END_CASE") and self.now.kind != "whole":
                body.append(self.statement())
            rows.append((labels, body))
        if self.takes("ELSE"):
            rest = self.statements("END_CASE")
        else:
            self.take("END_CASE")
        self.take(";")
        return ("case", value, rows, rest, line)

    def reference(self) -> Any:
        result: Any = ("variable", self.name(), self.now.line)
        while self.sees(".", "["):
            if self.takes("."):
                result = ("member", result, self.name().lower(), self.now.line)
            else:
                self.take("[")
                result = ("index", result, self.expression(), self.now.line)
                self.take("]")
        return result

    def expression(self, level: int = 0) -> Any:
        """Binary operators, the loosest first; all of them from left to right."""
        levels = (("OR",), ("XOR",), ("AND", "&"), ("=", "<>"), ("<", ">", "<=", ">="),
                  ("+", "-"), ("*", "/", "MOD"))  # fmt: skip
        if level == len(levels):
            return self.unary()
        left = self.expression(level + 1)
        while self.sees(*levels[level]):
            line, mark = self.now.line, self.take(*levels[level])
            left = ("binary", mark, left, self.expression(level + 1), line)
        return left

    def unary(self) -> Any:
        line = self.now.line
        for mark in ("-", "NOT"):
            if self.takes(mark):
                return ("unary", mark, self.unary(), line)
        if self.takes("("):
            inner = self.expression()
            self.take(")")
            return inner
        token = self.now
        if token.kind in ("real", "whole"):
            self.place += 1
            return ("literal", token.kind, token.text, line)
        if self.sees("TRUE", "FALSE"):
            return ("literal", "bool", self.take("TRUE", "FALSE"), line)
        if self.tokens[self.place + 1].text == "(":
            return self.call()
        return self.reference()

    def call(self) -> Any:
        line, name, given = self.now.line, self.name(), []
        self.take("(")
        while not self.takes(")"):
            is_named = self.tokens[self.place + 1].text == ":="
            label = self.name().lower() if is_named else None
            if is_named:
                self.take(":=")
            given.append((label, self.expression()))
            if not self.sees(")"):
                self.take(",")
        return ("call", name, given, line)
