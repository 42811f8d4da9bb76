"""The expressions of a program.

Conversions that C does silently are ``Convert`` nodes, so that both operands of arithmetic have the
type of the result. Pointers have one form: a place is ``Element(pointer, index)``, a pointer into
the middle ``Offset(pointer, index)``; ``p[i]``, ``*p``, ``&p[i]`` and ``p + i`` are written so.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst.export.translate.types import INT, CType


@final
@dataclass(frozen=True)
class Number:
    """A constant; of a real type, the exact value as Python's float."""

    value: float | int
    type: CType


@final
@dataclass(frozen=True)
class Name:
    """A variable.

    Parameters
    ----------
    name
        Unique in its function, or a table's.
    type
        Of what it holds.
    kind
        ``parameter``, ``local`` or ``table`` (a constant of the file).
    """

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
    """``-`` or ``~`` of a number of the same type.

    Parameters
    ----------
    operator
        As C writes it.
    operand
        The one operand.
    type
        Type of the result.
    """

    operator: str
    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class Not:
    """1 where the operand is 0 (or null), else 0.

    Parameters
    ----------
    operand
        The one operand.
    type
        Type of the result.
    """

    operand: Expression
    type: CType = INT


@final
@dataclass(frozen=True)
class Binary:
    """``+ - * / % & | ^ << >>``; of a shift, the right operand keeps its own type.

    Parameters
    ----------
    operator
        As C writes it.
    left
        The first operand.
    right
        The second operand.
    type
        Type of the result.
    """

    operator: str
    left: Expression
    right: Expression
    type: CType


@final
@dataclass(frozen=True)
class Comparison:
    """``< <= > >= == !=`` of two numbers of one type, or a pointer with ``Null``: 1 or 0.

    Parameters
    ----------
    operator
        As C writes it.
    left
        The first operand.
    right
        The second operand.
    type
        Type of the result.
    """

    operator: str
    left: Expression
    right: Expression
    type: CType = INT


@final
@dataclass(frozen=True)
class Logical:
    """``&&`` or ``||``, the right operand only evaluated where it decides: 1 or 0.

    Parameters
    ----------
    operator
        As C writes it.
    left
        The first operand.
    right
        The second operand.
    type
        Type of the result.
    """

    operator: str
    left: Expression
    right: Expression
    type: CType = INT


@final
@dataclass(frozen=True)
class Conditional:
    """One of two values of one type.

    Parameters
    ----------
    condition
        A comparison, or several, joined or denied.
    then
        Where the condition holds.
    other
        Where it does not.
    type
        Type of the result.
    """

    condition: Expression
    then: Expression
    other: Expression
    type: CType


@final
@dataclass(frozen=True)
class Convert:
    """A number as one of another type.

    Parameters
    ----------
    operand
        The one operand.
    type
        Type of the result.
    """

    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class ToBits:
    """The bits of a real number as an unsigned one of the same size.

    Parameters
    ----------
    operand
        The one operand.
    type
        Type of the result.
    """

    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class FromBits:
    """The real number that has these bits.

    Parameters
    ----------
    operand
        The one operand.
    type
        Type of the result.
    """

    operand: Expression
    type: CType


@final
@dataclass(frozen=True)
class Member:
    """A member of a structure, which is a place or a value, not a pointer to it.

    Parameters
    ----------
    of
        What it is of.
    name
        Its name.
    type
        Type of the result.
    """

    of: Expression
    name: str
    type: CType


@final
@dataclass(frozen=True)
class Element:
    """What a pointer or an array has at an index.

    Parameters
    ----------
    of
        What it is of.
    index
        A number of type size.
    type
        Type of the result.
    """

    of: Expression
    index: Expression
    type: CType


@final
@dataclass(frozen=True)
class Offset:
    """A pointer further on by an index.

    Parameters
    ----------
    of
        What it is of.
    index
        A number of type size.
    type
        Type of the result.
    """

    of: Expression
    index: Expression
    type: CType


@final
@dataclass(frozen=True)
class Decay:
    """An array, the place ``of``, as the pointer of a ``type`` to its first element."""

    of: Expression
    type: CType


@final
@dataclass(frozen=True)
class AddressOf:
    """The pointer to a place that is no element.

    Parameters
    ----------
    of
        What it is of.
    type
        Type of the result.
    """

    of: Expression
    type: CType


@final
@dataclass(frozen=True)
class Call:
    """A call of a function of the program; ``type`` may be void.

    Parameters
    ----------
    function
        The function it stands in or belongs to.
    arguments
        In their order.
    type
        Type of the result.
    """

    function: str
    arguments: tuple[Expression, ...]
    type: CType


@final
@dataclass(frozen=True)
class FunctionName:
    """A function by its ``name`` as the value of a member of a ``type``, which no call reads."""

    name: str
    type: CType


@final
@dataclass(frozen=True)
class Initialiser:
    """Values of all members or elements, in their order.

    Parameters
    ----------
    values
        In their order.
    type
        Type of the result.
    """

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
