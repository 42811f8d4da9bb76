"""No module has the name of something its package exports: importing it would hide that."""

from __future__ import annotations

import importlib
import pkgutil
from types import ModuleType

import hyst


def packages() -> list[ModuleType]:
    found = pkgutil.walk_packages(hyst.__path__, "hyst.")
    return [hyst, *(importlib.import_module(each.name) for each in found if each.ispkg)]


def test_no_module_hides_what_its_package_exports() -> None:
    hidden = []
    for package in packages():
        modules = {each.name for each in pkgutil.iter_modules(package.__path__)}
        both = sorted(modules & set(getattr(package, "__all__", ())))
        hidden += [
            f"{package.__name__}.{name}"
            for name in both
            if not isinstance(getattr(package, name), ModuleType)
        ]
    assert not hidden
