"""Sec. V: the printed constants of the measured piezo, and what a fair fit of more plays gives."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from hyst.identification import identify_weights_from_slopes
from hyst.models import PrandtlIshlinskii
from hyst.online import RadiusEstimator
from hyst.report.table import Table, number
from hyst.signals import Record
from hyst.studies.s2_adaptive_radii.paper import (
    MINOR_ERRORS,
    PIEZO_ERROR,
    PIEZO_GAIN,
    PIEZO_RANGE,
    RADII,
    SEVEN_WEIGHTS,
    SLOPES,
    WEIGHTS,
    fixed_radii,
    piezo,
    triangle,
)

Array = NDArray[np.float64]

RATE = 1000.0
COUNTS = range(4, 11)
# A major loop of 0 to 2 V at 4 V/s; the corners of the paper's minor loops are not printed.
MAJOR = [0.0, *([2.0, 0.0] * 4)]
MINOR = [0.0, 2.0, 0.0, 2.0, 0.5, 2.0, 1.0, 2.0, 1.5, 2.0, 0.0]


def drive(corners: list[float]) -> Array:
    """Give the triangle of 1 Hz and 2 V, or one with minor loops, by its corners."""
    return triangle(corners, 4.0 / RATE)


def misses(fixed: PrandtlIshlinskii, corners: list[float]) -> float:
    """Give how far a model misses the paper's four plays at most, its mean taken out, um.

    Parameters
    ----------
    fixed
        The model.
    corners
        Of the drive on which it is judged.
    """
    u = drive(corners)
    error = (fixed(u) - piezo()(u))[round(RATE) :]
    return float(np.abs(error - error.mean()).max())


def refit(n: int) -> PrandtlIshlinskii:
    """Fit n plays of preassigned radii to the paper's four on its major loop.

    Parameters
    ----------
    n
        How many, the one of radius 0 counted.

    Returns
    -------
    PrandtlIshlinskii
        By least squares over weights of at least 0 and an offset.
    """
    u = drive(MAJOR)
    weights, _ = fit_fixed(u, piezo()(u), fixed_radii(n), round(RATE))
    return PrandtlIshlinskii(weights[1:], fixed_radii(n), float(weights[0]))


def fit_fixed(u: Array, y: Array, r: Array, start: int) -> tuple[Array, float]:
    """Fit weights of at least 0, that of the input first, and an offset, from sample ``start`` on.

    Parameters
    ----------
    u, y
        Shape (N,).
    r
        Shape (n - 1,), radii.
    start
        First sample to compare; earlier ones set the memory.

    Returns
    -------
    weights : numpy.ndarray
        Shape (n,).
    offset : float
    """
    plays = [u, *(PrandtlIshlinskii([1.0], [each])(u) for each in r)]
    matrix = np.column_stack(plays)[start:]
    centred, out = matrix - matrix.mean(axis=0), y[start:] - y[start:].mean()
    weights, _ = nnls(centred, out)
    return weights, float(y[start:].mean() - matrix.mean(axis=0) @ weights)


def constants() -> Table:
    """Check the printed constants of the four plays against each other and against hyst."""
    u = drive(MAJOR)
    y = piezo()(u)
    settled = slice(round(RATE), None)
    found = identify_weights_from_slopes(Record(u, y, 1.0 / RATE))
    law = RadiusEstimator(WEIGHTS[1:], np.zeros(3), PIEZO_GAIN, 1.0 / RATE, p0=float(WEIGHTS[0]))
    long = drive([0.0, *([2.0, 0.0] * 60)])
    law.run(Record(long, piezo()(long), 1.0 / RATE))
    width = 2.0 * float(WEIGHTS @ RADII) / float(WEIGHTS.sum())
    rows = (
        (
            "weights: differences of the slopes",
            _listed(WEIGHTS),
            _listed(np.diff(SLOPES, prepend=0.0)),
        ),
        (
            "the same by segmentation (lemma 1)",
            _listed(WEIGHTS),
            _listed(np.diff(found.slopes, prepend=0.0)),
        ),
        ("radii by the law, gain 20, 60 s, from 0", _listed(RADII[1:]), _listed(law.radii)),
        (
            "range of the output, 2 V [um]",
            f"{PIEZO_RANGE:g} measured",
            number(float(np.ptp(y[settled]))),
        ),
        ("largest error [% of the range]", "-", number(100.0 * PIEZO_ERROR / PIEZO_RANGE, 2)),
        ("loop width 2 sum(p r) / sum(p) [V]", "-", number(width)),
        ("2 r_n and the input's range [V]", "-", f"{number(2.0 * float(RADII[-1]))} < 2"),
        (
            "range that suffices by eq. 26 [V]",
            "2 used",
            number(float(WEIGHTS.sum() / WEIGHTS[-1]) * width),
        ),
    )
    title = "Sec. V: the four plays of the paper's piezo, simulated with its printed constants"
    return Table(title, ("", "printed", "computed"), rows)


def refits() -> Table:
    """Set the printed seven plays and fair fits beside the paper's four plays, um."""
    printed = PrandtlIshlinskii(SEVEN_WEIGHTS[1:], fixed_radii(7), float(SEVEN_WEIGHTS[0]))
    models = [("printed, n = 7", printed), *((f"least squares, n = {n}", refit(n)) for n in COUNTS)]
    u = drive(MAJOR)[: 2 * round(RATE)]
    rows = tuple(
        (
            name,
            number(float(np.ptp(model(u)[round(RATE) :]))),
            number(misses(model, MAJOR), 3),
            number(misses(model, MINOR), 3),
            _listed(np.concatenate([[model.p0], model.p])),
        )
        for name, model in models
    )
    paper = ", ".join(f"{name} {error:g}" for name, error in MINOR_ERRORS.items())
    title = (
        "Sec. V-C: models of preassigned radii against the paper's four plays, which are within "
        f"{PIEZO_ERROR:g} um of its data (range {PIEZO_RANGE:g}; largest errors on its own minor "
        f"loops: {paper})"
    )
    return Table(title, ("", "range", "misses: major", "minor loops", "weights"), rows)


def _listed(values: Array) -> str:
    return " ".join(f"{each:.4f}" for each in values)
