"""The command a person typed, so that what it writes can say how it came about."""

from __future__ import annotations

import contextlib
import shlex
from collections.abc import Iterator, Sequence
from contextvars import ContextVar

_TYPED: ContextVar[str] = ContextVar("typed command", default="")


def typed_command() -> str:
    """Give the command that is being carried out; empty if hyst is used from Python."""
    return _TYPED.get()


@contextlib.contextmanager
def carrying_out(arguments: Sequence[str]) -> Iterator[None]:
    """Remember ``hyst`` with its ``arguments``, as a shell takes it, while it is carried out."""
    token = _TYPED.set(shlex.join(["hyst", *arguments]))
    try:
        yield
    finally:
        _TYPED.reset(token)
