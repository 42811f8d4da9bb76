"""hyst: from a measured hysteresis loop to a model, its exact inverse and a command.

Names are loaded when they are first used, so that ``import hyst`` stays quick; the stub
``__init__.pyi`` lists them.
"""

from __future__ import annotations

from hyst import errors as errors
from hyst._lazy import attach

__version__ = "0.1.0"

__getattr__, _names = attach(__name__, __file__)
__all__ = ["__version__", *_names]


def __dir__() -> list[str]:
    return sorted(__all__)
