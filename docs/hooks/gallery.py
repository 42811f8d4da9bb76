"""The gallery of families: rows of docs/families.md with a loop of each."""

from __future__ import annotations

from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

import hyst

DOCS = Path(__file__).resolve().parents[1]
HEAD = """# Gallery of families

A loop of each family, of simulated actuators: strokes of shrinking size or, where the rate counts,
slow and fast ones. Constants differ from actuator to actuator; the shape is the family's.
[Which family for what](families.md) has the meaning of the words and all families on measured
records; when in doubt, `hyst identify` compares them, and [`hyst compare`](compare.md) decides on a
fresh record.

<div class="grid cards" markdown>
"""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the page."""
    files.append(File.generated(config, "gallery.md", content=gallery()))
    return files


def gallery() -> str:
    """Give the page: a card for each row of the table."""
    return "\n".join([HEAD, *map(_card, rows()), "</div>", ""])


def rows() -> list[list[str]]:
    """Give the cells of the first table of docs/families.md."""
    text = (DOCS / "families.md").read_text(encoding="utf-8")
    lines = text.partition("\n| family |")[2].partition("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def _card(row: list[str]) -> str:
    name, purpose, loops, rate, inverse, constants, page = row
    name = name.strip("`")
    words = hyst.families[name].words.full_name
    picture = f"figures/families/{name}.png"
    facts = [
        f"Minor loops: {loops}.",
        f"Rate: {rate}.",
        f"Inverse: {inverse}.",
        f"Constants estimated: {constants}.",
    ]
    return "\n".join(
        [
            f"-   **`{name}`**: {words}",
            "",
            f"    ![Loops of a {words}: output over input]({picture})",
            "",
            f"    For {purpose}.",
            "",
            f"    {' '.join(facts)} More: {page}.",
            "",
        ]
    )
