"""Fleets: many actuators, one record and one model each, in one table, the odd ones named.

The names are loaded when first used; the stub ``__init__.pyi`` lists them.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__
