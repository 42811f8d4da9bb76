"""Models: named compositions and banks of operators.

The stub ``__init__.pyi`` lists them, one line a model; ``hyst`` offers the same names.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__


for _each in __all__:  # a class is known to model files once it is imported
    __getattr__(_each)
