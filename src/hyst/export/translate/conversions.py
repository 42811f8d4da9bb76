"""The conversions that C does without a word."""

from __future__ import annotations

import math
import struct
from fractions import Fraction

from hyst.export.translate.program import (
    BYTE,
    DOUBLE,
    FLOAT,
    INT,
    SIZE,
    UNSIGNED,
    WIDE,
    Array,
    Convert,
    CType,
    Decay,
    Expression,
    Null,
    Number,
    Offset,
    Pointer,
    Scalar,
)
from hyst.export.translate.refusal import refused
from hyst.export.translate.types import said

_RANK: list[CType] = [INT, UNSIGNED, SIZE, WIDE, FLOAT, DOUBLE]
_MOST = {"int32": 2**31 - 1, "uint32": 2**32 - 1, "size": 2**32 - 1, "uint64": 2**64 - 1}


def promoted(value: Expression) -> Expression:
    """Give a number as the type that arithmetic starts from."""
    return converted(value, INT) if value.type == BYTE else value


def common(left: Expression, right: Expression) -> tuple[Expression, Expression, CType]:
    """Give two numbers in the type that C computes with them in.

    Parameters
    ----------
    left
        The first operand.
    right
        The second operand.

    Raises
    ------
    UntranslatableError
        If C does something here that has no counterpart.
    """
    left, right = promoted(left), promoted(right)
    if left.type not in _RANK or right.type not in _RANK:
        raise refused("arithmetic with something that is no number")
    to = _RANK[max(_RANK.index(left.type), _RANK.index(right.type))]
    return converted(left, to), converted(right, to), to


def converted(value: Expression, to: CType) -> Expression:
    """Give a value as one of another type, as C does in assignments and calls.

    Parameters
    ----------
    value
        What it holds, or is given.
    to
        The type, or the place, it becomes.

    Raises
    ------
    UntranslatableError
        If C does something here that has no counterpart.
    """
    if isinstance(value, Null) and isinstance(to, Pointer):
        return Null(to)
    value = decayed(value)
    if value.type == to:
        return value
    if isinstance(to, Pointer) and isinstance(value.type, Pointer):
        return _pointer(value, to)
    if (
        not isinstance(to, Scalar)
        or not isinstance(value.type, Scalar)
        or "void"
        in (
            to.name,
            value.type.name,
        )
    ):
        raise refused(f"a conversion of {said(value.type)} to {said(to)}")
    if isinstance(value, Number) and _holds(value.value, to):
        return Number(float(value.value) if to.is_real else value.value, to)
    return Convert(value, to)


def decayed(value: Expression) -> Expression:
    """Give an array as the pointer to its first element, anything else as it is."""
    if isinstance(value.type, Array):
        return Decay(value, Pointer(value.type.of, is_const=False))
    return value


def real_literal(text: str) -> Number:
    """Give a floating constant of C, rounded as C rounds it.

    Raises
    ------
    UntranslatableError
        If it is one of extended precision, which C computes with as no other number here.
    """
    if text[-1] in "lL":
        raise refused(f"the constant {text} of extended precision")
    single = text[-1] in "fF" and not (text.lower().startswith("0x") and "p" not in text.lower())
    digits = text.rstrip("fF")
    value = float.fromhex(digits) if digits.lower().startswith("0x") else float(digits)
    if not single:
        return Number(value, DOUBLE)
    return Number(_as_single(digits, value), FLOAT)


def whole_literal(text: str) -> Number:
    """Give a whole constant of C.

    Raises
    ------
    UntranslatableError
        If its type is ``long``, whose size targets differ in, or its digits are octal.
    """
    digits = text.rstrip("uUlL")
    suffix = text[len(digits) :].lower()
    if digits[0] == "0" and digits.strip("0") and digits[1] not in "xX":
        raise refused(f"the octal constant {text}")
    value = int(digits, 0)
    is_long = digits[0] != "0" and "u" not in suffix and 2**31 <= value < 2**32
    if suffix.count("l") == 1 or is_long:
        raise refused(f"the constant {text} of type long")
    if "ll" in suffix or value > 2**32 - 1:
        return Number(value, WIDE)
    return Number(value, UNSIGNED if "u" in suffix or value > 2**31 - 1 else INT)


def _as_single(digits: str, value: float) -> float:
    """Give the single precision number nearest to the digits; by way of double it may miss."""
    nearest = struct.unpack("f", struct.pack("f", value))[0]
    if digits.lower().startswith("0x"):
        return nearest  # type: ignore[no-any-return]
    exact = Fraction(digits)
    bits = struct.unpack("I", struct.pack("f", nearest))[0]
    around = range(max(bits - 1, 0), bits + 2)
    near = [struct.unpack("f", struct.pack("I", each))[0] for each in around]
    # A tie goes to the even one, which is what double has chosen unless it was no tie.
    return min(  # type: ignore[no-any-return]
        (each for each in near if math.isfinite(each)),
        key=lambda each: (abs(Fraction(each) - exact), each != nearest),
    )


def _pointer(value: Expression, to: Pointer) -> Expression:
    """Let a pointer to something be one to something constant."""
    of = value.type
    if not isinstance(of, Pointer) or of.to != to.to or (of.is_const and not to.is_const):
        raise refused(f"a conversion of {said(of)} to {said(to)}")
    if isinstance(value, Decay):
        return Decay(value.of, to)
    if isinstance(value, Offset):
        return Offset(value.of, value.index, to)
    return Convert(value, to)


def _holds(value: float | int, to: Scalar) -> bool:
    if to.is_real:
        return isinstance(value, int) and abs(value) <= 2**24
    return isinstance(value, int) and 0 <= value <= _MOST.get(to.name, 255)
