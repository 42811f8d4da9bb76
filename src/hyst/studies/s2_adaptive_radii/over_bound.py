"""How far the estimates of sec. IV end from the Cramer-Rao bound, in noise."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from hyst.models import PrandtlIshlinskii
from hyst.online import JointEstimator, RadiusEstimator, Trajectory
from hyst.report.table import Table, number
from hyst.signals import Record
from hyst.studies.s2_adaptive_radii.paper import DT, GAIN, INPUTS, PLAYS, P, R

Array = NDArray[np.float64]

SECONDS = 100.0
TIMES = (5.0, 20.0, 50.0, 100.0)
LEVELS = (10.0, 20.0)
RUNS = 6
# Filter and dead time that did best with the paper's law at 20 dB among 0 to 100 ms.
FILTER = {"filter_time": 0.05, "dead_time": 0.05}
ESTIMATORS = ("paper", "paper told slopes", "joint")


def paper_law(options: dict[str, float] | None = None) -> RadiusEstimator:
    """Make the paper's law for its plays, from radii of 0."""
    return RadiusEstimator(P, np.zeros(5), GAIN, DT, **(options or {}))  # type: ignore[arg-type]


def joint() -> JointEstimator:
    """Make the joint estimator for its plays, from weights 30 and radii 50 % off."""
    return JointEstimator(PrandtlIshlinskii(0.7 * P, 1.5 * R), dt=DT)


def slopes_of(u: Array, y: Array) -> Array:
    """Give dy/du from each sample to the next; NaN at the first and while the input rests.

    Parameters
    ----------
    u, y
        Shape (N,), input and output.
    """
    du, dy = np.diff(u, prepend=u[0]), np.diff(y, prepend=y[0])
    return np.asarray(np.divide(dy, du, out=np.full(u.size, np.nan), where=du != 0.0))


@functools.cache
def noisy(name: str, decibels: float) -> tuple[Array, Array, float]:
    """Give an input, its output without noise, and the deviation of a noise of so many dB."""
    u = INPUTS[name](SECONDS)
    y = PLAYS(u)
    return u, y, float(np.std(y)) * 10.0 ** (-decibels / 20.0)


def bounds(u: Array, sigma: float) -> tuple[Array, Array]:
    """Give Cramer-Rao bounds at TIMES: of the radii alone, and with all parameters together.

    Parameters
    ----------
    u
        Shape (N,), input.
    sigma
        Standard deviation of the noise.
    """
    jacobian = np.column_stack([PLAYS.jacobian(u), np.ones(u.size)])
    alone, together = [], []
    for t in TIMES:
        seen = jacobian[: round(t / DT)]
        normal = seen.T @ seen
        alone.append(sigma * np.sqrt(np.diag(np.linalg.inv(normal[6:11, 6:11]))))
        together.append(sigma * np.sqrt(np.diag(np.linalg.inv(normal))))
    return np.array(alone), np.array(together)[:, 6:11]


@functools.cache
def ratios(name: str) -> dict[str, tuple[float, ...]]:
    """Give root mean square errors of the radii over the bound at TIMES, by estimator and noise."""
    found = {}
    for decibels in LEVELS:
        u, y, sigma = noisy(name, decibels)
        alone, together = bounds(u, sigma)
        slopes = slopes_of(u, y)
        errors: dict[str, list[Array]] = {each: [] for each in ESTIMATORS}
        for seed in range(RUNS):
            noise = np.random.default_rng(seed).standard_normal(u.size)
            record = Record(u, y + sigma * noise, DT)
            measured = paper_law(FILTER).run(record, 1000)
            told = paper_law().run(record, 1000, slopes=slopes)
            for label, each, first, bound in (
                (ESTIMATORS[0], measured, 0, alone),
                (ESTIMATORS[1], told, 0, alone),
                (ESTIMATORS[2], joint().run(record, 1000), 6, together),
            ):
                errors[label].append((_at(each, first) - R) / bound)
        for label, those in errors.items():
            ratio = np.sqrt(np.mean(np.square(those), axis=(0, 2)))
            found[f"{label}, {decibels:g} dB"] = tuple(ratio.tolist())
    return found


def errors_over_bound(name: str) -> Table:
    """Set the errors of all estimators over the bound side by side.

    Parameters
    ----------
    name
        Of the input, one of ``INPUTS``.

    Returns
    -------
    Table
    """
    rows = []
    for decibels in LEVELS:
        for label in (f"{who}, {decibels:g} dB" for who in ESTIMATORS):
            rows.append((label, *(number(v, 3) for v in ratios(name)[label])))
        u, _, sigma = noisy(name, decibels)
        bound = bounds(u, sigma)[1].max(axis=1)
        rows.append((f"largest bound, {decibels:g} dB", *(number(float(v), 3) for v in bound)))
    header = ("", *(f"{t:g} s" for t in TIMES))
    what = "of the radii alone for the paper's law, of all parameters for the joint estimator"
    told = "told slopes: those before the noise"
    title = (
        f"{name}: rms error of the radii over the Cramer-Rao bound ({what}; {told}; {RUNS} runs)"
    )
    return Table(title, header, tuple(rows))


def _at(trajectory: Trajectory, first: int) -> Array:
    rows = [round(t / (1000 * DT)) - 1 for t in TIMES]
    return np.asarray(trajectory.values[rows, first : first + 5])
