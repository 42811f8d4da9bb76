"""Many models of one structure, many records: evaluated at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_reals, as_signal, refuse_sample
from hyst.errors import InputError
from hyst.operators.base import Operator
from hyst.operators.engine_name import as_threads

Array = NDArray[np.float64]


def evaluate_batch(
    model: Operator,
    u: ArrayLike | Sequence[ArrayLike],
    theta: ArrayLike | None = None,
    *,
    threads: int = 1,
) -> Array | list[Array]:
    """Give the outputs of many models of one structure, or of one model for many records.

    ``y_i = model.with_parameters(theta_i)(u_i)``, each from its initial state, with the same bits.

    Parameters
    ----------
    model
        The structure, and the constants where ``theta`` is left out.
    u
        One record, shape (N,), for all models; M records, shape (M, N); or a list of M records of
        any lengths. Finite.
    theta
        Constants in the order of ``model.parameters()``, shape (M, n); those of the model, for each
        record, if left out.
    threads
        How many threads may work on it, at least 1.

    Returns
    -------
    numpy.ndarray or list of numpy.ndarray
        Shape (M, N); a list where the records are of several lengths.

    Raises
    ------
    InputError
        If a record or ``theta`` cannot be used, there are not as many records as rows of ``theta``,
        a row is not allowed by the constructor of the model, a sample overflows on its way (model
        and sample are named), or ``threads`` is not a positive integer.

    Examples
    --------
    >>> from hyst import PrandtlIshlinskii
    >>> model = PrandtlIshlinskii(p=[0.5], r=[0.1], p0=1.0)
    >>> evaluate_batch(model, [0.0, 1.0], [[1.0, 0.5, 0.1], [0.0, 2.0, 0.2]])
    array([[0.  , 1.45],
           [0.  , 1.6 ]])
    """
    records = _records(u, "u")
    (count, rows), count_threads = _sets(model, theta, records), as_threads(threads)
    lengths = [_of(records, i).size for i in range(count)]
    together = np.empty((count, lengths[0])) if len(set(lengths)) == 1 else None
    y = [np.empty(length) for length in lengths] if together is None else list(together)
    for part, chain, constants, state in _parts(model, rows, count):
        own = records if len(records) == 1 else records[part]
        job, bad = _engine.run_batch(chain, constants, state, own, y[part], count_threads)
        if job >= 0:
            _refuse(_of(own, job), bad, part.start + job, len(records) > 1)
    return y if together is None else together


def batch_loss_gradient(
    model: Operator,
    u: ArrayLike | Sequence[ArrayLike],
    y: ArrayLike | Sequence[ArrayLike],
    theta: ArrayLike | None = None,
    *,
    threads: int = 1,
) -> tuple[Array, Array]:
    """Give losses and their derivatives of many models, or of one model for many records.

    ``loss_i = 1/2 sum_k (f_i(u_i)_k - y_ik)^2``, as ``Operator.loss_gradient`` gives each.

    Parameters
    ----------
    model, u, theta, threads
        As in ``evaluate_batch``.
    y
        The outputs wanted: one record for all, or as many as there are models. Finite.

    Returns
    -------
    losses : numpy.ndarray
        Shape (M,).
    gradients : numpy.ndarray
        Shape (M, n).

    Raises
    ------
    InputError
        As ``evaluate_batch``, or if a record of ``y`` has another length than that of ``u``.

    Examples
    --------
    >>> from hyst import Affine
    >>> losses, gradients = batch_loss_gradient(
    ...     Affine(1.0), [1.0, 2.0], [1.0, 1.0], [[1.0, 0.0], [0.5, 0.5]]
    ... )
    >>> losses, gradients
    (array([0.5  , 0.125]), array([[2. , 1. ],
           [1. , 0.5]]))
    """
    records, wanted = _records(u, "u"), _records(y, "y")
    count, rows = _sets(model, theta, max(records, wanted, key=len))
    _refuse_unpaired(records, wanted, count)
    count_threads = as_threads(threads)
    losses, gradients = np.empty(count), np.empty((count, len(model.parameters())))
    for part, chain, constants, state in _parts(model, rows, count):
        inputs, targets = (each if len(each) == 1 else each[part] for each in (records, wanted))
        into = losses[part], gradients[part]
        _engine.loss_batch(chain, constants, state, inputs, targets, *into, count_threads)
    if not np.isfinite(losses).all():
        evaluate_batch(model, records, rows, threads=threads)  # names the sample
    return losses, gradients


def _refuse_unpaired(records: list[Array], wanted: list[Array], count: int) -> None:
    for each, name in ((records, "u"), (wanted, "y")):
        if len(each) not in (1, count):
            raise InputError(
                f"{name} has {len(each)} records for {count} models; give one, or one for each"
            )
    for i in range(count):
        samples, others = _of(records, i).size, _of(wanted, i).size
        if samples != others:
            raise InputError(f"record {i} has {samples} samples of u and {others} of y")


def _of(records: list[Array], i: int) -> Array:
    """Give the record of a model: one for each, or one for all."""
    return records[i if len(records) > 1 else 0]


def _records(u: ArrayLike | Sequence[ArrayLike], name: str) -> list[Array]:
    """Check one record or several, of one length or not."""
    if isinstance(u, list | tuple) and u and np.ndim(u[0]) == 1:
        return [_one(each, f"{name}[{i}]") for i, each in enumerate(u)]
    signal = as_signal(u, name)  # type: ignore[arg-type]
    return [signal] if signal.ndim == 1 else list(signal)


def _one(record: ArrayLike, name: str) -> Array:
    signal = as_signal(record, name)
    if signal.ndim != 1:
        raise InputError(f"{name} has shape {signal.shape}; give records, each of shape (N,)")
    return signal


def _sets(
    model: Operator, theta: ArrayLike | None, records: list[Array]
) -> tuple[int, Array | None]:
    """Check the constants; give how many models there are, and one row for each or none."""
    if theta is None:
        return len(records), None
    rows, own = as_reals(theta, "theta"), model.parameters()
    if rows.ndim != 2 or rows.shape[1] != len(own) or rows.shape[0] == 0:
        raise InputError(f"theta has shape {rows.shape}; give (models, {len(own)})")
    if len(records) not in (1, rows.shape[0]):
        raise InputError(
            f"theta has {rows.shape[0]} rows and there are {len(records)} records; give one, or "
            "one for each row"
        )
    # A NaN is not within bounds. What cannot be told here, the constructor allows or refuses.
    within = (rows >= own.lower) & (rows <= own.upper) & np.isfinite(rows)
    inside: NDArray[np.bool_] = np.logical_and.reduce(within, axis=1)
    for i, row in enumerate(rows):
        if not inside[i] or model.nearest_parameters(row).tobytes() != row.tobytes():
            _build(model, row, i)
    return rows.shape[0], rows


def _build(model: Operator, row: Array, i: int) -> Operator:
    try:
        built: Operator = model.with_parameters(row)
    except InputError as refusal:
        raise InputError(f"theta[{i}] cannot be used: {refusal}") from None
    return built


def _parts(
    model: Operator, rows: Array | None, count: int
) -> list[tuple[slice, _engine.Chain, Array, Array]]:
    """Cut a batch where constants change more than numbers: initial states, or sizes."""
    none = np.empty((0, len(model.parameters())))
    start = model.initial_state()
    if rows is None:
        return [(slice(0, count), _engine.Chain(model.stages()), none, start)]
    ends = [_build(model, rows[i], i).initial_state() for i in (0, -1)]
    if not start.any() and all(np.array_equal(start, each) for each in ends):
        return [(slice(0, count), _engine.Chain(model.stages()), rows, start)]
    built = [_build(model, row, i) for i, row in enumerate(rows)]
    return [
        (slice(i, i + 1), _engine.Chain(each.stages()), none, each.initial_state())
        for i, each in enumerate(built)
    ]


def _refuse(record: Array, bad: int, job: int, several: bool) -> None:
    try:
        refuse_sample(record, bad, f"u[{job}]" if several else "u")
    except InputError as refusal:
        raise InputError(f"model {job} of the batch: {refusal}") from None
