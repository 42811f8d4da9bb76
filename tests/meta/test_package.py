"""What the package says of itself: metadata, extras and versions, and what its source has."""

from __future__ import annotations

import email
import re
import shutil
import tarfile
import tomllib
from email.message import Message
from pathlib import Path
from typing import Any

import pytest

import hyst

backend = pytest.importorskip("scikit_build_core.build")

NOT_SHIPPED = {".ci", ".github", ".gitignore", ".pre-commit-config.yaml"}
JUNK = [
    ".venv/pyvenv.cfg",
    "build/dev/build.ninja",
    "demo/report.html",
    "dist/old.whl",
    "src/hyst/_engine.cpython-311-x86_64-linux-gnu.so",
    "src/hyst/core/SOURCES",
    "src/hyst/__pycache__/errors.cpython-311.pyc",
]
REAL = {"pyproject.toml", "README.md", "LICENSE", ".gitignore"}


@pytest.fixture(scope="module")
def settings(repository: Path) -> dict[str, Any]:
    return tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def shipped(
    repository: Path, tracked_files: list[Path], tmp_path_factory: pytest.TempPathFactory
) -> tuple[set[str], Message]:
    """Names and metadata of the source distribution of a tree of empty files, junk among them."""
    tree = tmp_path_factory.mktemp("tree")
    names = [file.relative_to(repository).as_posix() for file in tracked_files]
    for name in [*names, *JUNK]:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        if name in REAL:
            shutil.copy(repository / name, tree / name)
        else:
            (tree / name).touch()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tree)
        name = backend.build_sdist(str(tree / "dist"))
    with tarfile.open(tree / "dist" / name) as archive:
        files = {each.name.partition("/")[2] for each in archive if each.isfile()}
        content = archive.extractfile(f"{name.removesuffix('.tar.gz')}/PKG-INFO")
        assert content is not None
        return files, email.message_from_bytes(content.read())


def test_the_source_distribution_is_the_repository_without_its_ci(
    shipped: tuple[set[str], Message], repository: Path, tracked_files: list[Path]
) -> None:
    files, _ = shipped
    tracked = {file.relative_to(repository).as_posix() for file in tracked_files}
    kept = {name for name in tracked if name.partition("/")[0] not in NOT_SHIPPED}
    assert files == kept | {"PKG-INFO"}
    assert {"CMakeLists.txt", "core/SOURCES", "engine/chain.cpp", "LICENSE"} <= files


def test_metadata_name_the_licence_as_pep_639_wants(shipped: tuple[set[str], Message]) -> None:
    _, metadata = shipped
    assert metadata["License-Expression"] == "MIT"
    assert metadata.get_all("License-File") == ["LICENSE"]
    classifiers = metadata.get_all("Classifier") or []
    assert not [each for each in classifiers if each.startswith("License ::")]


def test_one_version_everywhere(shipped: tuple[set[str], Message], repository: Path) -> None:
    _, metadata = shipped
    cited = re.search(r"^version: (\S+)$", (repository / "CITATION.cff").read_text(), re.MULTILINE)
    assert cited is not None
    assert metadata["Version"] == hyst.__version__ == cited[1]


def test_every_extra_and_what_it_brings_is_in_the_table(
    settings: dict[str, Any], repository: Path
) -> None:
    page = (repository / "docs" / "install.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*?) \|", page, re.MULTILINE))
    extras = settings["project"]["optional-dependencies"]
    assert set(rows) == set(extras)
    called = {"clarabel": "Clarabel", "control": "python-control", "nicegui": "NiceGUI"}
    for extra in set(extras) - {"all", "dev", "docs"}:
        for each in extras[extra]:
            name = re.split(r"[<>=\[;]", each)[0]
            assert called.get(name, name).lower() in rows[extra].lower(), (extra, each)


def test_all_are_the_extras_that_the_page_says(settings: dict[str, Any]) -> None:
    extras = settings["project"]["optional-dependencies"]
    (everything,) = extras["all"]
    assert set(re.findall(r"\w+", everything)) - {"hyst"} == set(extras) - {
        "all",
        "dev",
        "docs",
        "jax",
    }


def test_every_dependency_has_a_lower_bound(settings: dict[str, Any]) -> None:
    project = settings["project"]
    groups = [project["dependencies"], *project["optional-dependencies"].values()]
    asked = [each for group in groups for each in group if not each.startswith("hyst[")]
    assert len(asked) > 20
    assert [each for each in asked if ">=" not in each] == []


def test_the_stable_abi_is_asked_for_where_it_is_configured(
    settings: dict[str, Any], repository: Path
) -> None:
    """Only both together make a wheel for several Pythons whose name is true."""
    build = (repository / "CMakeLists.txt").read_text()
    modules = re.findall(r"nanobind_add_module\((\w+) (\w+)", build)
    assert modules == [("_engine", "STABLE_ABI"), ("_single", "STABLE_ABI")]
    assert "${SKBUILD_SABI_COMPONENT}" in build
    assert settings["tool"]["scikit-build"]["wheel"]["py-api"] == "cp312"
