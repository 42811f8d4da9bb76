"""Parts of the export as structured text: numbers, names, functions on bits; and the machine."""

from __future__ import annotations

import ctypes
from pathlib import Path

import numpy as np
import pytest
from c_builds import compiled, compiler, same_bits
from hypothesis import given
from hypothesis import strategies as st
from structured_text_machine import Machine
from structured_text_parser import StructuredTextError
from test_structured_text import text_of

from hyst.export.c.core_sources import core_folder
from hyst.export.c.numbers import Precision
from hyst.export.iec61131.numbers import real_text
from hyst.export.iec61131.words import Names, is_taken

NUMBERS: dict[Precision, type] = {"double": np.float64, "single": np.float32}


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_is_read_back_to_the_bit(value: float) -> None:
    text = real_text(value, "double").strip("()")
    assert float(text).hex() == value.hex()
    assert "." in text


@given(st.floats(allow_nan=False, allow_infinity=False, width=32))
def test_a_number_of_single_precision_is_read_back_without_rounding_twice(value: float) -> None:
    text = real_text(value, "single").strip("()").replace("REAL#", "")
    assert float(text) == value
    assert np.float32(text) == np.float32(value)


@given(st.lists(st.text("abcDEF_xyz12", min_size=1), min_size=2, max_size=20, unique=True))
def test_names_differ_by_more_than_case(names: list[str]) -> None:
    own = Names(frozenset({"abc"}))
    given_names = [own.of(f"a{name}") for name in names]
    assert len({each.lower() for each in given_names}) == len(names)
    assert not any(is_taken(each) or "__" in each or each.endswith("_") for each in given_names)
    assert "abc" not in {each.lower() for each in given_names}


@pytest.mark.parametrize(
    "name",
    [
        "limit",
        "T",
        "end_if",
        "LREAL_TO_DINT",
        "to_real",
        "Bool",
        "any_real",
        "CTU_DINT",
        "add_time",
        "concat_date_tod",
        "XWORD",
        "ltime_of_day",
    ],
)
def test_words_of_the_language_are_no_names(name: str) -> None:
    assert is_taken(name)
    assert not is_taken(f"the_{name}")


PROBE = """
FUNCTION_BLOCK probe
VAR_INPUT x : REAL_TYPE; END_VAR
VAR_OUTPUT log2, exp2, root : REAL_TYPE; whole : DINT; END_VAR
log2 := lens_log2(x := x);
exp2 := lens_exp2(v := x);
root := mirror_root(x := x);
IF (x > -LARGE) AND (x < LARGE) THEN
    whole := lens_whole_part(x := x);
END_IF;
END_FUNCTION_BLOCK
"""
IN_C = """
#include "hyst/power.h"
#include "hyst/root.h"
void probe(const hyst_real *x, hyst_real *log2, hyst_real *exp2, hyst_real *root, size_t n)
{
    for (size_t k = 0; k < n; ++k) {
        log2[k] = hyst_log2(x[k]);
        exp2[k] = hyst_exp2(x[k]);
        root[k] = hyst_root(x[k]);
    }
}
"""


def inputs(precision: Precision) -> np.ndarray:
    """Every exponent with its ends and numbers in between, what is near the limits, and none."""
    number = NUMBERS[precision]
    about = np.finfo(number)
    word = np.uint64 if precision == "double" else np.uint32
    exponents = np.arange((1 << (about.bits - about.nmant - 1)) - 1, dtype=word)
    rng = np.random.default_rng(3)
    share = rng.integers(0, 1 << about.nmant, (exponents.size, 40), dtype=np.uint64).astype(word)
    root_half = np.array(0.5, number) ** number(0.5)
    ends = np.array(
        [0, 1, (1 << about.nmant) - 1, int(root_half.view(word)) & ((1 << about.nmant) - 1)]
    )
    near = [*ends.tolist(), int(ends[3]) - 1, int(ends[3]) + 1]
    share = np.concatenate([share, np.tile(np.array(near, word), (exponents.size, 1))], axis=1)
    every = ((exponents[:, None] << word(about.nmant)) | share).ravel().view(number)
    powers = rng.uniform(-1.1, 1.1, 20_000) * (1100 if precision == "double" else 160)
    halves = np.arange(-1200, 1200) * 0.5
    edges = [0.0, np.inf, about.max, about.smallest_subnormal, 1e-30, 8.0, -1e6, 1e6]
    return np.concatenate([every, powers.astype(number), halves.astype(number), edges]).astype(
        number
    )


