"""Draw the figure of docs/compare.md, and print what the page quotes.

    PYTHONPATH=. python docs/figures/draw_compare.py

The material is simulated (``benchmarks.plants``), of none of the families but one: a smooth density
of relays. The models are identified from loops of shrinking amplitude and compared on nested ones.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from benchmarks.plants import nested_loops, plants, shrinking_loops

from hyst.cli import main
from hyst.io import write_columns

HERE = Path(__file__).resolve().parent
FAMILIES = sys.argv[1:] or ["linear", "pi", "gpi", "mpi", "preisach"]
COLUMNS = ["--input", "field", "--output", "flux", "--rate", "100"]


def draw() -> None:
    """Run the commands of the page, and keep a figure."""
    material = next(each for each in plants() if each.name == "Preisach, smooth")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, u, seed in (("training", shrinking_loops(), 1), ("fresh", nested_loops(), 2)):
            y = material.output(u)
            y = y + 0.003 * np.ptp(y) * np.random.default_rng(seed).standard_normal(y.size)
            write_columns(folder / f"{file}.csv", ["field [A/m]", "flux [T]"], [u, y])
        for family in FAMILIES:
            training = str(folder / "training.csv")
            out = str(folder / family)
            main(["identify", training, *COLUMNS, "--family", family, "-o", out])
        files = [str(folder / each / "model.json") for each in FAMILIES]
        out = folder / "out"
        main(["compare", *files, str(folder / "fresh.csv"), *COLUMNS, "-o", str(out)])
        shutil.copy(out / "loops.png", HERE / "compare-loops.png")


if __name__ == "__main__":
    draw()
