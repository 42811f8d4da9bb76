"""Scheduled models and their inverses as C: a second input, equal bits, a bit of the fault."""

from __future__ import annotations

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
)

import hyst
from hyst.export import c_project, fmu, mex
from reference import moving_plays

OFF_SCHEDULE, NOT_FINITE = 8, 1


def scheduled(moving_radii: float = 0.4, map_weight: float = -0.4) -> hyst.Scheduled:
    models = []
    for t in (20.0, 35.0, 50.0):
        of = moving_plays.actuator(t, moving_radii=moving_radii, map_weight=map_weight)
        plays = hyst.PrandtlIshlinskii(of.p, of.r, p0=of.p0)
        output_map = hyst.DeadZone([1.0, of.w], [0.0, of.rho])
        models.append(hyst.Affine(of.gain, of.offset) @ output_map @ plays)
    return hyst.Scheduled(models, [20.0, 35.0, 50.0], "temperature", "degC")


def signals(samples: int = 20_000) -> tuple[np.ndarray, np.ndarray]:
    k = np.arange(samples)
    return np.sin(0.013 * k) * np.sin(0.0007 * k), 35.0 + 20.0 * np.sin(0.0003 * k)


@pytest.mark.parametrize("which", ["model", "inverse"])
@pytest.mark.parametrize(("driver", "language"), [("gcc", AS_C), ("clang++", AS_CXX)])
def test_a_second_input_gives_the_bits_of_python(
    which: str, driver: str, language: list[str], tmp_path: Path, objects: Objects
) -> None:
    model = scheduled() if which == "model" else scheduled().inverse()
    project = c_project(model, tmp_path / "out")
    library = build_library(project.path, objects, driver, language)
    code = Exported(library, project.state_length, project.saved_bytes, inputs=2)
    u, t = signals()
    run = model.run(u, t)
    assert run.held > 1000
    state = code.initial_state()
    # Up to where the second signal leaves the schedule nothing is raised.
    inside = int(model.outside(t).argmax())
    first = code.run(state, u[:inside], t[:inside])
    assert code.fault(state) == 0
    other = code.unset_state()
    assert code.load(other, code.save(state)) == 0
    rest = code.run(other, u[inside:], t[inside:])
    assert same_bits(np.concatenate([first, rest]), run.y)
    assert same_bits(code.memory(other), run.state)
    assert code.fault(other) == OFF_SCHEDULE
    kept = code.step(other, np.nan, 20.0)
    assert kept == code.step(other, 0.3, np.nan) == run.y[-1]
    assert code.fault(other) == OFF_SCHEDULE | NOT_FINITE
    assert same_bits(code.memory(other), run.state)


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("which", ["model", "inverse"])
def test_the_self_test_passes_and_can_fail(
    which: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    model = scheduled() if which == "model" else scheduled().inverse()
    project = c_project(model, tmp_path / "out", precision=precision)
    check_syntax(project.path, "gcc", AS_C)
    passed = run_selftest(project.path, objects)
    assert (passed.returncode, "max difference 0\n" in passed.stdout) == (0, True), passed.stdout
    # Some ten roundings of 6e-8 on the way, of numbers up to 2.
    assert project.away_from_double <= (0.0 if precision == "double" else 3e-6)
    source = project.path / "stage.c"
    text = source.read_text()
    assert "if (!stage_core_is_finite(s))" in text
    source.write_text(text.replace("schedule, s, now", "schedule, s + 0.5f, now"))
    failed = run_selftest(project.path, objects)
    assert failed.returncode == 1
    assert "the same numbers as in Python" in failed.stdout


def test_files_say_what_the_second_input_is(tmp_path: Path) -> None:
    project = c_project(scheduled(), tmp_path / "out")
    header = (project.path / "stage.h").read_text()
    assert "double stage_step(stage_state *state, double u, double s);" in header
    assert "STAGE_OFF_SCHEDULE 8u" in header
    assert "temperature in degC" in header
    assert "STAGE_OFF_SCHEDULE" in (project.path / "README.md").read_text()


def test_a_model_in_which_nothing_moves_is_exported_too(tmp_path: Path, objects: Objects) -> None:
    same = hyst.Scheduled([hyst.Affine(2.0) @ hyst.Play(0.1)] * 2, [0.0, 1.0])
    project = c_project(same, tmp_path / "out")
    assert run_selftest(project.path, objects).returncode == 0


def test_what_a_target_cannot_take_is_refused(tmp_path: Path) -> None:
    with pytest.raises(hyst.InputError, match="no FMU yet"):
        fmu(scheduled(), tmp_path / "stage.fmu")
    close = hyst.Scheduled(scheduled().models[:2], [1.0, 1.0 + 1e-9])
    with pytest.raises(hyst.InputError, match="one number in single precision"):
        c_project(close, tmp_path / "out", precision="single")
    dahl = hyst.Scheduled([hyst.Dahl(5.0, f, 1.0) for f in (1.0, 2.0)], [0.0, 1.0])
    with pytest.raises(hyst.InputError, match="its memory does not tell"):
        c_project(dahl, tmp_path / "out")
    with pytest.raises(hyst.InputError, match="no inverse with a preview"):
        hyst.export.inverse_of(scheduled(), preview=5)
    with pytest.raises(hyst.InputError, match="has no inverse"):
        hyst.export.inverse_of(scheduled(), explicit=True)
    folder = mex(scheduled(), tmp_path / "mex")
    assert folder.inputs == ("u", "s")
