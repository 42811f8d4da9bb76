"""The tutorials of the first loop and of the Cortex-M, run one after the other as they stand."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
from command_runs import Run
from pages import DOCS, commands, follow, untold, write_files

from hyst.demo import SimulatedStage
from hyst.io import read_column

EXAMPLES = DOCS.parent / "examples"
FIRST, ON_TARGET = "tutorials/first_loop.md", "tutorials/cortex_m.md"


def test_a_record_of_the_clone_becomes_a_command_and_firmware(
    run: Run, folder: Path, undrawn: None
) -> None:
    shutil.copytree(EXAMPLES, folder / "examples")
    told = follow(FIRST, run)
    assert untold(FIRST, told) == []

    # The true stage misses what it should do by no more than the page says.
    y_ref, _, _ = read_column("examples/trajectory.csv", "position")
    before, _, _ = read_column("examples/stage.csv", "drive")
    u, _, _ = read_column("command.csv", "command")
    missed = np.abs(SimulatedStage().position(u, before) - y_ref)
    assert np.sqrt(np.mean(missed**2)) < 0.0295
    assert missed.max() < 0.0985

    write_files(ON_TARGET)
    assert untold(ON_TARGET, follow(ON_TARGET, run)) == []


def test_the_commands_of_the_readme_are_those_of_the_tutorial() -> None:
    """They are run above; the README is no page of its own to go stale."""
    shown = [line.split() for line in commands("../README.md") if line.startswith("hyst ")]
    assert len(shown) == 3
    run_above = [line.split() for page in (FIRST, ON_TARGET) for line in commands(page)]
    assert [each for each in shown if each not in run_above] == []


def test_the_files_of_the_examples_are_made_by_their_script(tmp_path: Path) -> None:
    make = {"__name__": "make_stage"}
    exec(compile((EXAMPLES / "make_stage.py").read_text(), "make_stage.py", "exec"), make)
    make["make"](tmp_path)  # type: ignore[operator]
    for name in ("stage.csv", "trajectory.csv"):
        assert (tmp_path / name).read_bytes() == (EXAMPLES / name).read_bytes()
