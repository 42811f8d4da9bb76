"""Expressions of C, with the types they have."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hyst.export.translate.conversions import (
    common,
    converted,
    decayed,
    promoted,
    real_literal,
    whole_literal,
)
from hyst.export.translate.declared import Declared, Pattern
from hyst.export.translate.program import (
    DOUBLE,
    FLOAT,
    INT,
    SIZE,
    VOID,
    AddressOf,
    Array,
    Binary,
    Call,
    Comparison,
    Conditional,
    CType,
    Element,
    Expression,
    FromBits,
    FunctionName,
    FunctionPointer,
    Initialiser,
    Logical,
    Member,
    Name,
    Named,
    Not,
    Null,
    Number,
    Offset,
    Pointer,
    Scalar,
    ToBits,
    Unary,
)
from hyst.export.translate.refusal import refused
from hyst.export.translate.scope import Scope

_COMPARED = ("<", "<=", ">", ">=", "==", "!=")
_ZERO = Number(0, SIZE)


class Expressions:
    """Gives typed expressions in a scope.

    Parameters
    ----------
    declared
        Types and enumerators.
    scope
        Variables.
    signature
        Gives the types of parameters and the result of a function that is called.
    table
        Gives the table of a name, or None.
    target
        Gives the function that a member of a structure points to.
    """

    def __init__(
        self,
        declared: Declared,
        scope: Scope,
        signature: Callable[[str], tuple[tuple[CType, ...], CType]],
        table: Callable[[str], Name | None],
        target: Callable[[str, str], str],
    ) -> None:
        self.declared = declared
        self.scope = scope
        self.signature = signature
        self.table = table
        self.target = target

    def value(self, node: Any) -> Expression:
        """Give the value of an expression, an array as it is.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        method = getattr(self, f"_{type(node).__name__.lower()}", None)
        if method is None:
            raise refused(f"a {type(node).__name__} inside an expression", node)
        return method(node)  # type: ignore[no-any-return]

    def as_type(self, node: Any, to: CType) -> Expression:
        """Give the value of an expression, or of an initialiser, as that of a type.

        Parameters
        ----------
        node
            Of the syntax tree.
        to
            The type, or the place, it becomes.
        """
        if type(node).__name__ == "InitList":
            return self._initialiser(node, to)
        if isinstance(to, FunctionPointer):
            return FunctionName(node.name, to)
        return converted(self.value(node), to)

    def condition(self, node: Any) -> Expression:
        """Give an expression as a condition: a comparison, or several, joined or denied."""
        return _as_condition(self.value(node))

    def _constant(self, node: Any) -> Expression:
        if node.type in ("double", "float", "long double"):
            return real_literal(node.value)
        if "int" in node.type:
            return whole_literal(node.value)
        raise refused("a constant that is no number", node)

    def _id(self, node: Any) -> Expression:
        variable = self.scope.find(node.name)
        if variable is not None:
            return variable
        if node.name in self.declared.enumerators:
            value = self.declared.enumerators[node.name]
            return Number(value, INT) if value >= 0 else Unary("-", Number(-value, INT), INT)
        if node.name == "NULL":
            return Null(Pointer(VOID, is_const=True))
        table = self.table(node.name)
        if table is None:
            raise refused(f"the name {node.name}")
        return table

    def _cast(self, node: Any) -> Expression:
        to = self.declared.type_of(node.to_type.type)
        value = self.value(node.expr)
        if to == VOID:
            return value
        return converted(value, to)

    def _unaryop(self, node: Any) -> Expression:
        if node.op == "sizeof":
            raise refused("sizeof", node)
        if node.op == "&":
            return _address(self.value(node.expr), node)
        value = self.value(node.expr)
        if node.op == "*":
            return self._element(decayed(value), _ZERO)
        if node.op == "!":
            return Not(_as_condition(value))
        if node.op == "+":
            return promoted(value)
        if node.op in "-~":
            value = promoted(value)
            return Unary(node.op, value, value.type)
        raise refused(f"{node.op} inside an expression", node)

    def _binaryop(self, node: Any) -> Expression:
        if node.op in ("&&", "||"):
            return Logical(node.op, self.condition(node.left), self.condition(node.right))
        if node.op == "/" and _is_size(node.left) and _is_size(node.right):
            return self._count(node)
        left, right = decayed(self.value(node.left)), decayed(self.value(node.right))
        if isinstance(left.type, Pointer) or isinstance(right.type, Pointer):
            return _pointers(node, left, right)
        return self.arithmetic(node.op, left, right)

    def _count(self, node: Any) -> Expression:
        """Give the number of elements, as ``sizeof row / sizeof row[0]`` says it."""
        whole = self.value(node.left.expr)
        part = node.right.expr
        is_element = type(part).__name__ == "ArrayRef" and self.value(part.name) == whole
        if isinstance(whole.type, Array) and is_element:
            return Number(whole.type.count, SIZE)
        raise refused("sizeof", node)

    def arithmetic(self, operator: str, left: Expression, right: Expression) -> Expression:
        """Give an operation of two numbers.

        Parameters
        ----------
        operator
            As C writes it.
        left
            The first operand.
        right
            The second operand.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        if operator in ("<<", ">>"):
            left, right = promoted(left), promoted(right)
            return Binary(operator, left, right, left.type)
        left, right, kind = common(left, right)
        if operator in _COMPARED:
            return Comparison(operator, left, right)
        if kind in (FLOAT, DOUBLE) and operator not in "+-*/":
            raise refused(f"{operator} of real numbers")
        return Binary(operator, left, right, kind)

    def _ternaryop(self, node: Any) -> Expression:
        condition = self.condition(node.cond)
        then, other = decayed(self.value(node.iftrue)), decayed(self.value(node.iffalse))
        if isinstance(then.type, Scalar) and isinstance(other.type, Scalar):
            then, other, _ = common(then, other)
        elif isinstance(then, Null):
            then = converted(then, other.type)
        else:
            other = converted(other, then.type)
        return Conditional(condition, then, other, then.type)

    def _arrayref(self, node: Any) -> Expression:
        of, index = self.value(node.name), converted(promoted(self.value(node.subscript)), SIZE)
        return self._element(of, index)

    def _element(self, of: Expression, index: Expression) -> Expression:
        if isinstance(of, AddressOf) and index == _ZERO:
            return of.of
        if isinstance(of, Offset):
            return self._element(of.of, _sum(of.index, index))
        if isinstance(of.type, Pointer):
            return Element(of, index, of.type.to)
        if isinstance(of.type, Array):
            return Element(of, index, of.type.of)
        raise refused("an element of what is no array")

    def _structref(self, node: Any) -> Expression:
        of = self.value(node.name)
        if node.type == "->":
            of = self._element(decayed(of), _ZERO)
        if not isinstance(of.type, Named):
            raise refused("a member of what is no structure", node)
        name = node.field.name
        pattern = self.declared.patterns.get(of.type.name)
        if pattern is not None:
            return _half(pattern, of, name)
        return Member(of, name, self.declared.structures[of.type.name].members[name])

    def _funccall(self, node: Any) -> Expression:
        name = self._called(node.name)
        kinds, result = self.signature(name)
        given = () if node.args is None else node.args.exprs
        if len(given) != len(kinds):
            raise refused("a call with another number of arguments", node)
        arguments = tuple(self.as_type(each, kind) for each, kind in zip(given, kinds, strict=True))
        return Call(name, arguments, result)

    def _called(self, node: Any) -> str:
        if type(node).__name__ == "ID" and self.scope.find(node.name) is None:
            return str(node.name)
        value = self.value(node)
        if isinstance(value, Member) and isinstance(value.of.type, Named):
            return self.target(value.of.type.name, value.name)
        raise refused("a call of a function that is not known", node)

    def _initialiser(self, node: Any, to: CType) -> Initialiser:
        given = node.exprs
        if any(type(each).__name__ == "NamedInitializer" for each in given):
            raise refused("an initialiser with names", node)
        if isinstance(to, Array):
            count = len(given) if to.count < 0 else to.count
            kinds: list[CType] = [to.of] * count
            to = Array(to.of, count)
        elif isinstance(to, Named):
            kinds = list(self.declared.structures[to.name].members.values())
        else:
            raise refused("an initialiser of a number", node)
        if len(given) > len(kinds):
            raise refused("an initialiser with too many values", node)
        values = [self.as_type(each, kind) for each, kind in zip(given, kinds, strict=False)]
        values += [self.nothing(kind) for kind in kinds[len(given) :]]
        if isinstance(to, Array) and values:
            to = Array(values[0].type, to.count)
        return Initialiser(tuple(values), to)

    def nothing(self, kind: CType) -> Expression:
        """Give what C leaves where an initialiser says nothing.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        if isinstance(kind, Scalar):
            return Number(0.0 if kind.is_real else 0, kind)
        if isinstance(kind, Pointer):
            return Null(kind)
        if isinstance(kind, Array):
            return Initialiser((self.nothing(kind.of),) * kind.count, kind)
        if isinstance(kind, Named):
            members = self.declared.structures[kind.name].members.values()
            return Initialiser(tuple(self.nothing(each) for each in members), kind)
        raise refused("a member that is left out")


