"""Zeros, poles and gain of a system with one input and one output."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.control.linear_system import LinearSystem, balanced

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Points = NDArray[np.complexfloating[Any, Any]]

# A Markov parameter below this share of the product of the norms that make it is rounding.
_NEGLIGIBLE = 1e-14


@dataclass(frozen=True)
class ZerosAndPoles:
    """The factored form ``gain prod(s - zeros) / prod(s - poles)``, which keeps its accuracy."""

    zeros: ComplexArray
    poles: ComplexArray
    gain: float

    def response(self, s: Points) -> ComplexArray:
        """Values at the complex numbers s, (n,)."""
        above = np.prod(s[:, None] - self.zeros, axis=1)
        below = np.prod(s[:, None] - self.poles, axis=1)
        return np.asarray(self.gain * above / below, dtype=np.complex128)


def zeros_and_poles(system: LinearSystem) -> ZerosAndPoles:
    """Factor a continuous system with one input and one output."""
    poles = system.poles()
    scale = float(np.abs(poles).max(initial=0.0)) or 1.0
    plain = balanced(system)
    A, b, c = plain.A / scale, plain.B[:, 0] / scale, plain.C[0]
    d = float(plain.D[0, 0])
    if abs(d) > _NEGLIGIBLE * np.linalg.norm(b) * np.linalg.norm(c):
        zeros = scipy.linalg.eigvals(A - np.outer(b, c) / d).reshape(system.order)
        return ZerosAndPoles(scale * zeros, poles, d)
    rows, row, size = [c], c, float(np.linalg.norm(c))
    for _ in range(system.order):
        markov = float(row @ b)
        if abs(markov) > _NEGLIGIBLE * size * np.linalg.norm(b):
            break
        row = row @ A
        size = size * max(float(np.linalg.norm(A, 2)), 1e-300)
        rows.append(row)
    else:
        return ZerosAndPoles(np.zeros(0, complex), poles, 0.0)
    # With the output and its first derivatives held at 0, what still moves are the zeros.
    still = scipy.linalg.null_space(np.array(rows) / np.linalg.norm(rows, axis=1)[:, None])
    zeros = np.zeros(0, complex)
    if still.size:
        zeros = scipy.linalg.eigvals(still.T @ (A - np.outer(b, row @ A) / markov) @ still)
    # The balanced input was divided by scale, once; each further derivative brings another.
    return ZerosAndPoles(scale * zeros, poles, markov * scale ** len(rows))
