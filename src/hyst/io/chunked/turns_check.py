"""The turns of a signal that comes piece by piece, as many as tell whether it is usable."""

from __future__ import annotations

import numpy as np

from hyst.io.chunked.pieces import Array
from hyst.signals import reversals, suggest_dead_band

_MOST_TURNS = 100_000


class Turns:
    """Keeps a signal where it turns by more than a dead band.

    Parameters
    ----------
    dead_band
        See ``reversals``; None for what ``suggest_dead_band`` says of the first piece. That one
        is doubled as often as there are more than 100,000 turns.
    """

    def __init__(self, dead_band: float | None) -> None:
        self._given = dead_band
        self._dead_band: float | None = dead_band
        self._turned: list[Array] = []
        self._tail = np.empty(0)

    def add(self, signal: Array) -> None:
        """Look at more samples."""
        if self._dead_band is None:
            self._dead_band = suggest_dead_band(signal)
        # The last turn, or the start, the extremes since then in their order and the last value:
        # as much as decides where the next turn is.
        whole = np.concatenate([self._tail, signal])
        turns = reversals(whole, self._dead_band)
        if not self._turned:
            self._turned.append(whole[:1])
        self._turned.append(whole[turns])
        tail = whole[turns[-1] if turns.size else 0 :]
        self._tail = tail[sorted({0, int(tail.argmin()), int(tail.argmax()), tail.size - 1})]
        if self._given is None and sum(each.size for each in self._turned) > _MOST_TURNS:
            self._dead_band *= 2.0
            turned = np.concatenate(self._turned)
            kept = [0, *reversals(turned, self._dead_band).tolist(), turned.size - 1]
            self._turned = [turned[kept]]

    def signal(self) -> Array:
        """Give its start, its turns and what came after the last one."""
        return np.concatenate([*self._turned, self._tail[1:]])

    def dead_band(self) -> float:
        """Give the dead band, a quarter of the range at most unless it was given."""
        known = self._dead_band or 0.0
        return known if self._given is not None else min(known, float(np.ptp(self.signal())) / 4.0)
