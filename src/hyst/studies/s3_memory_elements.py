"""S3, memory elements: the loops of example 1, Fig. 4, and feedforward of eq. 24."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from hyst.identification import Identified, identify
from hyst.identification.fit_model import fit
from hyst.models import MasingOperator, PowerLaw, RambergOsgood
from hyst.operators import Affine, Operator
from hyst.report.reversal_figure import draw_collapse, draw_memories
from hyst.report.table import Table, number
from hyst.signals import Record
from hyst.studies.simulated_piezo import DT, SimulatedPiezo

Array = NDArray[np.float64]

TITLE = "Ramberg-Osgood as a memory element: identification and feedforward of a piezo"

PLAYS = 15
POWER_LAW = "power law"
"""The paper's memory element, the least slope c1 bounded, since these loops ask for none."""

PAPER = {"linear": 339.3, "pi": 97.5, POWER_LAW: 27.9}
"""RMS errors of feedforward on the measured actuator, nm (S3 sec. V-C)."""

PLANTS = {
    "Bouc-Wen with a resonance": SimulatedPiezo(asymmetric=False, creeps=False),
    "the same, asymmetric": SimulatedPiezo(creeps=False),
    "asymmetric, with creep": SimulatedPiezo(),
}
"""None of the models is one of these: what a feedforward leaves there is a result, not an input."""


def example_1() -> Array:
    """Give the input of eq. 1, volts, from 0 to 3 s."""
    t = np.arange(0.0, 3.0, DT)
    large, small = 250.0 * np.sin(2.0 * np.pi * t), 125.0 * np.sin(2.0 * np.pi * t) - 125.0
    return np.where(t <= 1.75, large, small)


def reference() -> tuple[Array, slice]:
    """Give a way from rest to the start of eq. 24, then two periods of it, nm; and where those are.

    Returns
    -------
    y_ref : numpy.ndarray
    eq_24 : slice
    """
    t = np.arange(0.0, 2.0, DT)
    rise = 0.5 - 0.5 * np.cos(np.pi * np.arange(0.0, 1.0, 2.0 * DT))
    y_ref = np.concatenate([-1600.0 * rise, -1600.0 * np.cos(2.0 * np.pi * t)])
    return y_ref, slice(rise.size, y_ref.size)


@functools.cache
def identified(plant: SimulatedPiezo) -> dict[str, Identified]:
    """Identify the models from 250 sin(20 pi t) V, one second of it (S3 sec. V-B).

    Parameters
    ----------
    plant
        What is measured.
    """
    t = np.arange(0.0, 1.0, DT)
    u = 250.0 * np.sin(20.0 * np.pi * t)
    record = Record(u, plant.measure(u), DT)
    # Play radii evenly spaced, as is usual for a bank of fixed size.
    radii = 250.0 * np.arange(PLAYS) / PLAYS + 0.5 * 250.0 / PLAYS
    return {
        "linear": identify(record, family="linear", delay=0),
        "pi": identify(record, family="pi", radii=radii, delay=0),
        "mpi": identify(record, family="mpi", radii=radii, delay=0),
        POWER_LAW: _power_law(record),
        "bouc-wen": identify(record, family="bouc-wen", delay=0),
    }


def _power_law(record: Record) -> Identified:
    """Fit ``dy/du = c1 + c2 p^c3`` with c1 at least a thousandth of the loop's slope."""
    slope, c3 = float(np.ptp(record.y) / np.ptp(record.u)), 0.3
    curve = PowerLaw(0.3 * slope, 0.7 * slope * (1.0 + c3) / float(np.ptp(record.u)) ** c3, c3)
    start = Affine(1.0) @ MasingOperator(curve)
    free = [each for each in start.parameters().names if not each.endswith(".gain")]
    return fit(start, record, free=free, bounds={"masing.c1": (1e-3 * slope, np.inf)})


