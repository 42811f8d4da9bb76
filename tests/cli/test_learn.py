"""hyst learn: from a reference and the measured repetitions so far to the next command."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from command_runs import write_csv
from learning_runs import (
    HEADER,
    MODEL,
    NOISE,
    TIME,
    Y_REF,
    Learn,
    column,
    errors,
    play,
    play_in_turn,
    rows,
)


def test_the_first_command_is_the_inverse_of_the_model(learn: Learn, folder: Path) -> None:
    ended = learn()
    assert ended.code == 0, ended
    assert ended.err == ""
    with (folder / "command.csv").open() as file:
        assert next(csv.reader(file)) == [
            "t [s]",
            "reference [um]",
            "command [V]",
            "predicted [um]",
        ]
    # Rounding of a number of 7 in the order of 1e-15, a thousand times.
    assert np.abs(MODEL(column("command.csv", "command")) - Y_REF).max() < 1e-12
    np.testing.assert_array_equal(column("command.csv", "t"), TIME)
    np.testing.assert_array_equal(column("command.csv", "reference"), Y_REF)
    assert np.abs(column("command.csv", "predicted") - Y_REF).max() < 1e-12
    assert "Repetitions" not in ended.out
    assert "record drive and output as repetition 1" in ended.out


def test_three_repetitions_lead_to_the_noise(learn: Learn) -> None:
    files = play_in_turn(learn, 4)
    missed = errors(files)
    assert missed[0] > 0.03 * np.ptp(Y_REF)  # there was something to learn
    assert (missed[1:] < missed[0]).all()
    # Noise, and as much again where plays of the model start to move at another drive.
    assert missed[3] < 2.0 * NOISE
    ended = learn(*files)
    assert ended.code == 0
    table = rows(ended.out)
    assert [row[:2] for row in table] == [[str(k + 1), f"run{k + 1}.csv"] for k in range(4)]
    # Printed to four digits; the mean of the error is part of it.
    told = [float(row[2]) for row in table]
    of_mean = [np.mean((column(each, "position") - Y_REF) ** 2) ** 0.5 for each in files]
    assert told == pytest.approx(of_mean, rel=1e-3)
    largest = [np.abs(column(each, "position") - Y_REF).max() for each in files]
    assert [float(row[3]) for row in table] == pytest.approx(largest, rel=1e-3)
    assert [float(row[4]) for row in table] == pytest.approx(
        [100.0 * each / 5.0 for each in of_mean], rel=1e-2
    )


def test_the_same_files_give_the_same_command(learn: Learn, folder: Path) -> None:
    files = play_in_turn(learn, 2)
    assert learn(*files).code == 0
    first = (folder / "command.csv").read_bytes()
    assert learn(*files).code == 0
    assert (folder / "command.csv").read_bytes() == first


def test_what_was_applied_counts_and_is_told(learn: Learn) -> None:
    learn()
    other = 0.93 * column("command.csv", "command")
    files = [play("own.csv", other)]
    ended = learn(*files)
    assert ended.code == 0
    assert "note: own.csv: its drive is" in ended.err
    assert "what was applied counts" in ended.err
    files.append(play("run2.csv", column("command.csv", "command"), 2))
    assert errors(files)[1] < 0.3 * errors(files)[0]


def test_a_command_played_again_is_seen(learn: Learn) -> None:
    files = play_in_turn(learn, 2)
    again = play("again.csv", column(files[0], "drive"), 5)
    ended = learn(*files, again)
    assert "again.csv: its drive is" in ended.err
    assert "and is command 1 again; it counts as such" in ended.err


def test_a_drive_that_was_read_back_adds_no_noise(learn: Learn) -> None:
    """A monitor of 0.3 % noise and 0.5 % gain error would else be in the next command."""
    learn()
    u = column("command.csv", "command")
    exact = play("exact.csv", u, 1)
    learn(exact)
    wanted = column("command.csv", "command")
    monitor = 1.005 * u + np.random.default_rng(9).normal(0.0, 0.01, u.size)
    read = write_csv(Path("read.csv"), HEADER, TIME, monitor, column(exact, "position"))
    ended = learn(read)
    assert ended.err == ""
    np.testing.assert_array_equal(column("command.csv", "command"), wanted)
