"""docs/tutorials/learning.md, run as it stands: a stage that starts at 3 % ends at its noise."""

from __future__ import annotations

import runpy
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest
from command_runs import Ended, Run
from learning_runs import column, rows
from pages import blocks

from hyst.demo import SimulatedStage

PAGE = "tutorials/learning.md"


def follow(run: Run, monkeypatch: pytest.MonkeyPatch) -> list[Ended]:
    """Run every command of the page; give what those of hyst said."""
    stage, motion = blocks(PAGE, "python")[:2]
    Path("stage.py").write_text(stage, encoding="utf-8")
    exec(compile(motion, PAGE, "exec"), {})
    said = []
    for line in "".join(blocks(PAGE, "bash")).splitlines():
        program, *words = shlex.split(line)
        if program == "python":
            monkeypatch.setattr(sys, "argv", words)
            runpy.run_path(words[0])
        else:
            said.append(run(*words))
    return said


def test_the_page_is_as_it_says(run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said = follow(run, monkeypatch)
    assert [each.code for each in said] == [0] * len(said)
    words = " ".join(said[-1].out.split())
    for line in "".join(blocks(PAGE, "text")).splitlines():
        assert " ".join(line.split()) in words
    y_ref = column("wanted.csv", "position")
    missed = [
        np.sqrt(np.mean((column(f"run{k}.csv", "position") - y_ref) ** 2)) for k in (1, 2, 3, 4)
    ]
    assert 0.02 < missed[0] / np.ptp(y_ref) < 0.05  # it starts at some 3 %
    assert max(missed[1:]) < missed[0]
    assert missed[3] < 1.5 * SimulatedStage().noise  # what three repetitions have learnt
    assert len(rows(said[-1].out)) == 4
    assert (folder / "learning.png").read_bytes().startswith(b"\x89PNG")
