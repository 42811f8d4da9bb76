"""What is exported, compiled and measured: every example of the contract tests, and two sizes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from embedded.rounding_bound import single_precision_bound
from hyst import ModifiedPrandtlIshlinskii, Operator, PrandtlIshlinskii
from hyst.operators import DeadZone
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

SAMPLES = 300
HEADLINE = "inverse mpi of 10 plays"


@dataclass(frozen=True)
class Case:
    """A model and the record it is given, shape (N, inputs); some samples are not finite.

    `step` is the C that takes inputs u[..] into `model`, `roots` the functions it needs, the step
    last, and `fault` the bits that stand at the end.
    """

    name: str
    model: Operator
    inputs: Array
    step: str = "return stage_step(model, u[0]);"
    roots: tuple[str, ...] = ("stage_init", "stage_step")
    fault: int = 1

    def expected(self) -> Array:
        """Give the outputs in double precision, sample by sample."""
        step = self.model.stepper()
        return np.array([step(u) for u in self.inputs[:, 0].tolist()])

    def bound(self) -> float:
        """Give the bound of single precision's error."""
        u = self.inputs[:, 0]
        return single_precision_bound(self.model, u[np.isfinite(u)])


def drive(seed: int = 0) -> Array:
    """Give a record that turns, rests and jumps, every sample of it exact in single precision."""
    rng = np.random.default_rng(seed)
    corners = rng.uniform(-7.0, 7.0, SAMPLES // 10 + 1)
    corners[5:7] = 6.5, 6.5
    walk = np.interp(np.arange(SAMPLES), np.arange(0, SAMPLES + 10, 10), corners)
    walk[::17] = rng.uniform(-7.0, 7.0, walk[::17].size)
    walk[0] = 0.0
    walk[100], walk[200], walk[201] = np.nan, np.inf, -np.inf
    return np.asarray(np.round(walk * 1024.0) / 1024.0)


def ten_plays() -> Operator:
    """Give the inverse of a modified model as identification leaves it: 10 plays, 7 dead zones."""
    weights = 0.4 * np.exp(-0.25 * np.arange(10.0))
    plays = PrandtlIshlinskii(weights, 0.3 * np.arange(1.0, 11.0), p0=0.6)
    map_ = DeadZone(
        [0.9, 0.08, 0.06, -0.05, -0.07, 0.04, 0.06], [0.0, 1.0, 2.0, 4.0, -1.0, -2.0, -4.0]
    )
    return ModifiedPrandtlIshlinskii(plays, map_).inverse()


def thirty_one_plays() -> Operator:
    """Give a bank of plays of the size of a finely identified model."""
    return PrandtlIshlinskii(np.full(31, 0.05), 0.2 * np.arange(1.0, 32.0), p0=0.3)


def cases() -> Iterator[Case]:
    """Give every case, the ones with a goal first."""
    models = {HEADLINE: ten_plays(), "pi of 31 plays": thirty_one_plays(), **EXAMPLES}
    for name, model in models.items():
        yield Case(name, model, drive().reshape(-1, 1))
