"""Reports: tables, figures and a page of HTML that explain what was found.

The names are loaded when first used, because figures need matplotlib and tables do not.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hyst.report.identification_report import write_report
    from hyst.report.tables import Table

_HOME = {
    "Table": "hyst.report.tables",
    "write_report": "hyst.report.identification_report",
}

__all__ = ["Table", "write_report"]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'hyst.report' has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOME[name]), name)
    globals()[name] = value
    return value
