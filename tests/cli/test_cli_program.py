"""The program as a whole: help, version, how it ends, and the whole path on measured data."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import typer
from command_runs import Run, write_csv

import hyst


def test_version(run: Run) -> None:
    ended = run("--version")
    assert (ended.code, ended.out, ended.err) == (0, f"hyst {hyst.__version__}\n", "")


def test_help_lists_the_verbs(run: Run) -> None:
    ended = run("--help")
    assert ended.code == 0
    for verb in ("identify", "simulate", "compensate", "info", "demo"):
        assert verb in ended.out


def test_nothing_given_shows_the_help(run: Run) -> None:
    ended = run()
    assert ended.code == 2
    assert "identify" in ended.out
    assert "Missing verb" in ended.err


@pytest.mark.parametrize(
    "arguments", [("explode",), ("--nonsense",), ("info",), ("info", "a", "b"), ("identify",)]
)
def test_usage_errors_are_refused(arguments: tuple[str, ...], refused: Callable[..., str]) -> None:
    assert "hyst --help" in refused(*arguments)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (hyst.SolverError("did not converge"), 1),
        (hyst.MissingExtraError("install hyst[files]"), 1),
        (hyst.NotIdentifiableError("too little"), 2),
        (hyst.InputError("two\nlines"), 2),
        (PermissionError(13, "Permission denied", "out"), 1),
        (RuntimeError("a bug"), 1),
    ],
)
@pytest.mark.parametrize("place", ["nowhere", "before", "after"])
def test_errors_end_in_one_sentence_and_show_their_origin_on_demand(
    error: Exception, code: int, place: str, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(path: object) -> None:
        raise error

    monkeypatch.setattr("hyst.load", fail)
    before = ["--debug"] if place == "before" else []
    after = ["--debug"] if place == "after" else []
    ended = run(*before, "info", "model.json", *after)
    assert ended.code == code
    lines = ended.err.splitlines()
    assert lines[-1].startswith("error: ")
    if place == "nowhere":
        assert len(lines) == 1
    else:
        assert lines[0].startswith("Traceback")


@pytest.mark.parametrize(("interruption", "code"), [(typer.Abort, 1), (KeyboardInterrupt, 130)])
def test_an_interruption_shows_no_origin(
    interruption: type[BaseException], code: int, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(path: object) -> None:
        raise interruption

    monkeypatch.setattr("hyst.load", stop)
    ended = run("info", "model.json")
    assert ended.code == code
    assert "Traceback" not in ended.err


def test_the_installed_program_refuses_in_one_sentence(folder: Path) -> None:
    finished = subprocess.run(
        [sys.executable, "-c", "import sys; from hyst.cli import main; sys.exit(main())", "info"],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
    )
    assert finished.returncode == 2
    assert finished.stdout == ""
    assert finished.stderr.startswith("error: ")
    assert finished.stderr.count("\n") == 1


def test_from_a_measured_loop_to_a_command(run: Run, measured_data: Path, folder: Path) -> None:
    data = measured_data / "piezo-dbo" / "Model_Vi_Do.dat"
    columns = ("--input", 0, "--output", 4, "--rate", 200)
    ended = run("identify", data, *columns, "--family", "mpi", "-o", "out")
    assert ended.code == 0, ended.err
    model = hyst.load(folder / "out" / "model.json")
    about = model.description
    record = hyst.read_record(data, input=0, output=4, rate=200)
    error = model(record.u)[: record.samples - about.delay] - record.y[about.delay :]
    # The goal for this record: 0.45 % of its range, once the start-up of two seconds is over.
    assert np.sqrt(np.mean(error[400:] ** 2)) < 0.0045 * np.ptp(record.y)
    middle = float(model([0.0, 1.8])[-1])
    y_ref = middle + 10.0 * np.sin(np.linspace(0.0, 25.0, 1000))
    write_csv(folder / "sine.csv", "wanted", y_ref)
    command = ("compensate", "out/model.json", "sine.csv", "--column", "wanted", "-o", "u.csv")
    assert run(*command).code == 0
    simulate = ("simulate", "out/model.json", "u.csv", "--input", "command", "-o", "y.csv")
    assert run(*simulate).code == 0
    y = hyst.io.read_column(folder / "y.csv", 1)[0]
    assert np.abs(y - y_ref).max() < 1e-9 * np.ptp(y_ref)
