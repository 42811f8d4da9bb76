"""The typed program that other languages are written from.

Conversions that C does silently are ``Convert`` nodes, so that both operands of arithmetic have the
type of the result. Pointers have one form: a place is ``Element(pointer, index)``, a pointer into
the middle ``Offset(pointer, index)``; ``p[i]``, ``*p``, ``&p[i]`` and ``p + i`` are written so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True)
class Scalar:
    """A number: double, float, int32, uint32, uint64, uint8 or size; or void."""

    name: str

    @property
    def is_real(self) -> bool:
        """Whether it is a floating-point number."""
        return self.name in ("double", "float")


@final
@dataclass(frozen=True)
class Pointer:
    """A pointer to one or more of a type."""

    to: CType
    is_const: bool


@final
@dataclass(frozen=True)
class Array:
    """So many of a type."""

    of: CType
    count: int


@final
@dataclass(frozen=True)
class Named:
    """A structure, by its name."""

    name: str


@final
@dataclass(frozen=True)
class FunctionPointer:
    """A pointer to a function; one target is known for each, so calls of it are ordinary ones."""


CType = Scalar | Pointer | Array | Named | FunctionPointer

VOID, INT, UNSIGNED, SIZE = Scalar("void"), Scalar("int32"), Scalar("uint32"), Scalar("size")
BYTE, WIDE, DOUBLE, FLOAT = Scalar("uint8"), Scalar("uint64"), Scalar("double"), Scalar("float")


@final
@dataclass(frozen=True)
class Number:
    """A constant; of a real type, the exact value as Python's float."""

    value: float | int
    type: CType


@final
@dataclass(frozen=True)
class Name:
    """A variable: ``kind`` is parameter, local or table (a constant of the file)."""

    name: str
    type: CType
    kind: str


@final
@dataclass(frozen=True)
class Null:
    """The pointer to nothing, of the type that takes it."""

    type: CType


@final
@dataclass(frozen=True)
class Unary:
    """``-`` or ``~`` of a number of the same type."""

    operator: str
    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class Not:
    """1 where the operand is 0 (or null), else 0."""

    operand: Expression
    type: CType = INT


@final
@dataclass(frozen=True)
class Binary:
    """``+ - * / % & | ^ << >>``; of a shift, the right operand keeps its own type."""

    operator: str
    left: Expression
    right: Expression
    type: CType


@final
@dataclass(frozen=True)
class Comparison:
    """``< <= > >= == !=`` of two numbers of one type, or a pointer with ``Null``: 1 or 0."""

    operator: str
    left: Expression
    right: Expression
    type: CType = INT


@final
@dataclass(frozen=True)
class Logical:
    """``&&`` or ``||``, the right operand only evaluated where it decides: 1 or 0."""

    operator: str
    left: Expression
    right: Expression
    type: CType = INT


@final
@dataclass(frozen=True)
class Conditional:
    """One of two values of one type."""

    condition: Expression
    then: Expression
    other: Expression
    type: CType


@final
@dataclass(frozen=True)
class Convert:
    """A number as one of another type."""

    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class ToBits:
    """The bits of a real number as an unsigned one of the same size."""

    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class FromBits:
    """The real number that has these bits."""

    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class Member:
    """A member of a structure, which is a place or a value, not a pointer to it."""

    of: Expression
    name: str
    type: CType


@final
@dataclass(frozen=True)
class Element:
    """What a pointer or an array has at an index."""

    of: Expression
    index: Expression
    type: CType


@final
@dataclass(frozen=True)
class Offset:
    """A pointer further on by an index."""

    of: Expression
    index: Expression
    type: CType


@final
@dataclass(frozen=True)
class Decay:
    """An array as the pointer to its first element."""

    of: Expression
    type: CType


@final
@dataclass(frozen=True)
class AddressOf:
    """The pointer to a place that is no element."""

    of: Expression
    type: CType


@final
@dataclass(frozen=True)
class Call:
    """A call of a function of the program; ``type`` may be void."""

    function: str
    arguments: tuple[Expression, ...]
    type: CType


@final
@dataclass(frozen=True)
class FunctionName:
    """A function as the value of a member, which no call reads."""

    name: str
    type: CType


@final
@dataclass(frozen=True)
class Initialiser:
    """Values of all members or elements, in their order."""

    values: tuple[Expression, ...]
    type: CType


Expression = (
    Number
    | Name
    | Null
    | Unary
    | Not
    | Binary
    | Comparison
    | Logical
    | Conditional
    | Convert
    | ToBits
    | FromBits
    | Member
    | Element
    | Offset
    | Decay
    | AddressOf
    | Call
    | FunctionName
    | Initialiser
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
    """``other`` is empty where there is none."""

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
    """Leaves the function."""

    value: Expression | None


@final
@dataclass(frozen=True)
class Block:
    """Statements with variables of their own; their names are unique in the function anyway."""

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
    """

    name: str
    members: Mapping[str, CType]


@final
@dataclass(frozen=True)
class Table:
    """A constant of the file: an array, a structure or a number."""

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
