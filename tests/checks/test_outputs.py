"""Arrays that outputs go into: what is refused, and that nothing is written then."""

from __future__ import annotations

import numpy as np
import pytest

from hyst import InputError, Play
from hyst.checks.outputs import as_output

u = np.arange(12.0).reshape(3, 4)
wide = np.zeros((3, 8))
read_only = np.zeros((3, 4))
read_only.flags.writeable = False


@pytest.mark.parametrize(
    ("out", "message"),
    [
        ([0.0], "out is of type list"),
        (np.ma.zeros((3, 4)), "out is of type MaskedArray"),
        (np.zeros((3, 4), dtype=np.float32), "dtype float32; give float64"),
        (np.zeros((3, 4), dtype=">f8"), "dtype >f8"),
        (np.zeros((4, 3)), r"shape \(4, 3\); give that of u, \(3, 4\)"),
        (np.zeros(12), r"shape \(12,\)"),
        (wide[:, ::2], "not contiguous"),
        (np.zeros((4, 3)).T, "not contiguous"),
        (read_only, "read-only"),
    ],
)
def test_arrays_that_would_not_get_the_output_are_refused(out: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        as_output(out, u)
    with pytest.raises(InputError, match=message):
        Play(0.5)(u, out=out)  # type: ignore[arg-type]


@pytest.mark.parametrize("shift", [-3, -1, 1, 3])
def test_a_partial_overlap_is_refused(shift: int) -> None:
    memory = np.arange(20.0)
    signal, out = memory[4:14], memory[4 + shift : 14 + shift]
    with pytest.raises(InputError, match="shares a part of its memory with u"):
        Play(0.5)(signal, out=out)
    np.testing.assert_array_equal(memory, np.arange(20.0))


def test_the_signal_itself_and_its_neighbours_are_taken() -> None:
    memory = np.arange(20.0)
    assert as_output(memory[:10], memory[10:]) is not None
    assert as_output(memory[:10], memory[:10]).size == 10


def test_what_is_converted_is_not_the_output() -> None:
    # u is of whole numbers, so a copy is evaluated; out has memory of its own.
    y = np.empty(3)
    assert Play(0.5)(np.array([0, 1, 3]), out=y) is y
    np.testing.assert_array_equal(y, [0.0, 0.5, 2.5])
    whole = np.array([0, 1, 3])
    with pytest.raises(InputError, match="dtype int64"):
        Play(0.5)(whole, out=whole)  # type: ignore[arg-type]