def feedforward_error(model: Operator, plant: SimulatedPiezo) -> float:
    """Give the rms error of a feedforward of eq. 24, nm, its mean taken out, without noise.

    Parameters
    ----------
    model
        Its inverse makes the command.
    plant
        It answers.

    Returns
    -------
    float
    """
    y_ref, eq_24 = reference()
    return float(np.std((plant(model.inverse()(y_ref)) - y_ref)[eq_24]))


def tables() -> tuple[Table, ...]:
    """Compute the tables of the study.

    Returns
    -------
    tuple of Table
    """
    element = identified(SimulatedPiezo())[POWER_LAW]
    return (_loops_table(), _feedforward_table(), _parameters_table(element))


def figures() -> dict[str, bytes]:
    """Draw example 1 in both memories, and Fig. 4.

    Returns
    -------
    dict
        PNG by file name.
    """
    model = RambergOsgood(*_example_constants())
    u = example_1()
    return {
        "ramberg-osgood-memories.png": draw_memories(model, *minor_loops()),
        "s3-slopes.png": draw_collapse(model, u),
    }


def minor_loops() -> tuple[Array, Array]:
    """Give large loops with small ones on their way up; and their time, seconds."""
    t = np.arange(0.0, 4.0, DT)
    rising = np.maximum(np.cos(2.0 * np.pi * t), 0.0)
    return 200.0 * np.sin(2.0 * np.pi * t) + 60.0 * rising * np.sin(18.0 * np.pi * t), t


def _example_constants() -> tuple[float, float, float]:
    """Constants with which a branch of 500 V is 3.2 um, nm and V: the loop of S3 Fig. 2."""
    return 4.4, 0.13, 0.5


def _loops_table() -> Table:
    """Where the loops of example 1 end, in both memories."""
    u = example_1()
    closes = {}
    for memory in ("masing", "last-reversal"):
        model = RambergOsgood(*_example_constants()).with_memory(memory)
        y = model(u)
        bottoms = np.flatnonzero(np.isclose(u, -250.0, rtol=0.0, atol=1e-9))
        minor, t = minor_loops()
        ends = model(minor)[[int(np.argmin(np.abs(t - each))) for each in (1.75, 3.75)]]
        closes[memory] = (float(np.ptp(y[bottoms])), float(abs(np.diff(ends)[0])))
    rows = tuple(
        (memory, number(example, 3), number(drift, 3))
        for memory, (example, drift) in closes.items()
    )
    return Table(
        "Do loops close? Distance of the outputs at the same lowest input, cycles apart [nm]",
        ("memory", "eq. 1", "200 V with minor loops"),
        rows,
    )


def _feedforward_table() -> Table:
    names = {
        "linear": "linear",
        "pi": f"Prandtl-Ishlinskii, {PLAYS} plays",
        "mpi": f"modified Prandtl-Ishlinskii, {PLAYS} plays",
        POWER_LAW: "memory element, power law",
        "bouc-wen": "Bouc-Wen",
    }
    rows = []
    for name, words in names.items():
        found = [identified(plant)[name] for plant in PLANTS.values()]
        errors = [
            number(feedforward_error(each.model, plant), 3)
            for each, plant in zip(found, PLANTS.values(), strict=True)
        ]
        constants = str(found[0].parameter_values.size - 1)
        rows.append((words, constants, *errors, number(PAPER[name], 4) if name in PAPER else "-"))
    return Table(
        "Feedforward of eq. 24, rms error [nm]: simulated piezos that are none of the models, and "
        "the paper's measured one",
        ("feedforward", "constants", *PLANTS, "paper"),
        tuple(rows),
    )


def _parameters_table(found: Identified) -> Table:
    rows = tuple(
        (name, number(float(value), 5), number(float(error), 2))
        for name, value, error in zip(
            found.parameter_names, found.parameter_values, found.standard_errors, strict=True
        )
    )
    return Table(
        "The memory element identified from the last of them",
        ("constant", "value", "standard error"),
        rows,
    )
