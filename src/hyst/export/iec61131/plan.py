"""What all functions of a translation have in common: names, types, places."""

from __future__ import annotations

import operator
from functools import cache, cached_property
from typing import Any

import numpy as np

from hyst.export.iec61131.numbers import Numbers
from hyst.export.iec61131.usage import Usage, nodes_in, plain, usage_of
from hyst.export.iec61131.words import Names
from hyst.export.translate.program import (
    INT,
    SIZE,
    UNSIGNED,
    Array,
    Binary,
    Convert,
    CType,
    Decay,
    FunctionPointer,
    Member,
    Named,
    Number,
    Pointer,
    Program,
    Scalar,
)
from hyst.export.translate.refusal import refused

_ARITHMETIC = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}


class Plan:
    """A program as structured text will have it.

    Parameters
    ----------
    program
        The C.
    name
        Of the function block; all names of the file begin with it.
    """

    def __init__(self, program: Program, name: str) -> None:
        self.program = program
        self.name = name
        self.precision = "single" if program.real.name == "float" else "double"
        self.real = "REAL" if self.precision == "single" else "LREAL"
        self.usage: Usage = usage_of(program)
        self.numbers = Numbers(self.precision)
        self._names = Names(frozenset({name, f"{name}_numbers", self.whole_part_name}))
        self._global_names: dict[tuple[str, str], str] = {}
        # The memory comes first, where one looks for it.
        self.memory = self._memory_length()
        self.numbers.place("", "memory", self.memory)
        self.numbers.take_tables(program)
        self.uses_whole_part = False

    @property
    def state(self) -> str:
        """Name of the state's structure in C."""
        return f"{self.name}_state"

    def _memory_length(self) -> int:
        kind = self.program.structures[self.state].members["memory"]
        assert isinstance(kind, Array)
        return kind.count

    # Names.

    def _global(self, kind: str, name: str) -> str:
        key = (kind, name)
        if key not in self._global_names:
            shorter = name.removeprefix("hyst_").removeprefix(f"{self.name}_")
            self._global_names[key] = self._names.fresh(f"{self.name}_{shorter}{kind}")
        return self._global_names[key]

    def name_of_function(self, name: str) -> str:
        """Give what a function is called."""
        return self._global("", name)

    def names_of_functions(self) -> frozenset[str]:
        """Give all names that no variable may have."""
        functions = {self.name_of_function(each) for each in self.program.functions}
        types = {self.type_text(Named(each)) for each in self.program.structures}
        tables = {self.name_of_table(each) for each in self.program.tables}
        return frozenset(
            functions | types | tables | {self.name, "numbers", "ignored", self.whole_part_name}
        )

    @cache  # noqa: B019 - lives as long as one export
    def name_of_table(self, name: str) -> str:
        """Give what a structure of constants is called."""
        return self._tables.of(name)

    @cached_property
    def _tables(self) -> Names:
        return Names(frozenset({"numbers", "state", "ignored"}))

    @cache  # noqa: B019
    def parameter_names(self, function: str) -> Names:
        """Give the names of the parameters of a function."""
        names = Names(self.names_of_functions())
        for parameter, role in zip(
            self.program.functions[function].parameters, self.usage.roles[function], strict=True
        ):
            names.of(parameter.name)
            if role.may_be_null:
                names.of(f"{parameter.name}_given")
        return names

    @cache  # noqa: B019
    def _fields(self, structure: str) -> Names:
        names = Names()
        for each in self.program.structures[structure].members:
            names.of(each)
        return names

    def field(self, kind: CType, name: str) -> str:
        """Give what a member, by its ``name`` in C, of a structure, its ``kind``, is called."""
        assert isinstance(kind, Named)
        return self._fields(kind.name).of(name)

    @property
    def whole_part_name(self) -> str:
        """Name of what cuts off the fraction of a number."""
        return f"{self.name}_whole_part"

    def whole_part(self) -> str:
        """Give the name of what cuts off the fraction of a number, which is then needed."""
        self.uses_whole_part = True
        return self.whole_part_name

    # Types.

    def type_text(self, kind: CType) -> str:
        """Give a type as structured text has it; a pointer to a structure is kept as its copy.

        Raises
        ------
        UntranslatableError
            If it has no form in structured text.
        """
        if isinstance(kind, Named):
            return self._global("_type", kind.name)
        if isinstance(kind, Pointer):
            if isinstance(kind.to, Named) and kind.is_const:
                return self.type_text(kind.to)
            if isinstance(kind.to, Scalar) and kind.to.is_real:
                return "DINT"
        if isinstance(kind, Array):
            return f"ARRAY [0..{kind.count - 1}] OF {self.type_text(kind.of)}"
        if isinstance(kind, Scalar):
            if kind.is_real:
                return "LREAL" if kind.name == "double" else "REAL"
            if kind in (INT, SIZE):
                return "DINT"
            if kind == UNSIGNED:
                return "DWORD"
            if kind.name == "void":
                return "BOOL"
        raise refused(f"a variable of type {kind}")

    def is_left_out(self, kind: CType) -> bool:
        """Tell whether a member is not kept: which function it points to is known."""
        return isinstance(kind, FunctionPointer)

    @cached_property
    def _walked(self) -> frozenset[tuple[str, str]]:
        """Arrays inside structures that are walked over by a pointer."""
        found = set()
        for function in self.program.functions.values():
            for each in nodes_in(function.body):
                if isinstance(each, Decay) and isinstance(each.of, Member):
                    found.add(_place_of(each.of))
        return frozenset(found)

    def is_inline(self, of: Any) -> bool:
        """Tell whether an array is a member that stays in its structure."""
        if not isinstance(of, Member) or _place_of(of) == (self.state, "memory"):
            return False
        return _place_of(of) not in self._walked

    def array_member(self, of: Member) -> int:
        """Give where an array inside a structure begins, if it has one place alone.

        Raises
        ------
        UntranslatableError
            If it has no form in structured text.
        """
        if _place_of(of)[0] == self.state:
            return 0
        raise refused(f"a pointer into the member {of.name} of {of.of.type}")

    def is_member_kept(self, structure: str, name: str) -> bool:
        """Tell whether the member ``name`` of a ``structure`` is written."""
        kind = self.program.structures[structure].members[name]
        is_memory = structure == self.state and name == "memory"
        return not self.is_left_out(kind) and not is_memory

    # Constants.

    def folded(self, of: Any) -> Number | None:
        """Give the value of constants, rounded as the target would; None if it is none."""
        if isinstance(of, Number):
            return of
        if isinstance(of, Convert) and isinstance(of.type, Scalar) and not of.type.is_real:
            inner = self.folded(of.operand)
            whole = inner is not None and not inner.type.is_real  # type: ignore[union-attr]
            return Number(inner.value, of.type) if whole and inner is not None else None
        if not isinstance(of, Binary):
            return None
        left, right = self.folded(plain(of.left)), self.folded(plain(of.right))
        if not (isinstance(left, Number) and isinstance(right, Number)):
            return None
        if not (isinstance(of.type, Scalar) and of.type.is_real):
            return _whole(of, int(left.value), int(right.value))
        number = np.float32 if of.type.name == "float" else np.float64
        value = _ARITHMETIC[of.operator](number(left.value), number(right.value))
        return Number(float(value), of.type)


def _whole(of: Binary, left: int, right: int) -> Number | None:
    """Give what two whole numbers make; None where Python and C need not agree."""
    if of.operator not in _WHOLE or min(left, right) < 0 or (of.operator in "/%" and not right):
        return None
    value = int(_WHOLE[of.operator](left, right))
    return Number(value, of.type) if 0 <= value < 2**31 else None


_WHOLE: dict[str, Any] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.floordiv,
    "%": operator.mod, "&": operator.and_, "|": operator.or_, "^": operator.xor,
}  # fmt: skip


def _place_of(member: Member) -> tuple[str, str]:
    """Give the structure that a member is in, and its name."""
    assert isinstance(member.of.type, Named)
    return member.of.type.name, member.name
