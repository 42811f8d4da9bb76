"""What every operator is: a causal map of a signal with a finite, flat state."""

from __future__ import annotations

import functools
import os
from abc import ABC, abstractmethod
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_signal, as_state, refuse_sample
from hyst.checks.outputs import as_output
from hyst.errors import InputError
from hyst.operators.constants import Constants
from hyst.operators.description import ModelDescription
from hyst.operators.engine_name import EngineName, as_engine, as_threads
from hyst.operators.inverses import Inverses
from hyst.operators.model_file import MODEL, write_file
from hyst.operators.portrait import LOOP, Portrait
from hyst.operators.registry import compose
from hyst.operators.reverse import Reverse
from hyst.operators.shown import Shown
from hyst.operators.stage import Stage
from hyst.operators.stepper import Stepper
from hyst.operators.traits import Traits

Array = NDArray[np.float64]


class Operator(Inverses, Constants, Reverse, Shown, ABC):
    """A causal operator with a finite state; ``y = operator(u)``.

    Concrete operators are frozen dataclasses that say what they are (constants, traits, state,
    inverse); how records, samples and derivatives are computed is written here, once, for all.
    """

    @abstractmethod
    def traits(self) -> Traits:
        """Give the traits that hold for these constants."""

    @abstractmethod
    def initial_state(self) -> Array:
        """Give the state before the first sample, shape (n,), a fresh array."""

    @property
    def dt(self) -> float | None:
        """The sample time the operator is made for, seconds; None if any will do."""
        return None

    @final
    def require_sample_time(self, dt: float, what: str = "the record") -> None:
        """Refuse a record of another sample time.

        Parameters
        ----------
        dt
            Sample time of the record, seconds.
        what
            What messages call the record.

        Raises
        ------
        InputError
            If the operator has a sample time that differs by more than one part in a million.
        """
        own = self.dt
        if own is not None and abs(dt - own) > 1e-6 * own:
            raise InputError(
                f"{what} has dt = {dt:.6g} s, the model {own:.6g} s; its constants hold for its "
                "own sample time only, so resample the record or identify the model anew"
            )

    def at_sample_time(self, dt: float) -> Operator:
        """Give the same operator for records of another sample time.

        Parameters
        ----------
        dt
            Sample time of the record, seconds.

        Returns
        -------
        Operator
            The operator itself where any sample time will do, or this one.

        Raises
        ------
        InputError
            If its constants hold for its own sample time only.
        """
        self.require_sample_time(dt)
        return self

    def require_possible_time(self, dt: float, what: str = "the record") -> None:
        """Refuse a record of a sample time that the operator cannot be brought to.

        Parameters
        ----------
        dt
            Sample time of the record, seconds.
        what
            What messages call the record.

        Raises
        ------
        InputError
            If its constants, or those of a part, hold for another sample time only.
        """
        try:
            self.at_sample_time(dt)
        except InputError:
            self.require_sample_time(dt, what)

    def keeps_unit(self) -> bool:
        """Tell whether a signal keeps its unit, as what is only bent, shifted or delayed does."""
        return False

    def portrait(self) -> Portrait:
        """Say how the operator is best drawn: by its loop, unless it knows better."""
        return LOOP

    @abstractmethod
    def lipschitz_constant(self) -> float:
        """Give L with ``max |f(u) - f(v)| <= L max |u - v|``, or infinity."""

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""

    @classmethod
    @abstractmethod
    def from_dict(cls, data: dict[str, Any]) -> Operator:
        """Rebuild the operator from ``to_dict()``.

        Parameters
        ----------
        data
            What ``to_dict()`` gave, or the same read from a model file.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """

    @abstractmethod
    def stages(self) -> tuple[Stage, ...]:
        """Give the stages of this operator in the order the signal passes them.

        They are what the engine runs and what exports write as C.
        """

    @final
    def __call__(self, u: ArrayLike, *, out: Array | None = None) -> Array:
        """Give the output for a whole record that starts from the initial state.

        Parameters
        ----------
        u
            Shape (N,) or (batch, N), finite, N >= 1.
        out
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            The output, in the shape of ``u``.

        Raises
        ------
        InputError
            If ``u`` or ``out`` cannot be used; the first bad index is named.
        """
        return self.run(u, out=out)[0]

    @final
    def run(
        self,
        u: ArrayLike,
        state: ArrayLike | None = None,
        *,
        engine: EngineName = "auto",
        threads: int = 1,
        out: Array | None = None,
    ) -> tuple[Array, Array]:
        """Give the output for a whole record and the state after it.

        Running two halves one after the other gives the bits of running the whole; where the memory
        curve is used, of a long record through many plays, those of the state, and y to rounding.

        Parameters
        ----------
        u
            Shape (N,) or (batch, N), finite, N >= 1.
        state
            Shape (n,) or (batch, n), float64; the initial state if left out. It is not changed.
        engine
            How plays are evaluated: the cheapest way, ``"auto"``; sample by sample, ``"loop"``; in
            time lanes, ``"lanes"``, with the same bits; or by the ``"memory-curve"``.
            ``hyst.operators.evaluation.explain`` tells what ``"auto"`` takes, and why.
        threads
            How many threads may work on it, at least 1.
        out
            Where the output goes: a float64 array in the shape of ``u``, C-contiguous and
            writeable. A fresh one if left out, which takes longer than the arithmetic of a small
            model. ``u`` itself is allowed and then overwritten; what only overlaps it is not. The
            output has the same bits either way. Where a sample is refused, what ``out`` holds
            means nothing.

        Returns
        -------
        y : numpy.ndarray
            In the shape of ``u``; ``out`` if given.
        state : numpy.ndarray
            Shape (n,), or (batch, n) for a batch.

        Raises
        ------
        InputError
            If ``u``, ``state`` or ``out`` cannot be used, a sample overflows on its way through the
            operator (the first is named), there is no such engine, or ``threads`` is not a positive
            integer.

        Examples
        --------
        >>> from hyst import Play
        >>> u, y = np.array([0.0, 1.0, 0.5]), np.empty(3)
        >>> Play(0.25).run(u, out=y)[0] is y
        True
        """
        signal = as_signal(u, finite=False)
        batch = None if signal.ndim == 1 else signal.shape[0]
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, batch)
        rows = signal.reshape(1, -1) if batch is None else signal
        y = np.empty_like(signal) if out is None else as_output(out, signal)
        bad = self._chain.run(
            memory, rows, y.reshape(rows.shape), as_engine(engine), as_threads(threads)
        )
        if bad >= 0:
            refuse_sample(signal, bad, "u")
        return (y, memory) if batch is not None else (y, memory[0])

    @final
    def stepper(self, state: ArrayLike | None = None) -> Stepper:
        """Give a callable that takes one sample at a time, with the same numbers as ``run``.

        Parameters
        ----------
        state
            Shape (n,), float64; the initial state if left out. It is copied.

        Returns
        -------
        Stepper
            ``step(u) -> y``, with ``state``, ``fault`` and ``clear_fault()``.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, None)[0]
        return _engine.stepper(self._chain, memory, 0.0)

    @final
    def jacobian(self, u: ArrayLike, state: ArrayLike | None = None) -> Array:
        """Give the derivative of the output by the parameters.

        Forward mode, with the contact-sample rule: while a play rests its derivative is the one it
        had when it last moved. At a kink the derivative is one-sided. The initial state does not
        depend on the parameters.

        Parameters
        ----------
        u
            Shape (N,), finite, N >= 1.
        state
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N, m), m = ``len(self.parameters())``.

        Raises
        ------
        InputError
            If ``u`` is not one record or ``state`` cannot be used.
        """
        signal = as_signal(u)
        if signal.ndim != 1:
            raise InputError(f"u has shape {signal.shape}; the Jacobian takes one record, (N,)")
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, None)[0]
        result = np.empty((signal.size, self._chain.parameter_count))
        self._chain.jacobian(memory, signal, result)
        return result

    @final
    def loss_gradient(
        self,
        u: ArrayLike,
        y: ArrayLike,
        state: ArrayLike | None = None,
        *,
        engine: EngineName = "auto",
        threads: int = 1,
    ) -> tuple[float, Array]:
        """Give the loss ``1/2 sum_k (f(u)_k - y_k)^2`` and its derivative by the parameters.

        For a bank of plays the Jacobian is not stored and the cost is that of a few evaluations.

        Parameters
        ----------
        u
            Shape (N,), finite, N >= 1.
        y
            Shape (N,), finite, the output wanted.
        state, engine, threads
            As in ``run``.

        Returns
        -------
        loss : float
            In squared output units.
        gradient : numpy.ndarray
            Shape (m,), ``jacobian(u).T @ (f(u) - y)``, m = ``len(self.parameters())``.

        Raises
        ------
        InputError
            If ``u`` and ``y`` are not two records of one length, a sample overflows on its way
            through the operator, or ``state``, ``engine`` or ``threads`` cannot be used.
        """
        signal, wanted = as_signal(u), as_signal(y, "y")
        if signal.ndim != 1 or wanted.shape != signal.shape:
            raise InputError(
                f"u has shape {signal.shape} and y {wanted.shape}; give one record of each, (N,)"
            )
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, None)[0]
        gradient = np.empty(self._chain.parameter_count)
        loss = self._chain.loss_gradient(
            memory, signal, wanted, gradient, as_engine(engine), as_threads(threads)
        )
        if not np.isfinite(loss):
            self.run(signal, start)  # names the sample, unless only the squares overflow
        return loss, gradient

    @final
    def __matmul__(self, inner: Operator) -> Operator:
        """Compose: ``(f @ g)(u) = f(g(u))``."""
        return compose((inner, self))

    @final
    def save(
        self, path: str | os.PathLike[str], description: ModelDescription | None = None
    ) -> None:
        """Write a model file: JSON that a person can read, every double exact.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.
        description
            What the numbers mean; that of the operator itself if left out.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        about = self.description if description is None else description
        write_file(path, MODEL, {"model": self.to_dict()}, about)

    @functools.cached_property
    def _chain(self) -> _engine.Chain:
        return _engine.Chain(self.stages())

    @final
    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Operator) or type(self) is not type(other):
            return False
        return self.to_dict() == other.to_dict()

    @final
    def __hash__(self) -> int:
        # Not of the dictionary's text: -0.0 equals 0.0 but is written otherwise.
        constants = (*self.parameters().values.tolist(), *self.initial_state().tolist())
        return hash((self.kind, constants))

    @final
    def __reduce__(self) -> tuple[Any, ...]:
        # The compiled chain is rebuilt, not carried, when an operator goes to another process.
        return type(self).from_dict, (self.to_dict(),), self._carried()