def _is_size(node: Any) -> bool:
    return type(node).__name__ == "UnaryOp" and node.op == "sizeof"


def _as_condition(value: Expression) -> Expression:
    if isinstance(value, Comparison | Logical | Not):
        return value
    value = decayed(value)
    if isinstance(value.type, Pointer):
        return Comparison("!=", value, Null(value.type))
    if not isinstance(value.type, Scalar):
        raise refused("a condition that is no number")
    return Comparison("!=", value, Number(0.0 if value.type.is_real else 0, value.type))


def _address(of: Expression, node: Any) -> Expression:
    if isinstance(of, Element):
        base = decayed(of.of)
        if not isinstance(base.type, Pointer):
            raise refused("an address", node)
        return base if of.index == _ZERO else Offset(base, of.index, base.type)
    if isinstance(of, Name | Member):
        return AddressOf(of, Pointer(of.type, is_const=False))
    raise refused("an address of what is no place", node)


def _pointers(node: Any, left: Expression, right: Expression) -> Expression:
    """Give what C does with two values of which one is a pointer at least."""
    if node.op in ("==", "!="):
        if isinstance(left, Null):
            left, right = right, left
        if isinstance(right, Null):
            return Comparison(node.op, left, Null(left.type))
    if node.op == "+" and isinstance(right.type, Pointer):
        left, right = right, left
    return moved(node.op, left, right, node)


