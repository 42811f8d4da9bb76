"""Run the program inside the test's own process, in a folder of its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Ended, Run, describe, drive, snapshot, write_csv
from learning_runs import COLUMNS, MODEL, TIME, Y_REF, Learn

from hyst.cli import main


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder the program runs in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def run(folder: Path, capsys: pytest.CaptureFixture[str]) -> Run:
    """Run the program with some arguments."""

    def run_it(*arguments: object) -> Ended:
        capsys.readouterr()
        code = main([str(each) for each in arguments])
        return Ended(code, *capsys.readouterr())

    return run_it


@pytest.fixture
def record_file(folder: Path) -> Path:
    """A record of the simulated stage, with a little noise."""
    u = drive()
    y = STAGE(u) + np.random.default_rng(3).normal(0.0, 1e-3, u.size)
    return write_csv(folder / "loop.csv", "t [s],u [V],y [um]", np.arange(u.size) * 0.01, u, y)


@pytest.fixture
def model_file(folder: Path) -> Path:
    """The simulated stage's own model, with a description."""
    path = folder / "model.json"
    STAGE.save(path, describe(STAGE))
    return path


@pytest.fixture
def refused(run: Run, folder: Path) -> Callable[..., str]:
    """Run, and hold the program to a refusal: exit code 2, one sentence, no file touched."""

    def run_it(*arguments: object) -> str:
        before = snapshot(folder)
        ended = run(*arguments)
        assert ended.code == 2, ended
        assert ended.out == ""
        assert ended.err.startswith("error: ")
        assert ended.err.count("\n") == 1
        assert "Traceback" not in ended.err
        assert snapshot(folder) == before
        return ended.err

    return run_it


@pytest.fixture
def known(folder: Path) -> Path:
    """The model of the stage that the tests of hyst learn know, which is not the stage."""
    path = folder / "model.json"
    MODEL.save(path, describe(MODEL, input_low=-1.0, input_high=5.0, delay=0))
    return path


@pytest.fixture
def wanted(folder: Path) -> Path:
    """What the output should do, again and again."""
    return write_csv(folder / "wanted.csv", "t [s],position [um]", TIME, Y_REF)


@pytest.fixture
def learn(run: Run, known: Path, wanted: Path) -> Learn:
    """Run the verb with the files so far."""

    def run_it(*more: object) -> Ended:
        return run("learn", known, wanted, *more, *COLUMNS, "-o", "command.csv")

    return run_it


@pytest.fixture
def refuses(refused: Callable[..., str], known: Path, wanted: Path) -> Callable[..., str]:
    """Run the verb, and hold it to a refusal."""

    def run_it(*more: object) -> str:
        return refused("learn", known, wanted, *more, *COLUMNS, "-o", "command.csv")

    return run_it
