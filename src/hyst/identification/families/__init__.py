"""The families of models, one a file; the stub ``__init__.pyi`` lists them.

``hyst.families`` is the registry of what is listed there.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__
