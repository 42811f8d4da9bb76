"""The layouts of an export: the same C in each, under names that cannot collide."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from c_builds import AS_C, AS_CXX, STRICT, compiled, compiler
from distinct_code import DISTINCT

from hyst.export.c.block import Block, block_of
from hyst.export.c.drive import Drive
from hyst.export.c.firmware import project_files
from hyst.export.c.layout import Layout
from hyst.export.c.numbers import Precision
from hyst.export.c.selftest import SelfTest
from hyst.operators import ModelDescription
from reference.examples import EXAMPLES

# One sample, for these tests compile and compare texts.
TEST = SelfTest(Drive.between(-1.0, 1.0), np.zeros(1), 0.0)
# Beside gcc as C99 and clang++ as C++17, with which test_c_projects compiles the layout folder.
WAYS: dict[Precision, tuple[str, list[str]]] = {
    "double": ("g++", AS_CXX),
    "single": ("clang", AS_C),
}
# Numbers that no warning depends on: two models that differ in them alone are checked once.
NUMBERS = re.compile(r"-?0x[0-9a-f.]+p[-+]\d+|0x[0-9a-f]{8}u")
CHECKED: set[tuple[str, str]] = set()


def laid_out(block: Block, precision: Precision, form: str, shared: bool = False) -> dict[str, str]:
    """The C of an example by path, without its self-test."""
    layout = Layout(form, shared, "stage", precision)
    files = project_files(block, TEST, ModelDescription(), layout)
    return {
        path: content.decode()
        for path, content in files.items()
        if path.endswith((".c", ".h")) and not path.startswith("extras/") and "test" not in path
    }


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", DISTINCT)
def test_every_code_in_every_layout(name: str, precision: Precision, tmp_path: Path) -> None:
    """What the layout folder compiles to is tested in test_c_projects; the others hold its text."""
    block = block_of(EXAMPLES[name], precision)
    folder = laid_out(block, precision, "folder")
    flat = laid_out(block, precision, "flat")
    assert {
        path.removeprefix("core/src/"): text.replace('"core/src/', '"')
        for path, text in folder.items()
    } == flat
    prefix = "hystf" if precision == "single" else "hyst"
    renamed = {
        path.replace(f"{prefix}_", "stage_core_"): re.sub(
            rf"\b{prefix}_", "stage_core_", text
        ).replace(f"{prefix.upper()}_", "STAGE_CORE_")
        for path, text in laid_out(block, precision, "folder", shared=True).items()
    }
    assert renamed == folder
    single = laid_out(block, precision, "single-file")
    assert set(single) == {"stage.c", "stage.h"}
    assert single["stage.h"] == folder["stage.h"]
    for path, text in single.items():
        (tmp_path / path).write_text(text)
    driver, language = WAYS[precision]
    kind = driver, NUMBERS.sub("0.0", single["stage.c"])
    if kind not in CHECKED:
        compiled([compiler(driver), *language, *STRICT, "-fsyntax-only", "stage.c"], tmp_path)
        CHECKED.add(kind)


DEFINED = re.compile(
    r"^static\s[\w\s\*]*?\b(\w+)\s*[(=\[]|^\}\s*(\w+);|^typedef\s[\w\s\*]*?(\w+);|#define\s+(\w+)"
    r"|^    ([A-Z][A-Z0-9_]*)(?: = \w+)?,?(?: /\*.*)?$",
    re.MULTILINE,
)


@pytest.mark.parametrize("name", EXAMPLES)
def test_all_that_a_single_file_defines_has_its_name(name: str) -> None:
    """So that any two of them can be included in one source."""
    text = laid_out(block_of(EXAMPLES[name], "double"), "double", "single-file")["stage.c"]
    found = {each for names in DEFINED.findall(text) for each in names if each}
    assert len(found) > 2
    assert not [each for each in found if not each.lower().startswith("stage_")]


@pytest.mark.parametrize("language", [AS_C, AS_CXX])
@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", ["inverse of nested", "inverse iwan", "jiles-atherton"])
def test_a_single_file_by_every_compiler(
    name: str, precision: Precision, language: list[str], tmp_path: Path
) -> None:
    """Of several stages, of a solver, and of a series: what many static functions are for."""
    single = laid_out(block_of(EXAMPLES[name], precision), precision, "single-file")
    for path, text in single.items():
        (tmp_path / path).write_text(text)
    for driver in ("gcc", "clang") if language is AS_C else ("g++", "clang++"):
        compiled([compiler(driver), *language, *STRICT, "-O1", "-c", "stage.c"], tmp_path)
        assert (tmp_path / "stage.o").stat().st_size > 0
        (tmp_path / "stage.o").unlink()
