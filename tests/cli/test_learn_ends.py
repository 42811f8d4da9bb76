"""How hyst learn ends: what it writes beside the command, with which code, and what it refuses."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, describe, write_csv
from learning_runs import (
    COLUMNS,
    HEADER,
    MODEL,
    TIME,
    TRUE,
    Y_REF,
    Learn,
    column,
    play,
    play_in_turn,
)

import hyst
from hyst.operators import Verdict


def test_a_page_and_a_figure_are_drawn(learn: Learn, folder: Path) -> None:
    files = play_in_turn(learn, 1)
    ended = learn(*files, "--report", "out/learning.html", "--figure", "learning.png")
    assert ended.code == 0, ended
    assert (folder / "learning.png").read_bytes().startswith(b"\x89PNG")
    page = (folder / "out" / "learning.html").read_text()
    assert "<h1>Learning from repetition</h1>" in page
    assert page.count("<figure>") == 1
    assert not re.search(r"https?://", page)
    assert [name for name in ("run1.csv", "wanted.csv", "model.json") if name not in page] == []
    lines = ended.out.splitlines()
    assert "wrote command.csv, learning.png in ." in lines
    assert "wrote learning.html in out" in lines


@pytest.mark.usefixtures("undrawn")
def test_repetitions_that_get_worse_are_stopped_and_the_best_is_kept(
    learn: Learn, folder: Path
) -> None:
    """An output that answers changes of the command by other motions, eight times as large."""
    files = play_in_turn(learn, 1)
    best, first = column(files[0], "drive"), column(files[0], "position")
    random = np.random.default_rng(1)
    learn(*files)
    for k in range(2, 9):
        u = column("command.csv", "command")
        size = 8.0 * np.sqrt(2.0 * np.mean((TRUE(u) - TRUE(best)) ** 2))
        other = size * np.cos(2.0 * np.pi * (0.2 + random.random()) * TIME + 6.3 * random.random())
        files.append(write_csv(Path(f"run{k}.csv"), HEADER, TIME, u, first + other))
        ended = learn(*files)
        if ended.code:
            break
    assert ended.code == 3, ended
    assert "Traceback" not in ended.err
    assert ended.out.startswith("diverged after")
    np.testing.assert_array_equal(column("command.csv", "command"), best)
    assert "the command written is that of the best repetition" in ended.out
    assert learn(*files, "--report", "learning.html").code == 3
    assert 'class="verdict unfit"' in (folder / "learning.html").read_text()


def test_a_repetition_far_worse_than_the_best_is_told(learn: Learn) -> None:
    """A sensor that lost its gain, or another motion: leaving its file out takes it back."""
    files = play_in_turn(learn, 3)
    ended = learn(*files)
    assert ended.err == ""
    wanted = column("command.csv", "command")
    broken = hyst.operators.Affine(0.3, 2.0) @ TRUE
    files.append(play("run4.csv", wanted, 4, broken))
    ended = learn(*files)
    assert "note: repetition 4 (run4.csv) missed by " in ended.err
    assert "leave its file out" in ended.err
    learn(*files[:3])
    np.testing.assert_array_equal(column("command.csv", "command"), wanted)


def test_the_drive_stays_in_its_range(run: Run, learn: Learn, known: Path) -> None:
    files = play_in_turn(learn, 2, "--input-range", "-0.1,2.9")
    for each in files:
        u = column(each, "drive")
        assert u.min() >= -0.1
        assert u.max() <= 2.9
    ended = learn(*files, "--input-range", "-0.1,2.9")
    assert "limits -0.1 to 2.9" in ended.out
    assert "no limits" in learn(*files, "--input-range", "none").out


def test_the_drive_keeps_its_rate(learn: Learn) -> None:
    files = play_in_turn(learn, 2, "--rate-limit", 3.0)
    for each in files:
        steps = np.abs(np.diff(column(each, "drive")))
        assert steps.max() <= 3.0 * 0.01 * (1.0 + 1e-9)  # rounding


def test_a_history_sets_the_memory(learn: Learn) -> None:
    """After a stroke to 5 V and back the stage is elsewhere; the first command knows."""
    before = np.concatenate([np.linspace(0.0, 5.0, 50), np.linspace(5.0, 0.0, 50)])
    write_csv(Path("before.csv"), "drive", before)
    assert learn("--history", "before.csv:drive").code == 0
    u = column("command.csv", "command")
    after = MODEL(np.concatenate([before, u]))[before.size :]
    assert np.abs(after - Y_REF).max() < 1e-12  # rounding
    assert learn("--history", "5,0").code == 0
    np.testing.assert_array_equal(column("command.csv", "command"), u)


def test_an_unfit_model_is_refused_or_said(
    run: Run, refused: Callable[..., str], wanted: Path
) -> None:
    about = describe(MODEL, input_low=-1.0, input_high=5.0, delay=0)
    unfit = Verdict("unfit", ("The loop is another one.",))
    MODEL.save("poor.json", about.__class__(**{**vars(about), "verdict": unfit}))
    command = ("learn", "poor.json", wanted, *COLUMNS, "-o", "command.csv")
    assert "no command is made, for the verdict" in refused(*command)
    assert run(*command, "--despite-verdict").code == 3


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (("--input-range", "1"), "--input-range is '1'"),
        (("--input-range", "low,high"), "--input-range is 'low,high'"),
        (("--noise", "-1"), "noise"),
        (("--rate-limit", "0"), "rate"),
        (("--repetitions", "0"), "--repetitions"),
        (("--reference-rate", "0"), "--reference-rate"),
        (("--report", "page.html"), "nothing was measured yet"),
        (("--report", "command.csv"), "name one file twice"),
        (("--figure", "wanted.csv"), "wanted.csv is one of the files to read"),
        (("--history", "a,b"), "--history"),
    ],
)
def test_what_was_typed_wrong_is_refused(
    options: tuple[str, ...], part: str, refuses: Callable[..., str]
) -> None:
    assert part in refuses(*options)


def test_a_reference_that_cannot_be_is_refused(
    refused: Callable[..., str], known: Path, folder: Path
) -> None:
    command = ("learn", known, "other.csv", *COLUMNS, "-o", "command.csv")
    write_csv(folder / "other.csv", "t [s],position [mm]", TIME, Y_REF)
    assert "'mm' but the model's in 'um'" in refused(*command)
    write_csv(folder / "other.csv", "t [s],position [um]", TIME**2, Y_REF)
    assert "has no even steps" in refused(*command)
    write_csv(folder / "other.csv", "t [s],height [um]", TIME, Y_REF)
    assert "no column" in refused(*command)
    (folder / "other.csv").write_text("t [s],position [um]\n")
    assert "other.csv" in refused(*command)


def test_a_rate_limit_needs_a_sample_time(
    run: Run, refused: Callable[..., str], known: Path, folder: Path
) -> None:
    write_csv(folder / "other.csv", "position [um]", Y_REF)
    command = ("learn", known, "other.csv", *COLUMNS, "-o", "command.csv", "--rate-limit", "3")
    assert "give --reference-rate" in refused(*command)
    assert run(*command, "--reference-rate", "100").code == 0
    assert np.abs(np.diff(column("command.csv", "command"))).max() <= 0.03 * (1.0 + 1e-9)
    np.testing.assert_allclose(column("command.csv", "time"), TIME, rtol=1e-12)


def test_a_model_without_a_way_back_is_refused(
    refused: Callable[..., str], wanted: Path, folder: Path
) -> None:
    hyst.Play(0.5).save(folder / "play.json")
    message = refused("learn", "play.json", wanted, *COLUMNS, "-o", "command.csv")
    assert "has no linear part (p0 = 0)" in message
    (folder / "text.json").write_text("no model")
    assert "text.json" in refused("learn", "text.json", wanted, *COLUMNS, "-o", "command.csv")


def test_a_model_over_a_second_signal_is_taken_at_a_value(
    run: Run, refused: Callable[..., str], wanted: Path
) -> None:
    warm = MODEL.with_parameters(1.1 * MODEL.parameters().values)
    hyst.Scheduled((MODEL, warm), (20.0, 40.0), name="temperature").save("over.json")
    command = ("learn", "over.json", wanted, *COLUMNS, "-o", "command.csv")
    assert "over.json" in refused(*command)
    assert run(*command, "--schedule-value", "20").code == 0
    # Rounding of a number of 7, a thousand times.
    assert np.abs(MODEL(column("command.csv", "command")) - Y_REF).max() < 1e-12


def test_a_model_in_samples_has_its_sample_time_kept(
    run: Run, refused: Callable[..., str], folder: Path
) -> None:
    creeping = hyst.Creep([0.02], [1.0], 0.01) @ MODEL
    creeping.save("creeping.json", describe(MODEL, input_low=-1.0, input_high=5.0))
    command = ("learn", "creeping.json", "other.csv", *COLUMNS, "-o", "command.csv")
    write_csv(folder / "other.csv", "t [s],position [um]", 2.0 * TIME, Y_REF)
    assert "0.02" in refused(*command)
    write_csv(folder / "other.csv", "position [um]", Y_REF)
    ended = run(*command)
    assert ended.code == 0
    assert "taken to have the model's sample time, 0.01 s" in ended.err
    np.testing.assert_allclose(column("command.csv", "time"), TIME, rtol=1e-12)
    u = column("command.csv", "command")
    played = play("run1.csv", u, 1, hyst.Creep([0.03], [1.5], 0.01) @ MODEL)
    assert run(*command[:3], played, *command[3:]).code == 0


def test_the_help_names_everything(run: Run) -> None:
    ended = run("learn", "--help")
    assert ended.code == 0
    words = ended.out
    for option in ("--periodic", "--noise", "--input-range", "--report", "--repetitions"):
        assert option in words
