"""Words of the answer of an observer."""

from __future__ import annotations

import math

import numpy as np

from hyst.report.observer.words import bandwidth_told, finite, hertz, rightmost, told


def test_bandwidths() -> None:
    assert bandwidth_told(0.0) == "none"
    assert bandwidth_told(math.inf) == "|E| stays below 0.707 at all frequencies"
    assert bandwidth_told(2.0 * math.pi * 77.33) == "77.33 Hz, where |E| first is 0.707"


def test_numbers() -> None:
    assert hertz(2.0 * math.pi) == "1 Hz"
    assert told(math.inf) == "diverges"
    assert told(0.25) == "0.25"
    assert finite(math.inf) == "inf"
    assert finite(None) is None
    assert rightmost(np.array([-3.0 + 4.0j, -3.0 - 4.0j, -5.0])) == "-3 +- 4j"
    assert rightmost(np.array([], dtype=complex)) == "none"
