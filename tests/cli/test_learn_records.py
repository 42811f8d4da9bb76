"""Records that hyst learn is given: long, late, early, of other rates, or of something else."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import Run, write_csv
from learning_runs import (
    COLUMNS,
    DT,
    HEADER,
    NOISE,
    TIME,
    TRUE,
    Y_REF,
    Learn,
    N,
    column,
    play,
    rows,
)


@pytest.fixture
def exact(learn: Learn) -> Path:
    """What the first command led to, from its first sample to its last."""
    assert learn().code == 0
    return play("exact.csv", column("command.csv", "command"), 1)


def next_command(learn: Learn, *files: object) -> np.ndarray:
    ended = learn(*files)
    assert ended.code == 0, ended
    return column("command.csv", "command")


def padded(exact: Path, name: str, before: int, after: int) -> Path:
    """The same measurement with rest before and after; the stage is at rest at both ends."""
    u, y = column(exact, "drive"), column(exact, "position")
    noise = np.random.default_rng(4).normal(0.0, NOISE, before + after)
    u = np.concatenate([np.full(before, u[0]), u, np.full(after, u[-1])])
    y = np.concatenate([y[0] + noise[:before], y, y[-1] + noise[before:]])
    return write_csv(Path(name), HEADER, DT * np.arange(u.size), u, y)


def test_a_longer_record_is_cut_where_the_command_is(learn: Learn, exact: Path) -> None:
    wanted = next_command(learn, exact)
    longer = padded(exact, "long.csv", 83, 120)
    ended = learn(longer)
    assert "long.csv: is longer than the motion, which was found at samples 83 to 782" in ended.err
    np.testing.assert_array_equal(column("command.csv", "command"), wanted)


def test_a_record_twice_as_long_as_its_motion_holds_one(learn: Learn, exact: Path) -> None:
    wanted = next_command(learn, exact)
    for before in (0, 300, N):
        twice = padded(exact, "twice.csv", before, N - before)
        ended = learn(twice)
        assert f"was found at samples {before} to {before + N - 1}" in ended.err
        np.testing.assert_array_equal(column("command.csv", "command"), wanted)


@pytest.mark.parametrize(("kept", "words"), [(slice(12, N), "12"), (slice(0, N - 30), "0")])
def test_a_record_that_lacks_an_end_is_refused(
    kept: slice, words: str, learn: Learn, refuses: Callable[..., str], exact: Path
) -> None:
    longer = padded(exact, "long.csv", 0, 12)
    u, y = column(longer, "drive")[kept], column(longer, "position")[kept]
    short = write_csv(Path("cut.csv"), HEADER, DT * np.arange(u.size), u, y)
    said = refuses(short)
    assert f"cut.csv has {N - int(words) if words == '12' else N - 30} samples" in said
    assert "record the whole motion" in said


@pytest.mark.parametrize("shift", [25, -40])
def test_a_record_of_the_right_length_that_began_early_or_late_is_refused(
    shift: int, refuses: Callable[..., str], exact: Path
) -> None:
    longer = padded(exact, "long.csv", 50, 50)
    part = slice(50 - shift, 50 - shift + N)
    u, y = column(longer, "drive")[part], column(longer, "position")[part]
    shifted = write_csv(Path("shifted.csv"), HEADER, DT * np.arange(N), u, y)
    said = refuses(shifted)
    side = "before" if shift > 0 else "after"
    assert f"shifted.csv begins {abs(shift)} samples {side} the command does" in said


def test_twice_the_rate_is_thinned(learn: Learn, exact: Path) -> None:
    wanted = next_command(learn, exact)
    u, y = column(exact, "drive"), column(exact, "position")
    between = np.interp(np.arange(2 * N) / 2.0, np.arange(N), u)
    y_between = np.interp(np.arange(2 * N) / 2.0, np.arange(N), y)
    fast = write_csv(Path("fast.csv"), HEADER, DT / 2.0 * np.arange(2 * N), between, y_between)
    ended = learn(fast)
    assert "fast.csv: has 2 samples for each of the reference; every 2nd is used" in ended.err
    np.testing.assert_array_equal(column("command.csv", "command"), wanted)


@pytest.mark.parametrize("rate", [150.0, 50.0, 101.0])
def test_another_rate_is_refused(rate: float, refuses: Callable[..., str], exact: Path) -> None:
    said = refuses(exact, "--rate", rate)
    assert f"has {rate:g} samples per second and the reference 100" in said


def test_times_need_not_be_told_where_they_are_the_references(learn: Learn, exact: Path) -> None:
    wanted = next_command(learn, exact)
    u, y = column(exact, "drive"), column(exact, "position")
    bare = write_csv(Path("bare.csv"), "drive,position", u, y)
    np.testing.assert_array_equal(next_command(learn, bare), wanted)
    np.testing.assert_array_equal(next_command(learn, bare, "--rate", 100), wanted)


def test_a_reference_without_times_has_those_of_the_records(
    run: Run, known: Path, learn: Learn, exact: Path
) -> None:
    wanted = next_command(learn, exact)
    bare = write_csv(Path("bare.csv"), "position", Y_REF)
    command = ("learn", known, bare, exact, *COLUMNS, "-o", "command.csv")
    assert run(*command).code == 0
    np.testing.assert_array_equal(column("command.csv", "command"), wanted)
    np.testing.assert_array_equal(column("command.csv", "time"), DT * np.arange(N))
    assert run(*command, "--reference-rate", 50).code == 2


def periods_of(count: int, seed: int, *commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Drive a stage through periods without a pause, each command so many times."""
    u = np.concatenate([np.tile(each, count) for each in commands])
    y = TRUE(u) + np.random.default_rng(seed).normal(0.0, NOISE, u.size)
    return u, y


