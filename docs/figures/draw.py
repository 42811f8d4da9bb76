"""Draw the figures of the README.

    python docs/figures/draw.py Model_Vi_Do.dat

Model_Vi_Do.dat is the piezo record of Aye and Ang (2018), to be had from
https://github.com/yan9a/DiscreteBacklashOperator in MatLabCode/DiscreteBacklashModel.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from hyst.cli import main

HERE = Path(__file__).resolve().parent


def draw(record: str) -> None:
    """Run the two commands the README shows, and keep a figure of each."""
    with tempfile.TemporaryDirectory() as folder:
        out, demo = Path(folder, "out"), Path(folder, "demo")
        columns = ["--input", "0", "--output", "4", "--rate", "200"]
        labels = ["--input-label", "drive [V]", "--output-label", "displacement [um]"]
        if main(["identify", record, *columns, *labels, "--family", "mpi", "-o", str(out)]):
            sys.exit("the record could not be identified")
        if main(["demo", "-o", str(demo)]):
            sys.exit("the demo failed")
        shutil.copy(out / "loop.png", HERE / "piezo-loop.png")
        shutil.copy(demo / "tracking.png", HERE / "demo-tracking.png")


if __name__ == "__main__":
    draw(sys.argv[1])
