"""Small simulated lots, cheap to identify."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

import hyst

CHEAP = {"family": "pi", "plays": 2, "delay": 0, "creep": None, "drift": False}
"""Nothing is left to choose."""

_T = np.linspace(0.0, 5.0, 240)
DRIVE = np.sin(2.0 * np.pi * _T) * np.repeat([1.0, 0.8, 0.6, 0.4, 0.9], 48)


def device(seed: int, gain: float = 1.0, weight: float = 1.0, **about: str) -> hyst.Record:
    """A device whose constants scatter by 5 %, gain and weights of plays times these."""
    random = np.random.default_rng(seed)
    a, b, c, d = 1.0 + 0.05 * random.standard_normal(4)
    model = hyst.PrandtlIshlinskii([0.5 * weight * a, 0.3 * weight * b], [0.15, 0.4 * c], 1.0)
    y = gain * d * model(DRIVE)
    return hyst.Record(DRIVE, y + 0.004 * random.standard_normal(y.size), 1e-3, **about)


def lot(count: int) -> dict[str, hyst.Record]:
    """Ordinary devices by identifier."""
    return {f"D{k:02d}": device(k) for k in range(count)}


@dataclass(frozen=True)
class Fails:
    """A source that cannot be loaded."""

    identifier: str
    error: type[Exception] = hyst.InputError

    def load(self) -> hyst.Record:
        raise self.error("the file is torn")


@dataclass(frozen=True)
class Kills:
    """A source that takes the process with it that loads it; once only, where a file says so."""

    identifier: str
    record: hyst.Record | None = None
    once: str = ""

    def load(self) -> hyst.Record:
        if self.record is None or not os.path.exists(self.once):
            if self.once:
                open(self.once, "w").close()
            os._exit(1)
        return self.record
