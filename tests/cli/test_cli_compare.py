"""hyst compare: model files and a record give tables, a page, and the file to take."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_runs import STAGE, Run, describe, drive, snapshot, write_csv

import hyst
from hyst.operators import Affine, Verdict

COLUMNS = ("--input", "u", "--output", "y", "--time", "t")
LINE = Affine(1.6, 1.5)


@pytest.fixture
def fresh(folder: Path) -> Path:
    """A record that no model has seen: another drive, the stage two samples late."""
    u = np.concatenate([np.zeros(20), drive(900)])
    y = np.roll(STAGE(u), 2) + np.random.default_rng(5).normal(0.0, 1e-3, u.size)
    return write_csv(folder / "fresh.csv", "t [s],u [V],y [um]", np.arange(u.size) * 0.01, u, y)


@pytest.fixture
def models(folder: Path) -> tuple[Path, Path]:
    """The stage itself and a line, each a model.json in a folder of its own."""
    paths = folder / "plays" / "model.json", folder / "line" / "model.json"
    for path, model in zip(paths, (STAGE, LINE), strict=True):
        path.parent.mkdir()
        family = {"plays": "pi", "line": "linear"}[path.parent.name]
        model.save(path, describe(model, family=family))
    return paths


def test_tables_and_files(run: Run, models: tuple[Path, Path], fresh: Path, folder: Path) -> None:
    ended = run("compare", *models, fresh, *COLUMNS, "-o", "out", "--copy-best", "best.json")
    assert ended.code == 0, ended
    assert ended.out.startswith("Best overall: plays misses by 0.00")
    assert "Take plays: nothing simpler is as good." in ended.out
    rows = {
        line.split()[0]: line.split() for line in ended.out.splitlines() if line.startswith("  ")
    }
    assert rows["plays"][1:4] == ["pi", "7", "2"]
    assert rows["line"][1:4] == ["linear", "2", "2"]
    names = {path.name for path in (folder / "out").iterdir()}
    pictures = {"loops.png", "errors.png"}
    assert names == {"comparison.json", "comparison.html", "model.json"} | pictures
    taken = hyst.load(folder / "out" / "model.json")
    assert taken == STAGE
    assert taken.description == hyst.load(models[0]).description
    assert (folder / "best.json").read_bytes() == models[0].read_bytes()
    numbers = json.loads((folder / "out" / "comparison.json").read_text())
    record = hyst.read_record(fresh, input="u", output="y", time="t")
    by_hand = np.roll(STAGE(record.u), 2) - record.y
    used = numbers["used_samples"][0]
    rms = float(np.sqrt(np.mean(by_hand[used["start"] : used["stop"]] ** 2)))
    assert numbers["models"][0]["metrics"]["rms"] == pytest.approx(rms, rel=1e-9)
    assert numbers["files"]["line"] == str(models[1])
    page = (folder / "out" / "comparison.html").read_text()
    assert page.count("<figure>") == 2
    assert "not judged" in page
    assert '<tr class="marked"><td>plays</td>' in page


def test_numbers_as_json(run: Run, models: tuple[Path, Path], fresh: Path) -> None:
    ended = run("compare", *models, fresh, *COLUMNS, "--json")
    assert ended.code == 0
    told = json.loads(ended.out)
    assert [each["name"] for each in told["models"]] == ["plays", "line"]
    assert told["chosen"] == told["for_commands"] == "plays"


def test_one_model_alone_is_told(run: Run, models: tuple[Path, Path], fresh: Path) -> None:
    ended = run("compare", models[0], fresh, *COLUMNS)
    assert ended.code == 0
    assert "One model alone" in ended.out
    assert "\n  model  " in ended.out  # called by its file


def test_files_of_one_name_are_told_apart_by_their_path(
    run: Run, folder: Path, fresh: Path
) -> None:
    places = ["a/x/plays.json", "b/x/plays.json", "b/line.json"]
    for place in places:
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        STAGE.save(folder / place, describe(STAGE))
    told = json.loads(run("compare", *places, fresh, *COLUMNS, "--json").out)
    assert [each["name"] for each in told["models"]] == ["a/x/plays", "b/x/plays", "line"]


def test_an_identified_model_on_its_own_record_is_warned_of(
    run: Run, record_file: Path, fresh: Path
) -> None:
    assert run("identify", record_file, *COLUMNS, "--family", "linear", "-o", "found").code in (
        0,
        3,
    )
    own = run("compare", "found/model.json", record_file, *COLUMNS)
    assert own.out.startswith("Warning: model was identified from this very record")
    assert "Warning" not in run("compare", "found/model.json", fresh, *COLUMNS).out


def test_a_model_saved_as_unfit_ends_with_3_and_is_not_copied(
    run: Run, folder: Path, fresh: Path
) -> None:
    STAGE.save("bad.json", describe(STAGE, verdict=Verdict("unfit", ("It describes nothing.",))))
    ended = run("compare", "bad.json", fresh, *COLUMNS, "--copy-best", "best.json")
    assert ended.code == 3
    assert "It is unfit, by the verdict it was saved with (It describes nothing)" in ended.out
    assert "no model was copied" in ended.err
    assert not (folder / "best.json").exists()


def test_what_cannot_be_compared_is_refused(
    refused: Callable[..., str], models: tuple[Path, Path], fresh: Path, folder: Path
) -> None:
    plays, line = models
    (folder / "no_model.json").write_text('{"a": 1}')
    assert "no_model.json" in refused("compare", plays, "no_model.json", fresh, *COLUMNS)
    assert "missing.json" in refused("compare", "missing.json", fresh, *COLUMNS)
    assert "is given twice" in refused("compare", plays, "./plays/model.json", fresh, *COLUMNS)
    assert "has no column" in refused(
        "compare", *models, fresh, "--input", "u", "--output", "force", "--time", "t"
    )
    lag = hyst.LinearDynamics.from_transfer_function([0.2], [1.0, -0.8], dt=2e-3)
    lag.save(folder / "lag.json")
    told = refused("compare", line, "lag.json", fresh, *COLUMNS)
    assert "record 1, for lag, has dt = 0.01 s, the model 0.002 s" in told
    told = refused("compare", *models, fresh, *COLUMNS, "--output-label", "force [N]")
    assert "is in 'N' but that of plays in 'um'" in told
    told = refused("compare", fresh, *COLUMNS)
    assert "Missing argument 'MODEL': give model files, or --family with --training" in told
    assert "Missing argument" in refused("compare")


def test_an_output_that_is_an_input_is_refused(
    refused: Callable[..., str], models: tuple[Path, Path], fresh: Path, folder: Path
) -> None:
    for copy in (models[1], fresh, "plays/../line/model.json"):
        told = refused("compare", *models, fresh, *COLUMNS, "--copy-best", copy)
        assert "is one of the files to read" in told
    inside = folder / "out" / "comparison.json"
    inside.parent.mkdir()
    STAGE.save(inside, describe(STAGE))
    told = refused("compare", inside, models[0], fresh, *COLUMNS, "-o", "out", "--force")
    assert "is one of the files to read" in told
    told = refused("compare", *models, fresh, *COLUMNS, "-o", "o", "--copy-best", "o/loops.png")
    assert "is a file of the report" in told


def test_a_controller_is_no_model(run: Run, folder: Path, fresh: Path) -> None:
    hyst.control.TrackingController([], [], [], [1.0, -1.0], 0.01).save(folder / "other.json")
    before = snapshot(folder)
    ended = run("compare", "other.json", fresh, *COLUMNS, "-o", "out")
    assert ended.code == 2
    assert "other.json holds a TrackingController" in ended.err
    assert snapshot(folder) == before


def test_families_are_identified_and_compared_with_files(
    run: Run, models: tuple[Path, Path], record_file: Path, fresh: Path, folder: Path
) -> None:
    ended = run(
        "compare", models[1], fresh, *COLUMNS, "--family", "pi,linear", "--training", record_file,
        "-o", "out", "--copy-best", "best.json",
    )  # fmt: skip
    assert ended.code == 0, ended
    numbers = json.loads((folder / "out" / "comparison.json").read_text())
    assert [each["name"] for each in numbers["models"]] == ["model", "linear", "pi"]
    # The stage is of plays, so a line misses it by more than its noise of 0.001.
    assert numbers["chosen"] == "pi"
    by_hand = hyst.identify(hyst.read_record(record_file, "u", "y", time="t"), family="pi")
    for name in ("out/pi.json", "out/model.json", "best.json"):
        assert hyst.load(folder / name) == by_hand.model
    assert hyst.load(folder / "out" / "linear.json").description.family == "linear"


def test_families_alone_need_no_file_and_one_that_fails_is_told(
    run: Run, record_file: Path, fresh: Path
) -> None:
    ended = run(
        "compare", fresh, *COLUMNS, "--family", "linear,butterfly,pi", "--training", record_file,
        "--json",
    )  # fmt: skip
    assert ended.code == 0, ended
    names = [each["name"] for each in json.loads(ended.out)["models"]]
    assert names[0] == "linear"
    assert names[-1] == "pi"
    assert ("butterfly" in names) != ("no model of the family butterfly: " in ended.err)


def test_families_without_records_of_their_own_are_refused(
    refused: Callable[..., str], models: tuple[Path, Path], fresh: Path, record_file: Path
) -> None:
    told = refused("compare", models[0], fresh, *COLUMNS, "--family", "pi")
    assert "--family needs --training, a record to identify from" in told
    told = refused("compare", models[0], fresh, *COLUMNS, "--training", record_file)
    assert "--training is to identify from; give --family too" in told
    told = refused("compare", fresh, *COLUMNS, "--family", "pie", "--training", record_file)
    assert "unknown family 'pie'" in told
    told = refused(
        "compare", fresh, *COLUMNS, "--family", "pi", "--training", "out/pi.json", "-o", "out"
    )
    assert "is one of the files to read" in told


def test_a_model_of_before_is_told_of_where_none_is_taken(
    run: Run, folder: Path, fresh: Path
) -> None:
    STAGE.save("bad.json", describe(STAGE, verdict=Verdict("unfit", ("It describes nothing.",))))
    (folder / "out").mkdir()
    LINE.save(folder / "out" / "model.json")
    ended = run("compare", "bad.json", fresh, *COLUMNS, "-o", "out", "--force")
    assert ended.code == 3
    assert "model.json was there before: every model is unfit" in ended.err
    assert hyst.load(folder / "out" / "model.json") == LINE
