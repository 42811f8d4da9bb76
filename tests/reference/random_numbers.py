"""Random numbers for hypothesis, on a lattice of quarters as often as of the reals."""

from __future__ import annotations

from hypothesis import strategies as st


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    lattice = st.integers(int(4 * low), int(4 * high)).map(lambda quarters: quarters / 4.0)
    return lattice | st.floats(low, high)
