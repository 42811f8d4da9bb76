"""An operator as frameworks with derivatives of their own call it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import as_reals, as_state
from hyst.errors import InputError
from hyst.operators.base import Operator

Array = NDArray[np.float64]


@final
class Differentiable:
    """Records and parameters with any leading axes, through an operator and back.

    Leading axes of records and parameters are broadcast. All records of one set of parameters go
    through the engine in one batch, in double whatever comes in.

    Parameters
    ----------
    model
        The operator; where no parameters are given, its own hold.
    state
        Before every record, shape (n,); the initial state of the operator if left out.

    Raises
    ------
    InputError
        If ``model`` is no operator or ``state`` does not fit it.

    Examples
    --------
    >>> from hyst.operators import Play
    >>> play = Differentiable(Play(0.5))
    >>> play.outputs([0.0, 1.0, 0.8], [[0.1], [0.3]])
    array([[0. , 0.9, 0.9],
           [0. , 0.7, 0.7]])
    >>> by_u, by_theta = play.cotangents([0.0, 1.0, 0.8], [0.0, 0.0, 1.0], [[0.1], [0.3]])
    >>> by_theta
    array([[-1.],
           [-1.]])
    """

    def __init__(self, model: Operator, state: ArrayLike | None = None) -> None:
        if not isinstance(model, Operator):
            raise InputError(f"model is of type {type(model).__name__}; give an operator of hyst")
        self._model = model
        if state is not None:
            state = as_state(state, model.initial_state().size, None)[0].copy()
        self._state = state

    @property
    def parameters(self) -> Array:
        """The operator's own parameters, shape (m,)."""
        return self._model.parameters().values

    def outputs(self, u: ArrayLike, theta: ArrayLike | None = None) -> Array:
        """Give the outputs.

        Parameters
        ----------
        u
            Shape (..., N), finite.
        theta
            Shape (..., m); the operator's own parameters if left out.

        Returns
        -------
        numpy.ndarray
            Shape (..., N).

        Raises
        ------
        InputError
            If ``u`` cannot be used, or ``theta`` is not allowed for the operator.
        """
        rows, sets = as_reals(u, "u"), self._sets(theta)
        lead = np.broadcast_shapes(rows.shape[:-1], sets.shape[:-1])
        rows = np.broadcast_to(rows, (*lead, rows.shape[-1]))
        y = np.empty(rows.shape)
        for at, model in self._models(sets, theta is None, len(lead)):
            y[at] = model.run(_flat(rows[at]), self._state)[0].reshape(y[at].shape)
        return y

    def cotangents(
        self, u: ArrayLike, cotangent: ArrayLike, theta: ArrayLike | None = None
    ) -> tuple[Array, Array]:
        """Give the products of a vector with the derivatives; see ``Operator.vjp``.

        Parameters
        ----------
        u, theta
            As for ``outputs``.
        cotangent
            Shape (..., N), finite.

        Returns
        -------
        by_u : numpy.ndarray
            Shape (..., N).
        by_theta : numpy.ndarray
            Shape (..., m), of each record for itself.

        Raises
        ------
        InputError
            As ``outputs``, or if ``cotangent`` cannot be used.
        """
        rows, given, sets = as_reals(u, "u"), as_reals(cotangent, "cotangent"), self._sets(theta)
        lead = np.broadcast_shapes(rows.shape[:-1], given.shape[:-1], sets.shape[:-1])
        rows = np.broadcast_to(rows, (*lead, rows.shape[-1]))
        given = np.broadcast_to(given, rows.shape)
        by_u, by_theta = np.empty(rows.shape), np.empty((*lead, sets.shape[-1]))
        for at, model in self._models(sets, theta is None, len(lead)):
            found = model.vjp(_flat(rows[at]), _flat(given[at]), self._state)
            by_u[at] = found[0].reshape(by_u[at].shape)
            by_theta[at] = found[1].reshape(by_theta[at].shape)
        return by_u, by_theta

    def _sets(self, theta: ArrayLike | None) -> Array:
        if theta is None:
            return self.parameters
        sets, count = as_reals(theta, "theta"), self.parameters.size
        if sets.ndim < 1 or sets.shape[-1] != count:
            raise InputError(
                f"theta has shape {sets.shape}; the operator has {count} parameters, so give "
                f"(..., {count})"
            )
        return sets

    def _models(
        self, sets: Array, own: bool, axes: int
    ) -> Iterator[tuple[tuple[Any, ...], Operator]]:
        """Give the operator of each set of parameters, and where among all records it applies."""
        if own:
            yield (), self._model
            return
        lead = (1,) * (axes - sets.ndim + 1) + sets.shape[:-1]
        sets = sets.reshape(*lead, sets.shape[-1])
        for index in np.ndindex(*lead):
            at = tuple(i if size > 1 else slice(None) for i, size in zip(index, lead, strict=True))
            yield at, self._model.with_parameters(sets[index])


def _flat(rows: Array) -> Array:
    """Give records as the engine takes them: one, or a batch."""
    return np.ascontiguousarray(rows if rows.ndim == 1 else rows.reshape(-1, rows.shape[-1]))
