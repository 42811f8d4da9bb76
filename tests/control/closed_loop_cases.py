"""The repaired example of S1 secs. 5.1 and 5.2, built from the printed numbers by hand."""

from __future__ import annotations

import numpy as np

import hyst

# S1 eqs. 41, 44.
MODES = ((0.8, 2.0 * np.pi * 90.0), (0.2, 2400.0))


def mode(damping: float, frequency: float) -> tuple[list[float], list[float]]:
    return [frequency**2], [1.0, 2.0 * damping * frequency, frequency**2]


def two_modes() -> tuple[np.ndarray, np.ndarray]:
    """Eq. 41."""
    above, below = zip(*(mode(*each) for each in MODES), strict=True)
    return np.polymul(*above), np.polymul(*below)


def printed_observer() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Eq. 46 with the printed L; inputs v and y, output d_hat."""
    damping, frequency = MODES[0]
    A = np.array([[-2.0 * damping * frequency, -(frequency**2), 1.0], [1.0, 0.0, 0.0], [0.0] * 3])
    L = np.array([-117.381, 0.197, 17113.1])
    C = np.array([0.0, frequency**2, 0.0])
    B = np.column_stack([[1.0, 0.0, 0.0], L])
    return A - np.outer(L, C), B, np.array([[0.0, 0.0, 1.0]]), np.zeros((1, 2))


PLANT = two_modes()
CONTROLLER = ([4.0, 8.0], [1.0, 0.0])
PRINTED_CONTROLLER = ([8.0, 4.0], [1.0, 0.0])
OBSERVER = printed_observer()
_P = [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7]
HYSTERESIS = hyst.PrandtlIshlinskii(_P, np.arange(4.0, 41.0, 4.0), 0.1)
INVERSE = HYSTERESIS.inverse()


def reference(seconds: float, dt: float) -> np.ndarray:
    t = np.arange(round(seconds / dt)) * dt
    return np.asarray(18.0 * np.sin(2.0 * np.pi * t) + 28.0 * np.sin(6.0 * np.pi * t))
