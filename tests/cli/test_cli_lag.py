"""A lag and a delay on the command line: identified, held, told, and undone."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv

import hyst

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

DT = 1e-3
PLAYS = hyst.PrandtlIshlinskii(p=[0.4, 0.3], r=[0.1, 0.35], p0=0.8)


def written(path: Path, amplifier: hyst.operators.Operator) -> Path:
    """Strokes that fall, some 80 samples a period, with noise of 0.1 %."""
    k = np.arange(2000)
    u = np.sin(0.08 * k) * np.linspace(1.0, 0.3, k.size)
    y = PLAYS(amplifier(u)) + 0.002 * np.random.default_rng(0).standard_normal(k.size)
    return write_csv(path, "t,u,y", k * DT, u, y)


ASKED = ("--input", "u", "--output", "y", "--time", "t", "--family", "pi", "--plays", 2)


def test_a_lag_is_identified_told_and_undone(run: Run, folder: Path) -> None:
    record = written(folder / "lag.csv", hyst.Lag(4e-3, DT))
    ended = run("identify", record, *ASKED, "--lag", "auto", "-o", "out")
    assert ended.code == 0, ended.err
    assert "first-order lag" in ended.out
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    low, high = numbers["lag_interval"]
    assert low <= 4e-3 <= high
    assert "first-order lag" in (folder / "out" / "report.html").read_text()
    reference = write_csv(
        folder / "ref.csv", "t,y", np.arange(400) * DT, 0.6 * np.sin(0.05 * np.arange(400))
    )
    compensated = run("compensate", "out/model.json", reference, "--column", "y", "-o", "c.csv")
    assert compensated.code == 0, compensated.err
    command = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)[:, 2]
    followed = PLAYS(hyst.Lag(4e-3, DT)(command))
    # The true plant follows to what the constants are wrong by; the lag alone would miss by 0.12.
    assert np.abs(followed - 0.6 * np.sin(0.05 * np.arange(400)))[100:].max() < 0.01


def test_a_lag_that_is_known_is_held(run: Run, folder: Path) -> None:
    record = written(folder / "lag.csv", hyst.Lag(4e-3, DT))
    ended = run("identify", record, *ASKED, "--lag", "0.004", "-o", "out")
    assert ended.code == 0, ended.err
    assert "(held)" in ended.out
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    assert numbers["lag"] == 0.004
    assert numbers["metrics"]["training"]["rms"] == pytest.approx(0.002, rel=0.1)


def test_what_is_no_lag_is_refused(run: Run, folder: Path) -> None:
    record = written(folder / "lag.csv", hyst.Lag(4e-3, DT))
    ended = run("identify", record, *ASKED, "--lag", "soon", "-o", "out")
    assert ended.code != 0
    assert "--lag is 'soon'; give a number or auto or none" in ended.err


def test_what_a_delay_costs_is_told_and_saved(run: Run, folder: Path) -> None:
    record = written(folder / "late.csv", hyst.Delay(3.0, DT))
    ended = run("identify", record, *ASKED, "-o", "out")
    assert ended.code == 0, ended.err
    y_ref = 0.6 * np.sin(0.05 * np.arange(400))
    reference = write_csv(folder / "ref.csv", "t,y", np.arange(400) * DT, y_ref)
    asked = ("compensate", "out/model.json", reference, "--column", "y", "-o", "c.csv")

    def missed() -> float:
        command = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)[:, 2]
        return float(np.std((PLAYS(hyst.Delay(3.0, DT)(command)) - y_ref)[100:-10]))

    plain = run(*asked)
    assert plain.code == 0, plain.err
    # Three samples of 0.05 rad of a sine of rms 0.42.
    told = float(plain.out.split("would miss the reference by ")[1].split(" ")[0])
    assert told == pytest.approx(0.15 * 0.6 / np.sqrt(2.0), rel=0.1)
    assert missed() == pytest.approx(told, rel=0.1)
    early = run(*asked, "--with-delay", "--force")
    assert early.code == 0, early.err
    assert "3 samples of 0.001 s earlier" in early.out
    assert missed() < 0.1 * told
