"""Expressions of a program in Rust."""

from __future__ import annotations

import struct
from typing import Any

from hyst.export.rust_crate.names import constant_name, rust_name, type_name
from hyst.export.rust_crate.places import Places, slot_of
from hyst.export.translate.pointers import split
from hyst.export.translate.program import (
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
    FromBits,
    Function,
    FunctionPointer,
    Initialiser,
    Logical,
    Member,
    Name,
    Named,
    Not,
    Null,
    Number,
    Pointer,
    Scalar,
    ToBits,
    Unary,
)
from hyst.export.translate.refusal import refused

# How strongly parts hold together: what is below needs parentheses inside what is above.
_ATOM, _SIGN, _TIMES, _PLUS, _COMPARED, _AND, _OR, _OTHER = 9, 8, 6, 5, 3, 2, 1, 0
_LEVELS = {"*": _TIMES, "/": _TIMES, "%": _TIMES, "+": _PLUS, "-": _PLUS}
_WRAPPING = {"+": "wrapping_add", "-": "wrapping_sub", "*": "wrapping_mul"}

Written = tuple[str, int]


class MismatchError(Exception):
    """Constant numbers are passed on as cells: the slot must be one of cells."""

    def __init__(self, slot: tuple[str, str]) -> None:
        super().__init__(slot)
        self.slot = slot


