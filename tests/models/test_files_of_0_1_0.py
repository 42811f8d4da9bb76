"""Files that hyst 0.1.0 wrote are read; what it refused itself stays refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst.online import JointEstimator

FOLDER = Path(__file__).parent / "files_of_0_1_0"


def test_an_operator() -> None:
    found = hyst.load(FOLDER / "operator.json")
    plays = hyst.PrandtlIshlinskii([0.5, 0.25], [1.0, 2.0], p0=0.3, z0=[0.5, 0.25])
    assert found == hyst.ModifiedPrandtlIshlinskii(plays, hyst.DeadZone([1.0, 0.5], [0.0, 1.5]))
    about = found.description
    assert (about.input_name, about.input_unit, about.output_name) == ("drive", "V", "position")
    assert (about.output_low, about.output_high, about.dt, about.delay) == (-1.5, 12.25, 0.001, 2)
    assert about.errors == {}
    assert about.provenance is None


def test_a_tracking_controller() -> None:
    found = hyst.load(FOLDER / "controller.json")
    assert isinstance(found, hyst.control.TrackingController)
    # C(s) = 4 + 8/s by the trapezoidal rule at 1 ms, and the inverse of 2 u + 0.5 play(u, 1).
    assert found.D.tolist() == [4.004, -4.004]
    assert found.inverse is not None
    assert found.inverse == hyst.PrandtlIshlinskii([0.5], [1.0], p0=2.0).inverse()
    assert found.description.output_unit == "um"


def test_a_joint_estimator() -> None:
    found = hyst.load(FOLDER / "joint_estimator.json")
    assert isinstance(found, JointEstimator)
    # What 0.1.0 said the moment before it wrote the file, after 200 samples.
    expected = [0.9645743068840762, 0.5367303176241328, 0.9471296968699511, 0.0004208201981908185]
    assert found.parameters.tolist() == expected
    commands = [found.command(y) for y in (0.0, 1.0, 2.0)]
    # The same operations in another build of the core may round once differently in each.
    assert np.allclose(
        commands, [-0.3388879478054697, 0.3271993896178569, 0.9932867270411834], rtol=1e-12
    )
    assert found.counts["used"] == 200
    assert (found.description.dt, found.description.delay) == (0.5, 1)
    assert found.model.description.output_unit == "um"


def test_an_estimator_without_a_description(tmp_path: Path) -> None:
    content = json.loads((FOLDER / "joint_estimator.json").read_text())
    del content["description"]
    (tmp_path / "estimator.json").write_text(json.dumps(content))
    assert hyst.load(tmp_path / "estimator.json").description == hyst.ModelDescription()


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("operator", {"version": 0}, "version 0 of the model file; this hyst reads versions 1, 2"),
        ("joint_estimator", {"version": 1}, "version 1 of the estimator file"),
        ("joint_estimator", {"author": "me"}, "unknown entry 'author'"),
        ("operator", {"description": {"errors": {}}}, "unknown entry 'errors' in 'description'"),
        ("joint_estimator", {"description": {"colour": 1}}, "unknown entry 'colour'"),
        ("operator", {"description": {"dt": None}}, "'dt' in 'description' is null"),
    ],
)
def test_what_no_version_wrote_is_refused(
    name: str, changes: dict[str, object], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "changed.json"
    content = json.loads((FOLDER / f"{name}.json").read_text())
    path.write_text(json.dumps(content | changes))
    with pytest.raises(hyst.InputError, match=message) as refused:
        hyst.load(path)
    assert str(path) in str(refused.value)
