"""Limits and starts of exported C: what they do, where they come from, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from c_builds import (
    Exported,
    Objects,
    build_library,
    run_selftest,
    same_bits,
    stepped,
    wandering,
)

import hyst
from hyst import Affine, InputError, PrandtlIshlinskii
from hyst.compensation import invert_trajectory
from hyst.control import TrackingController
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.control.repetitive.controller import RepetitiveController
from hyst.export import CProject, c_project
from hyst.export.c.any_block import any_block
from hyst.export.c.block import stepper_of
from hyst.export.c.drive_options import DriveOptions
from hyst.online import JointEstimator, ScaleEstimator
from hyst.operators import ModelDescription, Operator
from reference.examples import EXAMPLES

PI = PrandtlIshlinskii(p=[0.5, 0.2, 0.3], r=[0.1, 0.3, 0.9], p0=1.0)
ABOUT = ModelDescription(
    "drive", "stroke", "V", "um", input_low=0.0, input_high=3.0, output_low=0.0, output_high=5.0,
    dt=0.01,
)  # fmt: skip
STAGE = (Affine(2.0, 0.5) @ PI).with_description(ABOUT)
LIMITED = LimitedDrive(STAGE.inverse(), (0.0, 3.0))


def in_c(project: CProject, objects: Objects) -> Exported:
    library = build_library(project.path, objects)
    return Exported(library, project.state_length, project.saved_bytes)


def header_of(project: CProject) -> str:
    return (project.path / f"{project.name}.h").read_text()


# A bank at the end, plays before a map, and branches that are solved for.
CLIPPED = {
    "bank": EXAMPLES["mpi"],
    "map behind": EXAMPLES["gpi"],
    "ramberg-osgood": EXAMPLES["ramberg-osgood"],
    "coleman-hodgdon": EXAMPLES["coleman-hodgdon"],
}


@pytest.mark.parametrize("name", CLIPPED)
def test_what_is_out_of_reach_is_clipped_as_compensation_clips_it(
    name: str, tmp_path: Path, objects: Objects
) -> None:
    model = CLIPPED[name]
    y_ref = wandering(4000)
    y_ref = np.where(np.isfinite(y_ref), y_ref, 0.0)
    alone = model.inverse()(y_ref)
    low, high = np.quantile(alone, [0.2, 0.85]).tolist()
    history = [low, high, 0.5 * (low + high)]
    wanted = invert_trajectory(
        model, y_ref, input_range=(low, high), outside="clip", history=history
    )
    assert wanted.clipped > 100
    project = c_project(model.inverse(), tmp_path / "out", limits=(low, high), history=history)
    code = in_c(project, objects)
    u = code.run(code.initial_state(), y_ref)
    # The same but for rounding: where a bank is solved for the drive that is held, compensation
    # steps it with the output that belongs to it. Both forget that at the next turn.
    np.testing.assert_allclose(u, wanted.u, rtol=0.0, atol=1e-12 * (high - low) * 4000)


@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_range_of_the_record_is_the_default(
    precision: str, tmp_path: Path, objects: Objects
) -> None:
    project = c_project(STAGE.inverse(), tmp_path / "out", precision=precision)
    drive = project.drive
    assert (drive.side, drive.low, drive.high, drive.rate) == ("output", 0.0, 3.0, None)
    assert drive.said() == "0 to 3 V (the range of the record)"
    suffix = "f" if precision == "single" else ""
    for line in (f"#define STAGE_U_MIN (0.0{suffix})", f"#define STAGE_U_MAX (3.0{suffix})"):
        assert line in header_of(project)
    assert "STAGE_U_RATE" not in header_of(project)
    told = json.loads((project.path / "manifest.json").read_text())
    assert told["drive"] == {
        "side": "output", "low": 0.0, "high": 3.0, "unit": "V", "source": "the range of the record",
    }  # fmt: skip
    assert told["history"] == []
    # Of a model it is the input, in FMU and MEX as in C.
    assert c_project(STAGE, tmp_path / "model").drive.side == "input"
    fmu = hyst.export.fmu(STAGE.inverse(), tmp_path / "stage.fmu", binary=False)
    assert fmu.drive.limits == hyst.export.mex(STAGE.inverse(), tmp_path / "mex").drive.limits
    assert fmu.drive.limits == (0.0, 3.0)


def test_an_actuator_is_never_driven_beyond_and_its_memory_is_followed(
    tmp_path: Path, objects: Objects
) -> None:
    """By hand: a play of 1 with weight 0.5 beside 1, limits of 2."""
    stage = PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    code = in_c(c_project(stage.inverse(), tmp_path / "out", limits=(-2.0, 2.0)), objects)
    state = code.initial_state()
    # Up to u = 2 the output is u + 0.5 (u - 1); no more is to be had, and then the play stands.
    u = code.run(state, np.array([1.0, 2.5, 9.0, 1499.0, 2.0]))
    assert u.tolist() == [1.0, 2.0, 2.0, 2.0, 1.5]
    assert code.fault(state) == 16
    assert code.run(state, np.array([np.nan, -np.inf])).tolist() == [1.5, 1.5]
    assert code.fault(state) == 1 | 16


def test_a_model_answers_the_clipped_drive(tmp_path: Path, objects: Objects) -> None:
    code = in_c(c_project(STAGE, tmp_path / "out"), objects)
    state, u = code.initial_state(), np.linspace(-2.0, 6.0, 50)
    assert same_bits(code.run(state, u), STAGE(np.clip(u, 0.0, 3.0)))
    assert code.fault(state) == 16


def test_a_rate_is_kept_from_the_start_on(tmp_path: Path, objects: Objects) -> None:
    project = c_project(STAGE.inverse(), tmp_path / "out", rate_limit=10.0, history=[0.0, 3.0, 1.0])
    assert "#define STAGE_U_RATE (10.0)" in header_of(project)
    assert project.drive.said() == "0 to 3 V, at most 10 V per second (the range of the record)"
    code = in_c(project, objects)
    u = code.run(code.initial_state(), np.full(30, 100.0))
    # 10 V/s and 10 ms a sample, from the 1 V of the history; steps are rounded to 1 unit of 3.
    np.testing.assert_allclose(np.diff(np.append(1.0, u))[:19], 0.1, rtol=0.0, atol=1e-15)
    assert u[-1] == 3.0


def test_without_limits_there_is_none_and_it_is_said(tmp_path: Path, objects: Objects) -> None:
    unlimited = STAGE.inverse()
    for limits in ("none", None):
        project = c_project(unlimited, tmp_path / str(limits), limits=limits)
        assert project.drive.said() == "none: as asked for"
        assert "OUT_OF_RANGE" not in header_of(project)
        assert "U_MAX" not in header_of(project)
    u = wandering(500)
    code = in_c(project, objects)
    assert same_bits(code.run(code.initial_state(), u), stepped(unlimited.stepper(), u))
    unknown = c_project(PI.inverse(), tmp_path / "unknown")
    assert unknown.drive.said() == "none: no range of the drive is known"


def test_a_range_that_the_export_is_told_counts(tmp_path: Path) -> None:
    about = ModelDescription("wanted", "command", "um", "V", output_low=-1.0, output_high=2.0)
    project = c_project(PI.inverse(), tmp_path / "told", description=about)
    assert project.drive.limits == (-1.0, 2.0)
    # One that tells none does not take away what the model itself tells.
    kept = c_project(STAGE.inverse(), tmp_path / "kept", description=ModelDescription("x", "y"))
    assert kept.drive.limits == (0.0, 3.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_limits_are_no_wider_in_single_precision(
    sign: float, tmp_path: Path, objects: Objects
) -> None:
    """0.1 and 0.7 lie between numbers of single precision: 0.1 below its nearest, 0.7 above."""
    ends = sorted((0.1 * sign, 0.7 * sign))
    low, high = ends
    project = c_project(
        PI.inverse(), tmp_path / "out", precision="single", limits=(low, high), history=ends
    )
    assert project.drive.low is not None
    assert project.drive.high is not None
    assert low <= project.drive.low < low + 1e-7
    assert high - 1e-7 < project.drive.high <= high
    # The history ends at the very limits that were given.
    assert project.history == (project.drive.low, project.drive.high)
    assert run_selftest(project.path, objects).returncode == 0
    step = stepper_of(any_block(PI.inverse(), "single", DriveOptions((low, high))), "single")
    u = stepped(step, 100.0 * wandering(500))
    assert u.min() == project.drive.low
    assert u.max() == project.drive.high


STARTS: dict[str, Operator] = {
    "model": EXAMPLES["mpi"],
    "sampled model": EXAMPLES["rate-dependent"],
    "inverse with a bank at its end": EXAMPLES["inverse of mpi"],
    "inverse with a map at its end": EXAMPLES["inverse of gpi"],
    "inverse with branches": EXAMPLES["inverse ramberg-osgood"],
    "inverse that counts time": EXAMPLES["inverse creep"],
    "map": EXAMPLES["affine"],
}
TURNS = [0.1, 1.9, -0.6, 0.7, 0.2, 0.35]


@pytest.mark.parametrize("name", STARTS)
def test_a_start_follows_the_drive_without_limits_too(
    name: str, tmp_path: Path, objects: Objects
) -> None:
    model = STARTS[name]
    plain = c_project(model, tmp_path / "plain", limits=None)
    code = in_c(plain, objects)
    state, answer = code.state_after(TURNS)
    assert answer == 0
    memory = code.memory(state).tolist()
    # What an actuator with this history answers is what the inverse is asked for: u comes back.
    drive = np.array([0.3, 0.6, 0.9, 0.4, -0.1, 0.5])
    if name.startswith("inverse"):
        forward = model.inverse()
        outputs, expected = forward.run(drive, forward.run(TURNS)[1])[0], drive
    else:
        outputs, expected = drive, model.run(drive, model.run(TURNS)[1])[0]
    # An inverse gives the drive back but for rounding, through a few operations.
    np.testing.assert_allclose(code.run(state, outputs), expected, rtol=0.0, atol=1e-9)
    started = c_project(model, tmp_path / "started", limits=None, history=TURNS)
    same, after = in_c(started, objects), in_c(started, objects).state_after(TURNS)[0]
    assert bytes(same.save(same.initial_state())) == bytes(same.save(after))
    assert memory == same.memory(after).tolist()


@pytest.mark.parametrize("limits", [None, (-2.0, 2.5)])
def test_a_virgin_inverse_is_off_by_the_loop_and_a_started_one_is_not(
    limits: tuple[float, float] | None, tmp_path: Path, objects: Objects
) -> None:
    """After a sweep over the whole range every history before it is forgotten."""
    sweep = [-2.0, 2.5, 0.0]
    unknown = np.random.default_rng(3).uniform(-2.0, 2.5, 20)
    actuator = PI.run([*unknown, *sweep])[1]
    code = in_c(c_project(PI.inverse(), tmp_path / "out", limits=limits), objects)
    wanted = np.linspace(PI.run([0.0], actuator)[0][0], 2.0, 9)
    virgin = PI.run(code.run(code.initial_state(), wanted), actuator)[0]
    started = PI.run(code.run(code.state_after(sweep)[0], wanted), actuator)[0]
    assert np.abs(virgin - wanted).max() > 0.1
    # Sums of four terms of 1: rounding.
    assert np.abs(started - wanted).max() < 1e-14


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 3.0000001, -1e-9])
def test_a_drive_that_cannot_have_been_leaves_the_virgin_state(
    bad: float, tmp_path: Path, objects: Objects
) -> None:
    project = c_project(STAGE.inverse(), tmp_path / "out", history=[0.0, 3.0, 2.0])
    code = in_c(project, objects)
    state, answer = code.state_after([0.0, 3.0, bad, 1.0])
    assert answer == 1
    virgin, none = code.state_after([])
    assert none == 0
    assert bytes(code.save(state)) == bytes(code.save(virgin))
    assert code.memory(virgin).tolist() == LIMITED.initial_state().tolist()
    assert code.memory(code.initial_state()).tolist() != code.memory(virgin).tolist()


def test_what_overflows_on_its_way_is_no_history(tmp_path: Path, objects: Objects) -> None:
    steep = Affine(1e200) @ Affine(1e100)
    code = in_c(c_project(steep, tmp_path / "out"), objects)
    assert code.state_after([1.0])[1] == 0
    assert code.state_after([1.0, 1e10])[1] == 1
    with pytest.raises(InputError, match=r"history .* 1e\+10, value 2 of it, overflows"):
        c_project(steep, tmp_path / "x", history=[1.0, 1e10])


def test_a_state_is_one_of_its_limits(tmp_path: Path, objects: Objects) -> None:
    one = in_c(c_project(STAGE.inverse(), tmp_path / "one"), objects)
    other = in_c(c_project(STAGE.inverse(), tmp_path / "other", limits=(0.0, 2.0)), objects)
    started = in_c(c_project(STAGE.inverse(), tmp_path / "started", history=[1.0]), objects)
    saved = one.save(one.initial_state())
    assert other.load(other.unset_state(), saved) != 0
    assert started.load(started.unset_state(), saved) == 0


CONTROLLERS = {
    "unlimited": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=PI.inverse()
    ),
    "limited": TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=PI.inverse(), limits=(-1.0, 2.0)
    ),
    "without an inverse": TrackingController([], [], [], [2.0, -1.0], 1e-3, limits=(-1.0, 2.0)),
    "repetitive": RepetitiveController(
        16, [0.5, 0.25], [0.1, 0.2], 1, 1e-3, PI.inverse(), limits=(-1.0, 2.0)
    ),
}


@pytest.mark.parametrize("name", CONTROLLERS)
def test_a_controller_starts_after_a_history(name: str, tmp_path: Path, objects: Objects) -> None:
    controller, history = CONTROLLERS[name], [-0.5, 1.5, 0.25]
    project = c_project(controller, tmp_path / "out", history=history)
    code = Exported(
        build_library(project.path, objects), project.state_length, project.saved_bytes, inputs=2
    )
    state = code.initial_state()
    # By other means: the memories of the model and of its inverse, by their own runs.
    expected = controller.initial_state()
    first = expected.size - 6 - controller.is_limited if name != "unlimited" else 1
    if controller.inverse is not None:
        v, model = PI.run(history)
        expected[first : first + 3] = PI.inverse().run(v)[1]
        expected[first + 3 : first + 6] = model[: expected.size - first - 3]
    if controller.is_limited:
        expected[-1] = 0.25
    # The inverse of the inverse has the weights of the model but for rounding.
    np.testing.assert_allclose(code.memory(state), expected, rtol=0.0, atol=1e-14)
    assert code.step(state, np.nan, 0.0) == 0.25
    # Its own limits are kept, and no others are taken.
    assert project.drive.limits == controller.limits
    with pytest.raises(InputError, match="limits its drive itself, so limits cannot be given"):
        c_project(controller, tmp_path / "x", limits=(-1.0, 1.0))
    said = "of the controller" if controller.is_limited else "none: the controller was given none"
    assert said in project.drive.said()


def test_the_header_tells_what_a_step_gives_before_the_start(tmp_path: Path) -> None:
    """The drive never leaves its limits, so 0 is no answer where it is not among them."""
    for model, said in ((STAGE.inverse(), "1"), (STAGE, "0")):
        project = c_project(model, tmp_path / said, limits=(1.0, 3.0))
        assert f"Before stage_init: {said},\n * and a fault." in header_of(project)
    for kind, estimator in estimators().items():
        text = header_of(c_project(estimator, tmp_path / kind, limits=(1.0, 3.0)))
        assert "stage_init: 1. It never leaves\n * STAGE_U_MIN to STAGE_U_MAX; no bit" in text


def estimators() -> dict[str, JointEstimator | ScaleEstimator]:
    described = PI.with_description(ABOUT)
    return {"joint": JointEstimator(described), "scale": ScaleEstimator(described)}


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", ["joint", "scale"])
def test_commands_of_an_estimator_are_clamped(
    name: str, precision: str, tmp_path: Path, objects: Objects
) -> None:
    """The self-test compares them with Python, and asks for more than there is."""
    project = c_project(estimators()[name], tmp_path / "out", precision=precision)
    assert (project.drive.side, project.drive.limits) == ("command", (0.0, 3.0))
    block = any_block(estimators()[name], "double", DriveOptions())
    step = stepper_of(block, "double")
    assert [step(1.0, 1.5, y_ref) for y_ref in (99.0, -99.0)] == [3.0, 0.0]
    assert run_selftest(project.path, objects).returncode == 0


def test_what_an_estimator_is_not_told_of_its_drive(tmp_path: Path) -> None:
    name = "scale"
    free = c_project(estimators()[name], tmp_path / "free", limits="none")
    assert "U_MAX" not in header_of(free)
    with pytest.raises(InputError, match="no sequence of samples, so rate_limit cannot"):
        c_project(estimators()[name], tmp_path / "x", rate_limit=1.0)
    with pytest.raises(InputError, match="goes on from the memory that it has now"):
        c_project(estimators()[name], tmp_path / "x", history=[1.0])


def test_a_limited_drive_is_exported_as_it_is(tmp_path: Path, objects: Objects) -> None:
    drive = LimitedDrive(STAGE.inverse(), (0.5, 2.5))
    project = c_project(drive, tmp_path / "out", history=[1.0, 2.0])
    assert project.drive.limits == (0.5, 2.5)
    code, u = in_c(project, objects), wandering(500)
    step = drive.stepper(drive.state_after([1.0, 2.0]))
    assert same_bits(code.run(code.initial_state(), u), stepped(step, u))
    for told in ({"limits": (0.0, 1.0)}, {"limits": None}, {"rate_limit": 1.0}):
        with pytest.raises(InputError, match="a limited drive has its own limits"):
            c_project(drive, tmp_path / "x", **told)  # type: ignore[arg-type]


def test_every_self_test_meets_the_limits() -> None:
    """Else its fault would never be looked at."""
    for model in (STAGE, STAGE.inverse(), *(each.inverse() for each in CLIPPED.values())):
        block = any_block(model, "double", DriveOptions((0.25, 1.0)))
        assert block.tested is not None
        low, high = block.tested
        step = stepper_of(block, "double")
        u = stepped(step, np.linspace(low, high, 200))
        ends = (u.min(), u.max()) if block.drive.side == "output" else (low, high)
        assert ends[0] <= 0.25
        assert ends[1] >= 1.0
        assert step.limited  # type: ignore[attr-defined]
