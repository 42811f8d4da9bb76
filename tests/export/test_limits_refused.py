"""Limits and histories that an export refuses, or cannot have, and says why."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_limited_projects import ABOUT, PI, STAGE, header_of

import hyst
from hyst import Affine, DeadZone, InputError
from hyst.control.limited_drive.drive import LimitedDrive
from hyst.export import c_project, explicit_inverse
from hyst.models import RateDependentPrandtlIshlinskii
from hyst.operators import ModelDescription, Operator


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"limits": (3.0, 1.0)}, "give the lowest drive first"),
        ({"limits": (1.0, 1.0)}, "give the lowest drive first"),
        ({"limits": (0.0, np.nan)}, "the highest drive is nan"),
        ({"limits": "wide"}, "limits is 'wide'; give 'auto', 'none', or the lowest"),
        ({"limits": 3.0}, "give the lowest and the highest drive"),
        ({"rate_limit": 0.0}, "rate is 0"),
        ({"rate_limit": -5.0}, "rate is -5"),
        ({"history": [0.0, 3.5]}, "history has 3.5, beyond the limits of the drive, 0 to 3"),
        ({"history": [0.0, np.nan]}, "history is nan at index 1"),
        ({"history": []}, "history is empty"),
        ({"history": [[1.0]]}, "history has shape"),
    ],
)
def test_what_cannot_be_is_refused(told: dict[str, object], said: str, tmp_path: Path) -> None:
    for write, out in (
        (c_project, "c"), (hyst.export.mex, "mex"), (hyst.export.fmu, "x.fmu")
    ):  # fmt: skip
        with pytest.raises(InputError, match=said):
            write(STAGE.inverse(), tmp_path / out, **told)  # type: ignore[operator]
        assert not (tmp_path / out).exists()


def test_a_rate_needs_to_know_the_time(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="whose time is not known; give dt"):
        c_project(PI.inverse(), tmp_path / "out", limits=(0.0, 1.0), rate_limit=1.0)


def test_limits_beyond_which_the_output_turns_back(tmp_path: Path) -> None:
    """u - 2 max(u - 1, 0) rises up to 1; its inverse up to there is u itself."""
    tent = DeadZone([1.0, -2.0], [0.0, 1.0])
    rising = Affine(1.0).with_description(ModelDescription(is_inverse=True))
    turned = LimitedDrive(rising, (0.0, 1.0), forward=tent)
    assert c_project(turned, tmp_path / "up to the top").drive.limits == (0.0, 1.0)
    with pytest.raises(InputError, match="not the exact inverse of forward: drives within the lim"):
        LimitedDrive(rising, (0.0, 2.0), forward=tent)


def test_a_file_that_does_not_say_what_it_is_has_no_limits_and_no_start(tmp_path: Path) -> None:
    """Before version 5 the file of an inverse was like that of a model."""
    STAGE.inverse().save(tmp_path / "inverse.json")
    content = json.loads((tmp_path / "inverse.json").read_text())
    content["version"] = 4
    del content["description"]["is_inverse"]
    (tmp_path / "old.json").write_text(json.dumps(content))
    old = hyst.load(tmp_path / "old.json")
    assert isinstance(old, Operator)
    project = c_project(old, tmp_path / "out")
    assert (project.drive.side, project.drive.limits, project.has_start) == ("", None, False)
    assert "does not say whether it is a model or an inverse" in project.drive.said()
    for told in ({"limits": (0.0, 3.0)}, {"history": [0.0, 3.0]}):
        with pytest.raises(InputError, match="does not say whether it is a model or an inverse"):
            c_project(old, tmp_path / "other", **told)  # type: ignore[arg-type]
    # It stays open when it is written again, till somebody says it.
    old.save(tmp_path / "again.json")
    assert hyst.load(tmp_path / "again.json").description.is_inverse is None
    told_now = old.with_description(replace(old.description, is_inverse=True))
    assert c_project(told_now, tmp_path / "told").drive.limits == (0.0, 3.0)


def test_a_model_with_ranges_stays_a_model_in_its_file(tmp_path: Path) -> None:
    STAGE.save(tmp_path / "model.json")
    stage = hyst.load(tmp_path / "model.json")
    assert isinstance(stage, Operator)
    assert stage.description == ABOUT
    assert LimitedDrive(stage).drive == "input"
    # As a record leaves it, with the swing that no inverse has, older versions read it, too.
    assert replace(ABOUT, smallest_swing=0.1).version < 5


def test_the_description_of_an_export_says_which_signal_the_drive_is(tmp_path: Path) -> None:
    """Constants of an inverse that were typed in: the drive is the output, 0 to 3."""
    inverse = Affine(2.0, 0.5) @ PI
    project = c_project(inverse, tmp_path / "out", description=ABOUT.of_inverse())
    assert (project.drive.side, project.drive.limits) == ("output", (0.0, 3.0))


def test_an_inverse_whose_model_is_not_known_has_no_limits_and_no_start(tmp_path: Path) -> None:
    rated = RateDependentPrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], 0.01, 0.001, 1.0)
    rated = rated.with_description(ABOUT)
    for i, model in enumerate((rated.inverse(preview=5), explicit_inverse(rated))):
        project = c_project(model, tmp_path / str(i))
        assert project.drive.limits is None
        assert project.drive.said().startswith("none: the memory of a drive that is held could not")
        assert not project.has_start
        assert "init_after" not in header_of(project)
        with pytest.raises(InputError, match="a limited drive needs the operator"):
            c_project(model, tmp_path / "x", limits=(0.0, 3.0))
        with pytest.raises(InputError, match="no start after a history: the model in front"):
            c_project(model, tmp_path / "x", history=[1.0])
