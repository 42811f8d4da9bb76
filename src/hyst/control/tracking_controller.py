"""The block a target runs: feedback controller, disturbance observer and inverse in one."""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_constants, as_signal, as_state
from hyst.checks.numbers import as_sample_time
from hyst.control.controller_parts import disturbance_observer_of, feedback_controller, joined
from hyst.control.discretization import Method, discretize
from hyst.control.feedback.feedforward import with_feedforward
from hyst.errors import InputError
from hyst.operators import Operator
from hyst.operators.description import Described, ModelDescription
from hyst.operators.model_file import MODEL, write_file
from hyst.operators.registry import entries, operator_from_dict
from hyst.operators.verdict import refuse_if_unfit

Array = NDArray[np.float64]

KIND = "tracking-controller"
_LARGEST_ORDER = 64  # HYST_LARGEST_ORDER of the core


@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class TrackingController(Described):
    """Drive from reference and measured output, sample by sample.

    ``v_k = C x_k + D [y_ref_k, y_k]``, ``x_{k+1} = A x_k + B [y_ref_k, y_k]``,
    ``u_k = inverse(v_k)``. The estimate of the disturbance, which is already taken off in v, is
    ``d_hat_k = E x_k + F [y_ref_k, y_k]``; it is for looking at and is not exported.

    It is no operator, for it has two inputs. ``from_continuous`` makes it from a design.

    Parameters
    ----------
    A
        Shape (n, n), n <= 64.
    B
        Shape (n, 2): columns of y_ref and of y.
    C
        Shape (n,).
    D
        Shape (2,): of y_ref and of y.
    dt
        Sample time, s, > 0.
    inverse
        Operator from v, the wanted output of the hysteresis, to the drive u; ``u = v`` if left out.
    E, F
        Shapes (n,) and (2,), or neither.
    x0
        Shape (n,), state before the first sample; zeros if left out.
    despite_verdict
        Take also an inverse of a model whose verdict is ``unfit``.

    Raises
    ------
    InputError
        If shapes do not fit, a number is not finite, n is above 64, dt is not above 0, the inverse
        is no operator, has another dt or is of a model whose verdict is ``unfit``.

    Source
    ------
    S1 Fig. 2 and eq. 32.

    Examples
    --------
    >>> hold = TrackingController([[1.0]], [[1.0, -1.0]], [0.5], [2.0, -2.0], dt=1e-3)
    >>> hold.run([1.0, 1.0], [0.0, 0.5])[0].tolist()
    [2.0, 1.5]
    """

    A: Array
    B: Array
    C: Array
    D: Array
    dt: float
    inverse: Operator | None
    E: Array | None
    F: Array | None
    x0: Array

    def __init__(
        self,
        A: ArrayLike,
        B: ArrayLike,
        C: ArrayLike,
        D: ArrayLike,
        dt: float,
        inverse: Operator | None = None,
        *,
        E: ArrayLike | None = None,
        F: ArrayLike | None = None,
        x0: ArrayLike | None = None,
        despite_verdict: bool = False,
    ) -> None:
        c = as_constants(C, "C")
        n, time = c.size, as_sample_time(dt)
        if n > _LARGEST_ORDER:
            raise InputError(f"the controller has {n} states; at most {_LARGEST_ORDER} can be run")
        if (E is None) != (F is None):
            raise InputError("E and F belong together; give both or neither")
        if inverse is not None:
            if not isinstance(inverse, Operator):
                raise InputError(f"inverse is {type(inverse).__name__}; give an operator or None")
            inverse.require_sample_time(time, "the controller")
            refuse_if_unfit(inverse.description.verdict, "no controller is made", despite_verdict)
        values: dict[str, Any] = {
            "A": _matrix(A, (n, n), "A"),
            "B": _matrix(B, (n, 2), "B"),
            "C": c,
            "D": _vector(D, 2, "D"),
            "dt": time,
            "inverse": inverse,
            "E": None if E is None else _vector(E, n, "E"),
            "F": None if F is None else _vector(F, 2, "F"),
            "x0": _vector(np.zeros(n) if x0 is None else x0, n, "x0"),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @classmethod
    def from_continuous(
        cls,
        controller: Any,
        dt: float,
        *,
        observer: Any = None,
        inverse: Operator | None = None,
        method: Method = "tustin",
        feedforward: Any = None,
        plant: Any = None,
        despite_verdict: bool = False,
    ) -> TrackingController:
        """Sample a design in continuous time.

        Controller and observer are sampled each by itself, and then joined:
        ``v = F(z) y_ref + C(z)(y_ref - y) - d_hat``, where the observer's feedthrough from v,
        which ``"tustin"`` gives it, is solved for.

        Parameters
        ----------
        controller
            C(s), from the tracking error to v: a system of python-control, a LinearSystem, a pair
            (num, den), matrices (A, B, C, D), a number, or what ``design_controller`` gave.
        dt
            Sample time, s, > 0.
        observer
            Disturbance observer with inputs (v, y) and output d_hat, in one of these forms, or a
            design that has it as ``observer``; none if left out.
        inverse
            Operator from v to u; ``u = v`` if left out.
        method
            How they are sampled: ``"tustin"`` or ``"zoh"``.
        feedforward
            F, from the reference to v: True is the static ``1 / Pn(0)``; or a stable system, such
            as ``reference_feedforward`` gives; none if left out. It changes no pole of the loop.
        plant
            Pn, of which ``feedforward=True`` takes the static gain; left out, that of a designed
            controller or observer, or a gain of 1.
        despite_verdict
            Take also an inverse of a model whose verdict is ``unfit``.

        Returns
        -------
        TrackingController

        Raises
        ------
        InputError
            If a block cannot be read, is improper, has other inputs or outputs or another sample
            time, the observer is unstable, or the inverse is of a model whose verdict is ``unfit``.

        Examples
        --------
        >>> pi = TrackingController.from_continuous(([4.0, 8.0], [1.0, 0.0]), dt=1e-3)
        >>> round(pi.stepper()(1.0, 0.0), 6)
        4.004
        """
        parts = feedback_controller(controller), disturbance_observer_of(observer)
        blocks = discretize(parts[0], dt, method), discretize(parts[1], dt, method)
        known = (controller, observer)
        whole = joined(with_feedforward(blocks[0], feedforward, method, plant, known), blocks[1])
        return cls(
            whole.A,
            whole.B,
            whole.C[0],
            whole.D[0],
            dt,
            inverse,
            E=whole.C[1],
            F=whole.D[1],
            despite_verdict=despite_verdict,
        )

    @property
    def order(self) -> int:
        """Number of states of the linear part, n."""
        return int(self.C.size)

    def initial_state(self) -> Array:
        """Give the state before the first sample: x0, then that of the inverse; a fresh array."""
        memory = np.zeros(0) if self.inverse is None else self.inverse.initial_state()
        return np.concatenate([self.x0, memory])

    def run(
        self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Give the drive for whole records of reference and output, and the state after them.

        Parameters
        ----------
        y_ref, y
            Shape (N,) each, finite, N >= 1: reference and measured output.
        state
            Shape (m,), float64; the initial state if left out. It is not changed.

        Returns
        -------
        u : numpy.ndarray
            Shape (N,).
        state : numpy.ndarray
            Shape (m,).

        Raises
        ------
        InputError
            If the records or the state cannot be used, or the drive overflows.
        """
        reference, output = as_signal(y_ref, "y_ref"), as_signal(y, "y")
        if reference.ndim != 1 or output.shape != reference.shape:
            raise InputError(
                f"y_ref has shape {reference.shape} and y {output.shape}; give one record of each, "
                "(N,)"
            )
        memory = self._checked_state(state)
        u = np.empty_like(reference)
        bad = self.compiled.run(memory, reference, output, u)
        if bad >= 0:
            raise InputError(
                f"the drive overflows at sample {bad}; the controller by itself is unstable, or "
                "its inputs are too large"
            )
        return u, memory

    def estimate(self, y_ref: ArrayLike, y: ArrayLike, state: ArrayLike | None = None) -> Array:
        """Give what the observer estimates, d_hat, for the records and the state of ``run``.

        Parameters
        ----------
        y_ref, y, state
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N,), in units of v; zeros without an observer.

        Raises
        ------
        InputError
            As ``run``, or if E and F are not known.
        """
        if self.E is None or self.F is None:
            raise InputError("E and F were not given, so the estimate is not known; give both")
        memory = self._checked_state(state)[: self.order]
        watching = TrackingController(self.A, self.B, self.E, self.F, self.dt)
        return watching.run(y_ref, y, memory)[0]

    def stepper(self, state: ArrayLike | None = None) -> _engine.TrackingStepper:
        """Give a callable that takes one sample at a time, with the same numbers as ``run``.

        A sample in which y_ref or y is not finite repeats the last drive, at first 0, leaves the
        state as it is and raises ``fault``, which stays up until ``clear_fault()``.

        Parameters
        ----------
        state
            Shape (m,), float64; the initial state if left out. It is copied.

        Returns
        -------
        TrackingStepper
            ``step(y_ref, y) -> u``, with the live ``state``, ``fault`` and ``clear_fault()``.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        return _engine.TrackingStepper(self.compiled, self._checked_state(state))

    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""
        data: dict[str, Any] = {"kind": KIND, "dt": self.dt}
        data |= {name: getattr(self, name).tolist() for name in ("A", "B", "C", "D")}
        if self.E is not None and self.F is not None:
            data |= {"E": self.E.tolist(), "F": self.F.tolist()}
        if self.x0.any():
            data["x0"] = self.x0.tolist()
        if self.inverse is not None:
            data["inverse"] = self.inverse.to_dict()
        return data

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> TrackingController:
        """Rebuild from ``to_dict()``.

        Parameters
        ----------
        data
            What ``to_dict()`` gave, or the same read from a model file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        if not isinstance(data, dict) or data.get("kind") != KIND:
            kind = data.get("kind") if isinstance(data, dict) else data
            raise InputError(f"the kind is {kind!r}; give the dictionary of a {KIND}")
        given = entries(data, ("dt", "A", "B", "C", "D"), ("E", "F", "x0", "inverse"))
        if "inverse" in given:
            given["inverse"] = operator_from_dict(given["inverse"])
        return cls(**given)

    def save(
        self, path: str | os.PathLike[str], description: ModelDescription | None = None
    ) -> None:
        """Write a model file, every double exact; ``hyst.load`` reads it.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.
        description
            What the numbers mean; that of the controller itself if left out.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        about = self.description if description is None else description
        write_file(path, MODEL, {"model": self.to_dict()}, about)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TrackingController) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash((KIND, self.dt, *self.A.ravel().tolist(), *self.C.tolist()))

    def __reduce__(self) -> tuple[Any, ...]:
        return TrackingController.from_dict, (self.to_dict(),), self._carried()

    def __repr__(self) -> str:
        return f"TrackingController(order={self.order}, dt={self.dt!r}, inverse={self.inverse!r})"

    @functools.cached_property
    def compiled(self) -> _engine.TrackingController:
        """The block in the engine."""
        chain = _engine.Chain(() if self.inverse is None else self.inverse.stages())
        columns, b = self.A.T.ravel().tolist(), self.B.T.ravel().tolist()
        return _engine.TrackingController(
            columns, b, self.C.tolist(), float(self.D[0]), float(self.D[1]), chain
        )

    def _checked_state(self, state: ArrayLike | None) -> Array:
        start = self.initial_state() if state is None else state
        memory: Array = as_state(start, self.compiled.state_length, None)[0]
        return memory


def _matrix(values: ArrayLike, shape: tuple[int, int], name: str) -> Array:
    if 0 in shape and np.asarray(values, dtype=object).size == 0:
        return np.zeros(shape)
    matrix = as_signal(values, name)
    if matrix.shape != shape:
        raise InputError(f"{name} has shape {matrix.shape}; C has {shape[0]} entries, give {shape}")
    matrix = matrix.copy()
    matrix.flags.writeable = False
    return matrix


def _vector(values: ArrayLike, length: int, name: str) -> Array:
    vector = as_constants(values, name)
    if vector.size != length:
        raise InputError(f"{name} has {vector.size} entries; give {length}")
    return vector
