"""`import hyst` and `hyst --help` stay light: they load no heavy library nobody asked for."""

from __future__ import annotations

import subprocess
import sys

import pytest

HELP = """
import contextlib, io, sys
sys.argv = ["hyst", "--help"]
from hyst.cli import main
with contextlib.redirect_stdout(io.StringIO()) as shown, contextlib.suppress(SystemExit):
    main()
assert "identify" in shown.getvalue(), "this was not the help"
"""


def modules_loaded_by(program: str) -> set[str]:
    listing = "\nimport sys\nprint('\\n'.join(sys.modules))\n"
    finished = subprocess.run(
        [sys.executable, "-c", program + listing], capture_output=True, text=True, check=False
    )
    assert finished.returncode == 0, finished.stderr
    return set(finished.stdout.split())


@pytest.fixture(scope="module")
def after_import() -> set[str]:
    return modules_loaded_by("import hyst")


@pytest.fixture(scope="module")
def after_help() -> set[str]:
    return modules_loaded_by(HELP)


@pytest.mark.parametrize("heavy", ["scipy", "pandas", "matplotlib", "control"])
def test_import_of_hyst_loads_no(heavy: str, after_import: set[str]) -> None:
    assert "hyst" in after_import
    assert heavy not in after_import


@pytest.mark.parametrize("heavy", ["scipy.signal", "pandas", "matplotlib", "control"])
def test_help_loads_no(heavy: str, after_help: set[str]) -> None:
    assert "hyst.cli" in after_help
    assert heavy not in after_help


def test_verbs_load_no_numerics_before_they_run(after_help: set[str]) -> None:
    heavy = {"hyst.identification", "hyst.online", "hyst.control", "hyst.compensation", "scipy"}
    assert not heavy & after_help