def test_a_periodic_record_is_one_repetition_with_its_noise(learn: Learn) -> None:
    learn("--periodic")
    files: list[Path] = []
    for k in range(6):
        u, y = periods_of(3, k, column("command.csv", "command"))
        time = DT * np.arange(u.size)
        files.append(write_csv(Path(f"run{k + 1}.csv"), HEADER, time, u, y))
        ended = learn(*files, "--periodic")
        assert ended.code == 0, ended
        told = f"run{k + 1}.csv, periods 1 to 3: the mean of 2 periods with the same drive, without"
        assert told in ended.err
        assert "off command" not in ended.err  # each is what came out for the files before it
    kept = [np.mean(column(each, "position").reshape(3, N)[1:], axis=0) for each in files]
    of_means = [np.mean((each - Y_REF) ** 2) ** 0.5 for each in kept]
    assert of_means[-1] < 0.1 * of_means[0]
    # In units of the noise of such a mean; 700 squares of the first record tell it to 2.7 %.
    over = [float(row[-1]) for row in rows(ended.out)]
    assert over == pytest.approx([each / (NOISE / 2.0**0.5) for each in of_means], rel=0.1)


def test_a_periodic_record_may_begin_anywhere(learn: Learn) -> None:
    learn("--periodic")
    u, y = periods_of(4, 1, column("command.csv", "command"))
    straight = write_csv(Path("straight.csv"), HEADER, DT * np.arange(2 * N), u[N:-N], y[N:-N])
    wanted = next_command(learn, straight, "--periodic")
    part = slice(N + 200, 3 * N + 200)
    turned = write_csv(Path("turned.csv"), HEADER, DT * np.arange(2 * N), u[part], y[part])
    ended = learn(turned, "--periodic")
    assert "turned.csv: began 200 samples after the command does" in ended.err
    # Other noise, nothing else: the command differs by some of it.
    assert np.abs(column("command.csv", "command") - wanted).max() < 6.0 * NOISE


def test_commands_that_change_within_a_record_are_repetitions(learn: Learn) -> None:
    learn("--periodic")
    first = column("command.csv", "command")
    u, y = periods_of(2, 1, first, 0.97 * first)
    both = write_csv(Path("both.csv"), HEADER, DT * np.arange(u.size), u, y)
    ended = learn(both, "--periodic")
    assert ended.code == 0, ended
    names = [" ".join(row[1:5]) for row in rows(ended.out)]
    assert names == ["both.csv, periods 1 to", "both.csv, periods 3 to"]


def test_repetitions_may_be_counted(learn: Learn, refuses: Callable[..., str], exact: Path) -> None:
    assert "the reference 2 times 1400" in refuses(exact, "--repetitions", 2)
    learn()
    u, y = periods_of(3, 1, column("command.csv", "command"))
    u, y = (np.concatenate([np.full(60, each[0]), each]) for each in (u, y))
    three = write_csv(Path("three.csv"), HEADER, DT * np.arange(u.size), u, y)
    ended = learn(three, "--repetitions", 3, "--periodic")
    assert "began 60 samples before the command does" in ended.err
    assert "the mean of 2 periods with the same drive, without the first" in ended.err


@pytest.mark.parametrize("y_ref", [2.0 + 0.5 * TIME, np.full(N, 3.0)], ids=["ramp", "hold"])
def test_a_motion_need_not_turn(y_ref: np.ndarray, learn: Learn, folder: Path) -> None:
    write_csv(folder / "wanted.csv", "t [s],position [um]", TIME, y_ref)
    missed = []
    files: list[Path] = []
    for k in range(3):
        assert learn(*files).code == 0
        files.append(play(f"run{k}.csv", column("command.csv", "command"), k))
        missed.append(np.sqrt(np.mean((column(files[k], "position") - y_ref) ** 2)))
    assert missed[2] < max(0.1 * missed[0], 1.5 * NOISE)


def test_what_is_not_the_motion_is_refused(
    refuses: Callable[..., str], refused: Callable[..., str], known: Path, exact: Path
) -> None:
    learn = ("learn", known, "wanted.csv")
    out = ("-o", "next.csv")
    u, y = column(exact, "drive"), column(exact, "position")
    write_csv(Path("swapped.csv"), "position,drive", u + 9.0, y)
    assert "so it is another motion" in refuses("swapped.csv")
    write_csv(Path("far.csv"), "drive,position", u, 1e3 * y)
    assert "far.csv is 1.01e+03 times the range of its reference off" in refuses("far.csv")
    write_csv(Path("milli.csv"), "t [s],drive [mV],position [um]", DT * np.arange(N), u, y)
    assert "the drive in milli.csv is in 'mV' but the model's in 'V'" in refuses("milli.csv")
    write_csv(Path("nano.csv"), "t [s],drive [V],position [nm]", DT * np.arange(N), u, y)
    assert "the output in nano.csv is in 'nm' but the model's in 'um'" in refuses("nano.csv")
    assert "gone.csv does not exist" in refuses("gone.csv")
    wrong = ("--column", "position", "--input", "voltage", "--output", "position")
    assert "voltage" in refused(*learn, exact, *wrong, *out)
    column_only = ("--column", "position")
    assert "no --input" in refused(*learn, exact, *column_only, *out)
    assert "no --output" in refused(*learn, exact, *column_only, "--input", "drive", *out)
    write_csv(Path("flat.csv"), "drive,position", u, np.zeros(N))
    assert "throughout" in refuses("flat.csv")
    text = exact.read_text().splitlines()
    text[40] = text[40].rpartition(",")[0] + ",nan"
    Path("holes.csv").write_text("\n".join(text) + "\n")
    assert "nan" in refuses("holes.csv").lower()
    shutil.copy(exact, "command.csv")
    assert "is one of the files to read" in refuses("command.csv")
