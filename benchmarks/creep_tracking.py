"""Open-loop tracking of a stage that creeps and lags, by inverses identified from one record.

The plant (a modified Prandtl-Ishlinskii model, creep of three time constants that make 6 % of the
stroke, an amplifier's lag of 0.42 samples, noise of 0.1 %) is simulated at a hundred times the
sample rate. Each reference is followed for 60 s through the exact inverse; errors are those of the
plant without the noise of its sensor, in percent of the stroke.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import hyst
from benchmarks.creeping_actuator import CreepingActuator, record_of_a_lab

Array = NDArray[np.float64]

DURATION, NOISE = 60.0, 1e-3
PLANTS = {
    "as stated": CreepingActuator(),
    "slower": CreepingActuator((0.03, 0.02, 0.01), (0.21, 1.7, 14.0)),
    "no creep": CreepingActuator((), ()),
}


def references(low: float, high: float, dt: float) -> dict[str, Array]:
    """Give outputs to follow, from rest at 0 within a second and then within the range.

    Parameters
    ----------
    low, high
        Of the output.
    dt
        Sample time, s.
    """
    t = np.arange(round(DURATION / dt)) * dt
    triangle = np.abs(2.0 * ((t / 4.0 + 0.5) % 1.0) - 1.0)
    sine = 0.5 - 0.5 * np.cos(2.0 * np.pi * t / 3.0)
    levels = np.array([0.0, 0.8, 0.8, 0.2, 0.6, 0.6, 0.35, 0.9, 0.9, 0.9, 0.5, 0.1, 0.1])
    steps = np.interp(t, np.linspace(0.0, DURATION, levels.size), levels)
    mixed = steps + 0.06 * np.sin(2.0 * np.pi * 0.9 * t) + 0.03 * np.sin(2.0 * np.pi * 2.3 * t)
    shapes = {"triangle": triangle, "sine": sine, "mixed": mixed}
    rise = np.minimum(t / 2.0, 1.0)
    return {
        name: low + (high - low) * (0.05 + 0.9 * np.clip(each, 0.0, 1.0)) * rise
        for name, each in shapes.items()
    }


def tracked(actuator: CreepingActuator, model: hyst.Operator, reference: Array) -> Array:
    """Give the error of following a reference open loop, of the same shape.

    Parameters
    ----------
    actuator
        The plant.
    model
        As identified.
    reference
        Shape (N,), the output to follow.
    """
    return actuator.output(model.inverse()(reference)) - reference


def main() -> None:
    print("| plant | creep | fit, s | weights | time constants, s | triangle | sine | mixed |")
    print("|---|---|---|---|---|---|---|---|")
    for name, actuator in PLANTS.items():
        u = record_of_a_lab(dt=actuator.dt)
        stroke = float(np.ptp(actuator.output(u)))
        y = actuator.output(u, NOISE * stroke, seed=1)
        record = hyst.Record(u, y, actuator.dt)
        goals = references(actuator.offset, actuator.offset + 0.95 * stroke, actuator.dt)
        for creep in ("auto", None):
            begun = time.perf_counter()
            found = hyst.identify(record, family="mpi", creep=creep)
            took = time.perf_counter() - begun
            errors = [
                100.0 * float(np.sqrt(np.mean(tracked(actuator, found.model, goal) ** 2))) / stroke
                for goal in goals.values()
            ]
            weights, times = (_told(found, kind) for kind in ("weights[", "time_constants["))
            cells = (name, "yes" if creep else "no", f"{took:.1f}", weights, times)
            print("| " + " | ".join((*cells, *(f"{each:.3f} %" for each in errors))) + " |")


def _told(found: hyst.Identified, kind: str) -> str:
    values = [
        f"{value:.3g} +- {error:.1g}"
        for name, value, error in zip(
            found.parameter_names, found.parameter_values, found.standard_errors, strict=True
        )
        if name.startswith(f"creep.{kind}")
    ]
    return ", ".join(values) or "-"


if __name__ == "__main__":
    main()
