"""What every verb does alike: how much it says, options from files, and what it leaves alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from command_runs import Run, snapshot

import hyst
from hyst.cli.console import Told, note, speaking

QUICK = ("--input", "1", "--output", "2", "--time", "0", "--family", "pi", "--plays", "2")


def test_quiet_says_nothing_and_does_the_same(run: Run, record_file: Path, folder: Path) -> None:
    told = run("identify", record_file, *QUICK, "-o", "told")
    silent = run("identify", record_file, *QUICK, "-o", "silent", "-q")
    assert (silent.code, silent.out, silent.err) == (told.code, "", "")
    models = [hyst.load(folder / each / "model.json") for each in ("told", "silent")]
    assert models[0].parameters().values.tolist() == models[1].parameters().values.tolist()


def test_quiet_keeps_errors(run: Run, folder: Path) -> None:
    ended = run("identify", "nowhere.csv", *QUICK, "-o", "out", "--quiet")
    assert ended.code == 2
    assert ended.err.startswith("error: ")


def test_verbose_prints_the_steps(run: Run, record_file: Path) -> None:
    ended = run("identify", record_file, *QUICK, "-o", "out", "-v")
    steps = [line.split("identifying: ")[1] for line in ended.err.splitlines()]
    assert steps[:3] == ["reading", "diagnosis", "delay"]
    assert "final fit: pi with 2 plays" in steps
    seconds = [float(line.split()[0]) for line in ended.err.splitlines()]
    assert seconds == sorted(seconds)


def test_json_is_one_document_with_what_was_told(run: Run, record_file: Path, folder: Path) -> None:
    ended = run("identify", record_file, *QUICK, "-o", "out", "--json")
    told = json.loads(ended.out)
    assert (told["verb"], told["exit_code"]) == ("identify", ended.code)
    assert told["said"][0].startswith("verdict: ")
    assert {Path(each).name for each in told["files"]} == {p.name for p in Path("out").iterdir()}
    titles = {each["title"] for each in told["tables"]}
    assert "Parameters" in titles
    assert told["metrics"] == json.loads((folder / "out" / "metrics.json").read_text())


def test_notes_are_in_the_document(capsys: pytest.CaptureFixture[str]) -> None:
    told = Told()
    with speaking(told=told):
        note("the file has no units")
    with speaking(is_quiet=True):
        note("unheard")
    assert told.collected("")["notes"] == ["the file has no units"]
    assert capsys.readouterr() == ("", "")


def test_options_are_saved_and_taken_again(run: Run, record_file: Path, folder: Path) -> None:
    asked = ("identify", "loop.csv", *QUICK, "--delay", 0, "--leave-disturbances")
    assert run(*asked, "-o", "first", "--save-config", "how.toml").code in (0, 3)
    saved = tomllib.loads((folder / "how.toml").read_text())
    assert saved["verb"] == "identify"
    assert saved["data"] == ["loop.csv"]
    assert (saved["plays"], saved["leave-disturbances"]) == ("2", True)
    again = run("identify", "--config", "how.toml", "-o", "again")
    assert again.code in (0, 3), again.err
    values = [
        hyst.load(folder / each / "model.json").parameters().values.tolist()
        for each in ("first", "again")
    ]
    assert values[0] == values[1]
    # What is typed wins.
    other = run("identify", "--config", "how.toml", "--plays", 3, "-o", "other", "--json")
    rows = json.loads(other.out)["tables"][-1]["rows"]
    assert sum(".r[" in row[0] for row in rows) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("playz = 2", "playz is no option of hyst identify"),
        ('verb = "fit"', "has the options of hyst fit, not of identify"),
        ("plays = {a = 1}", "plays is a table; give a value"),
        ("plays = ", "cannot be read as TOML"),
        ('rate = "fast"', "Invalid value for '--rate'"),
    ],
)
def test_a_file_of_options_that_cannot_be_taken_is_refused(
    run: Run, record_file: Path, folder: Path, text: str, message: str
) -> None:
    (folder / "how.toml").write_text(text)
    before = snapshot(folder)
    ended = run("identify", record_file, *QUICK, "-o", "out", "--config", "how.toml")
    assert ended.code == 2
    assert message in ended.err
    assert snapshot(folder) == before


def test_an_existing_file_is_kept_unless_it_may_go(
    run: Run, model_file: Path, record_file: Path, folder: Path
) -> None:
    (folder / "y.csv").write_text("mine")
    asked = ("simulate", model_file, record_file, "--input", "u", "-o", "y.csv")
    ended = run(*asked)
    assert (ended.code, "y.csv exists; name another" in ended.err) == (2, True)
    assert (folder / "y.csv").read_text() == "mine"
    assert run(*asked, "--force").code == 0
    assert (folder / "y.csv").read_text() != "mine"


@pytest.mark.parametrize("name", ["loop.csv", "link.csv", "hard.csv", "sub/../loop.csv"])
def test_what_is_read_is_never_written(
    run: Run, model_file: Path, record_file: Path, folder: Path, name: str
) -> None:
    (folder / "sub").mkdir()
    (folder / "link.csv").symlink_to(record_file)
    os.link(record_file, folder / "hard.csv")
    before = snapshot(folder)
    ended = run("simulate", model_file, record_file, "--input", "u", "-o", name, "--force")
    assert ended.code == 2
    assert "is one of the files to read; write elsewhere" in ended.err
    assert snapshot(folder) == before


def test_a_model_that_is_read_is_not_replaced_by_its_own_fit(
    run: Run, model_file: Path, record_file: Path, folder: Path
) -> None:
    (folder / "out").mkdir()
    model = model_file.rename(folder / "out" / "model.json")
    before = snapshot(folder)
    columns = ("--input", "u", "--output", "y", "--time", "t")
    ended = run("fit", model, record_file, *columns, "-o", "out", "--force")
    assert ended.code == 2
    assert "model.json is one of the files to read" in ended.err
    assert snapshot(folder) == before


def test_it_runs_as_a_module() -> None:
    ended = subprocess.run(
        [sys.executable, "-m", "hyst", "--version"], capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stdout) == (0, f"hyst {hyst.__version__}\n")


def test_a_shell_is_told_the_verbs_that_begin_so() -> None:
    asked = {"_HYST_COMPLETE": "complete_bash", "COMP_WORDS": "hyst ide", "COMP_CWORD": "1"}
    ended = subprocess.run(
        [sys.executable, "-m", "hyst"],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | asked,
    )
    assert ended.stdout.split() == ["identify"]
