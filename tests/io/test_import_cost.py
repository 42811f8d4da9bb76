from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HEAVY = ("scipy", "pandas", "h5py", "pyarrow", "pymatreader", "matplotlib", "nptdms", "openpyxl")


def loaded_by(statement: str) -> str:
    program = f"import sys; {statement}; print([name for name in {HEAVY!r} if name in sys.modules])"
    # The same hyst as here, whether installed or found on this process's path.
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    return done.stdout.strip()


def test_reading_text_loads_no_optional_package(tmp_path: Path) -> None:
    path = tmp_path / "loop.csv"
    path.write_text("0;0\n1;2\n0;1\n1;2\n")
    statement = f"from hyst.io import read_record; read_record({str(path)!r}, 0, 1, rate=1.0)"
    # hyst itself may load scipy for other parts; reading must add none of these to it.
    assert loaded_by(statement) == loaded_by("import hyst")


def test_importing_hyst_io_loads_no_file_format() -> None:
    for package in ("pandas", "h5py", "pyarrow", "pymatreader", "nptdms", "openpyxl"):
        assert package not in loaded_by("import hyst.io")
