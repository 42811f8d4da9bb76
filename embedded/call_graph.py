"""The deepest stack a function can need, from the call graphs the compiler writes.

``gcc -fcallgraph-info=su`` writes for every object which functions it defines, how many bytes of
stack each takes, and which it calls. A recursion, a frame whose size is only known at run time, or
a call through a pointer other than those listed here has no bound, and is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import reduce

NODE = re.compile(r'^node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
FRAME = re.compile(r"(\d+) bytes \(([a-z,]+)\)")

BY_POINTER = {"_core_branch_advance": ("jiles_change",)}
"""Whom the core calls through pointers: the slopes of the equations that branches are made of.

By the end of a function's name, for its beginning is that of an export."""


@dataclass(frozen=True)
class CallGraph:
    """Bytes of stack of every function that is defined, and whom each function calls."""

    frames: Mapping[str, int] = field(default_factory=dict)
    calls: Mapping[str, frozenset[str]] = field(default_factory=dict)

    def joined(self, other: CallGraph) -> CallGraph:
        calls = {
            name: self.calls.get(name, frozenset()) | other.calls.get(name, frozenset())
            for name in {*self.calls, *other.calls}
        }
        return CallGraph({**self.frames, **other.frames}, calls)

    def deepest(self, root: str) -> int:
        """Give the bytes on the deepest way from a function down."""
        return self._below(root, ())

    def _below(self, name: str, above: tuple[str, ...]) -> int:
        if name in above:
            raise ValueError(f"recursion: {' -> '.join((*above, name))}")
        if name == "__indirect_call":
            return max(self._below(each, above) for each in self._by_pointer(above[-1]))
        ways = [self._below(each, (*above, name)) for each in self.calls.get(name, ())]
        return self.frames.get(name, 0) + max(ways, default=0)

    def _by_pointer(self, caller: str) -> list[str]:
        """Give whom a function may call through its pointer; static ones have a file's name."""
        name = caller.split(":")[-1]
        known = {called for end in BY_POINTER if name.endswith(end) for called in BY_POINTER[end]}
        found = [each for each in self.frames if each.split(":")[-1] in known]
        if not found:
            raise ValueError(f"{caller} calls through a pointer, so its stack has no bound")
        return found


def read_call_graph(text: str) -> CallGraph:
    """Read one of the compiler's ``.ci`` files."""
    frames: dict[str, int] = {}
    calls: dict[str, frozenset[str]] = {}
    for line in text.splitlines():
        if node := NODE.match(line):
            name, label = node.groups()
            if frame := FRAME.search(label):
                size, kind = frame.groups()
                if kind != "static":
                    raise ValueError(f"{name} has a frame of a size known at run time ({kind})")
                frames[name] = int(size)
        elif edge := EDGE.match(line):
            source, called = edge.groups()
            calls[source] = calls.get(source, frozenset()) | {called}
    return CallGraph(frames, calls)


def joined(graphs: Iterable[CallGraph]) -> CallGraph:
    """Give the call graph of several objects together."""
    return reduce(CallGraph.joined, graphs, CallGraph())
