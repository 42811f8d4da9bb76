"""Scale estimators as C: estimate and commands, sample for sample those of Python."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from c_builds import AS_C, AS_CXX, Objects, check_syntax, run_selftest

import hyst
from hyst.export import c_project
from hyst.online import ScaleEstimator
from reference.examples import EXAMPLES

# A chain, an iteration, a table, a stage with a sample time, several with one, one without memory.
MODELS = (
    "bouc-wen",
    "composition with names inside",
    "preisach",
    "jiles-atherton",
    "creep of hysteresis",
    "affine",
    "ramberg-osgood",
)


def after_some_samples(name: str) -> ScaleEstimator:
    model = EXAMPLES[name]
    dt = model.dt or 1.0
    estimator = ScaleEstimator(model, memory=300.0 * dt, dt=dt)
    u = 3.0 * np.sin(np.arange(700) / 20.0)
    estimator.run(hyst.Record(u, 1.2 * model(u) + 0.1, dt))
    return estimator


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", MODELS)
def test_self_tests_find_no_difference(
    name: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    project = c_project(after_some_samples(name), tmp_path / "out", precision=precision)
    ended = run_selftest(project.path, objects)
    assert ended.stdout == "10000 samples, max difference 0\n"
    check_syntax(project.path, "clang", AS_C)
    check_syntax(project.path, "g++", AS_CXX)


def test_what_is_held_stays_in_c(tmp_path: Path, objects: Objects) -> None:
    estimator = ScaleEstimator(EXAMPLES["bouc-wen"], held=["scale"])
    project = c_project(estimator, tmp_path / "out")
    assert run_selftest(project.path, objects).stdout == "10000 samples, max difference 0\n"
    assert ", 1, 0};" in (project.path / "stage.c").read_text()


def test_what_has_no_inverse_is_refused(tmp_path: Path) -> None:
    estimator = ScaleEstimator(EXAMPLES["rate-dependent"])
    with pytest.raises(hyst.InputError, match="no command to export"):
        c_project(estimator, tmp_path / "out")
    assert not (tmp_path / "out").exists()
