"""Folders and zips: whole or not at all, the same bytes every time, nothing else destroyed."""

from __future__ import annotations

import errno
import hashlib
import json
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from c_builds import Exported, Objects, build_library, compiler, run_selftest

import hyst
from hyst import InputError, PrandtlIshlinskii
from hyst.export import c_project, mex
from reference.examples import EXAMPLES

MODEL = PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0)
OTHER = PrandtlIshlinskii([0.5, 0.2], [0.1, 0.4], 1.0)


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def test_the_same_model_gives_the_same_bytes(tmp_path: Path) -> None:
    first = c_project(EXAMPLES["composition with names inside"], tmp_path / "a")
    second = c_project(EXAMPLES["composition with names inside"], tmp_path / "b")
    assert contents(first.path) == contents(second.path)
    assert tuple(sorted(contents(first.path))) == first.files
    for name in ("a.zip", "b.zip"):
        c_project(MODEL, tmp_path / name)
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()


def test_the_order_of_hashes_does_not_matter(tmp_path: Path) -> None:
    program = (
        "import sys, hyst; from hyst.export import c_project\n"
        "m = hyst.PrandtlIshlinskii([0.5], [0.1], 1.0) @ hyst.DeadZone([1.0, 0.5], [0.0, 1.0])\n"
        "c_project(m, sys.argv[1])\n"
    )
    for seed in ("1", "2"):
        subprocess.run(
            [sys.executable, "-c", program, str(tmp_path / seed)],
            env={"PYTHONHASHSEED": seed, "PATH": "", "PYTHONPATH": ":".join(sys.path)},
            check=True,
        )
    assert contents(tmp_path / "1") == contents(tmp_path / "2")


def test_a_zip_holds_what_the_folder_holds(tmp_path: Path) -> None:
    folder = c_project(MODEL, tmp_path / "out", name="lens")
    zipped = c_project(MODEL, tmp_path / "out.zip", name="lens")
    assert zipped.files == folder.files
    with zipfile.ZipFile(zipped.path) as archive:
        archive.extractall(tmp_path / "unpacked")
    assert [each.name for each in (tmp_path / "unpacked").iterdir()] == ["lens"]
    assert contents(tmp_path / "unpacked" / "lens") == contents(folder.path)


def test_one_command_builds_and_tests_a_zip(tmp_path: Path) -> None:
    """The command of the README, copied out of it."""
    c_project(MODEL.inverse(), tmp_path / "stage.zip")
    with zipfile.ZipFile(tmp_path / "stage.zip") as archive:
        archive.extractall(tmp_path)
    compiler("cc")
    readme = (tmp_path / "stage" / "README.md").read_text().splitlines()
    command = next(line for line in readme if line.startswith("cc ") and "_test && " in line)
    finished = subprocess.run(
        command, shell=True, cwd=tmp_path / "stage", capture_output=True, text=True, check=True
    )
    assert finished.stdout == "10000 samples, max difference 0\n"


def test_cmake_builds_library_and_self_test(tmp_path: Path) -> None:
    cmake = compiler("cmake")
    project = c_project(MODEL, tmp_path / "out", precision="single", name="lens")
    for command in (["-S", ".", "-B", "build"], ["--build", "build"]):
        finished = subprocess.run(
            [cmake, *command], cwd=project.path, capture_output=True, text=True, check=False
        )
        assert finished.returncode == 0, finished.stderr
    assert list((project.path / "build").glob("liblens.a"))
    finished = subprocess.run(
        [str(project.path / "build" / "lens_selftest")], capture_output=True, text=True, check=True
    )
    assert finished.stdout == "10000 samples, max difference 0\n"


