"""Statements of C: what they do, in the few forms the program has."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hyst.export.translate.conversions import converted
from hyst.export.translate.declared import Declared
from hyst.export.translate.expressions import Expressions, moved, stored
from hyst.export.translate.program import (
    VOID,
    Array,
    Assign,
    Block,
    Break,
    Call,
    CType,
    Declare,
    Element,
    Evaluate,
    Expression,
    If,
    Initialiser,
    Logical,
    Loop,
    Member,
    Name,
    Named,
    Number,
    Pointer,
    Return,
    Scalar,
    Statement,
    Table,
)
from hyst.export.translate.refusal import refused
from hyst.export.translate.scope import Scope
from hyst.export.translate.walk import inside


class Statements:
    """Gives the statements of one function.

    Parameters
    ----------
    declared
        Types and enumerators.
    scope
        Variables.
    expressions
        Gives expressions in that scope.
    result
        Type of the function.
    hoist
        Takes a table that stands inside the function, and gives the name it has outside.
    """

    def __init__(
        self,
        declared: Declared,
        scope: Scope,
        expressions: Expressions,
        result: CType,
        hoist: Callable[[Table], Name],
    ) -> None:
        self.declared = declared
        self.scope = scope
        self.expressions = expressions
        self.result = result
        self.hoist = hoist

    def all(self, nodes: Any) -> tuple[Statement, ...]:
        """Give statements one after the other."""
        return tuple(each for node in nodes or () for each in self.one(node))

    def one(self, node: Any) -> tuple[Statement, ...]:
        """Give what a statement does; nothing for one that does nothing.

        Raises
        ------
        UntranslatableError
            If C does something here that has no counterpart.
        """
        method = getattr(self, f"_{type(node).__name__.lower()}", None)
        if method is None:
            raise refused(f"a {type(node).__name__}", node)
        return method(node)  # type: ignore[no-any-return]

    def _body(self, node: Any) -> tuple[Statement, ...]:
        """Give a branch or the body of a loop as a block of its own."""
        if node is None:
            return ()
        self.scope.enter()
        is_block = type(node).__name__ == "Compound"
        body = self.all(node.block_items) if is_block else self.one(node)
        self.scope.leave()
        return body

    def _compound(self, node: Any) -> tuple[Statement, ...]:
        body = self._body(node)
        return (Block(body),) if body else ()

    def _emptystatement(self, node: Any) -> tuple[Statement, ...]:
        return ()

    def _decl(self, node: Any) -> tuple[Statement, ...]:
        if "static" in (node.storage or []):
            self._static(node)
            return ()
        kind = self.declared.type_of(node.type, self.declared.constant)
        pattern = self.declared.patterns.get(kind.name) if isinstance(kind, Named) else None
        if pattern is not None:
            kind = pattern.word
            if node.init is not None:
                raise refused("a union with an initialiser", node)
        value = None if node.init is None else self.expressions.as_type(node.init, kind)
        if isinstance(kind, Array) and kind.count < 0:
            raise refused("an array without a length", node)
        is_const = value is not None and is_constant(node.type)
        variable = self.scope.declare(node.name, kind, is_const)
        if pattern is not None:
            self.scope.bind(
                node.name, Name(variable.name, Named(_key(self.declared, pattern)), "local")
            )
        return (Declare(variable, value),)

    def _decllist(self, node: Any) -> tuple[Statement, ...]:
        return self.all(node.decls)

    def _static(self, node: Any) -> None:
        if node.init is None or not is_constant(node.type):
            raise refused("a static variable", node)
        kind = self.declared.type_of(node.type, self.declared.constant)
        value = self.expressions.as_type(node.init, kind)
        outside = self.hoist(Table(node.name, value.type, value))
        self.scope.bind(node.name, outside)

    def _assignment(self, node: Any) -> tuple[Statement, ...]:
        before: tuple[Statement, ...] = ()
        last = node.rvalue
        if type(last).__name__ == "Assignment":
            before, last = self._assignment(last), last.lvalue
        place = self.expressions.value(node.lvalue)
        value = self.expressions.value(last)
        if node.op != "=":
            _refuse_twice(place, node)
            value = self._changed(node, place, value)
        if type(node.rvalue).__name__ == "InitList" or not isinstance(
            stored_place := stored(place, value)[0], Name | Member | Element
        ):
            raise refused("an assignment", node)
        return (*before, Assign(stored_place, stored(place, value)[1]))

    def _changed(self, node: Any, place: Expression, by: Expression) -> Expression:
        operator = node.op[:-1]
        if isinstance(place.type, Pointer):
            return moved(operator, place, by, node)
        return self.expressions.arithmetic(operator, place, by)

    def _unaryop(self, node: Any) -> tuple[Statement, ...]:
        operator = {"p++": "+", "++": "+", "p--": "-", "--": "-"}.get(node.op)
        if operator is None:
            raise refused("a statement without an effect", node)
        place = self.expressions.value(node.expr)
        _refuse_twice(place, node)
        if not isinstance(place.type, Scalar):
            raise refused(f"{node.op} of a pointer", node)
        value = self.expressions.arithmetic(operator, place, Number(1, place.type))
        return (Assign(place, converted(value, place.type)),)

    def _exprlist(self, node: Any) -> tuple[Statement, ...]:
        return self.all(node.exprs)

    def _funccall(self, node: Any) -> tuple[Statement, ...]:
        call = self.expressions.value(node)
        if not isinstance(call, Call):
            raise refused("a statement", node)
        return (Evaluate(call),)

    def _cast(self, node: Any) -> tuple[Statement, ...]:
        """Take ``(void)`` before what is not used."""
        if self.declared.type_of(node.to_type.type) != VOID:
            raise refused("a statement without an effect", node)
        if type(node.expr).__name__ == "FuncCall":
            return self._funccall(node.expr)
        self.expressions.value(node.expr)
        return ()

    def _if(self, node: Any) -> tuple[Statement, ...]:
        condition = self.expressions.condition(node.cond)
        return (If(condition, self._body(node.iftrue), self._body(node.iffalse)),)

    def _while(self, node: Any) -> tuple[Statement, ...]:
        _refuse_continue(node.stmt)
        return (Loop((), self.expressions.condition(node.cond), (), self._body(node.stmt)),)

    def _for(self, node: Any) -> tuple[Statement, ...]:
        _refuse_continue(node.stmt)
        if node.cond is None:
            raise refused("a for without a condition", node)
        self.scope.enter()
        before = () if node.init is None else self.one(node.init)
        condition = self.expressions.condition(node.cond)
        step = () if node.next is None else self.one(node.next)
        loop = Loop(before, condition, step, self._body(node.stmt))
        self.scope.leave()
        return (loop,)

    def _break(self, node: Any) -> tuple[Statement, ...]:
        return (Break(),)

    def _return(self, node: Any) -> tuple[Statement, ...]:
        if node.expr is None:
            return (Return(None),)
        return (Return(self.expressions.as_type(node.expr, self.result)),)

    def _switch(self, node: Any) -> tuple[Statement, ...]:
        """Give a choice as one comparison after the other; every case must leave it."""
        chosen = self.expressions.value(node.cond)
        _refuse_twice(chosen, node)
        branches: list[tuple[Expression | None, tuple[Statement, ...]]] = []
        labels: list[Expression] = []
        if type(node.stmt).__name__ != "Compound":
            raise refused("a switch without a block", node)
        for case in node.stmt.block_items or ():
            if type(case).__name__ not in ("Case", "Default"):
                raise refused("what stands before the cases", case)
            is_default = type(case).__name__ == "Default"
            if not is_default:
                label = self.expressions.value(case.expr)
                labels.append(self.expressions.arithmetic("==", chosen, label))
            if not case.stmts and not is_default:
                continue
            if is_default and case is not node.stmt.block_items[-1]:
                raise refused("a default that is not the last case", node)
            branches.append((None if is_default else _any_of(labels), self._case(case)))
            labels = []
        statements: tuple[Statement, ...] = ()
        for condition, body in reversed(branches):
            statements = body if condition is None else (If(condition, body, statements),)
        return statements

    def _case(self, case: Any) -> tuple[Statement, ...]:
        self.scope.enter()
        body = self.all(case.stmts)
        self.scope.leave()
        while body and isinstance(body[-1], Block):
            body = (*body[:-1], *body[-1].body)
        if body and isinstance(body[-1], Break):
            body = body[:-1]
        elif not _always_returns(body):
            raise refused("a case that goes on with the next one", case)
        if _breaks(body):
            raise refused("a break inside a case", case)
        return body


def _any_of(labels: list[Expression]) -> Expression:
    result = labels[0]
    for each in labels[1:]:
        result = Logical("||", result, each)
    return result


def _always_returns(body: tuple[Statement, ...]) -> bool:
    match body[-1:]:
        case (Return(),):
            return True
        case (If(_, then, other),):
            return _always_returns(then) and _always_returns(other)
        case (Block(inner),):
            return _always_returns(inner)
    return False


def _breaks(body: tuple[Statement, ...]) -> bool:
    """Tell whether a break in statements leaves what they stand in."""
    return any(
        isinstance(each, Break)
        or (isinstance(each, If) and (_breaks(each.then) or _breaks(each.other)))
        or (isinstance(each, Block) and _breaks(each.body))
        for each in body
    )


def _refuse_twice(place: Expression, node: Any) -> None:
    """Refuse what would be evaluated twice and calls something."""
    if any(isinstance(each, Call | Initialiser) for each in inside(place)):
        raise refused("a call inside a place that is changed", node)


def _refuse_continue(node: Any) -> None:
    if node is None or type(node).__name__ in ("For", "While", "DoWhile"):
        return
    if type(node).__name__ == "Continue":
        raise refused("a continue", node)
    for _, child in node.children():
        _refuse_continue(child)


def is_constant(kind: Any) -> bool:
    """Tell whether a variable of a type does not change itself, whatever it points to."""
    while type(kind).__name__ == "ArrayDecl":
        kind = kind.type
    return "const" in (getattr(kind, "quals", None) or [])


def _key(declared: Declared, pattern: Any) -> str:
    return next(name for name, each in declared.patterns.items() if each is pattern)
