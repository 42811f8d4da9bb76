"""Plants and references of the tests of repetitive control, and a loop of their own."""

from __future__ import annotations

import numpy as np
import scipy.signal

from hyst.control import RepetitiveController

DT, N = 1e-3, 100
STAGE = ([4e5], [1.0, 40.0, 4e5])  # 100 Hz, damping 0.03


def wanted(periods: int, samples: int = N) -> np.ndarray:
    """A reference of two harmonics, the same bits in every period."""
    angle = 2.0 * np.pi * np.arange(samples) / samples
    return np.tile(np.sin(angle) + 0.3 * np.sin(3.0 * angle + 1.0), periods)


def difference_equation(plant: tuple, delay: int) -> tuple[np.ndarray, np.ndarray]:
    """Zero-order hold by SciPy, delay of whole samples before it: (b, a) in powers of 1/z."""
    b, a, _ = scipy.signal.cont2discrete(plant, DT)
    return np.concatenate([np.zeros(delay), b.ravel()]), a


def loop(block: RepetitiveController, b: np.ndarray, a: np.ndarray, r: np.ndarray) -> np.ndarray:
    """The error of a block without inverse around a linear plant, written out sample by sample."""
    h, taps, lead, n = block.smooth.size - 1, block.learn.size, block.lead, block.period
    Q = np.concatenate([block.smooth[:0:-1], block.smooth])
    before = n + h + taps + b.size
    s, e, v, y = (np.zeros(before + r.size) for _ in range(4))
    for k in range(before, before + r.size):
        past = y[k - a.size + 1 : k][::-1]
        y[k] = b @ v[k - b.size + 1 : k + 1][::-1] - a[1:] @ past  # b[0] = 0: v[k] is not yet used
        e[k] = r[k - before] - y[k]
        w = Q @ s[k - n - h : k - n + h + 1]
        v[k] = r[k - before] + w
        s[k] += w
        if k - before >= block.wait + lead:
            s[k - lead] += block.learn @ e[k - taps + 1 : k + 1]
    return e[before:]


def by_period(e: np.ndarray, samples: int = N) -> np.ndarray:
    """Root mean square of every period."""
    return np.sqrt((e.reshape(-1, samples) ** 2).mean(axis=1))
