"""Best linear approximation from periodic drives: response, noise and distortion by frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.errors import InputError, NotIdentifiableError
from hyst.identification.families.hammerstein.repetition import advice_on_period, repeats
from hyst.signals import Record

Array = NDArray[np.float64]

_EXCITED = 1e-6  # of the largest line


@dataclass(frozen=True, eq=False)
class BestLinearApproximation:
    """Frequency response at the lines of a periodic drive.

    Parameters
    ----------
    frequency
        Shape (m,), Hz: the lines all realisations excite.
    response
        Shape (m,), complex, mean over realisations and periods.
    noise
        Shape (m,), standard deviation of ``response`` by noise that changes from period to period.
    total
        Shape (m,), standard deviation of ``response`` by noise and distortion together, from the
        scatter over realisations; NaN for a single one.
    distortion
        Shape (m,), standard deviation of the distortion in one realisation: what the nonlinearity
        adds, the same in every period; NaN for a single realisation, 0 where noise hides it.
    silent_frequency, silent_output
        Lines nothing was put into, and the amplitude of the output there, mean over periods; what
        stands above ``silent_noise`` is distortion, even or odd as the line is.
    silent_noise
        Standard deviation of ``silent_output`` by noise.
    """

    frequency: Array
    response: NDArray[np.complex128]
    noise: Array
    total: Array
    distortion: Array
    silent_frequency: Array
    silent_output: Array
    silent_noise: Array


def best_linear_approximation(
    records: Record | Sequence[Record], period: int, settle: int = 1
) -> BestLinearApproximation:
    """Estimate the best linear approximation from periodic records.

    Parameters
    ----------
    records
        One for each realisation of the phases, all of the same lines.
    period
        Samples of a period.
    settle
        Periods left out at the beginning.

    Returns
    -------
    BestLinearApproximation

    Raises
    ------
    InputError
        If a record has fewer than two periods after the settling, or is not periodic, there is no
        record, or their sample times differ.
    NotIdentifiableError
        If no line is excited in all records.

    Notes
    -----
    Pintelon and Schoukens, System Identification, 2nd ed. (2012), sec. 4.3.1, the robust method.

    Examples
    --------
    >>> u = np.tile(np.random.default_rng(0).normal(size=64), 3)
    >>> found = best_linear_approximation(Record(u, 2.0 * u, 0.1), 64)
    >>> bool(np.abs(found.response - 2.0).max() < 1e-12)
    True
    """
    given = [records] if isinstance(records, Record) else list(records)
    if not given:
        raise InputError("no record is given; give at least one")
    if any(not np.isclose(each.dt, given[0].dt, rtol=1e-6, atol=0.0) for each in given):
        raise InputError("the records have different dt; give records of one sample time")
    spectra = [_spectra(record, period, settle) for record in given]
    inputs = np.array([u.mean(axis=0) for u, _ in spectra])
    size = np.abs(inputs)
    excited = (size > _EXCITED * size.max(axis=1, keepdims=True)).all(axis=0)
    excited[0] = False
    silent = (size <= _EXCITED * size.max(axis=1, keepdims=True)).all(axis=0)
    silent[0] = False
    if not excited.any():
        raise NotIdentifiableError("no line is excited in all records; give records of one band")
    frequency = np.arange(period // 2 + 1) / (period * given[0].dt)
    means = np.array([y.mean(axis=0) for _, y in spectra])
    within = np.array([y.var(axis=0, ddof=1) / len(y) for _, y in spectra])
    responses = means[:, excited] / inputs[:, excited]
    noise_of_one = within[:, excited] / size[:, excited] ** 2
    count = len(given)
    noise = np.sqrt(noise_of_one.mean(axis=0) / count)
    total = np.full(noise.size, np.nan)
    distortion = total.copy()
    if count > 1:
        total = np.sqrt(responses.var(axis=0, ddof=1) / count)
        distortion = np.sqrt(np.maximum(count * (total**2 - noise**2), 0.0))
    scale = 2.0 / period
    return BestLinearApproximation(
        frequency=frequency[excited],
        response=responses.mean(axis=0),
        noise=noise,
        total=total,
        distortion=distortion,
        silent_frequency=frequency[silent],
        silent_output=scale * np.sqrt(np.mean(np.abs(means[:, silent]) ** 2, axis=0)),
        silent_noise=scale * np.sqrt(within[:, silent].mean(axis=0)),
    )


def average_periods(record: Record, period: int, settle: int = 1) -> Record:
    """Average the periods of a record after the first ones: less noise, one period left.

    Parameters
    ----------
    record
        Of a periodic drive.
    period
        Samples of a period.
    settle
        Periods left out at the beginning.

    Returns
    -------
    Record
        Two equal periods, so that the first can serve as past of the second.

    Raises
    ------
    InputError
        If fewer than one period is left, or the input is not periodic.
    """
    u, y = _periods(record, period, settle, 1)
    return Record(
        np.tile(u.mean(axis=0), 2),
        np.tile(y.mean(axis=0), 2),
        record.dt,
        record.input_name,
        record.output_name,
        record.input_unit,
        record.output_unit,
        (*record.notes, f"{len(u)} periods of {period} samples were averaged"),
    )


def _spectra(
    record: Record, period: int, settle: int
) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    u, y = _periods(record, period, settle, 2)
    return np.fft.rfft(u, axis=1), np.fft.rfft(y, axis=1)


def _periods(record: Record, period: int, settle: int, least: int) -> tuple[Array, Array]:
    if isinstance(period, bool) or not isinstance(period, int | np.integer) or period < 2:
        raise InputError(f"period is {period!r}; give the samples of a period, at least 2")
    if isinstance(settle, bool) or not isinstance(settle, int | np.integer) or settle < 0:
        raise InputError(f"settle is {settle!r}; give a whole number of periods, at least 0")
    count = len(record) // period - settle
    if count < least:
        raise InputError(
            f"the record has {len(record) // period} periods of {period} samples, {settle} of them "
            f"to settle; at least {least} must be left"
        )
    used = slice(settle * period, (settle + count) * period)
    u, y = record.u[used].reshape(count, period), record.y[used].reshape(count, period)
    if not repeats(u):
        raise InputError(advice_on_period(record.u[settle * period :], period, least))
    return u, y
