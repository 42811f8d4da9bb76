"""What is identified says how good it is and where it comes from."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import hyst
from hyst.operators import data_hash

TRUE = hyst.PrandtlIshlinskii(p=[0.5, 0.3], r=[0.1, 0.3], p0=1.0)


def simulated(seed: int) -> hyst.Record:
    u = np.sin(np.linspace(0.0, 20.0, 600)) * np.linspace(1.0, 0.5, 600)
    y = TRUE(u) + 0.01 * np.random.default_rng(seed).standard_normal(u.size)
    return hyst.Record(u, y, dt=1e-3)


def test_the_model_says_its_errors_and_its_origin(tmp_path: Path) -> None:
    record, judge = simulated(1), simulated(2)
    found = hyst.identify(record, family="pi", plays=2, validation=judge)
    about = found.model.description
    assert about == found.description
    assert about.errors.keys() == found.metrics.keys()
    error = found.predict(judge.u) - judge.y
    used = error[found.used[0].start :]
    # By hand, over the samples that are judged: the whole record once the memory is known.
    assert abs(about.errors["validation"]["max_abs"] - np.abs(used).max()) < 1e-12
    assert abs(about.errors["validation"]["rms"] - np.sqrt(np.mean(used**2))) < 1e-12
    assert about.provenance is not None
    assert about.provenance.data_sha256 == data_hash([record])
    assert about.provenance.options == {"family": "pi", "plays": 2}
    found.model.save(tmp_path / "model.json")
    assert hyst.load(tmp_path / "model.json").description == about


def content(path: Path) -> dict[str, Any]:
    read: dict[str, Any] = json.loads(path.read_text())
    return read


def test_two_identical_runs_differ_in_the_date_only(tmp_path: Path) -> None:
    record = simulated(1)
    for name in ("a", "b"):
        hyst.identify(record, family="pi", plays=2).model.save(tmp_path / name)
    a, b = content(tmp_path / "a"), content(tmp_path / "b")
    for each in (a, b):
        assert each["description"]["provenance"].pop("date")
    assert a == b


def test_every_family_says_it() -> None:
    plays = simulated(1)
    curved = replace(plays, y=hyst.RambergOsgood(1.0, 0.2, 2.0)(plays.u))
    dynamics: dict[str, Any] = {"hysteresis": "linear", "fir_order": 3, "state_order": 1}
    for record, options in (
        (plays, {"family": "rdpi", "plays": 2}),
        (plays, {"family": "hammerstein", **dynamics}),
        (curved, {"family": "ramberg-osgood", "memory": "last-reversal"}),
    ):
        about = hyst.identify(record, **options).model.description
        assert about.provenance is not None
        assert about.provenance.options == options
        assert about.errors["training"]["rms"] > 0.0