class Expressions:
    """Writes the expressions of one function.

    Parameters
    ----------
    places
        Types.
    function
        In which they stand; None for those of tables.
    """

    def __init__(self, places: Places, function: Function | None) -> None:
        self.places = places
        self.function = function

    def value(self, expression: Any, least: int = _OTHER) -> str:
        """Give the Rust of a value, in parentheses if it holds less than ``least``.

        Parameters
        ----------
        expression
            What is written.
        least
            How strongly it must hold together.
        """
        text, level = self._write(expression)
        return f"({text})" if level < least else text

    def condition(self, expression: Any, least: int = _OTHER) -> str:
        """Give a condition as a bool.

        Parameters
        ----------
        expression
            What is written.
        least
            How strongly it must hold together.
        """
        text, level = self._condition(expression)
        return f"({text})" if level < least else text

    def _condition(self, expression: Any) -> Written:
        match expression:
            case Comparison(operator, left, Null()):
                return self._null(operator, left)
            case Comparison(operator, left, right):
                first, second = self.value(left, _PLUS), self.value(right, _PLUS)
                return f"{first} {operator} {second}", _COMPARED
            case Logical(operator, left, right):
                level = _AND if operator == "&&" else _OR
                first = self.condition(left, level)
                return f"{first} {operator} {self.condition(right, level + 1)}", level
            case Not(operand):
                return f"!{self.condition(operand, _ATOM)}", _SIGN
        raise refused("a condition")

    def _null(self, operator: str, pointer: Any) -> Written:
        if isinstance(pointer.type, Pointer) and isinstance(pointer.type.to, Named):
            says = "is_none" if operator == "==" else "is_some"
            return f"{self.value(pointer)}.{says}()", _ATOM
        root, _ = split(pointer)
        text = f"{self.slice(root, None)}.is_empty()"
        return (text, _ATOM) if operator == "==" else (f"!{text}", _SIGN)

    def _write(self, expression: Any) -> Written:
        match expression:
            case Number(value, kind):
                return self._number(value, kind)
            case Comparison() | Logical() | Not():
                return f"i32::from({self.condition(expression)})", _ATOM
            case Name(name, _, kind):
                return (constant_name(name) if kind == "table" else rust_name(name)), _ATOM
            case Unary("-", operand, kind):
                return self._negative(operand, kind)
            case Unary(_, operand):
                return f"!{self.value(operand, _SIGN)}", _SIGN
            case Binary():
                return self._binary(expression)
            case Conditional(condition, then, other):
                first, second = self.value(then), self.value(other)
                return f"if {self.condition(condition)} {{ {first} }} else {{ {second} }}", _OTHER
            case Convert(operand, kind):
                return f"{self.value(operand, _ATOM)} as {self.places.number(kind)}", _OTHER
        return self._write_place(expression)

    def _write_place(self, expression: Any) -> Written:
        match expression:
            case ToBits(operand):
                return f"{self.value(operand, _ATOM)}.to_bits()", _ATOM
            case FromBits(operand, kind):
                return f"{self.places.number(kind)}::from_bits({self.value(operand)})", _ATOM
            case Member(of, name):
                return f"{self.whole(of)}.{rust_name(name)}", _ATOM
            case Element():
                return self._element(expression)
            case Call():
                return self._call(expression), _ATOM
            case Initialiser():
                return self._initialiser(expression), _ATOM
        raise refused(f"a {type(expression).__name__} as a value")

    def _number(self, value: float | int, kind: CType) -> Written:
        number = self.places.number(kind)
        if not isinstance(kind, Scalar) or not kind.is_real:
            return f"{value}_{number}", _ATOM
        return real_text(float(value), number)

    def _negative(self, operand: Any, kind: CType) -> Written:
        if isinstance(kind, Scalar) and kind.is_real:
            return f"-{self.value(operand, _SIGN)}", _SIGN
        if isinstance(operand, Number):
            return f"-{operand.value}_{self.places.number(kind)}", _SIGN
        return f"{self.value(operand, _ATOM)}.wrapping_neg()", _ATOM

    def _binary(self, expression: Binary) -> Written:
        operator, left, right = expression.operator, expression.left, expression.right
        kind = expression.type
        if isinstance(kind, Scalar) and kind.is_real:
            level = _LEVELS[operator]
            first = self.value(left, level)
            return f"{first} {operator} {self.value(right, level + 1)}", level
        first = self.value(left, _ATOM)
        if isinstance(left, Unary):
            first = f"({first})" if not first.startswith("(") else first
        if operator in _WRAPPING:
            return f"{first}.{_WRAPPING[operator]}({self.value(right)})", _ATOM
        if operator in ("/", "%"):
            if isinstance(right, Number) and right.value:
                return f"{first} {operator} {self.value(right)}", _TIMES
            says = "checked_div" if operator == "/" else "checked_rem"
            return f"{first}.{says}({self.value(right)}).unwrap_or(0)", _ATOM
        if operator in ("<<", ">>"):
            says = "wrapping_shl" if operator == "<<" else "wrapping_shr"
            by = self.value(right, _ATOM)
            by = f"{by} as u32" if right.type != Scalar("uint32") else by
            if isinstance(right, Number):
                by = str(right.value)
            return f"{first}.{says}({by})", _ATOM
        return f"{first} {operator} {self.value(right, _ATOM)}", _OTHER

    def whole(self, of: Any) -> str:
        """Give a structure as the place it has.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        match of:
            case Element(of=Name() | Member() as pointer, index=Number(value=0)) if isinstance(
                pointer.type, Pointer
            ):
                return self._pointed(pointer)
            case Element():
                return self._element(of)[0]
            case Name() | Member() | Call():
                return self.value(of, _ATOM)
        raise refused("a structure that is no place")

    def _pointed(self, pointer: Any) -> str:
        slot = slot_of(self.function, pointer) if self.function is not None else None
        text = self.value(pointer, _ATOM)
        if slot is not None and self.places.is_optional(slot, pointer.type):
            return f"{text}.unwrap_or(&{self.places.blank(pointer.type.to)})"
        return text

    def _element(self, expression: Element) -> Written:
        of, index = expression.of, expression.index
        if isinstance(of.type, Pointer) and isinstance(of.type.to, Named):
            if index == Number(0, Scalar("size")):
                return f"*{self.whole(expression)}", _SIGN
            raise refused("an element of an array of structures behind a pointer")
        if isinstance(of, Decay):
            of = of.of
        if isinstance(of.type, Array):
            return self._of_array(of, index)
        if isinstance(of, AddressOf):
            raise refused("an element beyond one number")
        cells = self.is_cells(of)
        read = "slices::cell_at" if cells else "slices::number_at"
        return f"{read}({self.slice(of, None)}, {self.value(index)})", _ATOM

    def _of_array(self, of: Any, index: Any) -> Written:
        text = self.value(of, _ATOM)
        count = of.type.count
        if isinstance(index, Number) and index.value < count:
            return f"{text}[{index.value}]", _ATOM
        if of.type.of == self.places.program.real:
            return f"slices::number_at(&{text}, {self.value(index)})", _ATOM
        blank = self.places.blank(of.type.of)
        return f"{text}.get({self.value(index)}).copied().unwrap_or({blank})", _ATOM

    def is_cells(self, root: Any) -> bool:
        """Tell whether a pointer to numbers is a slice of cells."""
        if isinstance(root, Conditional):
            return self.is_cells(root.then)
        slot = slot_of(self.function, root) if self.function is not None else None
        return slot is not None and self.places.is_cell(slot, root.type)

    def slice(self, pointer: Any, wants_cells: bool | None) -> str:
        """Give a pointer to numbers as a slice; ``wants_cells`` of the kind that is asked for."""
        root, index = split(pointer)
        text = self._root(root, wants_cells)
        if index == Number(0, Scalar("size")):
            return text
        if isinstance(root, Decay) and not text.startswith("slices::cells("):
            text = f"{text}[..]"
        return f"slices::from({text}, {self.value(index)})"

    def _root(self, root: Any, wants_cells: bool | None) -> str:
        match root:
            case Null():
                return "&[]"
            case Decay(Element(of=of, index=index)) if isinstance(of.type, Array):
                return f"slices::row(&{self.value(of, _ATOM)}, {self.value(index)})"
            case Decay(of):
                place = self.value(of, _ATOM)
                return f"slices::cells(&mut {place})" if wants_cells else f"&{place}"
            case AddressOf(of):
                place = self.value(of, _ATOM)
                if wants_cells:
                    return f"slices::cells(core::slice::from_mut(&mut {place}))"
                return f"core::slice::from_ref(&{place})"
            case Conditional(condition, then, other):
                first, second = self._root(then, wants_cells), self._root(other, wants_cells)
                return f"(if {self.condition(condition)} {{ {first} }} else {{ {second} }})"
        if wants_cells and not self.is_cells(root) and self.function is not None:
            slot = slot_of(self.function, root)
            if slot is not None:
                raise MismatchError(slot)
        return self.value(root, _ATOM)

    def _call(self, call: Call) -> str:
        function = self.places.program.functions[call.function]
        arguments = ", ".join(
            self.given((function.name, parameter.name), parameter.type, argument)
            for parameter, argument in zip(function.parameters, call.arguments, strict=True)
        )
        return f"{rust_name(call.function)}({arguments})"

    def given(self, slot: tuple[str, str], kind: CType, value: Any) -> str:
        """Give what a parameter or a member is given.

        Parameters
        ----------
        slot
            The parameter or member it is given to.
        kind
            The type.
        value
            What it holds, or is given.
        """
        if not isinstance(kind, Pointer):
            return self.value(value)
        if isinstance(kind.to, Scalar):
            return self.slice(value, self.places.is_cell(slot, kind))
        return self._structure(slot, kind, value)

    def _structure(self, slot: tuple[str, str], kind: Pointer, value: Any) -> str:
        optional = self.places.is_optional(slot, kind)
        if isinstance(value, Null):
            return "None"
        if isinstance(value, AddressOf):
            mark = "&mut " if self._is_lent_to_change(slot) else "&"
            text = f"{mark}{self.whole(value.of)}"
            return f"Some({text})" if optional else text
        if not isinstance(value, Name | Member):
            raise refused(f"{type(value).__name__} as {'.'.join(slot)}, a pointer to a structure,")
        own = slot_of(self.function, value) if self.function is not None else None
        is_optional = own is not None and self.places.is_optional(own, value.type)
        text = self.value(value, _ATOM)
        if optional == is_optional:
            return text
        return f"Some({text})" if optional else self._pointed(value)

    def _is_lent_to_change(self, slot: tuple[str, str]) -> bool:
        return slot[0] in self.places.program.functions and self.places.is_changed(slot)

    def _initialiser(self, expression: Initialiser) -> str:
        kind = expression.type
        if isinstance(kind, Array):
            return f"[{', '.join(self.value(each) for each in expression.values)}]"
        if not isinstance(kind, Named):
            raise refused("an initialiser")
        members = self.places.program.structures[kind.name].members
        parts = [
            f"{rust_name(name)}: {self.given((kind.name, name), each, value)}"
            for (name, each), value in zip(members.items(), expression.values, strict=True)
            if not isinstance(each, FunctionPointer)
        ]
        return f"{type_name(kind.name)} {{ {', '.join(parts)} }}"


def real_text(value: float, number: str) -> Written:
    """Give a real number as Rust reads it back to the bit, the shortest way.

    Parameters
    ----------
    value
        What it holds, or is given.
    number
        The type in Rust.
    """
    if number == "f32":
        import numpy as np

        shortest = str(np.float32(value))
        assert struct.pack("f", value) == struct.pack("f", np.float32(shortest))
    else:
        shortest = repr(value)
    level = _SIGN if shortest.startswith("-") else _ATOM
    return f"{shortest}_{number}", level
