"""hyst watch: files that grow, are torn, replaced or broken; standard input; logs and ends."""

from __future__ import annotations

import contextlib
import csv
import io
import itertools
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from command_runs import STAGE, Ended, Run
from watch_runs import (
    COLUMNS,
    DT,
    END,
    NOISE,
    alarms,
    counts,
    lines,
    reports,
    saved_stage,
    strokes,
    text_of,
)

import hyst
from hyst.cli.watch.sources import GrowingFile, Piece


@pytest.fixture
def model(folder: Path) -> Path:
    """The stage's model."""
    return saved_stage(folder)


@pytest.fixture
def grown(
    run: Run, folder: Path, model: Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., Ended]:
    """Watch a file while a thread writes to it, each step once the one before was read."""
    stop = threading.Event()
    idle = [0]
    read = GrowingFile.read

    def counted(self: GrowingFile) -> Piece | None:
        piece = read(self)
        idle[0] += piece is None
        return piece

    @contextlib.contextmanager
    def stopped() -> Iterator[threading.Event]:
        yield stop

    monkeypatch.setattr(GrowingFile, "read", counted)
    monkeypatch.setattr("hyst.cli.watch.start.ended_by_signals", stopped)
    monkeypatch.setattr("hyst.cli.watch.loop._PAUSE", 0.005)

    def write(steps: list[Callable[[Path], object]]) -> None:
        for step in steps:
            step(folder / "run.csv")
            # The first may have begun before the step.
            until = idle[0] + 2
            while idle[0] < until and not stop.is_set():
                time.sleep(0.002)
        stop.set()

    def run_it(steps: list[Callable[[Path], object]], *options: object) -> Ended:
        writer = threading.Thread(target=write, args=[steps])
        writer.start()
        try:
            return run(
                "watch", "model.json", "run.csv", *COLUMNS, "--time", "t", "--json", *options
            )
        finally:
            stop.set()
            writer.join()

    return run_it


def add(text: str) -> Callable[[Path], object]:
    def step(path: Path) -> None:
        with path.open("a") as file:
            file.write(text)

    return step


def replaced(text: str) -> Callable[[Path], object]:
    def step(path: Path) -> None:
        path.rename(path.with_suffix(".1"))
        path.write_text(text)

    return step


def cut_off(text: str) -> Callable[[Path], object]:
    def step(path: Path) -> None:
        path.write_text(text)

    return step


def test_a_file_that_grows_is_followed_line_by_torn_line(grown: Callable[..., Ended]) -> None:
    whole = text_of(strokes(12.0))
    cuts = [0, 700, 705, 9000, 9001, len(whole)]
    steps = [add(whole[a:b]) for a, b in itertools.pairwise(cuts)]
    ended = grown(steps)
    assert ended.code == 0, ended
    assert counts(ended)["samples"] == 1200
    assert counts(ended)["unreadable lines"] == 0
    assert alarms(ended) == []
    estimate = reports(ended)[-1]["estimate"]
    np.testing.assert_allclose(estimate["p0"]["value"], 1.0, atol=0.02)


def test_a_file_may_come_later(grown: Callable[..., Ended]) -> None:
    ended = grown([lambda path: None, add(text_of(strokes(6.0)))])
    assert ended.code == 0, ended
    assert "waiting for run.csv" in ended.err
    assert counts(ended)["samples"] == 600


def test_a_file_that_does_not_come_is_told(refused: Callable[..., str], model: Path) -> None:
    said = refused("watch", "model.json", "no.csv", *COLUMNS, "--rate", 100, "--wait", 0)
    assert "no.csv did not come within 0 s" in said


@pytest.mark.parametrize("change", [replaced, cut_off])
def test_another_file_in_its_place_is_read_from_its_start(
    grown: Callable[..., Ended], change: Callable[[str], Callable[[Path], object]]
) -> None:
    ended = grown([add(text_of(strokes(8.0))), change(text_of(strokes(6.0)))])
    assert ended.code == 0, ended
    assert "another file begins" in ended.err
    assert counts(ended)["samples"] == 1400
    # Both memories are unknown at first; a stroke has 50 samples.
    assert 1400 - 4 * 50 <= counts(ended)["learnt"] < 1400
    assert alarms(ended) == []


def test_a_file_cut_off_and_grown_beyond_the_old_place_is_noticed(
    grown: Callable[..., Ended],
) -> None:
    ended = grown([add(text_of(strokes(2.0))), cut_off(text_of(strokes(9.0, gain=1.0001)))])
    assert "another file begins" in ended.err
    assert counts(ended)["samples"] == 1100


@pytest.fixture
def piped(run: Run, model: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Ended]:
    def run_it(text: str | bytes, *options: object) -> Ended:
        data = text if isinstance(text, bytes) else text.encode()
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(data)))
        return run("watch", "model.json", "-", *COLUMNS, "--time", "t", "--json", *options)

    return run_it


def test_standard_input_with_semicolons_and_commas(piped: Callable[..., Ended]) -> None:
    text = text_of(strokes(10.0)).replace(",", ";").replace(".", ",").replace("\n", "\r\n")
    ended = piped(text)
    assert (ended.code, ended.err) == (0, "")
    assert counts(ended)["samples"] == 1000
    assert [report["time"] for report in reports(ended)] == pytest.approx([4.99, 9.99])


def test_rows_without_header_or_time(run: Run, model: Path, folder: Path) -> None:
    bare = "".join(line.split(",", 1)[1] for line in strokes(10.0))
    (folder / "bare.csv").write_text(bare)
    how = ("--input", 0, "--output", 1, "--rate", 100, "--json", *END)
    ended = run("watch", "model.json", "bare.csv", *how)
    assert ended.code == 0, ended
    assert counts(ended)["learnt"] > 900


