"""How Rust holds what the pointers of a program point to.

Numbers that change lie in slices of cells, which may be shared and need no ``unsafe``; constants
lie in plain slices. Every pointer of the program points to one of the two, never now to this, now
to that.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, final

from hyst.export.rust_crate.names import type_name
from hyst.export.translate.facts import MEMORY, TABLE, Facts, Slot
from hyst.export.translate.program import (
    VOID,
    Array,
    CType,
    Function,
    FunctionPointer,
    Member,
    Name,
    Named,
    Pointer,
    Program,
    Scalar,
)
from hyst.export.translate.refusal import refused
from hyst.export.translate.types import said

_NUMBERS = {
    "double": "f64",
    "float": "f32",
    "int32": "i32",
    "uint32": "u32",
    "uint64": "u64",
    "uint8": "u8",
    "size": "usize",
}


@final
@dataclass
class Places:
    """Types of Rust for those of a program.

    Parameters
    ----------
    program, facts
        What is translated, and what is known of its pointers.
    """

    program: Program
    facts: Facts
    # Slots whose numbers go on to a slot of cells.
    forced: set[Slot] = field(default_factory=set)

    def number(self, kind: CType) -> str:
        """Give the name of a type of numbers.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        if not isinstance(kind, Scalar) or kind.name not in _NUMBERS:
            raise refused(f"the type {said(kind)}")
        return _NUMBERS[kind.name]

    def is_cell(self, slot: Slot, kind: Pointer) -> bool:
        """Tell whether a parameter or a member is a slice of cells.

        Parameters
        ----------
        slot
            The parameter or member it is given to.
        kind
            The type.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        lies = self.facts.lies.get(slot, set())
        if slot in self.forced or MEMORY in lies or not kind.is_const:
            if TABLE in lies:
                raise refused(f"{'.'.join(slot)}, which points to constants and to memory,")
            return True
        return False

    def has_lifetime(self, kind: CType) -> bool:
        """Tell whether a value of a type holds references."""
        if isinstance(kind, Pointer):
            return True
        if isinstance(kind, Array):
            return self.has_lifetime(kind.of)
        if isinstance(kind, Named):
            return any(self.has_lifetime(each) for _, each in self.members(kind.name))
        return False

    def members(self, structure: str) -> Iterator[tuple[str, CType]]:
        """Give the members that Rust has: pointers to functions are called by name."""
        for name, kind in self.program.structures[structure].members.items():
            if not isinstance(kind, FunctionPointer):
                yield name, kind

    def value_type(self, kind: CType, lifetime: str = "'_") -> str:
        """Give the type of a number, an array or a structure.

        Parameters
        ----------
        kind
            The type.
        lifetime
            Of the references inside.
        """
        if isinstance(kind, Array):
            return f"[{self.value_type(kind.of, lifetime)}; {kind.count}]"
        if isinstance(kind, Named):
            of = f"<{lifetime}>" if self.has_lifetime(kind) else ""
            return type_name(kind.name) + of
        return self.number(kind)

    def member_type(self, structure: str, name: str, kind: CType) -> str:
        """Give the type of a member.

        Parameters
        ----------
        structure
            Name of the structure.
        name
            Its name.
        kind
            The type.
        """
        if isinstance(kind, Pointer):
            return self._pointer((structure, name), kind, "'a ", "'a")
        return self.value_type(kind, "'a")

    def parameter_type(self, function: Function, name: str, kind: CType) -> str:
        """Give the type of a parameter.

        Parameters
        ----------
        function
            The function it stands in or belongs to.
        name
            Its name.
        kind
            The type.
        """
        slot = (function.name, name)
        before, inner = self.lifetimes(function)
        if not isinstance(kind, Pointer):
            return self.value_type(kind, inner)
        if isinstance(kind.to, Named) and self.is_changed(slot):
            return f"&mut {self.value_type(kind.to, inner)}"
        return self._pointer(slot, kind, before, inner)

    def lifetimes(self, function: Function) -> tuple[str, str]:
        """Give the lifetimes of the references that a function takes, and of those inside them."""
        if self.has_lifetime(function.result):
            return "'a ", "'a"
        keeps = any(
            isinstance(each.type, Pointer)
            and isinstance(each.type.to, Named)
            and self.has_lifetime(each.type.to)
            and self.is_changed((function.name, each.name))
            for each in function.parameters
        )
        return ("", "'a") if keeps else ("", "'_")

    def is_changed(self, slot: Slot) -> bool:
        """Tell whether a parameter points to a structure that is changed, or to a state."""
        return slot in self.facts.written or slot[0] in self.program.entries

    def is_optional(self, slot: Slot, kind: CType) -> bool:
        """Tell whether a pointer to a structure may be none; no numbers are an empty slice.

        Parameters
        ----------
        slot
            The parameter or member it is given to.
        kind
            The type.
        """
        return (
            isinstance(kind, Pointer) and isinstance(kind.to, Named) and slot in self.facts.nullable
        )

    def _pointer(self, slot: Slot, kind: Pointer, before: str, inner: str) -> str:
        if isinstance(kind.to, Scalar) and kind.to != VOID:
            number = self.number(kind.to)
            held = f"Cell<{number}>" if self.is_cell(slot, kind) else number
            return f"&{before}[{held}]"
        if isinstance(kind.to, Named):
            text = f"&{before}{self.value_type(kind.to, inner)}"
            return f"Option<{text}>" if self.is_optional(slot, kind) else text
        raise refused(f"{'.'.join(slot)}, a pointer to {said(kind.to)},")

    def blank(self, kind: CType, slot: Slot = ("", "")) -> str:
        """Give a value for what is set later.

        Parameters
        ----------
        kind
            The type.
        slot
            The parameter or member it is given to.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        if isinstance(kind, Scalar):
            return f"0.0_{self.number(kind)}" if kind.is_real else f"0_{self.number(kind)}"
        if isinstance(kind, Array):
            return f"[{self.blank(kind.of)}; {kind.count}]"
        if isinstance(kind, Named):
            return f"{type_name(kind.name)}::BLANK"
        if isinstance(kind, Pointer):
            if self.is_optional(slot, kind):
                return "None"
            return f"&{self.blank(kind.to)}" if isinstance(kind.to, Named) else "&[]"
        raise refused(f"a value of {said(kind)}")


def slot_of(function: Function, pointer: Any) -> Slot | None:
    """Give the parameter or member that a pointer is read from; None if it is neither.

    Parameters
    ----------
    function
        The function it stands in or belongs to.
    pointer
        What points.
    """
    if isinstance(pointer, Name) and pointer.kind == "parameter":
        return (function.name, pointer.name)
    if isinstance(pointer, Member) and isinstance(pointer.of.type, Named):
        return (pointer.of.type.name, pointer.name)
    return None
