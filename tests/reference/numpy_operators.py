"""Reference implementations, written from the papers' equations and from nothing else.

They read the dictionary of an operator, so that no code of the package computes anything here, and
sum with math.fsum, whose result is the exact sum rounded once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

EPS = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Trace:
    """A simulated record.

    ``regimes`` holds for every sample which branch each play and each dead-zone took;
    ``rounding`` bounds what rounding may have moved an output computed in another order, and
    ``memory_rounding`` a memory.
    """

    y: Array
    memory: Array
    regimes: tuple[tuple[int, ...], ...]
    rounding: float
    memory_rounding: float = 0.0


def play(u: Array, r: float, z: float) -> tuple[Array, list[int]]:
    """S1 eq. 2: F_k = max(u_k - r, min(u_k + r, F_{k-1}))."""
    outputs, regimes = [], []
    for value in u.tolist():
        # A play of threshold 0 is the input itself; it has one branch only.
        regimes.append(0 if r == 0.0 else int(value - r > z) - int(value + r < z))
        z = max(value - r, min(value + r, z))
        outputs.append(z)
    return np.array(outputs), regimes


def play_by_cases(u: Array, r: float, z: float) -> Array:
    """S0 eq. 8, the same operator as three cases."""
    outputs = []
    before = z
    for value in u.tolist():
        if value < before and value + r < z:
            z = value + r
        elif value > before and value - r > z:
            z = value - r
        before = value
        outputs.append(z)
    return np.array(outputs)


def stop_by_increments(u: Array, r: float) -> Array:
    """An elastic-plastic spring: the stress follows the strain's increments inside [-r, r]."""
    stress, before, outputs = 0.0, 0.0, []
    for value in u.tolist():
        stress = min(r, max(-r, stress + value - before))
        before = value
        outputs.append(stress)
    return np.array(outputs)


def dead_zone(u: float, rho: float) -> tuple[float, int]:
    """S1 eq. 50 for rho > 0, its mirror image for rho < 0, and the linear part for rho = 0."""
    if rho > 0.0:
        return max(u - rho, 0.0), int(u > rho)
    if rho < 0.0:
        return min(u - rho, 0.0), -int(u < rho)
    return u, 0


def dead_zone_by_direction(before: float, u: float, eta: float) -> tuple[float, int]:
    """S0 eq. 3 as printed."""
    if u > before and u > eta:
        return u - eta, 1
    if u < before and u < -eta:
        return u + eta, -1
    return 0.0, 0


def simulate(model: dict[str, Any], u: Sequence[float] | Array) -> Trace:
    """Run the operator that a dictionary describes from its initial state."""
    trace = Trace(np.asarray(u, dtype=np.float64), np.empty(0), ((),) * len(u), 0.0)
    for stage in flat(model):
        passed = _SIMULATE[stage["kind"]](stage, trace.y)
        slope = steepest(stage)
        trace = Trace(
            passed.y,
            np.concatenate([trace.memory, passed.memory]),
            tuple(a + b for a, b in zip(trace.regimes, passed.regimes, strict=True)),
            passed.rounding + slope * trace.rounding,
            max(trace.memory_rounding, trace.rounding),  # clamping moves nothing further apart
        )
    return trace


def has_twin(model: dict[str, Any]) -> bool:
    """Tell whether all parts of a model have a reference implementation here."""
    return all(stage["kind"] in _SIMULATE for stage in flat(model))


def jumps_behind_rounding(model: dict[str, Any]) -> bool:
    """A dead-zone by direction jumps, so a rounded input may put it on the other side."""
    return any(stage.get("variant") == "by-direction" for stage in flat(model)[1:])


def flat(model: dict[str, Any]) -> list[dict[str, Any]]:
    """The operators of a composition in the order the signal passes them."""
    parts = {
        "composition": lambda: model["stages"],
        "generalized-prandtl-ishlinskii": lambda: [model["envelope"], model["pi"]],
        "modified-prandtl-ishlinskii": lambda: [model["pi"], model["output_map"]],
    }
    if model["kind"] not in parts:
        return [model]
    return [stage for part in parts[model["kind"]]() for stage in flat(part)]


def steepest(stage: dict[str, Any]) -> float:
    """A bound of the slope of one stage while no branch changes."""
    match stage["kind"]:
        case "affine":
            return abs(stage["gain"])
        case "play":
            return 1.0
        case "stop":
            return 2.0
        case "dead-zone":
            return sum(map(abs, stage["weights"]))
        case _:
            return abs(stage["p0"]) + sum(map(abs, stage["p"]))


def _sum(terms: Sequence[Sequence[float]], memory: Array, regimes: Any) -> Trace:
    """Add the terms of each sample; n terms added in any order are off by n eps of their sizes."""
    y = np.array([math.fsum(row) for row in terms])
    size = max(math.fsum(map(abs, row)) for row in terms)
    # Each product is rounded once, each sum once; a subnormal product loses what is below it.
    return Trace(y, memory, regimes, (len(terms[0]) + 1) * (EPS * size + 5e-324))


def _affine(stage: dict[str, Any], u: Array) -> Trace:
    terms = [(stage["gain"] * value, stage["offset"]) for value in u.tolist()]
    return _sum(terms, np.empty(0), ((),) * u.size)


def _play(stage: dict[str, Any], u: Array) -> Trace:
    z, regimes = play(u, stage["r"], stage.get("z0", 0.0))
    return Trace(z, z[-1:], tuple((each,) for each in regimes), 0.0)


def _stop(stage: dict[str, Any], u: Array) -> Trace:
    z, regimes = play(u, stage["r"], stage.get("z0", 0.0))
    terms = list(zip(u.tolist(), (-z).tolist(), strict=True))
    return _sum(terms, z[-1:], tuple((each,) for each in regimes))


def _dead_zone(stage: dict[str, Any], u: Array) -> Trace:
    by_direction = stage["variant"] == "by-direction"
    pairs = list(zip(stage["weights"], stage["thresholds"], strict=True))
    terms, regimes, before = [], [], 0.0
    for value in u.tolist():
        parts = [
            dead_zone_by_direction(before, value, rho) if by_direction else dead_zone(value, rho)
            for _, rho in pairs
        ]
        terms.append([w * part[0] for (w, _), part in zip(pairs, parts, strict=True)])
        regimes.append(tuple(part[1] for part in parts))
        before = value
    return _sum(terms, u[-1:] if by_direction else np.empty(0), tuple(regimes))


def _prandtl_ishlinskii(stage: dict[str, Any], u: Array) -> Trace:
    """S1 eq. 4: G = p0 u + sum_j p_j F_j."""
    n = len(stage["p"])
    runs = [play(u, r, z) for r, z in zip(stage["r"], stage.get("z0", [0.0] * n), strict=True)]
    z = np.array([run[0] for run in runs]).reshape(n, u.size)
    terms = np.vstack([stage["p0"] * u, np.array(stage["p"])[:, None] * z]).T
    regimes = tuple(tuple(run[1][k] for run in runs) for k in range(u.size))
    return _sum(terms.tolist(), z[:, -1], regimes)


_SIMULATE = {
    "affine": _affine,
    "play": _play,
    "stop": _stop,
    "dead-zone": _dead_zone,
    "prandtl-ishlinskii": _prandtl_ishlinskii,
}
