"""Reports: tables, figures and a page of HTML that explain what was found.

The names are loaded when first used, because figures need matplotlib and tables do not; the stub
``__init__.pyi`` lists them.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return __all__
