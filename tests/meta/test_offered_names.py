"""What a user finds with Tab: what may be called, written in one list, and all of it there."""

from __future__ import annotations

import ast
import importlib
import pkgutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import hyst

PACKAGE = Path(hyst.__file__).parent
PACKAGES = [
    "hyst",
    *(each.name for each in pkgutil.walk_packages(hyst.__path__, "hyst.") if each.ispkg),
]
LISTS = sorted(PACKAGE.rglob("__init__.pyi"))


@pytest.mark.parametrize("name", PACKAGES)
def test_a_package_shows_what_it_offers_and_has_it(name: str) -> None:
    package = importlib.import_module(name)
    if not hasattr(package, "__all__"):
        # A room inside a package offers nothing itself, and is not offered.
        outer = importlib.import_module(name.rpartition(".")[0])
        assert name.rpartition(".")[2] not in getattr(outer, "__all__", ())
        assert name.count(".") > 1 or name == "hyst.checks"
        return
    assert sorted(dir(package)) == sorted(package.__all__)
    assert len(set(package.__all__)) == len(package.__all__)
    for each in package.__all__:
        assert getattr(package, each) is not None
        assert each == "__version__" or not each.startswith("_")
    with pytest.raises(AttributeError, match="no attribute 'no_such_name'"):
        _ = package.no_such_name


def test_hyst_offers_what_users_call() -> None:
    shown = set(dir(hyst))
    # What other programs rely on, and what must not be in the way of it.
    assert {"PrandtlIshlinskii", "Play", "Record", "identify", "load", "read_record"} <= shown
    assert {"signals", "models", "online", "control", "export", "report", "io"} <= shown
    assert not {"demo", "studies", "errors", "files", "cli"} & shown
    assert hyst.errors.InputError is hyst.InputError


def test_every_model_is_offered_by_hyst_without_another_line() -> None:
    assert set(hyst.models.__all__) <= set(hyst.__all__)
    for name in hyst.models.__all__:
        assert getattr(hyst, name) is getattr(hyst.models, name)


@pytest.mark.parametrize("stub", LISTS, ids=lambda path: path.parent.name)
def test_a_list_that_type_checkers_read_is_the_one_that_is_used(stub: Path) -> None:
    """Every line offers a name as PEP 484 wants it, and the module beside it writes none."""
    names = []
    for line in ast.parse(stub.read_text()).body:
        if isinstance(line, ast.ImportFrom):
            names += [each for each in line.names if each.name != "*"]
    assert names
    assert all(each.name == each.asname for each in names)
    beside = stub.with_suffix(".py").read_text()
    assert not [each.name for each in names if f"import {each.name}" in beside]
    package = importlib.import_module(".".join(stub.relative_to(PACKAGE.parent).parts[:-1]))
    assert {each.name for each in names} <= set(package.__all__)


def test_names_are_loaded_when_they_are_used() -> None:
    program = (
        "import sys, hyst\n"
        "dir(hyst)\n"
        "assert not {m for m in sys.modules if m.startswith('hyst.')} - {'hyst._lazy', "
        "'hyst.errors'}\n"
        "hyst.Record\n"
        "assert 'hyst.signals' in sys.modules and 'hyst.models' not in sys.modules\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert finished.returncode == 0, finished.stderr


@pytest.mark.parametrize(
    ("kind", "loads", "loads_not"),
    [
        ("operator", "hyst.models", {"hyst.online", "hyst.control", "hyst.identification"}),
        ("controller", "hyst.control", {"hyst.online", "hyst.identification"}),
        ("joint_estimator", "hyst.online", {"hyst.control", "hyst.identification"}),
    ],
)
def test_a_file_loads_what_it_needs(kind: str, loads: str, loads_not: set[str]) -> None:
    path = PACKAGE.parents[1] / "tests" / "models" / "files_of_0_1_0" / f"{kind}.json"
    program = f"import sys, hyst\nhyst.load({str(path)!r})\nprint('\\n'.join(sys.modules))\n"
    finished = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert finished.returncode == 0, finished.stderr
    loaded = set(finished.stdout.split())
    assert loads in loaded
    assert not loads_not & loaded


def test_a_module_that_nobody_imported_is_found_where_a_list_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So ``from hyst.identification import families as families`` is all that a module needs."""
    package = tmp_path / "offering"
    (package / "inner" / "deep").mkdir(parents=True)
    (package / "__init__.py").write_text(
        "from hyst._lazy import attach\n__getattr__, __all__ = attach(__name__, __file__)\n"
    )
    (package / "__init__.pyi").write_text("from offering.inner import deep as deep\n")
    (package / "inner" / "__init__.py").write_text("")
    (package / "inner" / "deep" / "__init__.py").write_text("answer = 42\n")
    monkeypatch.syspath_prepend(tmp_path)
    offering = importlib.import_module("offering")
    assert offering.__all__ == ["deep"]
    assert isinstance(offering.deep, ModuleType)
    assert offering.deep.answer == 42