@pytest.mark.parametrize("precision", ["double", "single"])
def test_functions_on_bits_are_those_of_the_core(precision: Precision, tmp_path: Path) -> None:
    number = NUMBERS[precision]
    real = "LREAL" if precision == "double" else "REAL"
    large = "2.0E9" if precision == "double" else "REAL#2.0E9"
    probe = PROBE.replace("REAL_TYPE", real).replace("LARGE", large)
    both = text_of("masing of a power", precision)
    both += text_of("preisach", precision).replace("lens", "mirror")
    machine = Machine(both + probe, "probe", tmp_path)
    x = inputs(precision)
    found = machine.instance().run(("log2", "exp2", "root", "whole"), x=x)
    (tmp_path / "probe.c").write_text(IN_C)
    flags = ["-DHYST_SINGLE"] if precision == "single" else []
    include = f"-I{core_folder() / 'include'}"
    command = [compiler("gcc"), "-std=c99", "-O1", "-ffp-contract=off", "-fPIC", "-shared"]
    compiled([*command, *flags, include, "probe.c", "-o", "probe.so"], tmp_path)
    expected = [np.empty(x.size, number) for _ in range(3)]
    library = ctypes.CDLL(str(tmp_path / "probe.so"))
    places = [ctypes.c_void_p(each.ctypes.data) for each in (x, *expected)]
    library.probe(*places, ctypes.c_size_t(x.size))
    # A logarithm is asked of what is not negative; a root, up to 8 and not of an infinity.
    for ours, core, counts in zip(found, expected, (x >= 0.0, x <= np.inf, x <= 8.0), strict=False):
        assert same_bits(ours[counts], core[counts])
    counted = np.abs(x) < number(2.0e9)
    assert (found[3][counted] == np.trunc(x[counted])).all()


BLOCK = """
TYPE a_row : ARRAY [0..2] OF LREAL; END_TYPE
FUNCTION a_sum : LREAL
VAR_INPUT n : DINT; END_VAR
VAR_IN_OUT row : a_row; END_VAR
VAR i : DINT; END_VAR
FOR i := 0 TO n DO a_sum := a_sum + row[i]; END_FOR;
END_FUNCTION
FUNCTION_BLOCK a
VAR_INPUT n : DINT; END_VAR
VAR_OUTPUT y : LREAL; b : BOOL; END_VAR
VAR row : a_row := [1.0, 2(0.5)]; END_VAR
STATEMENT
END_FUNCTION_BLOCK
"""


def test_the_machine_runs_what_is_right_and_stops_out_of_bounds(tmp_path: Path) -> None:
    text = BLOCK.replace("STATEMENT", "y := a_sum(n := n, row := row);")
    a = Machine(text, "a", tmp_path).instance()
    assert a.run(("y",), n=[0, 1, 2])[0].tolist() == [1.0, 1.5, 2.0]
    with pytest.raises(StructuredTextError, match="out of bounds"):
        a.run(("y",), n=3)


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        ("y := n;", "DINT where LREAL"),
        ("y := 1;", "literal 1"),
        ("y := y + n;", "LREAL"),
        ("z := 1.0;", "not declared"),
        ("n := 1;", "input n is written"),
        ("b := y;", "LREAL where BOOL"),
        ("b := n AND n;", "AND of DINT"),
        ("y := a_sum(n := n);", "arguments"),
        ("y := a_sum(row := row, n := n);", "arguments"),
        ("y := row[y];", "LREAL where DINT"),
        ("row := row;", "array is assigned"),
        ("EXIT;", "outside a loop"),
        ("y := ;", "';'"),
        ("IF b THEN y := 1.0; END_IF", "instead of ;"),
        ("y := later(x := y);", "no function"),
        ("y := 0x1p3;", "instead of"),
        ("y := 1e5;", "instead of"),
    ],
)
def test_the_machine_refuses_what_a_compiler_would(
    statement: str, reason: str, tmp_path: Path
) -> None:
    with pytest.raises(StructuredTextError, match=reason):
        Machine(BLOCK.replace("STATEMENT", statement), "a", tmp_path)


@pytest.mark.parametrize(
    ("old", "new"),
    [("b : BOOL", "Y : BOOL"), ("row : a_row :=", "Limit : a_row :="), ("i : DINT", "i__j : DINT")],
)
def test_the_machine_refuses_names_that_a_compiler_would(
    old: str, new: str, tmp_path: Path
) -> None:
    text = BLOCK.replace("STATEMENT", "y := 1.0;").replace(old, new)
    with pytest.raises(StructuredTextError):
        Machine(text, "a", tmp_path)
