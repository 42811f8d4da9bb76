"""Steps per second of FMUs through FMI's C API.

One step is set, do step, get, called from a C program that loads the binary as an importer does.
The goal is 5 million for the inverse of ten plays and an output map.
"""

from __future__ import annotations

import subprocess
import tempfile
import zipfile
from pathlib import Path

import numpy as np

import hyst
from hyst.operators import Operator

DRIVER = Path(__file__).with_name("fmu_driver.c")
GOAL = 5e6

PLAYS = hyst.PrandtlIshlinskii(np.linspace(0.3, 0.05, 10), np.linspace(0.1, 2.0, 10), p0=1.0)
OUTPUT_MAP = hyst.DeadZone([1.0, 0.2, 0.1, 0.3], [0.0, 0.5, 1.5, -0.4])
LAG = hyst.LinearDynamics.from_transfer_function([0.5, 0.1], [1.0, -1.2, 0.5], dt=1e-3)
MODELS: dict[str, Operator] = {
    "inverse of 10 plays and a map": hyst.ModifiedPrandtlIshlinskii(PLAYS, OUTPUT_MAP).inverse(),
    "10 plays before dynamics": LAG @ PLAYS,
    "Ramberg-Osgood": hyst.RambergOsgood(1.0, 0.5, 1.2),
}


def main() -> None:
    """Print the table."""
    print(f"million steps a second, set, do step and get; the goal is {GOAL / 1e6:.0f}")
    print(f"  {'model':30s} {'FMI 2.0':>8s} {'FMI 3.0':>8s}")
    with tempfile.TemporaryDirectory() as folder:
        driver = Path(folder) / "driver"
        subprocess.run(["cc", "-std=c99", "-O2", DRIVER, "-o", driver, "-ldl"], check=True)
        for name, model in MODELS.items():
            rates = [steps_per_second(model, version, driver) / 1e6 for version in ("2.0", "3.0")]
            print(f"  {name:30s} {rates[0]:8.1f} {rates[1]:8.1f}")


def steps_per_second(model: Operator, version: str, driver: Path) -> float:
    """Export, unpack and time one FMU."""
    with tempfile.TemporaryDirectory() as folder:
        written = hyst.export.fmu(model, Path(folder) / "model.fmu", version=version)
        with zipfile.ZipFile(written.path) as archive:
            library = next(each for each in written.files if each.startswith("binaries/"))
            archive.extract(library, folder)
        arguments = [Path(folder) / library, version, written.token, repr(written.dt or 1e-3)]
        done = subprocess.run([driver, *arguments], capture_output=True, text=True, check=True)
    return float(done.stdout.split()[0])


if __name__ == "__main__":
    main()
