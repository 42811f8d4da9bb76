"""Run the program inside the test's own process, in a folder of its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Ended, Run, describe, drive, snapshot, write_csv

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
