"""Use an installed hyst once, from a record to C: python smoke.py RECORD.

Run by `make wheel` and by the workflow that builds wheels, where pytest is not installed.
"""

from __future__ import annotations

import sys
import sysconfig
import tempfile
from pathlib import Path

import numpy as np

import hyst
from hyst import _engine, export


def main(path: str) -> None:
    installed = [Path(sysconfig.get_path(name)) for name in ("platlib", "purelib")]
    assert any(Path(hyst.__file__).is_relative_to(each) for each in installed), hyst.__file__

    record = hyst.read_record(path, input="drive", output="position", time="time")
    found = hyst.identify(record, family="pi", plays=4)
    assert found.verdict.level != "unfit", found.verdict

    inverse = found.model.inverse()
    y = np.linspace(20.0, 30.0, 200)
    assert np.allclose(found.model(inverse(y)), y, rtol=0.0, atol=1e-9)

    step = found.model.stepper()
    assert [step(float(u)) for u in record.u[:100]] == list(found.model(record.u[:100]))

    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "lens"
        export.c_project(inverse, target, name="lens")
        names = sorted(each.name for each in target.rglob("*") if each.is_file())
        assert "lens.c" in names, names
        assert "lens.h" in names, names

    error = found.metrics["training"].rms
    engine = Path(_engine.__file__).name
    print(f"hyst {hyst.__version__}, {engine}: rms {error:.4g}, {len(names)} files of C")


if __name__ == "__main__":
    main(sys.argv[1])
