"""Random invertible models of plays and maps, approximate inverses and rich references."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.models import GeneralizedPrandtlIshlinskii, ModifiedPrandtlIshlinskii
from hyst.operators import Operator

Array = NDArray[np.float64]


def random_plays(rng: np.random.Generator, count: int) -> hyst.PrandtlIshlinskii:
    """Weights of either sign, cumulative weights between 0.1 and 3."""
    levels = rng.uniform(0.1, 3.0, count + 1)
    thresholds = np.sort(rng.uniform(0.0, 8.0, count))
    return hyst.PrandtlIshlinskii(np.diff(levels), thresholds, float(levels[0]))


def random_map(rng: np.random.Generator) -> hyst.DeadZone:
    """A rising map, odd or not, with slopes between 0.2 and 2."""
    right, left = rng.uniform(0.2, 2.0, 3), rng.uniform(0.2, 2.0, 3)
    left[0] = right[0]
    weights = np.concatenate([[right[0]], np.diff(right), np.diff(left)])
    bends = np.concatenate([np.sort(rng.uniform(0.1, 8, 2)), -np.sort(rng.uniform(0.1, 8, 2))])
    return hyst.DeadZone(weights, np.append(0.0, bends))


def random_model(rng: np.random.Generator, kind: str | None = None) -> Operator:
    chosen = kind or str(rng.choice(["pi", "gpi", "mpi"]))
    plays = random_plays(rng, int(rng.integers(0, 9)))
    if chosen == "pi":
        return plays
    if chosen == "gpi":
        return GeneralizedPrandtlIshlinskii(random_map(rng), plays)
    return ModifiedPrandtlIshlinskii(plays, random_map(rng))


def random_inverse(rng: np.random.Generator, model: Operator) -> Operator:
    """Unrelated, near, scaled, none: what an approximate inverse may be."""
    chosen = int(rng.integers(0, 4))
    if chosen == 0:
        return random_model(rng, {"p": "pi", "g": "mpi", "m": "gpi"}[model.kind[0]])
    if chosen == 1:
        near = model.inverse()
        theta = near.parameters().values * rng.uniform(0.9, 1.1, len(near.parameters()))
        return near.with_parameters(_with_thresholds_sorted(near, theta))
    if chosen == 2:
        return hyst.Affine(float(rng.uniform(0.1, 1.5))) @ model.inverse()
    return hyst.Affine(float(rng.uniform(0.2, 3.0)))


def _with_thresholds_sorted(operator: Operator, theta: Array) -> Array:
    """Thresholds of plays ascend, whatever noise has made of them."""
    names = operator.parameters().names
    places = [k for k, name in enumerate(names) if name.rpartition(".")[2].startswith("r[")]
    theta[places] = np.sort(theta[places])
    return theta


def rich_reference(rng: np.random.Generator, y_max: float) -> Array:
    """Nested and random turning points within +-y_max, and the extremes."""
    nested = y_max * np.linspace(1.0, 0.0, 12) * np.resize([1.0, -1.0], 12)
    return np.concatenate([rng.uniform(-y_max, y_max, 40), nested, [y_max, -y_max]])
