"""An export added to a folder: its own files, whole or not at all, and nothing else is touched."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hyst import InputError, PrandtlIshlinskii
from hyst.export import c_project
from hyst.models import Dahl

MODEL = PrandtlIshlinskii([0.5, 0.2], [0.1, 0.3], 1.0)
OTHER = PrandtlIshlinskii([0.5, 0.2], [0.1, 0.4], 1.0)
WITH_ANOTHER_CORE = Dahl(sigma=2.0, Fc=1.0)
LAYOUTS = [("flat", False), ("flat", True), ("single-file", False), ("folder", True)]


def contents(folder: Path) -> dict[str, bytes]:
    return {
        each.relative_to(folder).as_posix(): each.read_bytes()
        for each in folder.rglob("*")
        if each.is_file()
    }


def library(folder: Path) -> dict[str, bytes]:
    """A folder with files of the user's."""
    (folder / "extras").mkdir(parents=True)
    (folder / "Motor.cpp").write_text("int motor;\n")
    (folder / "README.md").write_text("My motor.\n")
    (folder / "extras" / "notes.txt").write_text("Mine.\n")
    return contents(folder)


@pytest.mark.parametrize(("layout", "shared_core"), LAYOUTS)
def test_exports_and_files_of_the_user_s_lie_side_by_side(
    layout: str, shared_core: bool, tmp_path: Path
) -> None:
    options = {"layout": layout, "shared_core": shared_core}
    users = library(tmp_path / "out")
    first = c_project(MODEL, tmp_path / "out", name="lens", **options)
    before = contents(tmp_path / "out")
    assert users.items() < before.items()
    second = c_project(OTHER, tmp_path / "out", name="mirror", precision="single", **options)
    after = contents(tmp_path / "out")
    assert before.items() < after.items()
    assert set(after) == {*users, *first.files, *second.files}
    assert not set(first.files) & set(second.files)
    alone = c_project(MODEL, tmp_path / "alone", name="lens", **options)
    assert contents(alone.path).items() <= after.items()
    for file in (*first.files, *second.files):
        assert Path(file).name.startswith(("lens", "mirror", "hyst_", "hystf_")), file


@pytest.mark.parametrize(("layout", "shared_core"), LAYOUTS)
def test_only_its_own_earlier_export_is_replaced(
    layout: str, shared_core: bool, tmp_path: Path
) -> None:
    options = {"layout": layout, "shared_core": shared_core}
    library(tmp_path / "out")
    c_project(WITH_ANOTHER_CORE, tmp_path / "out", name="lens", **options)
    c_project(OTHER, tmp_path / "out", name="mirror", **options)
    before = contents(tmp_path / "out")
    with pytest.raises(InputError, match=r"has an export named lens; .* --force"):
        c_project(MODEL, tmp_path / "out", name="lens", **options)
    assert contents(tmp_path / "out") == before
    c_project(MODEL, tmp_path / "out", name="lens", force=True, **options)
    fresh = tmp_path / "fresh"
    library(fresh)
    c_project(OTHER, fresh, name="mirror", **options)
    c_project(MODEL, fresh, name="lens", **options)
    assert contents(tmp_path / "out") == contents(fresh)


def test_a_core_that_another_export_needs_stays(tmp_path: Path) -> None:
    shared = {"layout": "flat", "shared_core": True}
    c_project(MODEL, tmp_path, name="lens", **shared)
    c_project(WITH_ANOTHER_CORE, tmp_path, name="mirror", **shared)
    c_project(WITH_ANOTHER_CORE, tmp_path, name="lens", force=True, **shared)
    assert not (tmp_path / "hyst_prandtl_ishlinskii.c").exists()
    assert (tmp_path / "hyst_dahl.c").exists()
    c_project(MODEL, tmp_path, name="mirror", force=True, **shared)
    assert (tmp_path / "hyst_dahl.c").exists()


def refusal(folder: Path, **options: object) -> str:
    """Give why an export is refused, which leaves the folder as it was."""
    before = contents(folder)
    with pytest.raises(InputError) as refused:
        c_project(MODEL, folder, **{"name": "lens", "layout": "flat", **options})
    assert contents(folder) == before
    return str(refused.value)


