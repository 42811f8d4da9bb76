"""A firmware's own power function in an export: taken, and noticed where it is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from readme_programs import ran, readme_of

import hyst
from hyst.export import c_project
from hyst.operators import ModelDescription

DRIVEN = ModelDescription(input_low=-40.0, input_high=40.0, output_low=-60.0, output_high=60.0)
MODEL = hyst.RambergOsgood(c1=1.0, c2=0.02, c3=0.9).with_description(DRIVEN)

# libm's, of either precision; `@` is what the names of the core start with.
OF_LIBM = """
#include <math.h>
static inline REAL @power(REAL x, REAL e) { return (REAL)SCALE * (REAL)pow((double)x, (double)e); }
static inline REAL @log2(REAL x) { return (REAL)log2((double)x); }
static inline REAL @exp2(REAL v) { return (REAL)exp2((double)v); }
"""


def differs(folder: Path, precision: str, scale: str) -> tuple[float, bool]:
    """What the self-test prints with that header, and whether it ends as passed."""
    told = readme_of(folder)
    (option,) = re.findall(r"`(-D\w+POWER_HEADER='\"my_power.h\"')`", told)
    (prefix,) = re.findall(r"`(\w+)power\(x, e\)`", told)
    number = "float" if precision == "single" else "double"
    text = OF_LIBM.replace("@", prefix).replace("REAL", number).replace("SCALE", scale)
    (folder / "my_power.h").write_text(text)
    done = ran(folder, "test", option, "-I.", "-Wall", "-Wextra", "-Wconversion", "-Werror")
    assert not done.stderr
    (difference,) = re.findall(r"10000 samples, max difference (\S+)", done.stdout)
    return float(difference), done.returncode == 0


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("inverse", [False, True])
def test_a_power_of_libm_gives_the_same_but_for_rounding(
    inverse: bool, precision: str, tmp_path: Path
) -> None:
    model = MODEL.inverse() if inverse else MODEL
    folder = c_project(model, tmp_path / "out", name="lens", precision=precision).path
    difference, same = differs(folder, precision, "1.0")
    epsilon = float(np.finfo(np.float64 if precision == "double" else np.float32).eps)
    # hyst_power errs by (4 + 2 |e log2 x|) epsilon, here with e = 1.9 and x <= 40, or so small
    # that its power counts for less: |e log2 x| < 13. A branch starts where the last one ended,
    # so errors of up to 64 nested ones add. 60 bounds input and output.
    assert difference <= 64 * (4 + 2 * 13) * epsilon * 60.0
    assert same == (difference == 0.0)


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("inverse", [False, True])
def test_a_power_that_is_wrong_is_noticed(inverse: bool, precision: str, tmp_path: Path) -> None:
    """By a thousandth: of the 21.7 that the power adds to 61.7, and twice that along a branch."""
    model = MODEL.inverse() if inverse else MODEL
    folder = c_project(model, tmp_path / "out", name="lens", precision=precision).path
    difference, passed = differs(folder, precision, "1.001")
    assert not passed
    assert 1e-3 < difference < 1e-1


def test_a_step_without_powers_is_told_of_none(tmp_path: Path) -> None:
    folder = c_project(hyst.Play(0.5), tmp_path / "out").path
    assert "POWER_HEADER" not in readme_of(folder)
