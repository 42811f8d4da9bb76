"""The kernel's own derivative: how many times longer it takes than a derivative written by hand.

Prints, for one machine and one run, columns of the Jacobian, nanoseconds a sample by hand and by
the kernel, and their ratio (by kernel over by hand; median over turns), for stages that have a
derivative of their own; and for others the nanoseconds of the kernel's.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.timing import interleaved, report_times
from hyst import _engine
from hyst.models import LinearDynamics, MemoryElement, MemoryFunction, RambergOsgood

Array = NDArray[np.float64]

SAMPLES = 20_000
R = np.linspace(0.1, 2.0, 10)
P = np.linspace(0.1, 1.0, 10)
PLAYS = hyst.PrandtlIshlinskii(P, R, 0.5)
ENVELOPE = hyst.DeadZone(
    [1.0, 0.3, -0.2, 0.1, 0.15, -0.1, 0.2], [0.0, 0.5, 1.1, 1.6, -0.4, -1.0, -1.6]
)
LAG = LinearDynamics.from_transfer_function(
    [0.1, 0.2, 0.05, 0.02, 0.01], np.poly([0.5, 0.6, 0.3 + 0.3j, 0.3 - 0.3j]).real, dt=0.01
)
BY_HAND: dict[str, hyst.Operator] = {
    "affine": hyst.Affine(2.0, 1.0),
    "play": hyst.Play(0.5),
    "dead zone, 7": ENVELOPE,
    "pi, 10 plays": PLAYS,
    "gpi, 7 and 10": hyst.GeneralizedPrandtlIshlinskii(ENVELOPE, PLAYS),
    "rate-dependent, 10": hyst.RateDependentPrandtlIshlinskii(P, R, beta=0.02, dt=0.1, p0=0.3),
    "state space, order 4": LAG,
    "two sections": hyst.models.SecondOrderSections.from_linear(LAG),
    "pi, state space": LAG @ PLAYS,
}
BY_KERNEL: dict[str, hyst.Operator] = {
    "ramberg-osgood": RambergOsgood(1.0, 0.5, 1.2),
    "its inverse": RambergOsgood(1.0, 0.5, 1.2).inverse(),
    "memory element": MemoryElement(MemoryFunction.polynomial([1.0, 0.2, 0.1]), 1e-3),
}


def jacobian(operator: hyst.Operator, u: Array, derivative: str) -> None:
    chain = _engine.Chain(operator.stages())
    result = np.empty((u.size, chain.parameter_count))
    chain.jacobian(operator.initial_state(), u, result, derivative)


def row(kind: str, name: str, operator: hyst.Operator, u: Array, ways: tuple[str, ...]) -> str:
    times = interleaved(
        {way: lambda way=way: jacobian(operator, u, way) for way in ways}, seconds=0.5
    )
    columns = len(operator.parameters().values)
    told = "".join(f"{1e9 * float(np.median(times[way])) / u.size:10.1f}" for way in ways)
    if len(ways) == 2:
        what = f"by kernel over by hand, {name}, {kind}"
        told += f"{report_times(what, times, 'kernel', 'auto', better='smaller'):8.1f}"
    return f"{name:22s}{columns:8d}{told}"


def main() -> None:
    t = np.arange(SAMPLES) / SAMPLES
    records = {
        "smooth": 3.0 * np.sin(2.0 * np.pi * 20.0 * t) * np.exp(-t) + 0.01,
        "rough": np.random.default_rng(0).standard_normal(SAMPLES),
    }
    for kind, u in records.items():
        print(f"{kind + ', ' + _engine.instruction_set():22s} columns   by hand by kernel   ratio")
        for name, operator in BY_HAND.items():
            print(row(kind, name, operator, u, ("auto", "kernel")))
        for name, operator in BY_KERNEL.items():
            print(row(kind, name, operator, u, ("kernel",)))
