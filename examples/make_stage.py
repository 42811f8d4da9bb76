"""Make the files of this folder again, with the same numbers: `python examples/make_stage.py`.

stage.csv is a record of the simulated stage of `hyst demo` (nothing is measured): its drive goes
between levels, large and small, and rests at some of them. trajectory.csv is a motion to follow.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import hyst
from hyst.demo import SimulatedStage
from hyst.demo.trajectories import staircase_and_sines, with_holds

LEVELS = (
    *(0.0, 100.0, 0.0, 80.0, 20.0, 65.0, 35.0, 55.0, 45.0),
    *(10.0, 90.0, 50.0, 70.0, 60.0, 100.0, 0.0),
)
"""V; large loops and small ones."""
HOLDS = {100.0: 0.5, 90.0: 0.5, 20.0: 3.0, 50.0: 2.0}
"""s, by level: while the drive rests the stage shows its creep."""
SPEED = 200.0
"""V/s."""


def make(folder: Path) -> None:
    """Write both files, rounded to what their instruments would give."""
    stage = SimulatedStage()
    u = with_holds(LEVELS, HOLDS, SPEED, stage.dt).round(3)
    write(
        folder / "stage.csv",
        {"drive [V]": u, "position [um]": stage.measure(stage.position(u)).round(4)},
    )
    write(
        folder / "trajectory.csv",
        {"position [um]": staircase_and_sines(8.0, 48.0, stage.dt).round(4)},
    )


def write(path: Path, columns: dict[str, np.ndarray]) -> None:
    """Write columns behind one of time."""
    count = len(next(iter(columns.values())))
    t = (SimulatedStage().dt * np.arange(count)).round(3)
    hyst.io.write_columns(path, ["time [s]", *columns], [t, *columns.values()])


if __name__ == "__main__":
    make(Path(sys.argv[1]) if sys.argv[1:] else Path(__file__).resolve().parent)