def test_a_drift_is_an_alarm_at_the_end(piped: Callable[..., Ended]) -> None:
    ended = piped(text_of(strokes(10.0), strokes(20.0, gain=1.1, start=10.0)))
    assert ended.code == 3
    assert {"model error", "drift"} <= set(alarms(ended))
    assert len(alarms(ended)) == len(set(alarms(ended)))
    assert "alarms at the end: " in ended.err
    times = [each["time"] for each in lines(ended) if each.get("event") == "start"]
    assert min(times) > 10.0


@pytest.mark.parametrize("seed", range(5))
def test_an_undisturbed_actuator_raises_none(piped: Callable[..., Ended], seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.arange(2000) * DT
    u = 2.0 - 2.0 * np.cos(2.0 * np.pi * rng.uniform(0.5, 3.0) * t + rng.uniform(0.0, 6.0))
    y = STAGE(u) + rng.normal(0.0, NOISE, t.size)
    rows = [f"{a:.2f},{b:.6f},{c:.6f}\n" for a, b, c in zip(t, u, y, strict=True)]
    only = ("--only", "scale,offset") if seed % 2 else ()
    ended = piped(text_of(rows), *only)
    assert (ended.code, alarms(ended)) == (0, [])


def test_lost_samples_and_broken_lines(piped: Callable[..., Ended], folder: Path) -> None:
    rows = strokes(20.0)
    rows[700] = "7.00,1.2.3,4\n"
    rows[705] = "7.05,oops\n"
    rows[900] = "9.00,nan,4.1\n"
    ended = piped(text_of(rows[:1200], rows[1260:]), "--log", "out")
    told = counts(ended)
    assert (told["samples lost"], told["unreadable lines"], told["no number"]) == (60, 2, 1)
    assert set(alarms(ended)) == {"samples lost", "unreadable lines", "no number"}
    assert ended.code == 0, ended
    assert "2 lines could not be read, the first was line 702: '7.00,1.2.3,4'" in ended.err
    with (folder / "out" / "alarms.csv").open() as file:
        table = list(csv.DictReader(file))
    assert [row["event"] for row in table].count("start") == 3
    assert [row["event"] for row in table].count("end") == 3


def test_the_log_and_going_on_from_it(piped: Callable[..., Ended], folder: Path, run: Run) -> None:
    ended = piped(text_of(strokes(10.0)), "--log", "out")
    assert ended.code == 0, ended
    out = folder / "out"
    assert {each.name for each in out.iterdir()} == {
        "log.csv",
        "alarms.csv",
        "estimator.json",
        "model.json",
    }
    first = hyst.load(out / "estimator.json")
    again = piped(
        text_of(strokes(10.0, start=20.0)), "--log", "out", "--resume", "out/estimator.json"
    )
    assert again.code == 0, again
    # It goes on counting what it used, but not before its memory is known again.
    second = hyst.load(out / "estimator.json")
    more = second.counts["used"] - first.counts["used"]
    assert 1000 - 100 <= more < 1000
    with (out / "log.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4
    low, value, high = (float(rows[-1][name]) for name in ("p0 low", "p0", "p0 high"))
    assert low < high
    assert value == pytest.approx(1.0, abs=0.02)
    assert rows[-1]["alarms"] == ""
    found = hyst.load(out / "model.json")
    assert found.description.input_unit == "V"


def test_a_log_in_one_file(piped: Callable[..., Ended], folder: Path) -> None:
    ended = piped(text_of(strokes(10.0)), "--log", "night.csv", "--only", "scale,offset")
    assert ended.code == 0, ended
    with (folder / "night.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["learnt"] for row in rows] == [
        str(each["counts"]["learnt"]) for each in reports(ended)
    ]
    assert float(rows[-1]["scale"]) == pytest.approx(1.0, abs=1e-3)
    assert hyst.load(folder / "night.estimator.json").names == ("scale", "offset")


def test_text_for_people(run: Run, model: Path, folder: Path) -> None:
    (folder / "run.csv").write_text(text_of(strokes(10.0), strokes(5.0, 1.2, 10.0)))
    ended = run("watch", "model.json", "run.csv", *COLUMNS, "--time", "t", *END)
    first, *_ = ended.out.splitlines()
    assert first.split()[:4] == ["4.99", "s", "error", first.split()[3]]
    assert "allowed 0.01" in first
    assert "+-" in first
    assert any("ALARM: model error: " in line for line in ended.out.splitlines())
    assert "alarms: " in ended.out.splitlines()[-1]


def test_ctrl_c_ends_cleanly_and_saves(model: Path, folder: Path) -> None:
    path = folder / "run.csv"
    path.write_text(text_of(strokes(8.0)))
    program = "import sys; from hyst.cli import main; sys.exit(main(sys.argv[1:]))"
    how = ["watch", "model.json", "run.csv", *COLUMNS, "--time", "t", "--log", "out"]
    process = subprocess.Popen(
        [sys.executable, "-c", program, *how],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(Path(hyst.__file__).parents[1])},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stdout is not None
        assert "error" in process.stdout.readline()
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=60)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 0, told
    assert "Traceback" not in told
    assert hyst.load(folder / "out" / "estimator.json").counts["used"] > 700
    assert (folder / "out" / "log.csv").read_text().endswith("\n")


def test_silence_is_an_alarm_and_ends_with_the_next_line(grown: Callable[..., Ended]) -> None:
    rows = strokes(8.0)
    wait = [lambda path: time.sleep(0.1), add("".join(rows[400:]))]
    ended = grown([add(text_of(rows[:400])), *wait], "--silence", 0.05)
    found = [each for each in lines(ended) if each.get("alarm") == "no data"]
    assert [each["event"] for each in found][:2] == ["start", "end"]
