"""The one door from what is below to what is above it: pictures, pages, tables of other programs.

A record is data, and an operator numbers: neither knows a figure. But ``record.plot()`` is where
people look for one. What is asked for so is named here by where it lives, and loaded then.
"""

from __future__ import annotations

import importlib
from typing import Any

PLOTS = "hyst.report.shown.plots"
PAGES = "hyst.report.shown.pages"
FRAMES = "hyst.io.frames"


def above(home: str, name: str) -> Any:
    """Load what is called ``name`` in a module of a higher layer, ``home``."""
    return getattr(importlib.import_module(home), name)
