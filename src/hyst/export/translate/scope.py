"""Variables a function sees, and names for them that no two share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import final

from hyst.export.translate.program import CType, Name, Variable


@final
@dataclass
class Scope:
    """Names of one function.

    Parameters
    ----------
    taken
        Names that no local variable may have: those of functions and tables.
    """

    taken: frozenset[str]
    visible: list[dict[str, Name]] = field(default_factory=lambda: [{}])
    declared: dict[str, Variable] = field(default_factory=dict)

    def enter(self) -> None:
        """Begin a block."""
        self.visible.append({})

    def leave(self) -> None:
        """End the innermost block."""
        self.visible.pop()

    def declare(self, name: str, kind: CType, is_const: bool, role: str = "local") -> Variable:
        """Give the variable of a declaration, under a name of its own.

        Parameters
        ----------
        name
            Its name.
        kind
            Its type.
        is_const
            Whether it must not be changed.
        role
            Its kind as a name: parameter or local.
        """
        own, count = name, 1
        seen = {each.name for block in self.visible for each in block.values()}
        while own in self.taken or own in seen or not self._fits(own, kind):
            count += 1
            own = f"{name}_{count}"
        before = self.declared.get(own)
        variable = Variable(own, kind, is_const and (before is None or before.is_const))
        self.declared[own] = variable
        self.visible[-1][name] = Name(own, kind, role)
        return Variable(own, kind, is_const)

    def bind(self, name: str, to: Name) -> None:
        """Let a name stand for something else in this block, as a table.

        Parameters
        ----------
        name
            Its name.
        to
            The type, or the place, it becomes.
        """
        self.visible[-1][name] = to

    def find(self, name: str) -> Name | None:
        """Give what a name stands for; None if no variable has it."""
        for block in reversed(self.visible):
            if name in block:
                return block[name]
        return None

    def _fits(self, name: str, kind: CType) -> bool:
        return name not in self.declared or self.declared[name].type == kind
