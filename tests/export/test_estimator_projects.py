"""Joint estimators as C: the estimate and its commands, sample for sample those of Python."""

from __future__ import annotations

import ctypes
from pathlib import Path

import numpy as np
import pytest
from c_builds import (
    AS_C,
    AS_CXX,
    Exported,
    Objects,
    build_library,
    check_syntax,
    run_selftest,
    same_bits,
    wandering,
)

import hyst
from hyst import Affine, DeadZone, InputError, PrandtlIshlinskii, Record
from hyst.export import c_project
from hyst.online import AdaptiveInverse, JointEstimator, RadiusEstimator

PI = PrandtlIshlinskii([0.5, 0.25, 0.7], [0.5, 1.5, 4.0], 0.3)
MAP = DeadZone.odd([0.65, 0.2, 0.3], [0.0, 2.0, 5.0])
LOPSIDED = DeadZone([0.8, 0.3, 0.2, 0.1], [0.0, 1.0, 3.0, -2.0])
SAMPLES = 5000


def after_some_samples() -> JointEstimator:
    estimator = JointEstimator(PI, memory=500.0)
    u = 5.0 * np.sin(np.arange(700) / 20.0)
    estimator.run(Record(u, 1.2 * PI(u), 1.0))
    return estimator


def estimators() -> dict[str, JointEstimator]:
    return {
        "plays": JointEstimator(PI),
        "between gains": JointEstimator(
            Affine(-2.0, 1.0) @ PI @ Affine(0.5, 0.2), memory=2000.0, dt=0.5
        ),
        "map before": JointEstimator(PI @ MAP, estimate_maps=True),
        "map behind": JointEstimator(LOPSIDED @ PI, estimate_maps=True, search=False),
        "held": JointEstimator(PI, held=("p0", "r[2]", "offset")),
        "after some samples": after_some_samples(),
        "one play": JointEstimator(PrandtlIshlinskii([0.5], [1.0], 1.0)),
    }


ESTIMATORS = list(estimators())


class ExportedEstimator(Exported):
    """An exported estimator in double."""

    def __init__(self, library: Path, state_length: int, saved_bytes: int) -> None:
        # The base class looks for a step; an estimator has an update and a command.
        self._prepare(library, state_length, saved_bytes)
        for suffix, result in (("update", ctypes.c_int), ("command", ctypes.c_double)):
            self._function(suffix).restype = result
        self._function("update").argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_double]
        self._function("command").argtypes = [ctypes.c_void_p, ctypes.c_double]

    def update(self, state: object, u: float, y: float) -> bool:
        return bool(self._function("update")(ctypes.byref(state), u, y))  # type: ignore[arg-type]

    def command(self, state: object, y_ref: float) -> float:
        return float(self._function("command")(ctypes.byref(state), y_ref))  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ESTIMATORS)
def test_estimates_and_commands_are_those_of_python(
    name: str, tmp_path: Path, objects: Objects
) -> None:
    estimator = estimators()[name]
    project = c_project(estimator, tmp_path / "out")
    u, other = wandering(SAMPLES, size=6.0), wandering(SAMPLES, seed=8, size=6.0)
    y = np.where(np.isfinite(other), 1.1 * PI(np.nan_to_num(u, posinf=0, neginf=0)), other)
    codes = [
        ExportedEstimator(
            build_library(project.path, objects, *each), project.state_length, project.saved_bytes
        )
        for each in (("gcc", AS_C), ("clang++", AS_CXX))
    ]
    states = [code.initial_state() for code in codes]
    wanted = (3.0 * np.sin(np.arange(SAMPLES) / 50.0)).tolist()
    for k, (u_k, y_k) in enumerate(zip(u.tolist(), y.tolist(), strict=True)):
        used = estimator.update(u_k, y_k)
        command = estimator.command(wanted[k])
        for code, state in zip(codes, states, strict=True):
            assert code.update(state, u_k, y_k) == used
            assert code.command(state, wanted[k]) == command
        if k == SAMPLES // 2:
            fresh = codes[0].unset_state()
            assert codes[0].load(fresh, codes[0].save(states[0])) == 0
            states[0] = fresh
    for code, state in zip(codes, states, strict=True):
        start = int((project.path / "stage.h").read_text().split("_THETA ")[1].split()[0])
        theta = code.memory(state)[start : start + estimator.parameters.size]
        assert same_bits(theta, estimator.parameters)
        assert code.fault(state) & 1


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", ESTIMATORS)
def test_self_tests_find_no_difference(
    name: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    project = c_project(estimators()[name], tmp_path / "out", precision=precision)
    assert run_selftest(project.path, objects).stdout == "10000 samples, max difference 0\n"
    check_syntax(project.path, "clang", AS_C)
    check_syntax(project.path, "g++", AS_CXX)


def test_before_init_and_for_what_is_not_finite(tmp_path: Path, objects: Objects) -> None:
    project = c_project(JointEstimator(PI), tmp_path / "out")
    library = build_library(project.path, objects)
    code = ExportedEstimator(library, project.state_length, project.saved_bytes)
    unset = code.unset_state()
    assert not code.update(unset, 1.0, 1.0)
    assert code.fault(unset) == 2
    assert code.command(unset, 1.0) == 0.0
    state = code.initial_state()
    assert code.update(state, 0.75, 0.5)
    before = bytes(state.memory)
    assert code.command(state, float("nan")) == 0.75
    assert code.command(state, float("inf")) == 0.75
    assert bytes(state.memory) == before
    assert code.fault(state) == 0
    assert not code.update(state, float("nan"), 1.0)
    assert code.fault(state) == 1
    # A sample whose update overflows: refused, and the state can still be saved.
    code.clear_fault(state)
    assert not code.update(state, 1e200, -1e300)
    assert code.fault(state) == 4
    assert code.load(code.unset_state(), code.save(state)) == 0


def test_estimators_are_exported_from_their_files(tmp_path: Path) -> None:
    estimator = after_some_samples()
    estimator.save(tmp_path / "estimator.json")
    loaded = hyst.load(tmp_path / "estimator.json")
    assert isinstance(loaded, JointEstimator)
    first = c_project(estimator, tmp_path / "a")
    second = c_project(loaded, tmp_path / "b")
    for file in first.files:
        assert (first.path / file).read_bytes() == (second.path / file).read_bytes()


def test_other_estimators_are_refused(tmp_path: Path) -> None:
    AdaptiveInverse(JointEstimator(PI), window=100.0).save(tmp_path / "inverse.json")
    with pytest.raises(InputError, match=r"AdaptiveInverse cannot be exported; .* has found"):
        c_project(hyst.load(tmp_path / "inverse.json"), tmp_path / "out")
    with pytest.raises(InputError, match="cannot be exported"):
        c_project(RadiusEstimator([0.5], [1.0], 1.0, 1.0), tmp_path / "out")  # type: ignore[arg-type]
