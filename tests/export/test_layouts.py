"""The layouts of an export: the same C in each, under names that cannot collide."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from c_builds import AS_C, AS_CXX, STRICT, compiled, compiler

from hyst.export.c.block import block_of
from hyst.export.c.drive import Drive
from hyst.export.c.firmware import project_files
from hyst.export.c.layout import Layout
from hyst.export.c.numbers import Precision
from hyst.export.c.selftest import SelfTest
from reference.examples import EXAMPLES

# One sample, for these tests compile and compare texts.
TEST = SelfTest(Drive.between(-1.0, 1.0), np.zeros(1), 0.0)
WAYS: dict[Precision, tuple[tuple[str, list[str]], ...]] = {
    "double": (("gcc", AS_C), ("g++", AS_CXX)),
    "single": (("clang", AS_C), ("clang++", AS_CXX)),
}
# Numbers that no warning depends on: two models that differ in them alone are checked once.
NUMBERS = re.compile(r"-?0x[0-9a-f.]+p[-+]\d+|0x[0-9a-f]{8}u")
CHECKED: set[tuple[str, str]] = set()


def laid_out(name: str, precision: Precision, form: str, shared: bool = False) -> dict[str, str]:
    """The C of an example by path, without its self-test."""
    model = EXAMPLES[name]
    layout = Layout(form, shared, "stage", precision)
    files = project_files(block_of(model, precision), TEST, model.description, layout)
    return {
        path: content.decode()
        for path, content in files.items()
        if path.endswith((".c", ".h")) and not path.startswith("extras/") and "test" not in path
    }


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_in_every_layout(name: str, precision: Precision, tmp_path: Path) -> None:
    """What the layout folder compiles to is tested in test_c_projects; the others hold its text."""
    folder = laid_out(name, precision, "folder")
    flat = laid_out(name, precision, "flat")
    assert {
        path.removeprefix("core/"): text.replace('"core/', '"') for path, text in folder.items()
    } == flat
    prefix = "hystf" if precision == "single" else "hyst"
    renamed = {
        path.replace(f"{prefix}_", "stage_core_"): re.sub(
            rf"\b{prefix}_", "stage_core_", text
        ).replace(f"{prefix.upper()}_", "STAGE_CORE_")
        for path, text in laid_out(name, precision, "folder", shared=True).items()
    }
    assert renamed == folder
    single = laid_out(name, precision, "single-file")
    assert set(single) == {"stage.c", "stage.h"}
    assert single["stage.h"] == folder["stage.h"]
    for path, text in single.items():
        (tmp_path / path).write_text(text)
    for driver, language in WAYS[precision]:
        kind = driver, NUMBERS.sub("0.0", single["stage.c"])
        if kind not in CHECKED:
            compiled([compiler(driver), *language, *STRICT, "-fsyntax-only", "stage.c"], tmp_path)
            CHECKED.add(kind)
