"""Families and their options are listed alike by the registry, the help, refusals and the docs."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import pytest

import hyst
from hyst.cli import main

OPTIONS = sorted({option for each in hyst.families.values() for option in each.options()})
NAME = re.compile(r"`([a-z_-]+)`")


@pytest.fixture(scope="module")
def rows(repository: Path) -> dict[str, str]:
    """Rows of the tables of the section by their first cell."""
    text = (repository / "docs" / "identification.md").read_text(encoding="utf-8")
    section = text.partition("## Families and their options\n")[2].partition("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| `")]
    return {line.split("`")[1]: line for line in lines}


@pytest.fixture(scope="module")
def help_of_identify() -> str:
    with contextlib.redirect_stdout(io.StringIO()) as shown:
        main(["identify", "--help"])
    return " ".join(shown.getvalue().replace("\u2502", " ").split())


@pytest.mark.parametrize("name", hyst.families)
def test_a_family_is_in_docs_help_and_refusal(
    name: str, rows: dict[str, str], help_of_identify: str
) -> None:
    full_name = hyst.families[name].words.full_name
    assert full_name in rows[name]
    assert f"{name} ({full_name})" in help_of_identify
    record = hyst.Record([0.0, 1.0, 0.0], [0.0, 1.0, 0.0], 1.0)
    with pytest.raises(hyst.InputError, match=rf"unknown family 'none'.*\b{name}\b"):
        hyst.identify(record, family="none")


@pytest.mark.parametrize("option", OPTIONS)
def test_an_option_is_in_docs_and_help(
    option: str, rows: dict[str, str], help_of_identify: str
) -> None:
    takers = NAME.findall(rows[option].split("|")[2])
    assert {each for each in takers if each in hyst.families} == set(hyst.families.takers(option))
    assert f"--{option.replace('_', '-')} " in help_of_identify


def test_the_families_that_auto_compares_are_said(repository: Path, help_of_identify: str) -> None:
    compared, reserve = hyst.families.compared(), hyst.families.in_reserve()
    assert f"auto (compares {', '.join(compared)}, and where" in help_of_identify
    assert f"is given, also {', '.join(reserve)})," in help_of_identify
    text = (repository / "docs" / "identification.md").read_text(encoding="utf-8")
    said = re.search(r"`auto` compares ([^.]*)\.", text)
    assert said is not None
    assert tuple(NAME.findall(said[1])) == compared
    also = re.search(r"it also compares ([^.]*)\.", text)
    assert also is not None
    assert tuple(NAME.findall(also[1])) == reserve
