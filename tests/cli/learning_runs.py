"""A stage to learn on, what is known of it, and how it is played, for the tests of hyst learn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from command_runs import Ended, write_csv

import hyst
from hyst.operators import Affine

Learn = Callable[..., Ended]

DT = 0.01
NOISE = 2.5e-3  # um: 0.05 % of the reference's range
TRUE = Affine(1.0, 2.0) @ hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.4, 1.1], p0=1.0)
MODEL = Affine(1.0, 2.0) @ hyst.PrandtlIshlinskii(p=[0.46, 0.34], r=[0.38, 1.15], p0=0.88)
"""What is known of the stage: slopes to 15 %, radii to 5."""

N = 700
TIME = DT * np.arange(N)
Y_REF = 4.5 - 2.5 * np.cos(2.0 * np.pi * TIME / 3.5)
COLUMNS = ("--column", "position", "--input", "drive", "--output", "position")
HEADER = "t [s],drive [V],position [um]"


def column(file: Path | str, name: str) -> np.ndarray:
    return hyst.io.read_column(file, name)[0]


def play(
    name: str, u: np.ndarray, seed: int = 0, stage: hyst.Operator = TRUE, dt: float = DT
) -> Path:
    """Drive the stage from rest, and write what was applied and measured."""
    y = stage(u) + np.random.default_rng(seed).normal(0.0, NOISE, u.size)
    return write_csv(Path(name), HEADER, dt * np.arange(u.size), u, y)


def play_in_turn(learn: Learn, count: int, *more: object) -> list[Path]:
    """Learn and play by turns; give the files."""
    files: list[Path] = []
    for k in range(count):
        ended = learn(*files, *more)
        assert ended.code == 0, ended
        files.append(play(f"run{k + 1}.csv", column("command.csv", "command"), k))
    return files


def errors(files: list[Path]) -> np.ndarray:
    """Root mean square of what each run missed the reference by, without hyst's table."""
    return np.array([np.std(column(each, "position") - Y_REF) for each in files])


def rows(text: str) -> list[list[str]]:
    """The table of repetitions."""
    lines = text.split("\nRepetitions\n")[1].split("\n\n")[0].splitlines()
    return [line.split() for line in lines[1:]]
