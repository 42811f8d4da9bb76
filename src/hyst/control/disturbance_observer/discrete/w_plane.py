"""The circle mapped to the axis: z = (1 + s) / (1 - s), so that stable polynomials look alike.

Frequencies become ``W = tan(w dt / 2)``: 0 to infinity for 0 to half the sample rate. Poles that
crowd at z = 1 where sampling is fast keep their digits here, and z = 0, a delay, is at s = -1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hyst.control.infinity_norm import bilinear
from hyst.control.linear_system import LinearSystem, balanced
from hyst.control.zeros_and_poles import ZerosAndPoles, zeros_and_poles
from hyst.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Points = NDArray[np.complexfloating[Any, Any]]

_AT_ZERO = 1e-9  # |z| of a pole that is a delay


def to_w_plane(z: Points) -> ComplexArray:
    """Map points z to s = (z - 1) / (z + 1)."""
    return np.asarray((z - 1.0) / (z + 1.0), dtype=np.complex128)


def from_w_plane(s: Points) -> ComplexArray:
    """Map points s to z = (1 + s) / (1 - s)."""
    return np.asarray((1.0 + s) / (1.0 - s), dtype=np.complex128)


def poles_in_w_plane(A: Array) -> ComplexArray:
    """Give the eigenvalues of A in the w-plane; those of a delay exactly at -1."""
    # A - 1, for the differences of poles near z = 1 from it are what matters.
    shifted = np.linalg.eigvals(A - np.eye(len(A))).astype(complex)
    plain = np.linalg.eigvals(A).astype(complex)
    delays = int((np.abs(plain) < _AT_ZERO).sum())
    shifted = shifted[np.argsort(np.abs(shifted + 1.0), kind="stable")]
    s = shifted / (2.0 + shifted)
    s[:delays] = -1.0
    return np.asarray(s, dtype=np.complex128)


def factored(system: LinearSystem) -> ZerosAndPoles:
    """Factor a sampled system with one input and one output in the w-plane.

    Raises
    ------
    InputError
        If the system has a pole at z = -1.
    """
    # Canonical forms have states of very different size, and would look as if singular.
    mapped = bilinear(balanced(system))
    if mapped is None:
        raise InputError("a pole lies at z = -1, half the sample rate; sample faster")
    parts = zeros_and_poles(mapped)
    return ZerosAndPoles(parts.zeros, poles_in_w_plane(system.A), parts.gain)


def continuous_in_w_plane(values: ComplexArray, dt: float) -> ComplexArray:
    """Give where samples every dt show the values of continuous poles and zeros, folded down."""
    return np.asarray(np.tanh(0.5 * dt * values), dtype=np.complex128)
