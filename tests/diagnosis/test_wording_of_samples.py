"""Samples are named so that they are found again."""

from __future__ import annotations

import numpy as np
import pytest

from hyst.diagnosis.values.wording import amount, indices, samples_counted


@pytest.mark.parametrize(
    ("samples", "words"),
    [
        ([7], "index 7"),
        ([7, 8, 9], "index 7 to 9"),
        ([1, 4, 5, 9], "index 1, 4 to 5 and 9"),
        (
            list(range(1, 31, 2)),
            "index 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23 and 3 more places",
        ),
    ],
)
def test_indices(samples: list[int], words: str) -> None:
    assert indices(np.array(samples, dtype=np.intp)) == words


def test_amounts() -> None:
    assert amount(48.0, "um") == "48 um"
    assert amount(0.25, "") == "0.25"
    assert (samples_counted(1), samples_counted(1312)) == ("1 sample", "1,312 samples")
