"""Switching materials: first-order reversal curves that a model has not seen, in percent of range.

A material is a smooth density of relays that is on no grid, followed relay by relay on a plane far
finer than any model. It is driven over its major loop and twenty first-order reversal curves, with
noise, and every other curve is held out. Printed for each density, over seeds, is the error of the
curves that are held out, without noise,
- of Preisach models by regression of the record and straight from the curves, and of the families
  of plays, by how many times theirs is larger;
- of a Preisach model trained on the major loop and two nested loops alone, of all curves;
- of one trained on the major loop alone, of all curves, and how much of them its band holds.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.identification import identify_from_reversal_curves

Array = NDArray[np.float64]
Density = Callable[[Array, Array], Array]

NOISE = 0.002
SEEDS = (0, 1)
CURVES = 20
SAMPLES = 100
"""Of a stroke over half the range."""

REVERSALS = np.linspace(-0.95, 0.95, CURVES)
NESTED = [-0.3, 0.4, -0.3, 1.0, -1.0, 0.3, -0.4, 0.3, -1.0]
PLAYS = ("pi", "gpi", "mpi")
BETAS, ALPHAS = 4000, 500
"""Relays: columns of one beta, and thresholds alpha between which a column is interpolated."""


def gaussian(coercive: float, width: float, bias: float, tilt: float = 0.0) -> Density:
    """Give a density that is Gaussian in coercive field and bias."""

    def density(alpha: Array, beta: Array) -> Array:
        h, b = ((alpha - beta) / 2.0 - coercive) / width, (alpha + beta) / 2.0 / bias
        return np.exp(-0.5 * (h * h + b * b - 2.0 * tilt * h * b))

    return density


def log_normal(coercive: float, width: float, bias: float) -> Density:
    """Give a density that is log-normal in coercive field and Gaussian in bias."""

    def density(alpha: Array, beta: Array) -> Array:
        h = np.maximum((alpha - beta) / 2.0, 1e-9)
        return (
            np.exp(
                -0.5 * (np.log(h / coercive) / width) ** 2
                - 0.5 * ((alpha + beta) / 2.0 / bias) ** 2
            )
            / h
        )

    return density


DENSITIES: dict[str, Density] = {
    "gaussian": gaussian(0.35, 0.12, 0.2),
    "wide": gaussian(0.3, 0.25, 0.35),
    "log-normal": log_normal(0.3, 0.5, 0.2),
    "tilted": gaussian(0.4, 0.15, 0.25, tilt=0.5),
    "narrow": gaussian(0.4, 0.06, 0.1),
}


class Material:
    """Relays with a density over -1.5 to 1.5, all down at first.

    Parameters
    ----------
    density
        Over both thresholds.
    """

    def __init__(self, density: Density) -> None:
        edges = np.linspace(-1.5, 1.5, BETAS + 1)
        self._beta = (edges[1:] + edges[:-1]) / 2.0
        self._alpha = np.linspace(-1.5, 1.5, ALPHAS)
        alpha, beta = np.meshgrid(self._alpha, self._beta)
        mass = np.where(alpha >= beta, density(alpha, beta), 0.0)
        trapezoids = np.zeros_like(mass)
        trapezoids[:, 1:] = np.cumsum((mass[:, 1:] + mass[:, :-1]) / 2.0, axis=1)
        self._up_to = trapezoids / trapezoids[:, -1].sum()

    def __call__(self, u: Array) -> Array:
        """Give the share of relays that are up: in every column those up to one alpha."""
        front, columns = self._beta.copy(), np.arange(BETAS)
        step = self._alpha[1] - self._alpha[0]
        y = np.empty(u.size)
        for k, each in enumerate(u):
            front = np.where(self._beta <= each, np.maximum(front, each), self._beta)
            place = np.clip((front - self._alpha[0]) / step, 0.0, ALPHAS - 1.001)
            whole = place.astype(np.intp)
            low, high = self._up_to[columns, whole], self._up_to[columns, whole + 1]
            # A column holds no relay below its own beta.
            y[k] = np.sum(low + (place - whole) * (high - low))
        return y


def strokes(turns: Sequence[float]) -> Array:
    """Give straight strokes from turn to turn."""
    parts = [np.array([turns[0]])]
    for a, b in itertools.pairwise(turns):
        count = max(round(SAMPLES * abs(b - a)), 2)
        parts.append(np.linspace(a, b, count + 1)[1:])
    return np.concatenate(parts)


def curves_from(reversals: Array) -> list[float]:
    """Give the turns of first-order reversal curves."""
    return [each for beta in reversals.tolist() for each in (beta, 1.0)]


def main() -> None:
    """Print a row for each density."""
    print(f"noise {100 * NOISE:g} %, errors in % of range, medians of {len(SEEDS)} seeds")
    print(
        "              held out of 20 curves, trained on the major loop and the others |"
        " two nested loops | major loop alone"
    )
    print(
        "  density     regression  direct  "
        + "  ".join(f"{each:>11s}" for each in PLAYS)
        + " |                  | error  band holds"
    )
    for name, density in DENSITIES.items():
        rows = np.array([row(Material(density), seed) for seed in SEEDS])
        found = np.median(rows, axis=0)
        plays = "  ".join(f"{e:5.2f} x{e / found[0]:4.1f}" for e in found[2 : 2 + len(PLAYS)])
        print(
            f"  {name:11s} {found[0]:8.3f} {found[1]:9.3f}   {plays} | {found[-4]:8.3f}         |"
            f" {found[-3]:5.2f}  {100 * found[-2]:3.0f} %   ({found[-1]:.2f} s a fit)",
            flush=True,
        )


def row(material: Material, seed: int) -> list[float]:
    """Give all errors of one density and seed, and the time of one fit."""
    rng = np.random.default_rng(seed)

    def record(turns: Sequence[float]) -> hyst.Record:
        u = strokes(turns)
        y = material(u)
        return hyst.Record(u, y + NOISE * np.ptp(y) * rng.standard_normal(u.size), 0.01)

    major = [-1.0, 1.0, -1.0, 1.0]
    trained = record([*major, *curves_from(REVERSALS[::2])])
    others, every = (
        strokes([-1.0, 1.0, *curves_from(each)]) for each in (REVERSALS[1::2], REVERSALS)
    )
    began = time.perf_counter()
    regression = hyst.identify(trained, family="preisach", delay=0)
    spent = time.perf_counter() - began
    result = [
        error(regression.model, material, others),
        error(identify_from_reversal_curves(trained).model, material, others),
    ]
    for family in PLAYS:
        found = hyst.identify(trained, family=family, delay=0, allow_unconverged=True)
        result.append(error(found.model, material, others))
    nested = hyst.identify(record([*major, -1.0, 1.0, *NESTED]), family="preisach", delay=0)
    alone = hyst.identify(record([*major, -1.0, 1.0]), family="preisach", delay=0)
    low, high = alone.band(every)
    y = material(every)
    held = float(np.mean(((low <= y) & (y <= high))[every.argmax() :]))
    return [
        *result,
        error(nested.model, material, every),
        error(alone.model, material, every),
        held,
        spent,
    ]


def error(model: hyst.Operator, material: Material, u: Array) -> float:
    """Give the rms error from the first top on, where memory is known, in percent of range."""
    y = material(u)
    top = int(u.argmax())
    return 100.0 * float(np.sqrt(np.mean(np.square(model(u) - y)[top:]))) / float(np.ptp(y))


if __name__ == "__main__":
    main()
