"""How far a modelled output is from the measured one."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import finite_vector, same_length
from hyst.checks.numbers import as_positive
from hyst.errors import InputError


@dataclass(frozen=True)
class Metrics:
    """Errors of a model over one record, in output units and in percent.

    Parameters
    ----------
    rms
        Root mean square error, output units.
    max_abs
        Largest absolute error, output units.
    rms_percent, max_percent
        The same in percent of ``output_range``.
    nrmse_fit_percent
        100 (1 - ||y - y_model|| / ||y - mean y||): 100 is perfect, 0 is no better than the mean.
    bias
        Mean of ``y_model - y``, output units; with a free offset, what was taken out.
    samples
        Number of samples compared.
    output_range
        What the percentages refer to, output units.

    Examples
    --------
    >>> error_metrics([0.0, 1.0, 2.0], [0.5, 1.5, 2.5]).to_dict()["bias"]
    0.5
    """

    rms: float
    max_abs: float
    rms_percent: float
    max_percent: float
    nrmse_fit_percent: float
    bias: float
    samples: int
    output_range: float

    def to_dict(self) -> dict[str, float | int]:
        """Give all fields as plain numbers, ready for JSON."""
        return asdict(self)


def error_metrics(
    y: ArrayLike,
    y_model: ArrayLike,
    free_offset: bool = False,
    output_range: float | None = None,
) -> Metrics:
    """Compare a modelled output with the measured one.

    The error is e = y_model - y; with a free offset e - mean(e), since a constant between model
    and sensor often means nothing.

    Parameters
    ----------
    y
        Measured output, shape (N,), finite, not constant.
    y_model
        Modelled output, shape (N,), finite.
    free_offset
        Whether the mean error is taken out before rms, maximum and fit are computed.
    output_range
        What the percentages refer to, > 0; by default max(y) - min(y).

    Returns
    -------
    Metrics
        The errors.

    Raises
    ------
    InputError
        If a signal is not a finite vector, the lengths differ, ``y`` is constant (no percentage
        means anything then), or ``output_range`` is not a positive finite number.

    Examples
    --------
    >>> metrics = error_metrics([0.0, 2.0, 0.0, 2.0], [0.1, 1.9, -0.1, 2.1])
    >>> round(metrics.rms, 12), round(metrics.max_percent, 12), round(metrics.nrmse_fit_percent, 12)
    (0.1, 5.0, 90.0)
    """
    measured = finite_vector(y, "y")
    modelled = finite_vector(y_model, "y_model")
    same_length(measured, modelled, "y and y_model")
    spread = measured - np.mean(measured)
    if measured.min() == measured.max():
        raise InputError(
            f"y is {measured[0]} throughout; errors in percent need an output that moves"
        )
    given = float(np.ptp(measured)) if output_range is None else output_range
    reference = as_positive(given, "output_range")
    error = modelled - measured
    bias = float(np.mean(error))
    if free_offset:
        error = error - bias
    rms, max_abs = _rms(error), float(np.max(np.abs(error)))
    return Metrics(
        rms=rms,
        max_abs=max_abs,
        rms_percent=100.0 * rms / reference,
        max_percent=100.0 * max_abs / reference,
        nrmse_fit_percent=100.0 * (1.0 - rms / _rms(spread)),
        bias=bias,
        samples=int(measured.size),
        output_range=reference,
    )


def _rms(values: NDArray[np.float64]) -> float:
    # In units of a power of two, exact, so that squares of no unit overflow or vanish.
    unit = math.ldexp(1.0, math.frexp(float(np.max(np.abs(values))))[1] - 1)
    return unit * math.sqrt(float(np.mean(np.square(values / unit))))
