"""The verb export: folders and zips that compile, and refusals in one sentence."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from command_runs import STAGE, Run, describe, snapshot

from hyst import RateDependentPrandtlIshlinskii
from hyst.control import TrackingController
from hyst.export import c_project, explicit_inverse

RATE_DEPENDENT = RateDependentPrandtlIshlinskii([0.5, 0.3], [0.1, 0.4], 0.01, 0.001, 1.0)


@pytest.fixture
def model_file(folder: Path) -> Path:
    STAGE.save(folder / "model.json", describe(STAGE))
    return folder / "model.json"


def test_writes_what_python_writes(run: Run, folder: Path, model_file: Path) -> None:
    ended = run("export", model_file, "--inverse", "-o", "out", "--name", "lens")
    assert ended.code == 0
    assert "inverse of model.json as c: out" in ended.out
    assert "bytes, 3 numbers of memory" in ended.out  # two plays and the last drive
    assert "next: cd out && cmake" in ended.out
    header = (folder / "out" / "lens.h").read_text()
    # Input and output have changed places with their names and units.
    assert "u: stroke in um" in header
    assert "y: drive in V" in header
    run("export", model_file, "-o", "forward", "--name", "lens")
    about = describe(STAGE)
    python = c_project(STAGE, folder / "python", name="lens", description=about)
    assert snapshot(folder / "forward") == snapshot(python.path)


def test_a_zip_unpacks_compiles_and_tests_itself(run: Run, folder: Path, model_file: Path) -> None:
    """The command that the verb prints, as it prints it."""
    ended = run("export", model_file, "--inverse", "--precision", "single", "-o", "stage.zip")
    command = ended.out.split("next: ")[1].split(";")[0]
    assert command.startswith("unzip ")
    finished = subprocess.run(
        command, shell=True, cwd=folder, capture_output=True, text=True, check=False
    )
    assert "100% tests passed" in finished.stdout, finished.stderr
    assert "float stage_step(" in (folder / "stage" / "stage.h").read_text()


def test_a_lag_of_the_record_is_said_and_paths_are_quoted(run: Run, folder: Path) -> None:
    STAGE.save(folder / "model.json", replace(describe(STAGE), delay=4, dt=0.005))
    ended = run("export", "model.json", "-o", "my stage")
    assert "lags the model by 4 samples, 20 ms" in ended.out
    assert "next: cd 'my stage' && cmake" in ended.out
    said = "| lag | the recorded output lagged 4 sample(s) of 0.005 s; this code does not |"
    assert said in (folder / "my stage" / "README.md").read_text()
    assert run("export", "model.json", "--target", "mex", "-o", "tool").code == 0
    assert said in (folder / "tool" / "README.md").read_text()


def test_a_folder_that_exists_is_replaced_only_by_force(
    run: Run, folder: Path, model_file: Path
) -> None:
    assert run("export", model_file, "-o", "out").code == 0
    before = snapshot(folder / "out")
    refused = run("export", model_file, "--inverse", "-o", "out")
    assert refused.code == 2
    assert "out exists" in refused.err
    assert "--force" in refused.err
    assert snapshot(folder / "out") == before
    assert run("export", model_file, "--inverse", "-o", "out", "--force").code == 0
    assert snapshot(folder / "out") != before


def test_the_explicit_inverse_of_a_rate_dependent_model(run: Run, folder: Path) -> None:
    RATE_DEPENDENT.save(folder / "model.json")
    refused = run("export", "model.json", "--inverse", "-o", "out")
    assert refused.code == 2
    assert "beta is 0.01" in refused.err
    assert run("export", "model.json", "--explicit", "-o", "out").code == 0
    python = c_project(explicit_inverse(RATE_DEPENDENT), folder / "python")
    for file in ("stage.c", "stage_selftest_vectors.h"):
        assert (folder / "out" / file).read_bytes() == (python.path / file).read_bytes()
    STAGE.save(folder / "stage.json")
    assert "no rate-dependent plays" in run("export", "stage.json", "--explicit", "-o", "x").err


def test_an_inverse_with_preview_says_how_late_it_is(run: Run, folder: Path) -> None:
    RATE_DEPENDENT.save(folder / "model.json")
    done = run("export", "model.json", "--inverse", "--preview", 7, "-o", "out")
    assert done.code == 0, done.err
    assert "the command for sample k - 7" in done.out
    assert "7 samples late" in (folder / "out" / "README.md").read_text()
    python = c_project(RATE_DEPENDENT.inverse(preview=7), folder / "python")
    for file in ("stage.c", "stage_selftest_vectors.h"):
        assert (folder / "out" / file).read_bytes() == (python.path / file).read_bytes()
    assert "add --inverse" in run("export", "model.json", "--preview", 7, "-o", "x").err
    both = run("export", "model.json", "--inverse", "--explicit", "--preview", 7, "-o", "x")
    assert "one of the two" in both.err


def test_a_tracking_controller_is_exported_from_its_file(run: Run, folder: Path) -> None:
    model = TrackingController.from_continuous(([4.0, 8.0], [1.0, 0.0]), dt=1e-3)
    model.save(folder / "loop.json")
    ended = run("export", "loop.json", "-o", "out", "--name", "loop")
    assert ended.code == 0
    assert (
        "loop_step(loop_state *state, double y_ref, double y)"
        in (folder / "out" / "loop.h").read_text()
    )
    assert "no inverse" in run("export", "loop.json", "--inverse", "-o", "x").err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--name", "int"], "a word of C or C++"),
        (["--name", "../x"], "C identifier"),
        (["--precision", "half"], "double or single"),
        (["--target", "cobol"], "--target is 'cobol'"),
        (["-o", "model.json/out"], "is a file"),
    ],
)
def test_bad_arguments_end_in_one_sentence(
    arguments: list[str], said: str, run: Run, folder: Path, model_file: Path
) -> None:
    before = snapshot(folder)
    ended = run("export", model_file, "-o", "out", *arguments)
    assert ended.code == 2
    assert said in ended.err
    assert ended.err.count("\n") == 1
    assert "Traceback" not in ended.err
    assert snapshot(folder) == before


def test_a_file_that_is_no_model_is_refused(run: Run, folder: Path) -> None:
    (folder / "model.json").write_text("{}")
    ended = run("export", "model.json", "-o", "out")
    assert ended.code == 2
    assert "not a model file" in ended.err
    assert run("export", "missing.json", "-o", "out").code == 2


def test_limits_and_start_are_told_in_the_table(run: Run, folder: Path, model_file: Path) -> None:
    by_itself = run("export", model_file, "--inverse", "-o", "auto", "--name", "lens")
    assert "0 to 4 V (the range of the record)" in by_itself.out
    assert "as nothing had ever driven it; or lens_init_after" in by_itself.out
    told = run(
        "export", model_file, "--inverse", "-o", "told", "--limits=-1,3.5", "--rate-limit", "20",
        "--history=3.5,-1,2",
    )  # fmt: skip
    assert "-1 to 3.5 V, at most 20 V per second (as given)" in told.out
    assert "after 3.5, -1, 2; or stage_init_after" in told.out
    python = c_project(
        STAGE.inverse(), folder / "python", limits=(-1.0, 3.5), rate_limit=20.0,
        history=[3.5, -1.0, 2.0], description=describe(STAGE).of_inverse(),
    )  # fmt: skip
    assert snapshot(folder / "told") == snapshot(python.path)
    none = run("export", model_file, "--inverse", "-o", "none", "--limits", "none")
    assert "none: as asked for" in none.out
    STAGE.save(folder / "undescribed.json")
    unknown = run("export", folder / "undescribed.json", "--inverse", "-o", "unknown")
    assert "none: no range of the drive is known" in unknown.out


def test_a_history_can_be_a_column(run: Run, folder: Path, model_file: Path) -> None:
    (folder / "drive.csv").write_text("V\n" + "\n".join(str(k % 5) for k in range(20)) + "\n")
    done = run("export", model_file, "--inverse", "-o", "out", "--history", "drive.csv:V")
    assert "after 0, 1, 2, 3, 4, 0 ... (20 drives)" in done.out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--limits", "4,0"], "give the lowest drive first"),
        (["--limits", "wide"], "--limits is 'wide'; give numbers with commas"),
        (["--limits", "1"], "--limits is '1'; give auto, none, or the lowest and the highest"),
        (["--limits", "0,1,2"], "give auto, none, or the lowest and the highest"),
        (["--rate-limit", "0"], "rate is 0"),
        (["--history", "0,9"], "history has 9, beyond the limits of the drive, 0 to 4"),
        (["--history", "nan"], "history is nan at index 0"),
        (["--history", "first"], "--history is 'first'; give numbers"),
    ],
)
@pytest.mark.parametrize("target", ["c", "mex"])
def test_limits_and_histories_that_cannot_be(
    target: str, arguments: list[str], said: str, run: Run, folder: Path, model_file: Path
) -> None:
    before = snapshot(folder)
    ended = run("export", model_file, "--inverse", "-o", "out", "--target", target, *arguments)
    assert ended.code == 2
    assert said in ended.err
    assert ended.err.count("\n") == 1
    assert snapshot(folder) == before