def test_what_would_be_overwritten_is_named(tmp_path: Path) -> None:
    (tmp_path / "lens.h").write_text("int mine;\n")
    assert "lens.h exists and is of no export" in refusal(tmp_path)
    assert "lens.h exists and is of no export" in refusal(tmp_path, force=True)
    (tmp_path / "lens.h").unlink()
    (tmp_path / "extras").write_text("a file where the self-test's folder would be")
    assert "extras is a file" in refusal(tmp_path)


def test_a_shared_core_of_another_version_is_named(tmp_path: Path) -> None:
    shared = {"layout": "flat", "shared_core": True}
    c_project(OTHER, tmp_path, name="mirror", **shared)
    core = tmp_path / "hyst_play.h"
    core.write_text(core.read_text().replace("Play", "An earlier play"))
    assert "hyst_play.h is also of the export mirror" in refusal(tmp_path, **shared)
    core.write_text(core.read_text() + "\n")
    assert "hyst_play.h is also of the export mirror" in refusal(tmp_path, force=True, **shared)


def test_names_that_differ_in_capitals_alone_are_refused(tmp_path: Path) -> None:
    c_project(OTHER, tmp_path, name="Lens", layout="flat")
    assert "an export named Lens" in refusal(tmp_path)


def test_the_folder_of_one_export_is_not_added_to(tmp_path: Path) -> None:
    out = c_project(MODEL, tmp_path / "out", name="lens").path
    assert "is the folder of one export" in refusal(out, name="mirror")
    assert "is the folder of one export" in refusal(out, force=True)
    shared = c_project(MODEL, tmp_path / "flat", name="lens", layout="flat").path
    before = contents(shared)
    with pytest.raises(InputError, match="not an earlier export"):
        c_project(MODEL, shared, name="lens", force=True)
    assert contents(shared) == before


def test_a_manifest_that_leads_out_of_the_folder_removes_nothing(tmp_path: Path) -> None:
    out = c_project(MODEL, tmp_path / "out", name="lens", layout="flat").path
    (tmp_path / "thesis.txt").write_text("mine")
    manifest = out / "lens_manifest.json"
    content = json.loads(manifest.read_text())
    content["files"] |= {"../thesis.txt": "", str(tmp_path / "thesis.txt"): ""}
    manifest.write_text(json.dumps(content))
    c_project(OTHER, out, name="lens", layout="flat", force=True)
    assert (tmp_path / "thesis.txt").read_text() == "mine"


def test_a_failure_half_way_leaves_the_folder_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    library(tmp_path / "out")
    c_project(WITH_ANOTHER_CORE, tmp_path / "out", name="lens", layout="flat")
    before = contents(tmp_path / "out")
    rename = Path.rename

    def failing(self: Path, target: Path) -> Path:
        if self.parent.name == "new" and self.name == "lens_manifest.json":
            raise OSError("disk on fire")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", failing)
    with pytest.raises(InputError, match="cannot be written: disk on fire"):
        c_project(MODEL, tmp_path / "out", name="lens", layout="flat", force=True)
    monkeypatch.undo()
    assert contents(tmp_path / "out") == before
    assert not list((tmp_path / "out").glob(".hyst*"))


@pytest.mark.parametrize(("layout", "shared_core"), LAYOUTS)
def test_a_zip_holds_what_a_new_folder_holds(
    layout: str, shared_core: bool, tmp_path: Path
) -> None:
    options = {"name": "lens", "layout": layout, "shared_core": shared_core}
    folder = c_project(MODEL, tmp_path / "out", **options)
    zipped = c_project(MODEL, tmp_path / "out.zip", **options)
    assert zipped.files == folder.files == tuple(sorted(contents(folder.path)))
    with pytest.raises(InputError, match="exists"):
        c_project(MODEL, tmp_path / "out.zip", **options)
    c_project(MODEL, tmp_path / "out.zip", force=True, **options)


@pytest.mark.parametrize("layout", ["", "Flat", "single", None])
def test_other_layouts_are_refused(layout: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="give folder, flat, single-file"):
        c_project(MODEL, tmp_path / "out", layout=layout)
    assert not list(tmp_path.iterdir())


def test_a_single_file_shares_no_core(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has the core within it"):
        c_project(MODEL, tmp_path / "out", layout="single-file", shared_core=True)
    assert not list(tmp_path.iterdir())


def test_a_name_that_no_file_system_takes_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        c_project(MODEL, tmp_path / ("x" * 300), layout="flat")
    assert not list(tmp_path.iterdir())
