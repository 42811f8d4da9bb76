"""Linear systems as matrices, and the one door of this package to python-control."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from hyst.checks.arrays import finite_array
from hyst.control.other_systems import matrices_of_other
from hyst.errors import InputError, MissingExtraError
from hyst.models.realizations import companion

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Points = NDArray[np.complexfloating[Any, Any]]

_LARGE, _AT_A_TIME, _BLOCK = 60, 2000, 64  # states that are many; points and rows solved at once

# Numbers that are solved for together: some 60 megabytes.
_MOST_ENTRIES = 4_000_000
# So near to a pole, as a share, its residue is far above all else, and not yet all rounding.
_BESIDE = 1e-12


@dataclass(frozen=True)
class LinearSystem:
    """A linear system in state space.

    ``dx/dt = A x + B u, y = C x + D u``, or ``x_{k+1} = A x_k + B u_k`` if dt is positive.

    Parameters
    ----------
    A, B, C, D
        Matrices (n, n), (n, m), (q, n), (q, m); finite.
    dt
        Sample time, s; 0 means continuous time.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    dt: float = 0.0

    def __post_init__(self) -> None:
        D = np.atleast_2d(finite_array(self.D, "D"))
        outputs, inputs = D.shape
        A = finite_array(self.A, "A")
        order = 0 if A.size == 0 else A.shape[0] if A.ndim == 2 else 1
        given = {"A": (order, order), "B": (order, inputs), "C": (outputs, order)}
        for name, shape in given.items():
            matrix = finite_array(getattr(self, name), name)
            if matrix.size != shape[0] * shape[1]:
                raise InputError(
                    f"{name} has shape {matrix.shape}, not {shape}; check the matrices"
                )
            object.__setattr__(self, name, matrix.reshape(shape))
        object.__setattr__(self, "D", D)
        for name in ("A", "B", "C", "D"):
            getattr(self, name).setflags(write=False)

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.A)

    @property
    def inputs(self) -> int:
        """Number of inputs."""
        return int(self.D.shape[1])

    @property
    def outputs(self) -> int:
        """Number of outputs."""
        return len(self.D)

    def poles(self) -> ComplexArray:
        """Eigenvalues of A."""
        if self.order == 0:  # which scipy 1.11 has no eigenvalues for
            return np.zeros(0, dtype=np.complex128)
        return np.asarray(scipy.linalg.eigvals(self.A), dtype=np.complex128).reshape(self.order)

    def response(self, s: Points) -> ComplexArray:
        """Values of the transfer function, (len(s), q, m).

        Parameters
        ----------
        s
            Complex numbers, 1/s.
        """
        points = np.atleast_1d(np.asarray(s, dtype=np.complex128))
        if self.order == 0:
            return np.broadcast_to(self.D.astype(complex), (points.size, *self.D.shape)).copy()
        # Companion forms of high order have entries of all sizes, where elimination loses digits.
        A, B, C = balanced_matrices(self.A, self.B, self.C)
        if self.order > _LARGE:
            return _by_schur(A, B, C, self.D, points)
        found = np.empty((points.size, *self.D.shape), dtype=np.complex128)
        # A few frequencies at a time: each has a matrix of its own.
        together = max(1, _MOST_ENTRIES // self.order**2)
        for first in range(0, points.size, together):
            some = slice(first, first + together)
            found[some] = C @ _solved(points[some], A, B.astype(complex)) + self.D
        return found

    def as_control(self) -> Any:
        """Give the ``control.StateSpace`` of the same matrices.

        Raises
        ------
        MissingExtraError
            If python-control is not installed.
        """
        control = _python_control()
        return control.ss(self.A, self.B, self.C, self.D, self.dt, remove_useless_states=False)


def _by_schur(A: Array, B: Array, C: Array, D: Array, points: ComplexArray) -> ComplexArray:
    """Values of a transfer function of many states, as long delays have: one triangle for all."""
    T, U = scipy.linalg.schur(A, output="complex")
    right, left, n = U.conj().T @ B, C @ U, len(A)
    points = np.where(np.isin(points, np.diag(T)), points * (1.0 + _BESIDE), points)
    values = np.empty((points.size, *D.shape), dtype=np.complex128)
    for start in range(0, points.size, _AT_A_TIME):
        z = points[start : start + _AT_A_TIME]
        X = np.empty((n, B.shape[1], z.size), dtype=np.complex128)
        for stop in range(n, 0, -_BLOCK):
            first = max(stop - _BLOCK, 0)
            # What is solved below a block of rows goes to its right-hand side at once.
            rest = right[first:stop, :, None] + np.tensordot(T[first:stop, stop:], X[stop:], 1)
            for i in range(stop - 1, first - 1, -1):
                inner = np.tensordot(T[i, i + 1 : stop], X[i + 1 : stop], 1)
                X[i] = (rest[i - first] + inner) / (z - T[i, i])
        values[start : start + _AT_A_TIME] = np.moveaxis(np.tensordot(left, X, 1), -1, 0) + D
    return values


def _solved(points: ComplexArray, A: Array, B: ComplexArray) -> ComplexArray:
    """Solve (s - A) X = B for each s; at a pole itself beside it, as rounding mostly has it."""
    unit = np.eye(A.shape[0])
    try:
        return np.asarray(np.linalg.solve(points[:, None, None] * unit - A, B))
    except np.linalg.LinAlgError:
        beside = points * (1.0 + _BESIDE)
        return np.asarray(np.linalg.solve(beside[:, None, None] * unit - A, B))


def in_series(first: LinearSystem, *others: LinearSystem) -> LinearSystem:
    """Put systems one behind the other, each with its own states: no polynomial of high order.

    Parameters
    ----------
    first, others
        In the order of the signal, all continuous or all of one dt; a system has as many inputs as
        the one before it outputs.
    """
    whole = first
    for each in others:
        n, m = whole.order, each.order
        A = np.zeros((n + m, n + m))
        A[:n, :n], A[n:, :n], A[n:, n:] = whole.A, each.B @ whole.C, each.A
        B = np.vstack([whole.B, each.B @ whole.D])
        C = np.hstack([each.D @ whole.C, each.C])
        whole = LinearSystem(A, B, C, each.D @ whole.D, each.dt)
    return whole


def balanced(system: LinearSystem) -> LinearSystem:
    """Scale the states of system by powers of two, which changes no digit."""
    return LinearSystem(*balanced_matrices(system.A, system.B, system.C), system.D, system.dt)


def balanced_matrices(A: Array, B: Array, C: Array) -> tuple[Array, Array, Array]:
    """Scale states by powers of two until rows and columns of [A B; C 0] are alike."""
    n = A.shape[0]
    sizes = np.zeros((n + 1, n + 1))
    sizes[:n, :n] = A**2
    np.fill_diagonal(sizes, 0.0)
    sizes[:n, n], sizes[n, :n] = np.sum(B**2, axis=1), np.sum(C**2, axis=0)
    scales = np.ones(n)
    for _ in range(50):
        settled = True
        for i in range(n):
            row, column = float(sizes[i].sum()), float(sizes[:, i].sum())
            if row == 0.0 or column == 0.0:
                continue
            factor = 2.0 ** round(0.25 * math.log2(column / row))
            if factor != 1.0:
                settled = False
                sizes[i] *= factor**2
                sizes[:, i] /= factor**2
                scales[i] *= factor
        if settled:
            break
    return scales[:, None] * A / scales, scales[:, None] * B, C / scales


def transfer_function_of(num: Array, den: Array, dt: float = 0.0) -> Any:
    """Give the ``control.TransferFunction`` of two polynomials.

    Parameters
    ----------
    num, den
        Coefficients, highest power first.
    dt
        Sample time, s; 0 in continuous time.
    """
    return _python_control().tf(num, den, dt)


def as_linear_system(system: Any, name: str = "the system") -> LinearSystem:
    """Read a linear system.

    Parameters
    ----------
    system
        A transfer function or state space of python-control or of scipy.signal (``lti``, ``dlti``),
        a LinearSystem or a plant that has one as ``system``, a ``hyst.LinearDynamics``, whose delay
        becomes states, a ``ContinuousDynamics`` without dead time, a pair (num, den) of
        polynomials, a quadruple (A, B, C, D), or a number.
    name
        What messages call it.

    Raises
    ------
    InputError
        If it is none of these, or has more zeros than poles.

    Examples
    --------
    >>> import scipy.signal
    >>> as_linear_system(scipy.signal.ZerosPolesGain([], [-2.0], 6.0)).D.tolist()
    [[0.0]]
    """
    if isinstance(system, LinearSystem):
        return system
    carried = getattr(system, "system", None)
    if isinstance(carried, LinearSystem):
        return carried
    other = matrices_of_other(system, name)
    if other is not None:
        return _read(*other, name)
    if hasattr(system, "A") and hasattr(system, "D"):
        return _read(system.A, system.B, system.C, system.D, getattr(system, "dt", 0.0), name)
    if hasattr(system, "num") and hasattr(system, "den"):
        return _from_polynomials(system, name)
    if isinstance(system, int | float) and not isinstance(system, bool):
        return LinearSystem(
            np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.array([system])
        )
    if isinstance(system, Sequence) and len(system) == 2:
        return LinearSystem(*_realize(system[0], system[1], name))
    if isinstance(system, Sequence) and len(system) == 4:
        A, B, C, D = (np.asarray(each, dtype=np.float64) for each in system)
        return LinearSystem(A, B, C, D)
    raise InputError(
        f"{name} is {type(system).__name__}; give a transfer function or state space of "
        "python-control or scipy.signal, a pair (num, den) or matrices (A, B, C, D)"
    )


def _read(A: Any, B: Any, C: Any, D: Any, dt: Any, name: str) -> LinearSystem:
    if dt is True:
        raise InputError(f"{name} is sampled with no sample time given; set its dt in seconds")
    # python-control leaves dt at None for a gain, which is then as good in continuous time.
    return LinearSystem(A, B, C, np.atleast_2d(D), 0.0 if dt is None else float(dt))


def _from_polynomials(system: Any, name: str) -> LinearSystem:
    """Realize each entry on its own: not minimal with several inputs or outputs, but exact."""
    rows = []
    for above, below in zip(system.num, system.den, strict=True):
        entries = [LinearSystem(*_realize(n, d, name)) for n, d in zip(above, below, strict=True)]
        rows.append(entries)
    flat = [each for row in rows for each in row]
    A = scipy.linalg.block_diag(*(each.A for each in flat if each.order))
    B, C = np.zeros((0, len(rows[0]))), np.zeros((len(rows), 0))
    for i, row in enumerate(rows):
        for j, each in enumerate(row):
            into, out = np.zeros((each.order, len(row))), np.zeros((len(rows), each.order))
            into[:, j], out[i] = each.B[:, 0], each.C[0]
            B, C = np.vstack([B, into]), np.hstack([C, out])
    D = np.array([[each.D[0, 0] for each in row] for row in rows])
    return _read(A if B.size else np.zeros((0, 0)), B, C, D, getattr(system, "dt", 0.0), name)


def _realize(num: Any, den: Any, name: str) -> tuple[Array, Array, Array, Array]:
    above = np.trim_zeros(np.atleast_1d(np.asarray(num, dtype=np.float64)), "f")
    below = np.trim_zeros(np.atleast_1d(np.asarray(den, dtype=np.float64)), "f")
    if above.size > below.size > 0:
        raise InputError(
            f"{name} is improper: its numerator has degree {above.size - 1}, its denominator "
            f"{below.size - 1}; add poles beyond the frequencies of interest"
        )
    A, B, C, D = companion(above if above.size else [0.0], below)
    return A, B.reshape(-1, 1), C.reshape(1, -1), np.array([[D]])


def _python_control() -> Any:
    try:
        import control  # optional, and slow
    except ImportError:
        raise MissingExtraError(
            "python-control is not installed; install hyst[control] or the package control"
        ) from None
    return control
