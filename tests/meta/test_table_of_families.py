"""docs/families.md has a row for every family, and what a row says is so."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import hyst
from reference.family_examples import family_example

HEADER = ("family", "made for", "minor loops", "rate", "inverse", "estimated", "page")


@pytest.fixture(scope="module")
def rows(repository: Path) -> dict[str, dict[str, str]]:
    """The rows of the first table of the page by family."""
    text = (repository / "docs" / "families.md").read_text(encoding="utf-8")
    lines = text.partition("\n| family |")[2].partition("\n\n")[0].splitlines()[2:]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return {row[0].strip("`"): dict(zip(HEADER, row, strict=True)) for row in cells}


def test_every_family_has_a_row(rows: dict[str, dict[str, str]]) -> None:
    assert set(rows) == set(hyst.families)


@pytest.mark.parametrize("name", hyst.families)
def test_a_row_says_what_its_actuator_does(name: str, rows: dict[str, dict[str, str]]) -> None:
    """Of the actuator that the contract of families takes; one of other constants may do less."""
    row, model = rows[name], family_example(name).model
    held = model.traits().held()
    assert (row["rate"] == "none") == bool(held["rate_independent"])
    assert row["minor loops"].startswith("closed" if held["return_point_memory"] else "open")
    if "congruent" in row["minor loops"].replace("not congruent", ""):
        assert held["congruent_loops"]
    assert row["inverse"].startswith("exact") == model.is_invertible()


@pytest.mark.parametrize("name", hyst.families)
def test_a_row_leads_to_a_page_that_names_the_family(
    name: str, rows: dict[str, dict[str, str]], repository: Path
) -> None:
    link = re.search(r"\]\((\w+\.md)\)", rows[name]["page"])
    assert link is not None
    page = (repository / "docs" / link[1]).read_text(encoding="utf-8")
    assert name in page


def test_every_family_is_on_measured_records(repository: Path) -> None:
    """`python -m benchmarks families --write` writes it; a new family needs it once more."""
    text = (repository / "docs" / "families.md").read_text(encoding="utf-8")
    table = text.partition("<!-- table: ")[2].partition("<!-- end of table -->")[0]
    summary = table.partition("\n| family |")[2].partition("\n\n")[0]
    listed = {line.split("`")[1] for line in summary.splitlines() if line.startswith("| `")}
    assert listed == {"auto", *hyst.families}
