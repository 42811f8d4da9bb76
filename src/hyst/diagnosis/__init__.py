"""Diagnosis: what records can tell, and what they cannot, before any model.

The names are loaded when first used, because findings need SciPy and the reading of files, which
asks for codes of instruments, does not; the stub ``__init__.pyi`` lists them.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__
