"""The typed program that other languages are written from: statements, functions, and the whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

from hyst.export.translate.nodes import (
    AddressOf,
    Binary,
    Call,
    Comparison,
    Conditional,
    Convert,
    Decay,
    Element,
    Expression,
    FromBits,
    FunctionName,
    Initialiser,
    Logical,
    Member,
    Name,
    Not,
    Null,
    Number,
    Offset,
    ToBits,
    Unary,
)
from hyst.export.translate.types import (
    BYTE,
    DOUBLE,
    FLOAT,
    INT,
    SIZE,
    UNSIGNED,
    VOID,
    WIDE,
    Array,
    CType,
    FunctionPointer,
    Named,
    Pointer,
    Scalar,
)


@final
@dataclass(frozen=True)
class Declare:
    """A local variable; without a value it is set before it is read."""

    variable: Variable
    value: Expression | None


@final
@dataclass(frozen=True)
class Assign:
    """A place (Name, Member or Element) gets a value of its type."""

    place: Expression
    value: Expression


@final
@dataclass(frozen=True)
class Evaluate:
    """A call whose value, if any, is not used."""

    call: Call


@final
@dataclass(frozen=True)
class If:
    """``other`` is empty where there is none.

    Parameters
    ----------
    condition
        A comparison, or several, joined or denied.
    then
        Where the condition holds.
    other
        Where it does not.
    """

    condition: Expression
    then: tuple[Statement, ...]
    other: tuple[Statement, ...]


@final
@dataclass(frozen=True)
class Loop:
    """``before`` once; while ``condition`` holds, ``body`` and then ``step``; no ``continue``."""

    before: tuple[Statement, ...]
    condition: Expression
    step: tuple[Statement, ...]
    body: tuple[Statement, ...]


@final
@dataclass(frozen=True)
class Break:
    """Leaves the innermost loop."""


@final
@dataclass(frozen=True)
class Return:
    """Leaves the function.

    Parameters
    ----------
    value
        What it holds, or is given.
    """

    value: Expression | None


@final
@dataclass(frozen=True)
class Block:
    """Statements with variables of their own; their names are unique in the function anyway.

    Parameters
    ----------
    body
        Statements.
    """

    body: tuple[Statement, ...]


Statement = Declare | Assign | Evaluate | If | Loop | Break | Return | Block


@final
@dataclass(frozen=True)
class Variable:
    """A parameter or a local variable.

    Parameters
    ----------
    name
        Unique in its function, except for variables of one type that never live at once.
    type
        Of a parameter that is an array in C, the pointer.
    is_const
        Whether it keeps its first value.
    """

    name: str
    type: CType
    is_const: bool = False


@final
@dataclass(frozen=True)
class Function:
    """A function.

    Parameters
    ----------
    name
        As in C.
    parameters
        In their order.
    result
        Type, void for none.
    body
        Statements.
    locals
        All variables declared anywhere in the body, each name once.
    """

    name: str
    parameters: tuple[Variable, ...]
    result: CType
    body: tuple[Statement, ...]
    locals: tuple[Variable, ...]


@final
@dataclass(frozen=True)
class Structure:
    """A structure: types of its members, in their order.

    A union of structures, of which C code uses the one that a tag names, is a structure too.

    Parameters
    ----------
    name
        Its name.
    members
        Types by name, in their order.
    """

    name: str
    members: Mapping[str, CType]


@final
@dataclass(frozen=True)
class Table:
    """A constant of the file: an array, a structure or a number.

    Parameters
    ----------
    name
        Its name.
    type
        Type of the result.
    value
        What it holds, or is given.
    """

    name: str
    type: CType
    value: Expression


@final
@dataclass(frozen=True)
class Program:
    """What the entry points reach.

    Parameters
    ----------
    real
        The type of ``hyst_real``: double or float.
    functions
        By name, those that are called before those that call them.
    structures
        By name, inner before outer.
    tables
        By name, in the order of the text, those that are pointed to before those that point.
    constants
        Values of the enumerators and of the macros asked for.
    entries
        Names of the entry points.
    """

    real: Scalar
    functions: Mapping[str, Function]
    structures: Mapping[str, Structure]
    tables: Mapping[str, Table]
    constants: Mapping[str, int]
    entries: tuple[str, ...]


__all__ = [
    "BYTE",
    "DOUBLE",
    "FLOAT",
    "INT",
    "SIZE",
    "UNSIGNED",
    "VOID",
    "WIDE",
    "AddressOf",
    "Array",
    "Assign",
    "Binary",
    "Block",
    "Break",
    "CType",
    "Call",
    "Comparison",
    "Conditional",
    "Convert",
    "Decay",
    "Declare",
    "Element",
    "Evaluate",
    "Expression",
    "FromBits",
    "Function",
    "FunctionName",
    "FunctionPointer",
    "If",
    "Initialiser",
    "Logical",
    "Loop",
    "Member",
    "Name",
    "Named",
    "Not",
    "Null",
    "Number",
    "Offset",
    "Pointer",
    "Program",
    "Return",
    "Scalar",
    "Statement",
    "Structure",
    "Table",
    "ToBits",
    "Unary",
    "Variable",
]