def moved(operator: str, pointer: Expression, by: Expression, node: Any) -> Expression:
    """Give a pointer further on, or back, by a number.

    Parameters
    ----------
    operator
        As C writes it.
    pointer
        What points.
    by
        How far.
    node
        Of the syntax tree.

    Raises
    ------
    UntranslatableError
        If C does something here that has no counterpart.
    """
    if operator not in "+-" or not isinstance(by.type, Scalar) or by.type.is_real:
        raise refused(f"{operator} of pointers", node)
    index = converted(promoted(by), SIZE)
    if operator == "-":
        before = pointer.index if isinstance(pointer, Offset) else _ZERO
        of = pointer.of if isinstance(pointer, Offset) else pointer
        return Offset(of, Binary("-", before, index, SIZE), pointer.type)
    if isinstance(pointer, Offset):
        return Offset(pointer.of, _sum(pointer.index, index), pointer.type)
    return Offset(pointer, index, pointer.type)


def _sum(first: Expression, second: Expression) -> Expression:
    if isinstance(first, Number) and isinstance(second, Number):
        return Number(int(first.value) + int(second.value), SIZE)
    if second == _ZERO:
        return first
    return second if first == _ZERO else Binary("+", first, second, SIZE)


def _half(pattern: Pattern, of: Expression, name: str) -> Expression:
    """Give one side of a union of a number and its bits; the variable itself holds the bits."""
    if not isinstance(of, Name):
        raise refused("a union that is no variable")
    bits = Name(of.name, pattern.word, of.kind)
    return bits if name == pattern.bits else FromBits(bits, pattern.real)


def stored(place: Expression, value: Expression) -> tuple[Expression, Expression]:
    """Give place and value of an assignment, bits where the place is a number kept as its bits."""
    if isinstance(place, FromBits):
        return place.operand, ToBits(converted(value, place.type), place.operand.type)
    return place, converted(value, place.type)
