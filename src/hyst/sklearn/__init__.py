"""Hysteresis as an estimator of scikit-learn; see docs/notebook.md.

What it offers is listed in the stub ``__init__.pyi``.
"""

from __future__ import annotations

from hyst._lazy import attach

__getattr__, __all__ = attach(__name__, __file__)


def __dir__() -> list[str]:
    return sorted(__all__)
