"""Limits and starts in simulation tools and in Octave: the bits of Python's limited drive."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmu_runs import INVERSE_MPI, VERSIONS, FmuRun, has_compiler, rough_signal
from test_mex import READ, WRITE, compiled, needs_octave, octave

import hyst.export
from hyst import Operator
from hyst.control import RepetitiveController, TrackingController
from hyst.control.limited_drive.drive import LimitedDrive
from reference.examples import EXAMPLES

LIMITS, HISTORY = (-1.5, 2.0), [2.0, -1.5, 0.75, 0.25]
# A bank that is solved for, and a model that is kept beside its inverse.
INVERSES = {"bank": INVERSE_MPI, "model beside": EXAMPLES["inverse of gpi"]}


def limited(model: Operator) -> LimitedDrive:
    drive = LimitedDrive(model, LIMITS)
    assert drive.keeps_forward == (model is not INVERSE_MPI)
    return drive


@has_compiler
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", INVERSES)
def test_an_fmu_starts_after_its_history(name: str, version: str, tmp_path: Path) -> None:
    model, u = INVERSES[name], rough_signal(300)
    drive = limited(model)
    step = drive.stepper(drive.state_after(HISTORY))
    expected = np.array([step(each) for each in u.tolist()])
    written = hyst.export.fmu(
        model, tmp_path / "lens.fmu", version=version, limits=LIMITS, history=HISTORY
    )
    run = FmuRun(written, tmp_path).initialize()
    assert run.run(u, 1e-3).tobytes() == expected.tobytes()
    assert run.get("fault") == 16
    run.free()


def test_parameters_that_would_belie_limits_or_memory_are_none(tmp_path: Path) -> None:
    def parameters(name: str, **told: object) -> tuple[str, ...]:
        path = tmp_path / "lens.fmu"
        model = INVERSES[name]
        written = hyst.export.fmu(model, path, binary=False, force=True, **told)  # type: ignore[arg-type]
        return written.parameters

    free = parameters("bank", limits=None)
    assert {"pi_2.p0", "pi_2.p[1]", "pi_2.r[1]"} < set(free)
    # The bank is solved for; the map in front of it may change.
    assert set(parameters("bank", limits=LIMITS)) == {
        each for each in free if not each.startswith("pi_2.")
    }
    assert parameters("model beside", limits=None) != ()
    assert parameters("model beside", limits=LIMITS) == ()
    # The memory of a history belongs to the radii, weights may change.
    after = set(parameters("bank", limits=None, history=HISTORY))
    assert {"pi_2.p0", "pi_2.p[1]"} < after
    assert not any(each.startswith("pi_2.r") for each in after)


@needs_octave
@pytest.mark.parametrize("name", INVERSES)
def test_octave_starts_after_a_history(name: str, tmp_path: Path) -> None:
    model, u = INVERSES[name], rough_signal(200)
    drive = limited(model)
    written = hyst.export.mex(model, tmp_path / "lens", name="lens", limits=LIMITS, history=HISTORY)
    folder = compiled(written, "-Wall", "-Wextra", "-O0")
    u.tofile(folder / "u.bin")
    program = """
    object = lens(); before = object.state;
    object.init_after([-1.5 1]); other = object.step(u);
    object.init_after([2; -1.5; 0.75; 0.25]); assert(object.state, before);
    disp(object.limited());
    y = object.step(u); assert(lens(u), y);
    disp(object.limited());
    try, object.init_after([0 3]), catch e, disp(e.message), end
    try, object.init_after([0 NaN]), catch e, disp(e.message), end
    try, object.init_after('0'), catch e, disp(e.message), end
    """
    said = octave(folder, READ.format("u") + program + WRITE.format("y") + WRITE.format("other"))
    expected = drive.run(u, drive.state_after(HISTORY))[0]
    assert (folder / "y.bin").read_bytes() == expected.tobytes()
    expected = drive.run(u, drive.state_after([-1.5, 1.0]))[0]
    assert (folder / "other.bin").read_bytes() == expected.tobytes()
    lines = said.splitlines()
    assert lines[:2] == ["0", "1"]
    assert lines[2] == lines[3]
    assert "is not finite or not from -1.5 to 2; pass those" in lines[2]
    assert "drives is not of class double" in lines[4]


@pytest.mark.parametrize("kind", ["tracking", "repetitive"])
def test_a_controller_with_limits_offers_no_half_of_its_inverse(kind: str, tmp_path: Path) -> None:
    """The inverse and the model beside it have the same constants, and stay each other's."""

    def parameters(limits: tuple[float, float] | None) -> tuple[str, ...]:
        if kind == "tracking":
            block: TrackingController | RepetitiveController = TrackingController.from_continuous(
                ([4.0, 8.0], [1.0, 0.0]), dt=1e-3, inverse=INVERSE_MPI, limits=limits
            )
        else:
            learn, smooth = [0.5, 0.2, 0.05], [0.1, -0.2, 0.5, 0.3]
            block = RepetitiveController(40, learn, smooth, 3, 1e-3, INVERSE_MPI, limits=limits)
        return hyst.export.fmu(block, tmp_path / "x.fmu", binary=False, force=True).parameters

    assert {"pi_3.p0", "pi_3.p[1]", "pi_3.r[1]"} < set(parameters(None))
    assert parameters(LIMITS) == ()
