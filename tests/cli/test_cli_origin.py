"""hyst info on everything that can be saved, and what files say about where they come from."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_runs import STAGE, Run, describe, drive, write_csv

import hyst
from hyst.operators import data_hash

# Pictures are looked at elsewhere.
pytestmark = pytest.mark.usefixtures("undrawn")

COLUMNS = ("--input", "u", "--output", "y", "--time", "t")
QUICK = ("--family", "pi", "--plays", 2, "--delay", 0)


def test_an_identified_model_knows_the_command_the_data_and_its_errors(
    run: Run, record_file: Path, folder: Path
) -> None:
    assert run("identify", record_file, *COLUMNS, *QUICK, "-o", "out").code == 0
    about = hyst.load(folder / "out" / "model.json").description
    origin = about.provenance
    assert origin is not None
    assert origin.command.startswith("hyst identify ")
    assert origin.command.endswith(
        "--input u --output y --time t --family pi --plays 2 --delay 0 -o out"
    )
    assert origin.options == {"family": "pi", "plays": 2, "delay": 0}
    record = hyst.read_record(record_file, input="u", output="y", time="t")
    assert origin.data_sha256 == data_hash([record])
    numbers = json.loads((folder / "out" / "metrics.json").read_text())
    assert about.errors["training"]["rms"] == numbers["metrics"]["training"]["rms"]
    shown = " ".join(run("info", "out/model.json").out.split())
    for part in (
        "Errors when it was identified",
        "training",
        "rms [um]",
        "Origin",
        "hyst identify",
    ):
        assert part in shown
    for part in (origin.date, f"hyst {hyst.__version__}", "plays 2", origin.data_sha256[:16]):
        assert part in shown


def test_a_run_in_python_after_a_command_names_none(run: Run, record_file: Path) -> None:
    run("identify", record_file, *COLUMNS, *QUICK, "-o", "out")
    record = hyst.read_record(record_file, input="u", output="y", time="t")
    origin = hyst.identify(record, family="pi", plays=2).description.provenance
    assert origin is not None
    assert origin.command == ""


def test_an_adapted_model_has_an_origin_of_its_own(
    run: Run, record_file: Path, folder: Path
) -> None:
    run("identify", record_file, *COLUMNS, *QUICK, "-o", "out")
    ended = run("adapt", "out/model.json", record_file, *COLUMNS, "-o", "on", "--memory", 5)
    assert ended.code == 0, ended.err
    about = hyst.load(folder / "on" / "model.json").description
    assert about == hyst.load(folder / "on" / "estimator.json").description
    assert about.provenance is not None
    assert about.provenance.command.startswith("hyst adapt out/model.json ")
    assert about.provenance.options["memory"] == 5.0
    assert about.errors == {}  # those of the start would be of other constants
    assert (about.input_unit, about.family) == ("V", "pi")
    shown = run("info", "on/estimator.json").out
    assert "JointEstimator: the model it has found so far is" in shown
    assert "hyst adapt" in shown


def test_info_of_a_controller_and_of_a_model_nobody_identified(run: Run, folder: Path) -> None:
    inverse = STAGE.inverse()
    controller = hyst.control.TrackingController([], [], [], [1.0, -1.0], 0.01, inverse)
    controller.save(folder / "controller.json", describe(STAGE))
    shown = run("info", "controller.json").out
    assert "tracking controller: 0 states, dt 0.01 s, an inverse, as follows" in shown
    assert "drive, 0 to 4 V" in shown
    limited = hyst.control.TrackingController(
        [], [], [], [1.0, -1.0], 0.01, inverse, limits=(-1.5, 2.0), rate=30.0
    )
    limited.save(folder / "limited.json")
    shown = run("info", folder / "limited.json").out
    assert "0 states, dt 0.01 s, drive from -1.5 to 2, at most 30 per second, an inverse" in shown
    hyst.control.TrackingController([], [], [], [1.0, -1.0], 0.01).save(folder / "alone.json")
    assert "no inverse" in run("info", "alone.json").out
    STAGE.save(folder / "model.json")
    shown = run("info", "model.json").out
    assert "Origin" not in shown
    assert "Errors" not in shown


@pytest.mark.parametrize("verb", ["simulate", "compensate", "adapt"])
def test_verbs_of_models_refuse_what_is_none(verb: str, run: Run, folder: Path) -> None:
    hyst.control.TrackingController([], [], [], [1.0, -1.0], 0.01).save(folder / "other.json")
    data = write_csv(folder / "u.csv", "u", drive())
    more = {
        "simulate": ("--input", "u", "-o", "out.csv"),
        "compensate": ("--column", "u", "-o", "out.csv"),
        "adapt": ("--input", "u", "--output", "u", "--rate", 100, "-o", "out"),
    }[verb]
    ended = run(verb, "other.json", data, *more)
    assert ended.code == 2
    assert "other.json holds a TrackingController" in ended.err
