"""The documentation site: every page has a place, notebooks are what pages say."""

from __future__ import annotations

import importlib.util
import json
import re
from pathlib import Path
from types import ModuleType

import pytest

import hyst


def module_of(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_page_is_in_the_navigation(repository: Path) -> None:
    """MkDocs refuses the same, but takes half a minute to say so."""
    listed = re.findall(r"([\w./-]+\.md)$", (repository / "mkdocs.yml").read_text(), re.MULTILINE)
    assert len(listed) == len(set(listed))
    docs = repository / "docs"
    written = {file.relative_to(docs).as_posix() for file in docs.rglob("*.md")}
    unlisted = {page for page in written if page not in listed and "decisions/0" not in page}
    assert unlisted == set()


def test_notebooks_are_what_pages_say(repository: Path) -> None:
    """After a change of a page: python docs/make_notebooks.py."""
    maker = module_of(repository / "docs" / "make_notebooks.py")
    kept = {path.stem: json.loads(path.read_text()) for path in maker.FOLDER.glob("*.ipynb")}
    assert kept == {Path(page).stem: maker.notebook_of(page) for page in maker.PAGES}


def test_a_family_has_its_picture(repository: Path) -> None:
    """After a new family: python docs/figures/draw_families.py."""
    folder = repository / "docs" / "figures" / "families"
    assert {path.stem for path in folder.glob("*.png")} == set(hyst.families)


def test_the_reference_has_every_public_name(repository: Path) -> None:
    pytest.importorskip("mkdocs")
    hooks = repository / "docs" / "hooks"
    pages = module_of(hooks / "reference.py").reference_pages()
    described = set(re.findall(r"^::: (\S+)$", "\n".join(pages.values()), re.MULTILINE))
    names = set(module_of(hooks / "check_site.py").public_names())
    assert "hyst.identification.identify" in names
    assert names <= described


@pytest.mark.parametrize(
    ("body", "fault"),
    [
        ('<a href="gone.html">x</a>', "a link that leads nowhere: gone.html"),
        ('<a href="#gone">x</a>', "a link that leads nowhere: #gone"),
        ('<script src="https://example.org/x.js"></script>', "fetches https://example.org/x.js"),
        ('<img src="x.png">', "a picture without a text"),
        ("<p>nothing</p>", "no page describes hyst.models.BoucWen"),
    ],
)
def test_a_fault_of_the_site_is_told(
    body: str, fault: str, repository: Path, tmp_path: Path
) -> None:
    pytest.importorskip("mkdocs")
    (tmp_path / "index.html").write_text(f"<html><body>{body}</body></html>", encoding="utf-8")
    told = module_of(repository / "docs" / "hooks" / "check_site.py").faults_of(tmp_path)
    assert any(fault in each for each in told)
