"""What noise of a measured drive leaves in the constants of a fit, and what is told of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.family import Fit
from hyst.identification.fit.problem import model_jacobian, model_output
from hyst.identification.record_use.smoothed_drive import Smoother
from hyst.identification.record_use.used_samples import Data
from hyst.operators import Operator

Array = NDArray[np.float64]

DRAWS = 40
"""Of the noise; the standard errors they give scatter by a ninth."""

SMALLEST_DIRECTION = 1e-8


def told_of_drives(smoothers: Sequence[Smoother | None]) -> tuple[str, ...]:
    """Say what was taken out of the drives.

    Parameters
    ----------
    smoothers
        For each record; None where nothing was.
    """
    used = [(number, each) for number, each in enumerate(smoothers, 1) if each is not None]
    noises, corners = ([f(each) for _, each in used] for f in (_noise, _corner))
    which = (
        ""
        if len(used) == len(smoothers)
        else " of record " + ", ".join(str(number) for number, _ in used)
    )
    return (
        f"noise of the measured drive{which}, {_span(noises)} rms, was smoothed out before the fit "
        f"(past and future alike, corner at {_span(corners)} Hz); standard errors count what is "
        "left of it, the model holds no filter, and errors are told beside the smoothed drive: "
        "give the model the commanded one",
    )


def errors_by_drives(fit: Fit, data: Data, root: Array | None) -> Array:
    """Give what the noise left in the drives adds to the standard errors of the estimates.

    What a smoother makes of noise of the size that was found is added to the drives, and the
    change of the output is put down to the constants by least squares, to first order.

    Parameters
    ----------
    fit
        The fit, in the user's units.
    data
        Its records.
    root
        Square root of every sample's weight, or None.

    Returns
    -------
    numpy.ndarray
        Shape (estimates,).
    """
    by_theta = fit.family.estimates(fit).by_theta
    if not any(data.smoothers):
        return np.zeros(len(by_theta))
    operator, weight = fit.operator, 1.0 if root is None else root
    inside = fit.parametrization.inside(fit.solution.theta)
    columns = model_jacobian(data, operator) @ fit.parametrization.transform[:, inside]
    columns = columns * (weight if root is None else root[:, None])
    sizes = np.linalg.norm(columns, axis=0)
    sizes[sizes == 0.0] = 1.0
    changes = _changes(data, operator) * (weight if root is None else root[:, None])
    moved, *_ = np.linalg.lstsq(columns / sizes, changes, rcond=SMALLEST_DIRECTION)
    of_estimates = by_theta[:, inside] @ (moved / sizes[:, None])
    return np.asarray(np.sqrt(np.mean(np.square(of_estimates), axis=1)))


def _changes(data: Data, operator: Operator) -> Array:
    """Give how the output changes with draws of what is left of the noise, shape (samples, k)."""
    random = np.random.default_rng(0)
    left = [
        np.zeros((each.u.size, DRAWS))
        if smoother is None
        else smoother(smoother.noise * random.normal(size=(each.u.size, DRAWS)))
        for each, smoother in zip(data.records, data.smoothers, strict=True)
    ]
    outputs = []
    for draw in range(DRAWS):
        records = tuple(
            replace(each, u=each.u + more[:, draw])
            for each, more in zip(data.records, left, strict=True)
        )
        outputs.append(model_output(replace(data, records=records), operator))
    return np.stack(outputs, axis=1) - model_output(data, operator)[:, None]


def _noise(smoother: Smoother) -> float:
    return smoother.noise


def _corner(smoother: Smoother) -> float:
    return smoother.corner


def _span(values: Sequence[float]) -> str:
    low, high = f"{min(values):.3g}", f"{max(values):.3g}"
    return low if low == high else f"{low} to {high}"
