"""`import hyst` and `hyst --help` stay light: they load no heavy library nobody asked for."""

from __future__ import annotations

import subprocess
import sys

import pytest

from hyst.cli.verbs import VERBS, command_of

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


def test_help_loads_no_array_library(after_help: set[str]) -> None:
    assert not {"numpy", "hyst.io", "hyst.operators", "hyst.report"} & after_help


@pytest.mark.parametrize("verb", VERBS)
def test_each_verb_is_listed_with_its_own_sentence(verb: str) -> None:
    shown = command_of(verb)
    assert shown.name == verb
    assert VERBS[verb][1] == str(shown.help).splitlines()[0]


BANK = """
import hyst
bank = hyst.PrandtlIshlinskii([0.5, 0.4], [0.1, 0.2], 1.0)
bank([1.0, 2.0, 0.0])
bank.inverse()([1.0, 2.0, 0.0])
bank.stepper()(1.0)
"""
IDENTIFIED = """
import hyst, math
u = [(1.0 - 0.001 * k) * math.sin(0.1 * k) for k in range(500)]
bank = hyst.PrandtlIshlinskii([0.5, 0.4], [0.1, 0.2], 1.0)
hyst.identify(hyst.Record(u, bank(u), dt=0.01), family="pi", plays=2, delay=0)
"""


def test_a_bank_loads_no_scipy() -> None:
    loaded = modules_loaded_by(BANK)
    assert "hyst.models" in loaded
    assert not {"scipy", "hyst.identification", "hyst.compensation"} & loaded


def test_identification_loads_no_statistics_filters_or_figures() -> None:
    loaded = modules_loaded_by(IDENTIFIED)
    assert "hyst.identification" in loaded
    heavy = {"scipy.stats", "scipy.signal", "matplotlib", "pandas", "pyarrow"}
    assert not (heavy | {"hyst.control", "hyst.online", "hyst.report", "hyst.export"}) & loaded
