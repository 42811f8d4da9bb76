"""The command line: one file a verb.

A verb is imported when it is typed, and reaches everything through the names of ``hyst`` itself,
which are loaded when first used; so ``hyst --help`` loads no numerics.
"""

from __future__ import annotations

from hyst.cli.app import main

__all__ = ["main"]


def __dir__() -> list[str]:
    return __all__
