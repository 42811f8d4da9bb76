"""The types that a program has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True)
class Scalar:
    """A number: double, float, int32, uint32, uint64, uint8 or size; or void.

    Parameters
    ----------
    name
        Its name.
    """

    name: str

    @property
    def is_real(self) -> bool:
        """Whether it is a floating-point number."""
        return self.name in ("double", "float")


@final
@dataclass(frozen=True)
class Pointer:
    """A pointer to one or more of a type.

    Parameters
    ----------
    to
        The type, or the place, it becomes.
    is_const
        Whether it must not be changed.
    """

    to: CType
    is_const: bool


@final
@dataclass(frozen=True)
class Array:
    """So many of a type.

    Parameters
    ----------
    of
        What it is of.
    count
        How many, or what evaluates it.
    """

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


def said(kind: CType) -> str:
    """Give a type for people, as C has it."""
    match kind:
        case Scalar(name) | Named(name):
            return name
        case Pointer(to, is_const):
            return f"a pointer to {'constant ' if is_const else ''}{said(to)}"
        case Array(of, count):
            return f"an array of {count} {said(of)}"
    return "a pointer to a function"
