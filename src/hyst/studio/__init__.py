"""The studio: the whole job in a browser, on this machine only.

Nothing is loaded before the studio is started; the stub ``__init__.pyi`` lists its names.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__
