"""A whole text of C, read: from its entry points to all they reach."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import Any

from hyst.errors import HystError, MissingExtraError
from hyst.export.translate.declared import Declared
from hyst.export.translate.expressions import Expressions
from hyst.export.translate.pointers import with_plain_pointers, without_local_pointers
from hyst.export.translate.preprocessor import preprocessed
from hyst.export.translate.program import (
    VOID,
    Array,
    CType,
    Function,
    FunctionPointer,
    Name,
    Named,
    Pointer,
    Program,
    Scalar,
    Structure,
    Table,
)
from hyst.export.translate.refusal import UntranslatableError, refused
from hyst.export.translate.scope import Scope
from hyst.export.translate.statements import Statements, is_constant
from hyst.export.translate.unread import without_unread_pointers

_STANDARD = "".join(
    f"typedef int {name};\n" for name in ("size_t", "uint8_t", "int32_t", "uint32_t", "uint64_t")
)
_BUILT_IN = ("size_t", "uint8_t", "int32_t", "uint32_t", "uint64_t")


def read_program(text: str, entries: Iterable[str], real: str = "hyst_real") -> Program:
    """Give the typed program of a text of C.

    Parameters
    ----------
    text
        C, all of it, headers before what includes them.
    entries
        Names of the functions that are called from outside.
    real
        The name of the type of all numbers.

    Returns
    -------
    Program

    Raises
    ------
    HystError
        If something cannot be translated; the message names the function and the construct.
    MissingExtraError
        If pycparser is not installed.
    """
    return _Reading(_parsed(_STANDARD + preprocessed(text))).program(tuple(entries), real)


def _parsed(text: str) -> Any:
    try:
        from pycparser import c_parser
    except ImportError as error:
        raise MissingExtraError(
            "an export in another language than C is translated with pycparser; install it with "
            "pip install 'hyst[languages]'"
        ) from error
    try:
        return c_parser.CParser().parse(text)
    except c_parser.ParseError as error:
        raise HystError(f"the C to translate cannot be parsed: {error}") from error


class _Reading:
    """Definitions of the text, and those that were asked for so far."""

    def __init__(self, tree: Any) -> None:
        self.declared = Declared()
        self.definitions: dict[str, Any] = {}
        self.constants: dict[str, Any] = {}
        self.functions: dict[str, Function] = {}
        self.tables: dict[str, Table] = {}
        self.pending: list[str] = []
        for node in tree.ext:
            self._take(node)
        self._know_targets(tree)

    def program(self, entries: tuple[str, ...], real: str) -> Program:
        for entry in entries:
            self._function(entry)
        kind = self.declared.names.get(real)
        if not isinstance(kind, Scalar) or not kind.is_real:
            raise HystError(f"the C to translate has no type {real}")
        whole = Program(
            kind, self.functions, {}, self.tables, dict(self.declared.enumerators), entries
        )
        return without_unread_pointers(whole, self.declared.structures)

    def _take(self, node: Any) -> None:
        match type(node).__name__:
            case "FuncDef":
                self.definitions[node.decl.name] = node
            case "Typedef":
                if node.name not in _BUILT_IN:
                    self.declared.names[node.name] = self.declared.type_of(
                        node.type, self.declared.constant
                    )
            case "Decl":
                if type(node.type).__name__ == "Enum":
                    self.declared.enumerate(node.type)
                elif type(node.type).__name__ in ("Struct", "Union"):
                    self.declared.structure(node, node.type)
                elif node.init is not None:
                    self.constants[node.name] = node

    def _know_targets(self, tree: Any) -> None:
        """Find which function every member that points to one is given, and the model's type.

        ``hyst_kind``, the row of a chain, is left out: exports call stages directly.
        """
        self.targets: dict[tuple[str, str], set[str]] = {}
        for node in _declarations(tree):
            name = getattr(getattr(node.type, "type", None), "names", [""])[-1]
            kind = self.declared.names.get(name)
            if not isinstance(kind, Named) or kind.name not in self.declared.structures:
                continue
            members = self.declared.structures[kind.name].members
            for (member, type_of), value in zip(members.items(), node.init.exprs, strict=False):
                if isinstance(type_of, FunctionPointer) and type(value).__name__ == "ID":
                    self.targets.setdefault((kind.name, member), set()).add(value.name)
        for (name, member), targets in self.targets.items():
            if len(targets) == 1:
                self._point_to_model(name, member, next(iter(targets)))

    def _point_to_model(self, name: str, member: str, target: str) -> None:
        """Give ``void`` pointers beside one to a function the type that this casts them to."""
        if target not in self.definitions:
            return
        kind = self._cast_of(self.definitions[target])
        if kind is None:
            return
        members = self.declared.structures[name].members
        self.declared.structures[name] = Structure(
            name, {key: kind if _is_void(each) else each for key, each in members.items()}
        )

    def _cast_of(self, definition: Any) -> CType | None:
        """Give the one type that a function casts its ``void`` parameter to."""
        kinds = {
            self.declared.type_of(node.to_type.type)
            for node in _casts(definition.body)
            if type(node.to_type.type).__name__ == "PtrDecl"
        }
        return next(iter(kinds)) if len(kinds) == 1 else None

    def _target(self, structure: str, member: str) -> str:
        targets = sorted(self.targets.get((structure, member), ()))
        if len(targets) != 1:
            raise refused(
                f"a call of {member}, which points to {' or '.join(targets) or 'nothing'}"
            )
        return targets[0]

    @functools.cache  # noqa: B019 - lives as long as one reading
    def _signature(self, name: str) -> tuple[tuple[CType, ...], CType]:
        if name not in self.definitions:
            raise refused(f"a call of {name}, which the text does not define,")
        definition = self.definitions[name]
        given = definition.decl.type.args
        kinds: list[CType] = []
        for each in () if given is None else given.params:
            if type(each).__name__ == "EllipsisParam":
                raise refused(f"{name}, which takes any number of arguments,")
            kind = self.declared.type_of(each.type, self.declared.constant)
            if isinstance(kind, Array):
                kind = Pointer(kind.of, "const" in each.type.type.quals)
            if _is_void(kind):
                kind = self._cast_of(definition) or kind
            kinds.append(kind)
        kinds = [] if kinds == [VOID] else kinds
        return tuple(kinds), self.declared.type_of(definition.decl.type.type)

    def _call_of(self, name: str) -> tuple[tuple[CType, ...], CType]:
        """Give the signature of a function that is called, and translate it."""
        signature = self._signature(name)
        self._function(name)
        return signature

    def _function(self, name: str) -> None:
        if name in self.functions:
            return
        if name in self.pending:
            raise refused(f"{name}, which calls itself,")
        self.pending.append(name)
        try:
            function = self._translated(name)
        except UntranslatableError as error:
            if str(error).startswith("in "):
                raise
            raise UntranslatableError(f"in {name}: {error}") from error
        self.pending.pop()
        self.functions[name] = function

    def _translated(self, name: str) -> Function:
        kinds, result = self._signature(name)
        definition = self.definitions[name]
        scope = Scope(frozenset(self.definitions) | frozenset(self.constants))
        names = [each.name for each in definition.decl.type.args.params] if kinds else []
        parameters = tuple(
            scope.declare(each, kind, False, "parameter")
            for each, kind in zip(names, kinds, strict=True)
        )
        expressions = Expressions(self.declared, scope, self._call_of, self._table, self._target)

        def hoist(table: Table) -> Name:
            own = f"{name}_{table.name}"
            self.tables[own] = Table(own, table.type, table.value)
            return Name(own, table.type, "table")

        statements = Statements(self.declared, scope, expressions, result, hoist)
        body = statements.all(definition.body.block_items)
        taken = {each.name for each in parameters}
        local = tuple(each for each in scope.declared.values() if each.name not in taken)
        function = Function(name, parameters, result, body, local)
        return without_local_pointers(function, self.functions)

    def _table(self, name: str) -> Name | None:
        """Give the constant of the file that has a name, translated with all it points to."""
        if name not in self.tables:
            node = self.constants.get(name)
            if node is None:
                return None
            kind = self.declared.type_of(node.type, self.declared.constant)
            if not is_constant(node.type):
                raise refused(f"the variable {name} of the file")
            expressions = Expressions(
                self.declared, Scope(frozenset()), self._call_of, self._table, self._target
            )
            value = with_plain_pointers(expressions.as_type(node.init, kind))
            self.tables[name] = Table(name, value.type, value)
        return Name(name, self.tables[name].type, "table")


def _is_void(kind: CType) -> bool:
    return isinstance(kind, Pointer) and kind.to == VOID


def _declarations(tree: Any) -> list[Any]:
    """Give all declarations with a list of values, wherever they stand."""
    found = []
    if type(tree).__name__ == "Decl" and type(tree.init).__name__ == "InitList":
        found.append(tree)
    for _, child in tree.children():
        found += _declarations(child)
    return found


def _casts(tree: Any) -> list[Any]:
    found = [tree] if type(tree).__name__ == "Cast" else []
    for _, child in tree.children():
        found += _casts(child)
    return found
