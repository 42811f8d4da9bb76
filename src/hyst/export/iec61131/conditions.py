"""Conditions of a program as BOOL of structured text."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

from hyst.export.iec61131.forms import changes, in_parentheses, may_always_be_evaluated
from hyst.export.iec61131.usage import plain, points_to_number
from hyst.export.iec61131.writer import Writer
from hyst.export.translate.program import Comparison, Logical, Name, Not, Null
from hyst.export.translate.refusal import refused

_COMPARISONS = {"==": "=", "!=": "<>"}


class Conditions(Writer):
    """Writes the conditions of one function."""

    @abstractmethod
    def value(self, of: Any) -> str:
        """Give an expression as the type it has."""

    @abstractmethod
    def index(self, of: Any, more: Any = None) -> str:
        """Give the pointer ``of`` numbers as the index it is, ``more`` elements further on."""

    def condition(self, of: Any) -> str:
        """Give an expression as BOOL."""
        match of:
            case Comparison():
                return self._comparison(of)
            case Not(operand=operand):
                return f"NOT {in_parentheses(self.condition(operand))}"
            case Logical():
                return self._logical(of)
        return f"{self.value(of)} <> 0"

    def _comparison(self, of: Comparison) -> str:
        if isinstance(of.right, Null):
            there = self._is_there(plain(of.left))
            return there if of.operator == "!=" else f"NOT {there}"
        mark = _COMPARISONS.get(of.operator, of.operator)
        left, right = self.value(of.left), self.value(of.right)
        return f"{left} {mark} {right}"

    def _is_there(self, pointer: Any) -> str:
        if self._may_be_null(pointer):
            return self.names.of(f"{pointer.name}_given")
        if points_to_number(pointer.type):
            return f"({self.index(pointer)} >= 0)"
        raise refused("a comparison of a pointer with NULL")

    def _may_be_null(self, pointer: Any) -> bool:
        role = self.roles.get(pointer.name) if isinstance(pointer, Name) else None
        return role is not None and role.may_be_null

    def _logical(self, of: Logical) -> str:
        left = self.condition(of.left)
        needed, right = self.apart(lambda: self.condition(of.right))
        word = "AND" if of.operator == "&&" else "OR"
        if not needed and may_always_be_evaluated(of.right) and not changes(of.left):
            return f"{in_parentheses(left)} {word} {in_parentheses(right)}"
        held = self.temporary("BOOL", "holds")
        self.lines.append(f"{held} := {left};")
        asks = held if word == "AND" else f"NOT {held}"
        with self.inside(f"IF {asks} THEN", "END_IF;"):
            self.lines += [*needed, f"{held} := {right};"]
        return held
