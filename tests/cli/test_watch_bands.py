"""What hyst watch tells of a file does not depend on how fast the file is read."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run, describe

DT = 0.01
NOISE = 0.005
HOW = ("--input", "u", "--output", "y", "--rate", "100", "--json", "--stop-after", "at-end")


@pytest.fixture
def drifted(folder: Path) -> str:
    """30 s of a stage whose offset leaps by 1 after 10 s, in a file that is complete."""
    t = np.arange(3000) * DT
    u = 2.0 - 2.0 * np.cos(4.0 * np.pi * t)
    y = STAGE(u) + (t > 10.0) + np.random.default_rng(1).normal(0.0, NOISE, t.size)
    STAGE.save(folder / "model.json", describe(STAGE, delay=0, errors={"training": {"rms": NOISE}}))
    rows = (f"{a:.6f},{b:.6f}\n" for a, b in zip(u, y, strict=True))
    (folder / "run.csv").write_text("u,y\n" + "".join(rows))
    return "run.csv"


def told(run: Run, name: str) -> list[dict[str, object]]:
    ended = run("watch", "model.json", name, *HOW, "--memory", "5")
    each = [json.loads(line) for line in ended.out.splitlines()]
    return [report for report in each if "estimate" in report]


def test_values_are_of_the_time_of_the_report(run: Run, drifted: str) -> None:
    """A file is read in milliseconds, when bands were asked for just before: all are told anew."""
    estimates = [report["estimate"] for report in told(run, drifted)]
    # The leap is 200 times the noise, and what it leaves after four memories is 2 % of it. Alone,
    # the running estimate ends in a false minimum with an offset of -1.7.
    assert estimates[1]["offset"]["value"] == pytest.approx(2.0, abs=0.01)
    assert estimates[-1]["offset"]["value"] == pytest.approx(3.0, abs=0.05)
    assert [each["low"] < each["value"] < each["high"] for each in estimates[-1].values()] == [
        True
    ] * len(estimates[-1])


def test_bands_that_were_not_asked_for_are_not_told(
    run: Run, drifted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where bands cost more than a tenth of the time, some reports have values alone."""
    monkeypatch.setattr("hyst.cli.watch.session._RARELY", 1e9)
    offset = [report["estimate"]["offset"] for report in told(run, drifted)]
    assert offset[0]["known"]
    assert [(each["low"], each["high"], each["known"]) for each in offset[1:]] == [
        (None, None, False)
    ] * (len(offset) - 1)
    assert abs(offset[-1]["value"] - offset[1]["value"]) > 0.5