def test_the_manifest_holds_the_hash_of_every_file(tmp_path: Path) -> None:
    project = c_project(MODEL, tmp_path / "out", precision="single")
    manifest = json.loads((project.path / "manifest.json").read_text())
    assert manifest["hyst"] == hyst.__version__
    assert (manifest["name"], manifest["precision"]) == ("stage", "single")
    assert set(manifest["files"]) == set(project.files) - {"manifest.json"}
    for file, digest in manifest["files"].items():
        assert hashlib.sha256((project.path / file).read_bytes()).hexdigest() == digest
    text = json.dumps(MODEL.to_dict(), sort_keys=True, separators=(",", ":"))
    assert manifest["model"]["sha256"] == hashlib.sha256(text.encode()).hexdigest()


def test_what_exists_is_refused(tmp_path: Path) -> None:
    for name in ("out", "out.zip"):
        c_project(MODEL, tmp_path / name)
        with pytest.raises(InputError, match="exists"):
            c_project(OTHER, tmp_path / name)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="exists"):
        c_project(MODEL, tmp_path / "empty")


def test_force_replaces_an_earlier_export_as_a_whole(tmp_path: Path) -> None:
    out = c_project(MODEL, tmp_path / "out", name="before").path
    c_project(OTHER, out, force=True)
    assert contents(out) == contents(c_project(OTHER, tmp_path / "fresh").path)
    (tmp_path / "empty").mkdir()
    c_project(OTHER, tmp_path / "empty", force=True)
    c_project(MODEL, tmp_path / "a.zip")
    c_project(OTHER, tmp_path / "a.zip", force=True)
    c_project(OTHER, tmp_path / "b.zip", force=True)
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()


def test_force_keeps_what_no_export_wrote(tmp_path: Path) -> None:
    out = c_project(MODEL, tmp_path / "out", name="before").path
    (out / "build").mkdir()
    (out / "build" / "before.o").write_text("object")
    (out / "example.c").write_text("mine")
    c_project(OTHER, out, force=True)
    own = {"build/before.o": b"object", "example.c": b"mine"}
    assert contents(out) == contents(c_project(OTHER, tmp_path / "fresh").path) | own
    before = contents(out)
    (out / "other.h").write_text("mine, too")
    with pytest.raises(InputError, match=r"other\.h is no file of the earlier export"):
        c_project(OTHER, out, name="other", force=True)
    assert contents(out) == before | {"other.h": b"mine, too"}


def test_force_does_not_replace_what_is_no_export(tmp_path: Path) -> None:
    photos = tmp_path / "photos"
    photos.mkdir()
    (photos / "cat.jpg").write_text("cat")
    (tmp_path / "link").symlink_to(photos)
    (tmp_path / "thesis.zip").write_text("no zip")
    with zipfile.ZipFile(tmp_path / "other.zip", "w") as archive:
        archive.writestr("manifest.json", "{}")
    own = c_project(MODEL, tmp_path / "own").path
    (tmp_path / "link to own").symlink_to(own)
    before = contents(tmp_path)
    for name in ("photos", "link", "link to own", "thesis.zip", "other.zip", "photos/cat.jpg"):
        with pytest.raises(InputError, match="not an earlier export"):
            c_project(MODEL, tmp_path / name, force=True)
    (photos / "manifest.json").write_text('{"format": "something else"}')
    with pytest.raises(InputError, match="not an earlier export"):
        c_project(MODEL, photos, force=True)
    (photos / "manifest.json").unlink()
    assert contents(tmp_path) == before


def test_folders_on_the_way_are_made_and_a_file_there_is_named(tmp_path: Path) -> None:
    assert (c_project(MODEL, tmp_path / "results" / "deep" / "out").path / "manifest.json").exists()
    assert c_project(MODEL, tmp_path / "zips" / "out.zip").path.is_file()
    (tmp_path / "notes").write_text("")
    with pytest.raises(InputError, match="notes is a file"):
        c_project(MODEL, tmp_path / "notes" / "out")


