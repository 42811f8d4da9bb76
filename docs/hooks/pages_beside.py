"""Pages of files that stand beside docs/: the README is the first page, and so on."""

from __future__ import annotations

import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
BESIDE = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
    "benchmarks/README.md": "benchmarks.md",
    "CITATION.cff": "CITATION.cff",
    "LICENSE": "LICENSE.txt",
}
DECISIONS = "decisions/index.md"
LINK = re.compile(r"(\]\()([^)#\s:]+)(?=[)#\s])")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages; those of docs/ are there already."""
    for source, page in BESIDE.items():
        files.append(File.generated(config, page, content=_text(ROOT / source)))
    files.append(File.generated(config, DECISIONS, content=list_of_decisions()))
    return files


def _text(source: Path) -> str:
    """Read a file, with its links as they are on the site."""
    text = source.read_text(encoding="utf-8")
    if source.suffix != ".md":
        return text
    return LINK.sub(lambda found: found[1] + _on_site(found[2], source), text)


def _on_site(target: str, source: Path) -> str:
    """Where a link of a file beside docs/ leads on the site."""
    path = (source.parent / target).resolve()
    inside = path.relative_to(ROOT).as_posix()
    if inside == "docs/decisions":
        return DECISIONS
    return BESIDE.get(inside, inside.removeprefix("docs/"))


def list_of_decisions() -> str:
    """Give the page that lists all decisions by their number."""
    rows = []
    for file in sorted((ROOT / "docs" / "decisions").glob("0*.md")):
        title = file.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
        number, _, words = title.partition(" ")
        rows.append(f"| {number} | [{words}]({file.name}) |")
    head = (
        "# Decisions\n\nWhy things are as they are: a question, what was decided, and what follows."
    )
    return "\n".join([head, "", "| | |", "|---|---|", *rows, ""])
