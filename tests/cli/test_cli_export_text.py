"""The verb export for PLCs."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_runs import STAGE, Run, describe

from hyst.export import structured_text


@pytest.fixture
def model_file(folder: Path) -> Path:
    STAGE.save(folder / "model.json", describe(STAGE))
    return folder / "model.json"


def test_structured_text_is_what_python_writes(run: Run, folder: Path, model_file: Path) -> None:
    options = ("--inverse", "--target", "st", "--name", "lens", "--precision", "single")
    ended = run("export", model_file, *options, "-o", "out")
    assert ended.code == 0
    assert "lens(u) -> y" in ended.out
    assert "REAL" in ended.out
    about = describe(STAGE).of_inverse()
    written = structured_text(
        STAGE.inverse(), folder / "same", "single", name="lens", description=about
    )
    for each in written.files:
        assert (folder / "out" / each).read_bytes() == (written.path / each).read_bytes()


def test_what_structured_text_has_no_use_for_is_refused(run: Run, model_file: Path) -> None:
    ended = run("export", model_file, "--target", "st", "--layout", "flat", "-o", "out")
    assert ended.code != 0
    assert "--layout" in ended.err
    ended = run("export", model_file, "--target", "st", "--name", "Limit", "-o", "out")
    assert ended.code != 0
    assert "collides in the other language" in ended.err