def test_a_folder_that_refuses_is_named_and_no_temporary_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refusing(*_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", str(tmp_path / ".hyst-abc"))

    monkeypatch.setattr("tempfile.mkdtemp", refusing)
    for name in ("out", "out.zip"):
        with pytest.raises(InputError, match=rf"{name} cannot be written: Permission denied;"):
            c_project(MODEL, tmp_path / name)


def test_a_c_project_is_no_fmu(tmp_path: Path) -> None:
    for write in (c_project, mex):
        with pytest.raises(InputError, match="the name of an FMU"):
            write(MODEL, tmp_path / "out.fmu")
    assert not list(tmp_path.iterdir())


def test_a_failure_leaves_the_earlier_export(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = c_project(MODEL, tmp_path / "out").path
    before = contents(out)
    rename = Path.rename

    def failing(self: Path, target: Path) -> Path:
        if self.name == "new":
            raise OSError("disk on fire")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", failing)
    with pytest.raises(InputError, match="cannot be written: disk on fire"):
        c_project(OTHER, out, force=True)
    monkeypatch.undo()
    assert contents(out) == before
    assert [each.name for each in tmp_path.iterdir()] == ["out"]


def test_a_model_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="single precision"):
        c_project(PrandtlIshlinskii([1e300], [1.0]), tmp_path / "out", precision="single")
    assert not list(tmp_path.iterdir())


def test_the_self_test_finds_a_constant_that_was_changed(tmp_path: Path, objects: Objects) -> None:
    project = c_project(MODEL, tmp_path / "out")
    source = project.path / "stage.c"
    text = source.read_text()
    assert text.count("0x1.3333333333333p-2") == 1  # 0.3
    source.write_text(text.replace("0x1.3333333333333p-2", "0x1.3333333333334p-2"))
    finished = run_selftest(project.path, objects)
    assert finished.returncode == 1
    assert "failed: the same numbers as in Python" in finished.stdout
    assert "max difference 0\n" not in finished.stdout


def test_states_of_another_model_and_damaged_ones_are_refused(
    tmp_path: Path, objects: Objects
) -> None:
    made = {}
    for name, model in (("mine", MODEL), ("other", OTHER)):
        project = c_project(model, tmp_path / name)
        library = build_library(project.path, objects)
        made[name] = Exported(library, project.state_length, project.saved_bytes)
    mine, other = made["mine"], made["other"]
    state = mine.initial_state()
    for u in (1.0, -0.25, float("nan")):
        mine.step(state, u)
    saved = mine.save(state)
    assert other.load(other.initial_state(), saved) != 0
    target = mine.initial_state()
    before = bytes(target)
    for place in range(len(saved)):
        for bit in (0x01, 0x80):
            damaged = bytearray(saved)
            damaged[place] ^= bit
            assert mine.load(target, damaged) != 0
            assert bytes(target) == before
    assert mine.load(target, saved) == 0
    assert bytes(target) == bytes(state)


def test_a_step_before_init_gives_zero_and_a_fault(tmp_path: Path, objects: Objects) -> None:
    project = c_project(MODEL, tmp_path / "out")
    code = Exported(build_library(project.path, objects), project.state_length, project.saved_bytes)
    state = code.unset_state()
    state.y_last = 7.0
    state.fault = 0x12345678
    assert code.step(state, 1.0) == 0.0
    assert code.fault(state) == 2
    code.clear_fault(state)
    assert code.fault(state) == 0
    assert code.step(state, 1.0) == 0.0  # clearing the fault makes it no readier


def test_sampled_models_say_their_sample_time(tmp_path: Path) -> None:
    for precision, literal in (("double", "0.1"), ("single", "0.1f")):
        project = c_project(EXAMPLES["rate-dependent"], tmp_path / precision, precision=precision)
        header = (project.path / "stage.h").read_text()
        assert f"#define STAGE_DT {literal} /* seconds" in header
        assert "0.1 s, and no other" in (project.path / "README.md").read_text()
    free = c_project(MODEL, tmp_path / "free")
    assert "STAGE_DT" not in (free.path / "stage.h").read_text()
