"""Where the text of one function comes together."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from hyst.export.iec61131.plan import Plan
from hyst.export.iec61131.words import Names
from hyst.export.translate.program import Function


class Writer:
    """The lines of one function so far, its names and its variables.

    Parameters
    ----------
    plan
        What is known of the whole program.
    function
        The one that is written.
    """

    def __init__(self, plan: Plan, function: Function) -> None:
        self.plan = plan
        self.function = function
        self.names = Names(plan.names_of_functions())
        self.lines: list[str] = []
        self.temporaries: list[tuple[str, str]] = []
        self.aliases: dict[str, str] = {}
        self.roles = dict(
            zip(
                (p.name for p in function.parameters),
                plan.usage.roles.get(function.name, ()),
                strict=True,
            )
        )
        self.stored = plan.usage.stored.get(function.name, frozenset())

    # Statements before.

    @contextmanager
    def inside(self, head: str, tail: str = "") -> Iterator[None]:
        """Write what is written meanwhile between the lines ``head`` and ``tail``, indented."""
        outer, self.lines = self.lines, []
        yield
        inner, self.lines = self.lines, outer
        self.lines.append(head)
        self.lines += [f"    {line}" for line in inner]
        if tail:
            self.lines.append(tail)

    def apart(self, written: Callable[[], str]) -> tuple[list[str], str]:
        """Give an expression, and the statements it needs before, unwritten."""
        outer, self.lines = self.lines, []
        text = written()
        needed, self.lines = self.lines, outer
        return needed, text

    def temporary(self, kind: str, name: str = "chosen") -> str:
        """Give a new variable of a ``kind``, called ``name`` or nearly so."""
        own = self.names.fresh(name)
        self.temporaries.append((own, kind))
        return own
