"""A guard run along a record: what it would have predicted and commanded, and from which model."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import final

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.cli.adapt.measured import Measured

Array = NDArray[np.float64]


@final
@dataclass(frozen=True, eq=False)
class GuardRun:
    """What a guard did at every sample of a record.

    Parameters
    ----------
    error
        Shape (N,), measured output less that of the model commands would have come from.
    from_estimate
        Shape (N,), whether that was the estimate, or the last good model.
    fallbacks
        Shape (N,), how often it had fallen back.
    command
        Shape (N,), the input for the wanted output, NaN where none gives it; empty without one.
    """

    error: Array
    from_estimate: NDArray[np.bool_]
    fallbacks: Array
    command: Array


def run_guard(
    inverse: hyst.online.AdaptiveInverse, measured: Measured, every: int
) -> tuple[hyst.online.Trajectory, GuardRun]:
    """Take a guarded estimator along a record.

    Parameters
    ----------
    inverse
        It goes on from where it is.
    measured
        The record, and the wanted output if there is one.
    every
        Estimates are kept after every so many samples.

    Returns
    -------
    Trajectory, GuardRun
    """
    record, estimator, y_ref = measured.record, inverse.estimator, measured.y_ref
    samples, rows = record.samples, record.samples // every
    values, errors = np.empty((2, rows, len(estimator.names)))
    error, fallbacks = np.zeros(samples), np.zeros(samples)
    from_estimate = np.zeros(samples, dtype=bool)
    command = np.empty(0 if y_ref is None else samples)
    for k, (u, y) in enumerate(zip(record.u.tolist(), record.y.tolist(), strict=True)):
        if y_ref is not None:
            command[k] = inverse.command(float(y_ref[k]))
        from_estimate[k] = inverse.trusts_estimate
        inverse.update(u, y)
        error[k], fallbacks[k] = inverse.error, inverse.fallbacks
        if (k + 1) % every == 0:
            values[k // every] = estimator.parameters
            errors[k // every] = estimator.standard_errors
    time = np.asarray(record.dt * (np.arange(1, rows + 1) * every - 1.0))
    trajectory = hyst.online.Trajectory(time, estimator.names, values, errors, error)
    return trajectory, GuardRun(error, from_estimate, fallbacks, command)


def write_guard_run(
    path: Path, run: GuardRun, record: hyst.Record, about: hyst.operators.ModelDescription
) -> None:
    """Write a guard's run, a row a sample; the file is written whole or not at all."""
    join = hyst.io.join_unit
    out, into = about.output_unit, about.input_unit
    headers = ["time [s]", join("prediction", out), join("error", out), "from estimate"]
    columns: list[Array] = [
        np.asarray(record.dt * np.arange(record.samples)),
        record.y - run.error,
        run.error,
    ]
    columns += [run.from_estimate.astype(np.float64), run.fallbacks]
    headers += ["fallbacks"]
    if run.command.size:
        headers.append(join("command", into))
        columns.append(run.command)
    hyst.io.write_columns(path, headers, columns)


def guard_sentences(
    run: GuardRun, inverse: hyst.online.AdaptiveInverse, record: hyst.Record
) -> list[str]:
    """Say how a guard's run went, and how it ended."""
    rms = float(np.sqrt(np.mean(run.error**2)))
    share = 100.0 * float(run.from_estimate.mean())
    said = [
        f"guard: predictions miss by {rms:.3g} rms, {share:.3g} % of them by the estimate, the "
        f"others by the last good model; {inverse.fallbacks} fallbacks",
        f"status: {inverse.status}",
    ]
    missing = int(np.isnan(run.command).sum())
    if missing:
        first = float(np.flatnonzero(np.isnan(run.command))[0]) * record.dt
        said.append(
            f"commands: no input gives the wanted output at {missing} samples, first at "
            f"{first:.4g} s; they are nan"
        )
    return said
