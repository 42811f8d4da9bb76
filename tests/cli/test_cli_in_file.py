"""hyst identify on a record that stays in its file."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv

import hyst
from hyst.cli import in_file
from hyst.identification.stream import survey

TRUE = hyst.PrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], 1.0)
ASKED = ("--input", "u", "--output", "y", "--rate", 1000, "--family", "pi", "--plays", 2)
QUICK = ("--delay", 0, "--creep", "none", "--leave-disturbances", "-o", "out")


@pytest.fixture
def long_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A record that is long for a part of 3000 samples, and large for a threshold of 100 kB."""
    monkeypatch.setattr(survey, "PART", 3000)
    monkeypatch.setattr(survey, "CHUNK", 500)
    monkeypatch.setattr(in_file, "LARGE", 100_000)
    t = 1e-3 * np.arange(12_000)
    u = (1.0 - 0.5 * np.sin(np.pi * t / t[-1]) ** 2) * np.sin(2.0 * np.pi * 3.0 * t)
    y = TRUE(u) + 0.2 + 0.01 * np.random.default_rng(0).standard_normal(t.size)
    return write_csv(folder / "long.csv", "u [V],y [um]", u, y)


def test_a_large_record_stays_in_its_file_and_all_of_it_is_fitted(
    run: Run, long_file: Path, folder: Path
) -> None:
    ended = run("identify", long_file, *ASKED, *QUICK)
    assert ended.code == 0, ended.err
    assert "its 12000 samples stay in the file" in ended.err
    assert "Judged on 3000 of 12000 samples, fitted to all." in " ".join(ended.out.split())
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    assert numbers["used_samples"][0]["total"] == 12_000
    start, stop = numbers["part"]
    assert stop - start == 3000
    assert numbers["metrics"]["training"]["samples"] > 11_000
    # The noise has a deviation of 0.01.
    assert numbers["metrics"]["training"]["rms"] == pytest.approx(0.01, rel=0.05)
    page = (folder / "out" / "report.html").read_text()
    assert "of 3000 were used" in page
    model = hyst.load(folder / "out" / "model.json")
    assert model.description.dt == pytest.approx(1e-3)
    assert (folder / "out" / "loop.png").stat().st_size > 1000


def test_the_option_decides_against_the_size(
    long_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    how = dict.fromkeys(("time", "time_unit", "dead_band", "format", *in_file._NOT_SERVED))
    kept = in_file.FileToKeep([long_file], how | {"input": "u", "output": "y", "rate": 1000.0}, {})
    assert kept.opened("no") is None
    opened = kept.opened("auto")
    assert opened is not None
    assert len(opened) == 12_000
    monkeypatch.setattr(in_file, "LARGE", 10**9)
    assert kept.opened("auto") is None
    assert kept.opened("yes") is not None


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--repair",), "--repair is not for a record that stays in its file"),
        (("--input-label", "drive [V]"), "--input-label is not for a record that stays"),
        (("--schedule", "1"), "--in-file is not for --schedule"),
    ],
)
def test_what_it_cannot_serve_is_refused(
    more: tuple[str, ...], said: str, refused: Callable[..., str], long_file: Path
) -> None:
    message = refused(
        "identify", long_file, *ASKED, *QUICK[:2], "-o", "out", "--in-file", "yes", *more
    )
    assert said in " ".join(message.split())


def test_several_files_are_refused(refused: Callable[..., str], long_file: Path) -> None:
    message = refused("identify", long_file, long_file, *ASKED, *QUICK)
    assert "2 records are given, and only one can stay in its file" in " ".join(message.split())
