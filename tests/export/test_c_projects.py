"""Every example, written as C, compiled and compared with Python: equal bits, no exceptions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from c_builds import (
    AS_C,
    AS_CXX,
    Exported,
    Objects,
    build_library,
    run_selftest,
    same_bits,
    stepped,
    wandering,
)
from distinct_code import DISTINCT
from hypothesis import given, settings
from hypothesis import strategies as st
from limited_examples import history_of, limited_example, with_drive

from hyst import InputError, Operator, PrandtlIshlinskii
from hyst.control.tracking_controller import TrackingController
from hyst.export import CProject, c_project, fmu, mex, rust, structured_text
from hyst.export.c.block import block_of, stepper_of
from hyst.models import LinearDynamics
from hyst.models.stable_inverse import StableInverse
from reference.examples import EXAMPLES
from reference.random_operators import RANDOM, signals

SAMPLES = 100_000
# What is solved for in every sample takes seconds for 10^5 of them.
SLOW = {
    "inverse ramberg-osgood": 20_000,
    "inverse degrading bouc-wen": 20_000,
    "degrading bouc-wen that pinches": 20_000,
    "degrading bouc-wen without inverse": 20_000,
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_gives_the_bits_of_python(
    name: str, tmp_path: Path, objects: Objects
) -> None:
    """As it is by one compiler; by the other with limits and a start, where it can have them.

    The other only where the code is another one, not where it differs in numbers alone: those with
    limits are run in single precision, below.
    """
    model, drive = EXAMPLES[name], limited_example(name)
    u = wandering(SLOW.get(name, SAMPLES))
    as_it_is = c_project(model, tmp_path / "out", limits=None)
    assert compared(as_it_is, model.stepper(), u, objects, "gcc", AS_C) == 1
    if name not in DISTINCT:
        return
    if drive is None:
        assert compared(as_it_is, model.stepper(), u, objects, "clang++", AS_CXX) == 1
        return
    limited = c_project(model, tmp_path / "limited", **with_drive(name))
    start = drive.state_after(history_of(drive))
    # The drives were chosen so that it is beyond its limits now and then.
    some = u[: u.size // 5]
    found = compared(limited, drive.stepper(start), some, objects, "clang++", AS_CXX)
    assert found == 1 | 16
    code = Exported(limited.path / "libstage-clang++.so", start.size, limited.saved_bytes)
    after, answer = code.state_after(history_of(drive))
    assert answer == 0
    assert same_bits(code.memory(after), start)


def compared(
    project: CProject,
    in_python: Callable[..., float],
    u: np.ndarray,
    objects: Objects,
    driver: str,
    language: list[str],
) -> int:
    """Compare bits, with the state saved and loaded on the way, and give the fault."""
    half, start = u.size // 3, np.array(in_python.state)  # type: ignore[attr-defined]
    y = stepped(in_python, u)
    assert np.isfinite(y).all()
    library = build_library(project.path, objects, driver, language)
    code = Exported(library, project.state_length, project.saved_bytes)
    assert code.state_size == project.state_bytes
    state = code.initial_state()
    assert same_bits(code.memory(state), start)
    first = code.run(state, u[:half])
    other = code.unset_state()
    assert code.load(other, code.save(state)) == 0
    second = code.run(other, u[half:])
    assert same_bits(np.concatenate([first, second]), y)
    assert same_bits(code.memory(other), np.asarray(in_python.state))  # type: ignore[attr-defined]
    return code.fault(other)


# In double where the code is another one; its numbers are compared in full above.
@pytest.mark.parametrize(
    ("name", "precision"),
    [*((name, "double") for name in DISTINCT), *((name, "single") for name in EXAMPLES)],
)
def test_every_self_test_finds_no_difference(
    name: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    # In single with limits and a start; what an example without them runs is part of that.
    told = with_drive(name) if precision == "single" else {"limits": None}
    project = c_project(EXAMPLES[name], tmp_path / "out", precision=precision, **told)
    finished = run_selftest(project.path, objects)
    assert finished.stdout == "10000 samples, max difference 0\n"
    assert finished.returncode == 0
    # The bits are those of the core in single; this finds a constant that is wrong in both. 1e-3 of
    # the output's range leaves room for sums over 10^4 samples.
    largest = np.abs(expected_outputs(project.path)).max()
    if precision == "double":
        assert project.away_from_double == 0.0
    elif EXAMPLES[name].kind == "rate-dependent-preview":
        # Rounding decides which of two plans is taken, so no more than their size is common.
        assert project.away_from_double <= 1.5 * max(largest, 1.0)
    else:
        assert project.away_from_double <= 1e-3 * max(largest, 1.0)


def expected_outputs(project: Path) -> np.ndarray:
    """The table of the self-test, read back."""
    text = (project / "stage_selftest_vectors.h").read_text()
    numbers = text[text.index("= {") + 3 :].rstrip("};\n").split(",")
    return np.array([float.fromhex(each.strip().rstrip("f")) for each in numbers])


@settings(max_examples=2)
@pytest.mark.parametrize("kind", RANDOM)
@given(data=st.data())
def test_operators_at_random_give_the_bits_of_python(
    data: st.DataObject, kind: str, objects: Objects, tmp_path_factory: pytest.TempPathFactory
) -> None:
    model, u = data.draw(RANDOM[kind]), data.draw(signals(most=64))
    project = c_project(model, tmp_path_factory.mktemp("random") / "out")
    library = build_library(project.path, objects)
    code = Exported(library, project.state_length, project.saved_bytes)
    record = np.concatenate([u, [np.nan], u[::-1]])
    assert same_bits(code.run(code.initial_state(), record), stepped(model.stepper(), record))


CONTROLLERS = {
    "pi and inverse": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=EXAMPLES["inverse of mpi"]
    ),
    "observer": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]),
        dt=1e-3,
        observer=([[-2.0]], [[0.5, -1.0]], [[1.0]], [[0.0, 0.25]]),
        inverse=PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0).inverse(),
    ),
    "gain": TrackingController([], [], [], [2.0, -1.0], dt=1e-3),
    "with memory": TrackingController(
        [[0.5, 0.1], [0.0, 0.9]], [[1.0, 0.5], [0.0, -1.0]], [1.0, 2.0], [0.5, -0.25], 0.1,
        inverse=EXAMPLES["inverse ramberg-osgood"], x0=[0.5, -0.25],
    ),
}  # fmt: skip
LIMITED = {
    "limited": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]),
        dt=1e-3,
        observer=([[-2.0]], [[0.5, -1.0]], [[1.0]], [[0.0, 0.25]]),
        inverse=PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0).inverse(),
        limits=(-1.7, 1.1),
    ),
    "limited, of several stages": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=EXAMPLES["inverse of mpi"],
        limits=(0.3, 2.3), rate=700.0,
    ),
    "limited, solved for": TrackingController(
        [[0.5, 0.1], [0.0, 0.9]], [[1.0, 0.5], [0.0, -1.0]], [1.0, 2.0], [0.5, -0.25], 0.1,
        inverse=EXAMPLES["inverse ramberg-osgood"], limits=(-0.1, 0.7), W=[0.25, -0.5],
    ),
    "limited gain": TrackingController([], [], [], [2.0, -1.0], dt=1e-3, limits=(-0.3, 0.7)),
    "limited rate": TrackingController(
        [[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], dt=1e-3, rate=30.0, W=[0.5]
    ),
    "limited, from a drive of its own": TrackingController(
        [[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], dt=1e-3, rate=30.0, W=[0.5], u0=7.1,
        limits=(-1.0, 7.3),
    ),
}  # fmt: skip
CONTROLLERS |= LIMITED


@pytest.mark.parametrize("name", CONTROLLERS)
def test_controllers_give_the_bits_of_python(name: str, tmp_path: Path, objects: Objects) -> None:
    model = CONTROLLERS[name]
    project = c_project(model, tmp_path / "out", name="loop")
    y_ref, y = wandering(20_000), wandering(20_000, seed=8)
    in_python = model.stepper()
    u = stepped(in_python, y_ref, y)
    for driver, language in (("gcc", AS_C), ("clang++", AS_CXX)):
        library = build_library(project.path, objects, driver, language)
        code = Exported(library, project.state_length, project.saved_bytes, inputs=2)
        state = code.initial_state()
        assert same_bits(code.run(state, y_ref, y), u)
        assert same_bits(code.memory(state), np.asarray(in_python.state))
    for precision in ("double", "single"):
        other = c_project(model, tmp_path / precision, precision=precision)
        assert run_selftest(other.path, objects).stdout == "10000 samples, max difference 0\n"


@pytest.mark.parametrize("name", LIMITED)
def test_limits_hold_on_a_target(name: str, tmp_path: Path, objects: Objects) -> None:
    """Before the first good sample, after bad ones, and in numbers of single precision."""
    model = LIMITED[name]
    low, high = model.limits or (-np.inf, np.inf)
    project = c_project(model, tmp_path / "out")
    code = Exported(
        build_library(project.path, objects), project.state_length, project.saved_bytes, inputs=2
    )
    state = code.initial_state()
    y_ref, y = 100.0 * wandering(2000), 100.0 * wandering(2000, seed=8)
    y_ref[:3], y[1000:1010] = np.nan, np.inf
    u = code.run(state, y_ref, y)
    # What is answered before there is a sample is the allowed drive nearest to u0.
    assert u[0] == min(max(model.u0, low), high)
    assert u.min() >= low
    assert u.max() <= high
    assert code.fault(state) == 1 | 16
    single = stepper_of(block_of(model, "single"), "single")
    v = stepped(single, y_ref, y)
    assert v.min() >= low
    assert v.max() <= high
    assert (single.fault, single.limited) == (True, True)


def test_a_drive_within_limits_raises_nothing(tmp_path: Path, objects: Objects) -> None:
    project = c_project(LIMITED["limited gain"], tmp_path / "out")
    code = Exported(
        build_library(project.path, objects), project.state_length, project.saved_bytes, inputs=2
    )
    state = code.initial_state()
    code.run(state, np.full(10, 0.1), np.zeros(10))
    assert code.fault(state) == 0
    code.run(state, np.full(1, 1.0), np.zeros(1))
    assert code.fault(state) == 16


def test_limits_between_which_single_precision_has_no_number(tmp_path: Path) -> None:
    narrow = TrackingController([], [], [], [1.0, -1.0], 1.0, limits=(1.0 + 1e-9, 1.0 + 2e-9))
    with pytest.raises(InputError, match="leave no number of single precision"):
        c_project(narrow, tmp_path / "out", precision="single")


@pytest.mark.parametrize("change", [5e-6, 1e-4])
def test_rates_that_get_lost_in_single_precision(change: float, tmp_path: Path) -> None:
    """Beside 150, 5e-6 is a third of the last place: the drive would stand still from 128 on."""
    slow = TrackingController(
        [], [], [], [1.0, -1.0], 1e-5, limits=(0.0, 150.0), rate=change / 1e-5, u0=140.0
    )
    assert np.float32(140.0) + np.float32(5e-6) == np.float32(140.0)
    with pytest.raises(InputError, match="lost beside a drive of 150 in single precision"):
        c_project(slow, tmp_path / "out", precision="single")
    c_project(slow, tmp_path / "double")


@pytest.mark.parametrize("limits", [None, (0.0, 150.0), (0.0, 1e30)])
def test_rates_that_single_precision_counts(limits: tuple[float, float] | None) -> None:
    block = TrackingController([], [], [], [1.0, -1.0], 1e-5, limits=limits, rate=100.0, u0=140.0)
    step = stepper_of(block_of(block, "single"), "single")
    u = stepped(step, np.full(1000, 150.0), np.zeros(1000))
    # 140 + 1000 times 1e-3, which last places of 1.5e-5 change by 1/128 at most.
    assert u[-1] == pytest.approx(141.0, abs=1e-2)


def test_controllers_need_no_chain(tmp_path: Path) -> None:
    needed = {
        # What starts it after a history solves for the plays of the inverse.
        "observer": {"prandtl_ishlinskii", "tracking_linear", "solved"},
        "limited": {"prandtl_ishlinskii", "tracking_linear", "drive_limits"},
    }
    for name, parts in needed.items():
        project = c_project(CONTROLLERS[name], tmp_path / name)
        sources = {file for file in project.files if file.endswith(".c") and "/" in file}
        assert sources == {f"core/src/stage_core_{part}.c" for part in parts}


def test_what_looks_ahead_is_refused_with_the_reason(tmp_path: Path) -> None:
    dynamics = LinearDynamics.from_zeros_poles_gain([1.6], [0.5, 0.3], 1.0, dt=1e-3)
    with pytest.raises(InputError, match="samples ahead"):
        c_project(StableInverse.of(dynamics), tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "nonsense", [None, 1.0, [1.0], "model.json", Path("a"), object(), Operator]
)
@pytest.mark.parametrize(
    ("export", "out"),
    [(c_project, "out"), (fmu, "a.fmu"), (mex, "out"), (rust, "out"), (structured_text, "a.st")],
)
def test_what_is_no_model_is_refused(
    export: Callable[..., object], out: str, nonsense: object, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match="cannot be exported; give an operator"):
        export(nonsense, tmp_path / out)
    assert not (tmp_path / out).exists()
