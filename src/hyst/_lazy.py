"""Names of a package that are loaded when first used; its stub is the one list of them.

``__init__.pyi`` beside ``__init__.py`` is what type checkers read. It is read here too, so that a
name is written once and ``import hyst`` stays quick. Its lines are

- ``from hyst.models import Dahl as Dahl`` or ``from hyst import io as io``: a name, or a module;
- ``from hyst.models import *``: whatever the stub of that package offers.
"""

from __future__ import annotations

import ast
import importlib
import os.path
import sys
from collections.abc import Callable
from typing import Any


def attach(package: str, file: str) -> tuple[Callable[[str], Any], list[str]]:
    """Give ``__getattr__`` and ``__all__`` of a ``package`` whose ``__init__.py`` is ``file``."""
    homes = _homes(package, os.path.dirname(file))

    def load(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = _loaded(package, homes[name], name)
        setattr(sys.modules[package], name, value)
        return value

    return load, sorted(homes)


def _loaded(package: str, home: str, name: str) -> Any:
    module = None if home == package else importlib.import_module(home)
    # What is no attribute of its home is a module in it that nobody has imported yet.
    if module is None or not hasattr(module, name):
        return importlib.import_module(f"{home}.{name}")
    return getattr(module, name)


def _homes(package: str, folder: str) -> dict[str, str]:
    """Give where to find each name that the stub of a package in a folder offers."""
    homes: dict[str, str] = {}
    # Not pathlib, whose own import would add a fifth to the time of ``import hyst``.
    with open(os.path.join(folder, "__init__.pyi"), encoding="utf-8") as stub:
        lines = ast.parse(stub.read()).body
    for line in lines:
        if not isinstance(line, ast.ImportFrom) or line.module is None:
            continue
        names = [each.name for each in line.names]
        if names == ["*"]:
            below = line.module.removeprefix(f"{package}.").split(".")
            names = list(_homes(line.module, os.path.join(folder, *below)))
        homes |= dict.fromkeys(names, line.module)
    return homes
