"""hyst: from a measured hysteresis loop to a model, its exact inverse and a command.

Names are loaded when they are first used, so that ``import hyst`` stays quick; ``__init__.pyi``
lists them.
"""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

__version__ = "0.1.0"

# Where each name is at home; a package is at home in hyst itself.
_HOME = {
    name: home
    for home, name in re.findall(
        r"^from (\S+) import (\w+) as \2$",
        Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
}
_PACKAGES = tuple(name for name, home in _HOME.items() if home == "hyst")

__all__ = ["__version__", *_HOME]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'hyst' has no attribute {name!r}")
    if name in _PACKAGES:
        value = importlib.import_module(f"hyst.{name}")
    else:
        value = getattr(importlib.import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
