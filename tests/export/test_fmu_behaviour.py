"""What an FMU answers to calls that are wrong, to numbers that are none, and to new parameters."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Iterator
from types import SimpleNamespace

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2LastSuccessfulTime, fmi2Terminated
from fmu_runs import ERROR, VERSIONS, WARNING, FmuRun, has_compiler, rough_signal

import hyst
from hyst import PrandtlIshlinskii, RateDependentPrandtlIshlinskii
from reference.examples import LAG, PI, RATE_DEPENDENT

pytestmark = has_compiler
SAMPLED = LAG @ PI  # dt = 0.01 s


@pytest.fixture(scope="module", params=VERSIONS)
def written(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, hyst.export.Fmu]:
    folder = tmp_path_factory.mktemp("fmus")
    models = {"pi": PI, "sampled": SAMPLED, "rate": RATE_DEPENDENT}
    return {
        name: hyst.export.fmu(model, folder / f"{name}.fmu", version=request.param)
        for name, model in models.items()
    }


@pytest.fixture
def start(written: dict[str, hyst.export.Fmu]) -> Iterator[object]:
    runs: list[FmuRun] = []

    def starting(name: str) -> FmuRun:
        runs.append(FmuRun(written[name], written[name].path.parent))
        return runs[-1]

    yield starting
    for run in runs:
        run.free()


def test_a_step_that_is_no_multiple_of_the_sample_time(start) -> None:
    run = start("sampled").initialize()
    before = run.run(np.array([3.0, -2.0]), 0.01)
    for size in (0.015, 0.004, 0.0100001, 1e300):
        with run.refusal(ERROR) as said:
            run.step(0.02, size)
        assert f"{size:.9g} s" in said[0]
        assert "0.01 s" in said[0]
        assert "whole multiple" in said[0]
    assert run.get("y") == before[-1]
    # Nothing has moved: the run goes on as if the steps had not been asked for.
    step = SAMPLED.stepper()
    expected = [step(u) for u in (3.0, -2.0, 1.0)][-1]
    assert run.run(np.array([1.0]), 0.01, 2)[0] == expected


def test_a_multiple_of_the_sample_time_is_so_many_samples(start) -> None:
    run = start("sampled").initialize()
    run.set(u=3.0)
    run.step(0.0, 0.05)
    step = SAMPLED.stepper()
    assert run.get("y") == [step(3.0) for _ in range(5)][-1]


def test_steps_that_rounding_has_touched_are_taken(start) -> None:
    run = start("sampled").initialize(time=1e9)
    times = 1e9 + 0.01 * np.arange(200)
    for t, size in zip(times, np.diff(times), strict=False):
        run.step(float(t), float(size))  # some differ from 0.01 in the fifth digit
    assert run.log == []


def test_a_clock_too_coarse_for_the_sample_time(start) -> None:
    run = start("sampled").initialize(time=1e15)
    with run.refusal(ERROR) as said:
        run.step(1e15, 0.125)
    assert "0.125 s" in said[0]


def test_any_step_will_do_without_a_sample_time(start) -> None:
    run = start("pi").initialize()
    u = rough_signal(20)
    sizes = np.random.default_rng(1).uniform(1e-6, 3.0, u.size)
    time = 0.0
    step = PI.stepper()
    for value, size in zip(u.tolist(), sizes.tolist(), strict=True):
        run.set(u=value)
        run.step(time, size)
        time += size
        assert run.get("y") == step(value)


@pytest.mark.parametrize("size", [0.0, -0.01, math.nan, math.inf])
@pytest.mark.parametrize("name", ["pi", "sampled"])
def test_a_step_without_length(start, name: str, size: float) -> None:
    run = start(name).initialize()
    with run.refusal(ERROR) as said:
        run.step(0.0, size)
    assert "longer than 0" in said[0]


def test_what_fmi_2_asks_after_a_refused_step(start) -> None:
    run = start("sampled").initialize()
    if not run.is_2:
        return  # FMI 3.0 has no such question: it gives the time with every step
    run.run(np.array([3.0, -2.0]), 0.01)
    with run.refusal(ERROR):
        run.step(0.02, 0.005)
    time, ended = ctypes.c_double(), ctypes.c_int(1)
    run.fmu.fmi2GetRealStatus(run.fmu.component, fmi2LastSuccessfulTime, ctypes.byref(time))
    run.fmu.fmi2GetBooleanStatus(run.fmu.component, fmi2Terminated, ctypes.byref(ended))
    assert (time.value, ended.value) == (0.02, 0)


def test_a_step_before_and_after_the_simulation(start) -> None:
    run = start("pi")
    with run.refusal(ERROR) as said:
        run.step(0.0, 0.1)
    assert "initialization" in said[0]
    run.initialize()
    run.fmu.terminate()
    with run.refusal(ERROR):
        run.step(0.0, 0.1)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_an_input_that_is_not_finite(start, bad: float) -> None:
    run = start("pi").initialize()
    u = rough_signal(30)
    y = run.run(u[:10], 1.0)
    held = run.run(np.full(3, bad), 1.0, 10)
    assert held.tolist() == [y[-1]] * 3
    assert run.get("fault") == 1
    rest = run.run(u[10:], 1.0, 13)
    assert run.get("fault") == 1  # sticky
    assert [status for status, _ in run.log] == [WARNING]  # logged once
    assert "not finite" in run.log[0][1]
    step = PI.stepper()
    assert np.concatenate([y, rest]).tolist() == [step(value) for value in u.tolist()]
    run.fmu.reset()
    assert run.get("fault") == 0


def test_a_weight_may_change_at_any_time(start) -> None:
    run = start("pi").initialize()
    u = rough_signal(60)
    first = run.run(u[:30], 1.0)
    run.set_all({"p0": 2.0, "p[2]": -0.5})
    second = run.run(u[30:], 1.0, 30)
    changed = PrandtlIshlinskii([0.5, -0.5, 0.7], PI.r, p0=2.0)
    y, memory = PI.run(u[:30])
    assert first.tobytes() == y.tobytes()
    assert second.tobytes() == changed.run(u[30:], memory)[0].tobytes()


def test_a_threshold_may_change_until_initialization_ends(start) -> None:
    run = start("pi")
    run.set_all({"r[2]": 2.25})
    run.initialize()
    u = rough_signal(40)
    changed = PrandtlIshlinskii(PI.p, [0.5, 2.25, 4.0], p0=PI.p0)
    assert run.run(u, 1.0).tobytes() == changed(u).tobytes()
    with run.refusal(ERROR) as said:
        run.set_all({"r[2]": 1.0})
    assert "fixed parameter" in said[0]
    assert run.get("r[2]") == 2.25


def test_instances_have_parameters_of_their_own(start) -> None:
    one, other = start("pi").initialize(), start("pi").initialize()
    one.set(p0=9.0)
    assert (one.get("p0"), other.get("p0")) == (9.0, PI.p0)
    u = rough_signal(40)
    assert other.run(u, 1.0).tobytes() == PI(u).tobytes()


@pytest.mark.parametrize(
    ("name", "value", "word"),
    [("p0", math.nan, "finite"), ("r[1]", math.inf, "finite"), ("r[1]", -1.0, "negative")],
)
def test_a_parameter_that_cannot_be(start, name: str, value: float, word: str) -> None:
    run = start("pi")
    before = run.get(name)
    with run.refusal(ERROR) as said:
        run.set_all({name: value})
    assert word in said[0]
    assert run.get(name) == before


def test_output_fault_and_strangers_cannot_be_set(start) -> None:
    run = start("pi").initialize()
    before = run.run(rough_signal(10), 1.0)
    with run.refusal(ERROR) as said:
        run.set(y=1.0)
    assert "only inputs and parameters can be set" in said[0]
    run.variables["stranger"] = SimpleNamespace(valueReference=1000)
    with run.refusal(ERROR) as said:
        run.set(stranger=1.0)
    assert "only inputs and parameters can be set" in said[0]
    with run.refusal(ERROR) as said:
        run.get("stranger")
    assert "no real variable of this value reference" in said[0]
    assert run.get("y") == before[-1]


def test_growth_of_rate_dependent_thresholds_is_fixed(start) -> None:
    run = start("rate")
    run.set(growth=0.7)
    run.initialize()
    u = rough_signal(40)
    dt = 0.1
    changed = RateDependentPrandtlIshlinskii(
        RATE_DEPENDENT.p, RATE_DEPENDENT.r, beta=0.7 * dt, dt=dt, p0=RATE_DEPENDENT.p0
    )
    # growth is beta / dt, and 0.7 dt / dt rounds back to 0.7 or a neighbour: a relative 1e-15.
    np.testing.assert_allclose(run.run(u, dt), changed(u), rtol=1e-13)
    with run.refusal(ERROR):
        run.set(growth=0.1)


@pytest.mark.parametrize("place", [0, 45, -1])
def test_damaged_states_are_refused(start, place: int) -> None:
    run = start("pi").initialize()
    run.run(rough_signal(10), 1.0)
    state = run.fmu.getFMUState()
    saved = bytearray(run.fmu.serializeFMUState(state))
    saved[place] ^= 4
    read = getattr(run.fmu, "deserializeFMUState", None) or run.fmu.deSerializeFMUstate
    with run.refusal(ERROR) as said:
        read(bytes(saved))
    assert "damaged" in said[0]
    with run.refusal(ERROR):
        read(bytes(saved[:20]))
    run.fmu.freeFMUState(state)


def test_states_of_another_model_are_refused(start) -> None:
    one, other = start("pi").initialize(), start("sampled").initialize()
    before = other.run(np.array([3.0, -2.0]), 0.01)
    state = one.fmu.getFMUState()
    read = getattr(other.fmu, "deserializeFMUState", None) or other.fmu.deSerializeFMUstate
    with other.refusal(ERROR) as said:
        read(one.fmu.serializeFMUState(state))
    assert "not those of a state of this FMU" in said[0]
    assert other.get("y") == before[-1]
    one.fmu.freeFMUState(state)


def test_a_token_of_another_fmu_is_refused(written) -> None:
    other = written["sampled"].token
    with pytest.raises(Exception, match="instantiate"):
        FmuRun(written["pi"], written["pi"].path.parent, token=other)


def test_an_importer_with_a_wrong_step_is_stopped(written) -> None:
    path, steps = str(written["sampled"].path), {"step_size": 0.004, "output_interval": 0.004}
    with pytest.raises(FMICallException):  # FMPy would repeat a discarded step for ever
        fmpy.simulate_fmu(path, stop_time=0.1, logger=lambda *told: None, **steps)
