"""The verb export for simulation tools and for MATLAB and Octave."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import fmpy
import pytest
from command_runs import STAGE, Run, describe, snapshot
from fmpy.validation import validate_fmu

from hyst.export import fmu, mex, rust


@pytest.fixture
def model_file(folder: Path) -> Path:
    STAGE.save(folder / "model.json", describe(STAGE))
    return folder / "model.json"


def test_an_fmu_is_what_python_writes(run: Run, folder: Path, model_file: Path) -> None:
    ended = run("export", model_file, "--target", "fmu", "--no-binary", "-o", "a.fmu")
    assert ended.code == 0
    assert "2.0, co-simulation" in ended.out
    assert "u -> y; fault" in ended.out
    written = fmu(STAGE, folder / "b.fmu", description=describe(STAGE), binary=False)
    assert (folder / "a.fmu").read_bytes() == written.path.read_bytes()


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler cc")
def test_an_fmu_of_an_inverse_in_a_folder(run: Run, folder: Path, model_file: Path) -> None:
    options = ("--inverse", "--target", "fmu", "--fmi", "3.0", "--name", "lens")
    (folder / "out").mkdir()
    ended = run("export", model_file, *options, "-o", "out")
    assert ended.code == 0
    assert "binaries/" in ended.out
    path = str(folder / "out" / "lens.fmu")
    assert validate_fmu(path) == []
    units = {each.name: each.unit for each in fmpy.read_model_description(path).modelVariables}
    assert (units["u"], units["y"]) == ("um", "V")  # changed places, as the signals have


def test_a_mex_function_is_what_python_writes(run: Run, folder: Path, model_file: Path) -> None:
    ended = run("export", model_file, "--target", "mex", "--name", "lens", "-o", "out")
    assert ended.code == 0
    written = mex(STAGE, folder / "python", name="lens", description=describe(STAGE))
    assert snapshot(folder / "out") == snapshot(written.path)


def test_a_rust_crate_is_what_python_writes(run: Run, folder: Path, model_file: Path) -> None:
    options = ("--target", "rust", "--precision", "single", "--name", "lens", "-o", "out")
    ended = run("export", model_file, *options)
    assert ended.code == 0
    assert "cargo test" in ended.out
    about = describe(STAGE)
    written = rust(STAGE, folder / "python", precision="single", name="lens", description=about)
    assert snapshot(folder / "out") == snapshot(written.path)


@pytest.mark.skipif(shutil.which("mkoctfile") is None, reason="mkoctfile is not installed")
def test_the_command_that_mex_prints_compiles(run: Run, folder: Path, model_file: Path) -> None:
    ended = run("export", model_file, "--target", "mex", "-o", "stage.zip")
    command = ended.out.split("next: ")[1].split(",")[0]
    assert command.startswith("unzip ")
    subprocess.run(command, shell=True, cwd=folder, check=True, capture_output=True)
    assert (folder / "stage" / "stage_mex.mex").is_file()


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("--target", "fmu", "--precision", "single", "-o", "a.fmu"), "--precision is for"),
        (("--target", "mex", "--fmi", "3.0", "-o", "out"), "--fmi is for --target fmu"),
        (("--target", "mex", "--name", "end", "-o", "out"), "MATLAB or Octave"),
        (("--target", "fmu", "--fmi", "1.0", "-o", "a.fmu"), "2.0 or 3.0"),
        (("--target", "fmu", "-o", "nowhere"), "nowhere is no folder"),
        (("--target", "ada", "-o", "out"), "c or fmu or mex"),
        (("--target", "rust", "--layout", "flat", "-o", "out"), "--layout is for --target c"),
        (("--target", "rust", "--name", "match", "-o", "out"), "a word of Rust"),
    ],
)
def test_refusals(
    arguments: tuple[str, ...], reason: str, run: Run, folder: Path, model_file: Path
) -> None:
    ended = run("export", model_file, *arguments)
    assert ended.code == 2
    assert reason in ended.err
    assert {each.name for each in folder.iterdir()} == {"model.json"}
