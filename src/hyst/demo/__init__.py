"""A simulated stage, and the whole story of hyst told on it without any file.

The names are loaded when first used, so that the command line can name them; the stub
``__init__.pyi`` lists them.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__
