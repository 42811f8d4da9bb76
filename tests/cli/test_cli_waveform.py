"""hyst waveform: tables for controllers that run no code."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run, describe, write_csv

K = np.arange(600)


@pytest.fixture
def wave(folder: Path) -> Path:
    return write_csv(
        folder / "u.csv", "time [s],u [V]", K / 1000.0, 2 + np.sin(2 * np.pi * K / 600)
    )


def test_a_command_becomes_a_table_of_codes(run: Run, folder: Path, wave: Path) -> None:
    asked = ("--column", "u", "--limits", "0,4", "--slew", "20", "--bits", 12, "--repeat")
    ended = run("waveform", wave, *asked, "--controller-rate", 500, "--points", 300, "-o", "w.csv")
    assert ended.code == 0, ended.err
    assert (folder / "w.csv").read_text().startswith("time [s],u [V],code\n0.0,")
    rows = np.loadtxt(folder / "w.csv", delimiter=",", skiprows=1)
    assert rows.shape == (300, 3)
    wanted = 2 + np.sin(2 * np.pi * K[::2] / 600)
    assert np.array_equal(rows[:, 2], np.ceil(wanted / 4.0 * 4095.0 - 0.5))
    assert np.abs(rows[:, 1] - rows[:, 2] * 4.0 / 4095.0).max() < 1e-12
    assert "one of 2 samples" in ended.err
    assert "300, 0.002 s each" in ended.out


def test_a_wanted_output_becomes_the_table_of_its_steady_cycle(run: Run, folder: Path) -> None:
    STAGE.save(folder / "model.json", describe(STAGE, dt=None, delay=0))
    y_ref = 5.0 + 1.5 * np.sin(2 * np.pi * K / 600)
    path = write_csv(folder / "y.csv", "time [ms],stroke [um]", 1.0 * K, y_ref)
    asked = ("--column", "stroke", "--model", "model.json", "--repeat")
    ended = run("waveform", path, *asked, "-o", "w.csv")
    assert ended.code == 0, ended.err
    rows = np.loadtxt(folder / "w.csv", delimiter=",", skiprows=1)
    assert np.abs(STAGE(np.tile(rows[:, 1], 3))[-600:] - y_ref).max() < 1e-12
    assert "first pass" in ended.out
    assert "steady cycle" in ended.out
    driver = ("--driver", "linear:0.001,0,0,4000")
    ended = run("waveform", path, *asked, *driver, "-o", "c.csv")
    assert ended.code == 0, ended.err
    codes = np.loadtxt(folder / "c.csv", delimiter=",", skiprows=1)[:, 2]
    # 1.8 is the slope of all plays together, 0.0005 half a code.
    assert np.abs(STAGE(np.tile(0.001 * codes, 3))[-600:] - y_ref).max() <= 1.8 * 0.0005 + 1e-9


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--limits", "0,2.5"), "point 51 at 0.051 s is 2.50904142, out of the limits 0 to 2.5"),
        (("--limits", "0,4", "--slew", "1"), "more than the slew 1"),
        (("--limits", "0"), "--limits is '0'"),
        ((), "no limits of the drive are known"),
        (("--limits", "0,4", "--points", "100"), "100 are allowed"),
        (("--limits", "0,4", "--repeat", "--controller-rate", "333"), "a whole number of them"),
        (("--limits", "0,4", "--driver", "none.csv"), "none.csv"),
        (("--limits", "0,4", "--bits", "8", "--driver", "linear:1,0,0,4"), "give one of them"),
        (("--limits", "0,4", "--history", "1"), "there is no model"),
    ],
)
def test_what_cannot_be_played_is_refused(
    run: Run, folder: Path, wave: Path, more: tuple[str, ...], said: str
) -> None:
    ended = run("waveform", wave, "--column", "u", *more, "-o", "w.csv")
    assert ended.code == 2
    assert said in ended.err
    assert not (folder / "w.csv").exists()


@pytest.mark.parametrize("header", ["code", "dac [counts]"])
def test_a_command_in_codes_is_the_volts_of_its_driver(run: Run, folder: Path, header: str) -> None:
    """Codes that could be volts, too: 20 of 8 bits are 2.4 V, and would keep the limits."""
    path = write_csv(folder / "c.csv", f"time [ms],{header}", K[:50], 20 + K[:50])
    asked = ("--column", 1, "--driver", "linear:-0.1,4.4,0,255", "--limits", "-30,30")
    ended = run("waveform", path, *asked, "-o", "w.csv")
    assert ended.code == 0, ended.err
    assert (folder / "w.csv").read_text().startswith("time [s],drive [V],code\n")
    rows = np.loadtxt(folder / "w.csv", delimiter=",", skiprows=1)
    assert np.array_equal(rows[:, 2], 20 + K[:50])
    assert np.abs(rows[:, 1] - (4.4 - 0.1 * (20 + K[:50]))).max() < 1e-13
    (folder / "w.csv").unlink()
    ended = run("waveform", path, *asked[:-2], "--driver", "linear:0.1,0,0,60", "-o", "w.csv")
    assert ended.code == 2
    assert "the code at index 41 is 61; the driver takes whole codes from 0 to 60" in ended.err


def test_times_come_from_the_file_or_the_user(run: Run, folder: Path) -> None:
    path = write_csv(folder / "plain.csv", "u", np.linspace(0.0, 1.0, 11))
    asked = ("waveform", path, "--column", "u", "--limits", "0,1", "-o")
    ended = run(*asked, "w.csv")
    assert ended.code == 2
    assert "give --rate" in ended.err
    assert run(*asked, "w.csv", "--rate", 10, "--controller-rate", 20).code == 0
    assert np.loadtxt(folder / "w.csv", delimiter=",", skiprows=1)[1].tolist() == [0.05, 0.05]
    assert run(*asked, path, "--rate", 10).code == 2  # never onto what is read
