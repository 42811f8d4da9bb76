"""Scheduled models and inverses as C with limits, and their start after a history."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from c_builds import Exported, Objects, build_library, run_selftest, same_bits, stepped, wandering
from test_mex import READ, WRITE, compiled, needs_octave, octave
from test_scheduled_projects import scheduled

from hyst import InputError, ModelDescription, PrandtlIshlinskii
from hyst.control import LimitedSchedule
from hyst.export import c_project, fmu, mex
from hyst.export.c.firmware import CProject
from reference import moving_plays

NOT_FINITE, OFF_SCHEDULE, OUT_OF_RANGE = 1, 8, 16
LIMITS = (-0.5, 0.75)
HISTORY = [0.75, -0.5, 0.5, 0.125]
AT = 27.0
DT = 1e-3
ABOUT = ModelDescription(input_name="voltage", input_unit="V", input_low=-0.5, input_high=0.75)

BLOCKS = {
    "model": LimitedSchedule(scheduled(), LIMITS),
    "inverse": LimitedSchedule(scheduled().inverse(), LIMITS),
    "inverse with a rate": LimitedSchedule(scheduled().inverse(), LIMITS, 20.0, dt=DT),
    "a rate alone": LimitedSchedule(scheduled().inverse(), "none", 20.0, dt=DT),
}


def in_c(project: CProject, objects: Objects) -> Exported:
    library = build_library(project.path, objects)
    return Exported(library, project.state_length, project.saved_bytes, inputs=2)


def signals(samples: int = 20_000) -> tuple[np.ndarray, np.ndarray]:
    """What is wanted, far beyond reach, and a temperature that moves all the while and leaves."""
    t = 35.0 + 20.0 * np.sin(0.003 * np.arange(samples))
    t[777::1000] = np.nan
    return wandering(samples, size=3.0), t


@pytest.mark.parametrize("name", BLOCKS)
def test_the_bits_are_those_of_python(name: str, tmp_path: Path, objects: Objects) -> None:
    block = BLOCKS[name]
    code = in_c(c_project(block, tmp_path / "out"), objects)
    x, t = signals()
    step, state = block.stepper(), code.initial_state()
    y = code.run(state, x[:9000], t[:9000])
    other = code.unset_state()
    assert code.load(other, code.save(state)) == 0
    y = np.concatenate([y, code.run(other, x[9000:], t[9000:])])
    assert same_bits(y, stepped(step, x, t))
    assert same_bits(code.memory(other), np.array(step.state))
    assert code.fault(other) == NOT_FINITE | OFF_SCHEDULE | OUT_OF_RANGE
    if name.startswith("inverse"):
        assert (y.min(), y.max()) == LIMITS
        held = np.isin(y, LIMITS)
        assert (held[1:] & held[:-1] & (np.diff(t) != 0.0)).sum() > 1000  # while t moves


@pytest.mark.parametrize(("u", "t", "fault"), [
    (0.1, 30.0, 0), (0.1, 60.0, OFF_SCHEDULE), (9.0, 30.0, OUT_OF_RANGE),
    (np.inf, 30.0, NOT_FINITE), (0.1, np.nan, NOT_FINITE), (0.1, np.inf, NOT_FINITE | OFF_SCHEDULE),
])  # fmt: skip
def test_each_fault_is_told_alone(
    u: float, t: float, fault: int, tmp_path: Path, objects: Objects
) -> None:
    code = in_c(c_project(BLOCKS["inverse"], tmp_path / "out"), objects)
    state = code.initial_state()
    code.step(state, u, t)
    assert code.fault(state) == fault


def test_the_plant_follows_again_as_soon_as_it_can(tmp_path: Path, objects: Objects) -> None:
    """The drive of C, held while it gets warmer, on plays in NumPy."""
    code = in_c(c_project(scheduled().inverse(), tmp_path / "out", limits=LIMITS), objects)
    k = np.arange(4000)
    t = 21.0 + 28.0 * k / k.size
    wanted = 0.2 + np.where((k // 200) % 2, 5.0, 0.6) * np.sin(0.037 * k)
    u = code.run(code.initial_state(), wanted, t)
    reached = moving_plays.output(u, t, moving_radii=0.4, map_weight=-0.4)
    held = (u == LIMITS[0]) | (u == LIMITS[1])
    assert 1000 < held.sum() < 3000
    # Some dozen roundings of numbers up to 2.
    assert np.abs(reached - wanted)[~held].max() < 1e-13
    assert np.where(u == LIMITS[1], wanted - reached, 0.0).min() > -1e-13
    assert np.where(u == LIMITS[0], reached - wanted, 0.0).min() > -1e-13


@pytest.mark.parametrize("name", ["model", "inverse"])
def test_a_start_after_a_history(name: str, tmp_path: Path, objects: Objects) -> None:
    block = BLOCKS[name]
    code = in_c(c_project(block, tmp_path / "out"), objects)
    x, t = signals(2000)
    state, failed = code.state_after(HISTORY, AT)
    step = block.stepper(block.state_after(HISTORY, AT))
    assert (failed, code.fault(state)) == (0, 0)
    assert same_bits(code.memory(state), np.array(step.state))
    assert same_bits(code.run(state, x, t), stepped(step, x, t))
    # The answer to a bad first sample: the last drive, or what the model makes of it.
    state, _ = code.state_after(HISTORY, AT)
    last = code.step(state, np.nan, AT)
    drives = moving_plays.output(
        np.array(HISTORY), np.full(4, AT), moving_radii=0.4, map_weight=-0.4
    )
    assert abs(last - (0.125 if name == "inverse" else drives[-1])) < 1e-15


@pytest.mark.parametrize(
    ("drives", "t"),
    [([0.1, 0.76], 30.0), ([np.nan], 30.0), ([0.1], np.nan), ([0.1], np.inf), ([-0.6], 60.0)],
)
def test_a_history_that_cannot_be_is_answered_with_1(
    drives: list[float], t: float, tmp_path: Path, objects: Objects
) -> None:
    code = in_c(c_project(BLOCKS["inverse"], tmp_path / "out"), objects)
    state, failed = code.state_after(drives, t)
    assert failed == 1
    assert bytes(state) == bytes(code.initial_state())


def test_a_history_outside_the_schedule_is_told(tmp_path: Path, objects: Objects) -> None:
    """The constants are those of the end of the schedule, 50."""
    code = in_c(c_project(BLOCKS["inverse"], tmp_path / "out"), objects)
    state, failed = code.state_after(HISTORY, 60.0)
    at_the_end, _ = code.state_after(HISTORY, 50.0)
    assert (failed, code.fault(state), code.fault(at_the_end)) == (0, OFF_SCHEDULE, 0)
    assert same_bits(code.memory(state), code.memory(at_the_end))


@pytest.mark.parametrize("name", ["model", "inverse"])
def test_without_limits_there_is_a_start_too(name: str, tmp_path: Path, objects: Objects) -> None:
    """Plays in Python, whose output an inverse is driven with, lead to the same memory."""
    model = scheduled() if name == "model" else scheduled().inverse()
    code = in_c(c_project(model, tmp_path / "out", limits=None), objects)
    u, at = np.array([2.0, -1.5, 0.5]), np.full(3, AT)
    led = u if name == "model" else scheduled().run(u, at).y
    state, failed = code.state_after(u, AT)
    assert failed == 0
    assert same_bits(code.memory(state), model.run(led, at).state)
    written = c_project(model, tmp_path / "after", limits=None, history=u, history_at=AT)
    assert same_bits(in_c(written, objects).memory(in_c(written, objects).initial_state()),
                     code.memory(state))  # fmt: skip


_SAME = """\
#include <stdio.h>
#include <string.h>
#include "stage.h"
static stage_state a, b;
int main(void) {
    const float drives[] = {0.75f, -0.5f, 0.5f, 0.125f};
    int failed = stage_init_after(&a, drives, 4u, 27.0f);
    stage_init(&b);
    printf("%d %d %d", failed, memcmp(a.memory, b.memory, sizeof a.memory),
           a.y_last < b.y_last || a.y_last > b.y_last);
    return 0;
}
"""


@pytest.mark.parametrize("limits", [LIMITS, None])
@pytest.mark.parametrize("name", ["model", "inverse"])
def test_in_single_the_history_of_the_export_is_the_start(
    name: str, limits: tuple[float, float] | None, tmp_path: Path, objects: Objects
) -> None:
    model = scheduled() if name == "model" else scheduled().inverse()
    told: dict[str, Any] = {"limits": limits, "history": HISTORY, "history_at": AT}
    project = c_project(model, tmp_path / "out", precision="single", **told)
    ran = run_selftest(project.path, objects)
    assert (ran.returncode, "max difference 0\n" in ran.stdout) == (0, True), ran.stdout
    # Some ten roundings of 6e-8 on the way, of numbers up to 2.
    assert project.away_from_double < 3e-6
    (tmp_path / "out" / "same.c").write_text(_SAME)
    command = "cc -std=c99 -ffp-contract=off same.c stage.c core/src/*.c -o same && ./same"
    done = subprocess.run(command, shell=True, cwd=project.path, capture_output=True, text=True)
    assert done.stdout == "0 0 0", done.stderr


@pytest.mark.parametrize("precision", ["double", "single"])
def test_the_range_of_the_record_is_the_limits(
    precision: str, tmp_path: Path, objects: Objects
) -> None:
    model = scheduled().with_description(ABOUT)
    for i, each in enumerate((model, model.inverse())):
        project = c_project(each, tmp_path / str(i), precision=precision)
        assert project.drive.limits == LIMITS
        assert project.drive.source == "the range of the record"
        assert project.has_start
        ran = run_selftest(project.path, objects)
        assert (ran.returncode, "max difference 0\n" in ran.stdout) == (0, True), ran.stdout
    header = (project.path / "stage.h").read_text()
    number = "0.75f" if precision == "single" else "0.75"
    assert f"#define STAGE_U_MAX ({number})" in header
    assert "STAGE_OUT_OF_RANGE 16u" in header
    assert "STAGE_OFF_SCHEDULE 8u" in header
    manifest = json.loads((project.path / "manifest.json").read_text())
    assert (manifest["drive"]["low"], manifest["drive"]["high"]) == LIMITS
    readme = (project.path / "README.md").read_text()
    assert "`STAGE_U_MIN` to `STAGE_U_MAX`: -0.5 to 0.75 V (the range of the record)" in readme
    assert "do not let it drift meanwhile" in readme
    assert (
        "U_MIN" not in (c_project(model, tmp_path / "x", limits=None).path / "stage.h").read_text()
    )


def test_what_cannot_be_is_refused(tmp_path: Path) -> None:
    model = scheduled()
    refused: list[tuple[Any, dict[str, Any], str]] = [
        (model, {"history": [0.1]}, "follows temperature needs its value meanwhile"),
        (model, {"history": [0.1], "history_at": 51.0}, "history_at is 51, outside 20 to 50"),
        (model, {"history": [0.1], "history_at": np.nan}, "history_at is nan"),
        (model, {"history_at": 30.0}, "history_at is of a history; give one"),
        (PrandtlIshlinskii([0.5], [0.2], 1.0), {"history": [0.1], "history_at": 3.0},
         "follows no second signal; leave history_at out"),
        (model, {"history": [0.8], "history_at": 30.0, "limits": LIMITS}, "beyond the limits"),
        (model, {"rate_limit": 1.0}, "whose time is not known; give dt"),
        (BLOCKS["inverse"], {"limits": (0.0, 1.0)}, "a limited drive has its own limits"),
        (BLOCKS["inverse"], {"limits": None}, "a limited drive has its own limits"),
    ]  # fmt: skip
    for of, told, said in refused:
        with pytest.raises(InputError, match=said):
            c_project(of, tmp_path / "out", **told)
    with pytest.raises(InputError, match="no FMU yet"):
        fmu(BLOCKS["inverse"], tmp_path / "stage.fmu")
    assert not (tmp_path / "out").exists()


@needs_octave
def test_octave_holds_and_starts(tmp_path: Path) -> None:
    block = BLOCKS["inverse"]
    x, t = (each[:300] for each in signals(300))
    x, t = np.nan_to_num(x, posinf=0.0, neginf=0.0), np.nan_to_num(t, nan=30.0)
    folder = compiled(mex(block, tmp_path / "lens", name="lens"), "-Wall", "-Wextra", "-O0")
    x.tofile(folder / "u.bin")
    t.tofile(folder / "s.bin")
    program = """
    object = lens(); object.init_after([0.75 -0.5 0.5 0.125], 27);
    y = object.step(u, s); disp(object.limited());
    try, object.init_after([0 1], 27), catch e, disp(e.message), end
    try, object.init_after(0, NaN), catch e, disp(e.message), end
    try, object.init_after(0, [27 28]), catch e, disp(e.message), end
    """
    reading = READ.format("u") + READ.format("s")
    lines = octave(folder, reading + program + WRITE.format("y")).splitlines()
    expected = block.run(x, t, block.state_after(HISTORY, AT)).y
    assert (folder / "y.bin").read_bytes() == expected.tobytes()
    assert lines[0] == "1"
    assert lines[1] == lines[2]
    assert "is not finite or not from -0.5 to 0.75, or s is not; pass those" in lines[1]
    assert "s is a record; pass the one value it had." in lines[3]
