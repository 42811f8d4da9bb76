"""Constants as C reads them back."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hyst import Affine, InputError, PrandtlIshlinskii
from hyst.export.c.core_stage import core_stages
from hyst.export.c.numbers import as_precision, literal, rounded, table
from hyst.export.c.stage_code import StageCode
from hyst.models import MasingOperator, PolynomialCurve

FINITE = st.floats(allow_nan=False, allow_infinity=False)


@given(FINITE)
def test_a_literal_gives_back_every_bit(value: float) -> None:
    text = literal(value, "double", "p")
    assert struct.pack("d", float.fromhex(text)) == struct.pack("d", value)


@given(st.floats(allow_nan=False, allow_infinity=False, width=32))
def test_a_literal_in_single_gives_back_every_bit(value: float) -> None:
    text = literal(value, "single", "p")
    assert text.endswith("f")
    assert np.float32(float.fromhex(text[:-1])).tobytes() == np.float32(value).tobytes()


def test_literals_by_hand() -> None:
    # 0.1 = 0x1.999999999999ap-4; in single the nearest of 24 bits is 0x1.99999ap-4.
    assert literal(0.1, "double", "p") == "0x1.999999999999ap-4"
    assert literal(0.1, "single", "p") == "0x1.99999ap-4f"
    assert [literal(each, "double", "p") for each in (0.0, -0.0, 1.0, -10.0, 5e-324)] == [
        "0x0p+0", "-0x0p+0", "0x1p+0", "-0x1.4p+3", "0x0.0000000000001p-1022",
    ]  # fmt: skip


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused(value: float) -> None:
    with pytest.raises(InputError, match=r"weight\[1\]"):
        table([0.0, value], "double", "weight")


def test_what_single_precision_cannot_hold_is_refused() -> None:
    with pytest.raises(InputError, match="beyond single precision"):
        rounded(1e39, "single", "p0")
    with pytest.raises(InputError, match="affine_1_gain is 1e"):
        StageCode(core_stages(Affine(1e300)), "single")
    assert rounded(1e300, "double", "p0") == 1e300
    tiny = MasingOperator(PolynomialCurve([1e-60, 1e-60]))
    StageCode(core_stages(tiny), "double")
    with pytest.raises(InputError, match="below what single precision holds"):
        StageCode(core_stages(tiny), "single")
    # Beside larger ones of a table a tiny constant is as good as 0.
    StageCode(core_stages(PrandtlIshlinskii([1.0, 1e-60], [0.0, 1.0])), "single")


@pytest.mark.parametrize("precision", ["", "float", "Double", None, 64])
def test_other_precisions_are_refused(precision: object) -> None:
    with pytest.raises(InputError, match="double or single"):
        as_precision(precision)  # type: ignore[arg-type]
