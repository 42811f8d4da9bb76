"""Types as the C text declares them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, final

from hyst.errors import HystError
from hyst.export.translate.conversions import whole_literal
from hyst.export.translate.program import (
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
    Structure,
)
from hyst.export.translate.refusal import refused

if TYPE_CHECKING:
    from pycparser import c_ast

_PLAIN = {
    ("double",): DOUBLE,
    ("float",): FLOAT,
    ("int",): INT,
    ("signed", "int"): INT,
    ("unsigned",): UNSIGNED,
    ("unsigned", "int"): UNSIGNED,
    ("unsigned", "char"): BYTE,
    ("void",): VOID,
    ("size_t",): SIZE,
    ("uint8_t",): BYTE,
    ("int32_t",): INT,
    ("uint32_t",): UNSIGNED,
    ("uint64_t",): WIDE,
}


@final
@dataclass(frozen=True)
class Pattern:
    """A union of a real number and its bits; a variable of it is kept as the bits.

    Parameters
    ----------
    value
        What it holds, or is given.
    bits
        Name of the member that holds the bits.
    real
        Type of the number.
    word
        Type of the bits.
    """

    value: str
    bits: str
    real: Scalar
    word: Scalar


@final
@dataclass
class Declared:
    """Types and enumerators that the text has declared so far.

    Parameters
    ----------
    names
        Types by name.
    structures
        By name.
    patterns
        Unions of a number and its bits, by name.
    enumerators
        Values by name.
    """

    names: dict[str, CType] = field(default_factory=dict)
    structures: dict[str, Structure] = field(default_factory=dict)
    patterns: dict[str, Pattern] = field(default_factory=dict)
    enumerators: dict[str, int] = field(default_factory=dict)

    def type_of(self, node: Any, count: Any = None) -> CType:
        """Give the type of a declarator; ``count`` evaluates the length of an array.

        Parameters
        ----------
        node
            Of the syntax tree.
        count
            How many, or what evaluates it.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        match type(node).__name__:
            case "TypeDecl":
                return self._base(node)
            case "PtrDecl":
                if type(node.type).__name__ == "FuncDecl":
                    return FunctionPointer()
                return Pointer(self.type_of(node.type, count), "const" in _qualifiers(node.type))
            case "ArrayDecl":
                length = -1 if node.dim is None else count(node.dim)
                return Array(self.type_of(node.type, count), length)
        raise refused(f"a declarator {type(node).__name__}", node)

    def _base(self, node: c_ast.TypeDecl) -> CType:
        kind = type(node.type).__name__
        if kind == "IdentifierType":
            names = tuple(node.type.names)
            if names in _PLAIN:
                return _PLAIN[names]
            if len(names) == 1 and names[0] in self.names:
                return self.names[names[0]]
            raise refused(f"the type {' '.join(names)}", node)
        if kind in ("Struct", "Union"):
            return self.structure(node, node.type)
        if kind == "Enum":
            self.enumerate(node.type)
            return INT
        raise refused(f"the type {kind}", node)

    def structure(self, node: Any, declared: Any) -> CType:
        """Take in a structure; one without a name gets that of what it is declared for.

        Parameters
        ----------
        node
            Of what it is declared for.
        declared
            Of the structure or the union.

        Raises
        ------
        UntranslatableError
            If a member has no counterpart.
        """
        name = declared.name or node.declname
        if declared.decls is None:
            return Named(name)
        if name in self.structures or name in self.patterns:
            name = f"{name}_{len(self.structures)}"
        members: dict[str, CType] = {}
        for each in declared.decls:
            if each.bitsize is not None:
                raise refused("a member of some bits", each)
            members[each.name] = self.type_of(each.type, self.constant)
        if type(declared).__name__ == "Union":
            pattern = _pattern(members)
            if pattern is not None:
                self.patterns[name] = pattern
                return Named(name)
            if not all(isinstance(each, Named) for each in members.values()):
                raise refused(f"the union {name}, whose members are not all structures", node)
        self.structures[name] = Structure(name, members)
        return Named(name)

    def enumerate(self, node: Any) -> None:
        """Take in enumerators."""
        following = 0
        for each in () if node.values is None else node.values.enumerators:
            if each.value is not None:
                following = self.constant(each.value)
            self.enumerators[each.name] = following
            following += 1

    def constant(self, node: Any) -> int:
        """Give the value of a constant expression of whole numbers.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        match type(node).__name__:
            case "Constant":
                if "int" in node.type:
                    return int(whole_literal(node.value).value)
            case "ID":
                if node.name in self.enumerators:
                    return self.enumerators[node.name]
            case "Cast":
                return self.constant(node.expr)
            case "UnaryOp":
                if node.op == "-":
                    return -self.constant(node.expr)
            case "BinaryOp":
                left, right = self.constant(node.left), self.constant(node.right)
                if node.op in _ARITHMETIC:
                    return int(_ARITHMETIC[node.op](left, right))
        raise refused("a constant that is not made of whole numbers", node)


_ARITHMETIC = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    # C cuts off towards zero.
    "/": lambda a, b: a // b if (a < 0) == (b < 0) else -(-a // b),
    "<<": lambda a, b: a << b,
    "|": lambda a, b: a | b,
}


def _qualifiers(node: Any) -> list[str]:
    return node.quals if hasattr(node, "quals") else []


def _pattern(members: dict[str, CType]) -> Pattern | None:
    if len(members) != 2:
        return None
    (first, real), (second, word) = members.items()
    pairs = {("double", "uint64"), ("float", "uint32")}
    if isinstance(real, Scalar) and isinstance(word, Scalar):
        if (real.name, word.name) in pairs:
            return Pattern(first, second, real, word)
        raise HystError(f"a union of {real.name} and {word.name} cannot be translated")
    return None
