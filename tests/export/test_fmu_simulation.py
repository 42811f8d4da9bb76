"""An FMU gives the numbers of Python, bit for bit, in FMPy."""

from __future__ import annotations

from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from fmu_runs import (
    CONTROLLER,
    ERROR,
    INVERSE_MPI,
    LIMITED_CONTROLLER,
    MPI,
    SHAPES,
    VERSIONS,
    WARNING,
    FmuRun,
    estimated,
    estimation,
    has_compiler,
    rough_signal,
)

import hyst
from hyst import Operator
from reference.examples import LAG, PI

pytestmark = has_compiler
N = 300
STRICT = "cc -Wall -Wextra -Wconversion -Wpedantic -Werror"


def stepped(operator: Operator, u: np.ndarray) -> np.ndarray:
    step = operator.stepper()
    return np.array([step(value) for value in u.tolist()])


@pytest.mark.parametrize("name", SHAPES)
def test_every_kind_of_model(name: str, tmp_path: Path) -> None:
    operator = SHAPES[name]
    written = hyst.export.fmu(operator, tmp_path / "model.fmu", compiler=STRICT)
    run = FmuRun(written, tmp_path).initialize()
    u = rough_signal(N, size=2.0)
    u[N // 2] = np.nan  # held, here as in Python
    y = run.run(u, operator.dt or 0.01)
    assert y.tobytes() == stepped(operator, u).tobytes()
    assert run.get("fault") == 1
    run.free()


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("operator", [INVERSE_MPI, LAG @ PI], ids=["inverse", "sampled"])
def test_a_simulation_by_fmpy(operator: Operator, version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(operator, tmp_path / "model.fmu", version=version)
    dt = operator.dt or 0.001
    u = rough_signal(2000)
    t = np.arange(u.size) * dt
    drive = np.array(list(zip(t, u, strict=True)), dtype=[("time", "f8"), ("u", "f8")])
    result = fmpy.simulate_fmu(
        str(written.path), validate=True, stop_time=t[-1], step_size=dt, output_interval=dt,
        input=drive, output=["u", "y"],
    )  # fmt: skip
    # FMPy interpolates the input at its own times and notes it after the step that used it.
    used = np.asarray(result["u"][1:])
    np.testing.assert_allclose(used, u[: used.size], rtol=1e-9, atol=1e-9)
    assert result["y"][1:].tobytes() == stepped(operator, used).tobytes()
    assert result["y"][0] == operator.stepper()(result["u"][0])


@pytest.mark.parametrize("version", VERSIONS)
def test_instances_side_by_side(version: str, tmp_path: Path) -> None:
    first = hyst.export.fmu(INVERSE_MPI, tmp_path / "a.fmu", version=version)
    second = hyst.export.fmu(LAG @ PI, tmp_path / "b.fmu", version=version)
    runs = [FmuRun(first, tmp_path, "a1"), FmuRun(second, tmp_path, "b"), FmuRun(first, tmp_path)]
    models = [INVERSE_MPI, LAG @ PI, INVERSE_MPI]
    signals = [rough_signal(N, seed) for seed in range(3)]
    outputs = np.empty((3, N))
    for run in runs:
        run.initialize()
    for k in range(N):
        for i, run in enumerate(runs):
            run.set(u=signals[i][k])
            run.step(k * 0.01, 0.01)
            outputs[i, k] = run.get("y")
    for model, u, y in zip(models, signals, outputs, strict=True):
        assert y.tobytes() == stepped(model, u).tobytes()
    for run in runs:
        run.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_state_that_was_kept(version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(INVERSE_MPI, tmp_path / "model.fmu", version=version)
    u = rough_signal(2 * N)
    expected = stepped(INVERSE_MPI, u)
    run = FmuRun(written, tmp_path).initialize()
    run.run(u[:N], 0.1)
    state = run.fmu.getFMUState()
    assert run.run(u[N:], 0.1, N).tobytes() == expected[N:].tobytes()
    run.fmu.setFMUState(state)
    assert run.get("y") == expected[N - 1]
    assert run.run(u[N:], 0.1, N).tobytes() == expected[N:].tobytes()
    # In another instance, as after a restart of the computer.
    serialize = run.fmu.serializeFMUState
    saved = serialize(state)
    run.fmu.freeFMUState(state)
    other = FmuRun(written, tmp_path, "other")
    read = getattr(other.fmu, "deserializeFMUState", None) or other.fmu.deSerializeFMUstate
    copy = read(saved)
    other.fmu.setFMUState(copy)
    assert other.run(u[N:], 0.1, N).tobytes() == expected[N:].tobytes()
    assert serialize(copy) == saved
    other.fmu.freeFMUState(copy)
    other.free()
    run.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_reset_starts_anew(version: str, tmp_path: Path) -> None:
    run = FmuRun(hyst.export.fmu(INVERSE_MPI, tmp_path / "model.fmu", version=version), tmp_path)
    u = rough_signal(N)
    first = run.initialize(u=2.0).run(u, 0.1)
    run.set_all({next(name for name in run.variables if name.endswith("weight[1]")): 7.0})
    run.fmu.reset()
    assert run.get("u") == 0.0
    assert run.initialize().run(u, 0.1).tobytes() == first.tobytes()
    run.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_initialization_looks_without_moving(version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(PI, tmp_path / "model.fmu", version=version)
    run = FmuRun(written, tmp_path)
    if run.is_2:
        run.fmu.setupExperiment()
    run.fmu.enterInitializationMode()
    for u in (5.0, -8.0, 1.0):
        run.set(u=u)
        assert run.get("y") == PI.stepper()(u)  # from rest, whatever was looked at before
    run.fmu.exitInitializationMode()
    assert run.get("y") == PI.stepper()(1.0)
    u = rough_signal(50)
    assert run.run(u, 1.0).tobytes() == stepped(PI, u).tobytes()
    run.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_controller_with_two_inputs(version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(CONTROLLER, tmp_path / "model.fmu", version=version)
    assert (written.inputs, written.output) == (("y_ref", "y"), "u")
    run = FmuRun(written, tmp_path).initialize()
    y_ref, y = rough_signal(N, 1), rough_signal(N, 2)
    u = np.empty(N)
    for k in range(N):
        run.set(y_ref=y_ref[k], y=y[k])
        run.step(k * 1e-3, 1e-3)
        u[k] = run.get("u")
    assert u.tobytes() == CONTROLLER.run(y_ref, y)[0].tobytes()
    # The drive answers y_ref at once, but y only in the next sample: D is [0.7, 0].
    assert [each.name for each in run.description.outputs[0].dependencies] == ["y_ref"]
    run.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_controller_with_limits(version: str, tmp_path: Path) -> None:
    written = hyst.export.fmu(
        LIMITED_CONTROLLER, tmp_path / "model.fmu", version=version, compiler=STRICT
    )
    run = FmuRun(written, tmp_path).initialize()
    y_ref, y = rough_signal(N, 1), rough_signal(N, 2)
    y_ref[:9], y[:9] = 0.0, 0.0
    u, faults = np.empty(N), np.empty(N, int)
    for k in range(N):
        run.set(y_ref=y_ref[k], y=y[k])
        run.step(k * 1e-3, 1e-3)
        u[k], faults[k] = run.get("u"), run.get("fault")
    assert u.tobytes() == LIMITED_CONTROLLER.run(y_ref, y)[0].tobytes()
    # To meet limits is no warning: the variable tells it, from the first such sample on.
    assert run.log == []
    step = LIMITED_CONTROLLER.stepper()
    expected = []
    for sample in zip(y_ref, y, strict=True):
        step(*sample)
        expected.append(16 * step.limited)
    assert faults.tolist() == expected
    assert 0 in expected
    run.set(y_ref=np.nan)
    run.step(N * 1e-3, 1e-3)
    assert [status for status, _ in run.log] == [WARNING]
    assert "not finite" in run.log[0][1]
    assert run.get("fault") == 17
    assert run.get("u") == u[-1]
    run.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_an_inverse_before_its_model(version: str, tmp_path: Path) -> None:
    """Two FMUs connected: what is wanted comes out."""
    inverse = FmuRun(hyst.export.fmu(INVERSE_MPI, tmp_path / "i.fmu", version=version), tmp_path)
    model = FmuRun(hyst.export.fmu(MPI, tmp_path / "m.fmu", version=version), tmp_path)
    inverse.initialize()
    model.initialize()
    y_ref = rough_signal(N)
    for k, wanted in enumerate(y_ref.tolist()):
        inverse.set(u=wanted)
        inverse.step(float(k), 1.0)
        model.set(u=inverse.get("y"))
        model.step(float(k), 1.0)
        # Some forty operations of rounding 1e-16 on numbers of size 10.
        assert abs(model.get("y") - wanted) < 1e-13
    inverse.free()
    model.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_an_estimator(version: str, tmp_path: Path) -> None:
    estimator, u, y, y_ref = estimation()
    written = hyst.export.fmu(estimator, tmp_path / "model.fmu", version=version, compiler=STRICT)
    assert (written.inputs, written.output) == (("u", "y", "y_ref"), "command")
    assert validate_fmu(str(written.path)) == []
    run = FmuRun(written, tmp_path).initialize()
    commands = np.empty(u.size)
    for k in range(u.size):
        run.set(u=u[k], y=y[k], y_ref=y_ref[k])
        run.step(k * 1e-3, 1e-3)
        commands[k] = run.get("command")
    assert commands.tobytes() == estimated(estimator, u, y, y_ref).tobytes()
    assert [run.get(name) for name in estimator.names] == estimator.parameters.tolist()
    assert run.get("fault") == 1
    with run.refusal(ERROR):
        run.set(p0=1.0)
    run.free()
