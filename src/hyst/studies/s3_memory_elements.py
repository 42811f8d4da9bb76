"""S3, memory elements: the loops of example 1, Fig. 4, and feedforward of eq. 24."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hyst.identification import Identified, identify
from hyst.models import MasingOperator, PiecewiseLinear, RambergOsgood
from hyst.operators import Operator
from hyst.report.reversal_figure import draw_collapse, draw_memories
from hyst.report.tables import Table, number
from hyst.signals import Record

Array = NDArray[np.float64]

TITLE = "Ramberg-Osgood as a memory element: identification and feedforward of a piezo"

DT = 5e-4
SCATTER = 0.0019
"""Of a measured piezo from cycle to cycle, rms over its stroke: the noise of the simulated one."""

PLAYS = 15

PAPER = {"linear": 339.3, "pi": 97.5, "ramberg-osgood": 27.9}
"""RMS errors of feedforward on the measured actuator, nm (S3 sec. V-C)."""


class SimulatedPiezo:
    """A piezo that is none of the models compared: asymmetric, with nested loops.

    The slope grows exponentially with the way since a reversal, and a parabola bends the loops, so
    that rising and falling branches differ. Volts in, nanometres out, some 3.2 um at 500 V, no
    dynamics. The parabola is sized so that a symmetric model misses the loop by as much as on a
    measured piezo, 0.7 % of its stroke; the hysteresis so that a line misses by as much as in S3.
    """

    def __init__(self, noise_seed: int = 0) -> None:
        x = np.linspace(0.0, 300.0, 601)[1:]
        # f(x) = 1/2 int_0^2x M(p) dp with M(p) = 2.2 + 8.3 (1 - exp(-p / 310 V)) nm/V.
        f = 10.5 * x - 8.3 * 155.0 * (1.0 - np.exp(-2.0 * x / 310.0))
        self._loops = MasingOperator(PiecewiseLinear.from_points(x, f))
        self._noise = np.random.default_rng(noise_seed)

    def __call__(self, u: Array) -> Array:
        """Give the position."""
        straight = self._loops(u)
        return np.asarray(straight + 2.6e-5 * straight**2)

    def measure(self, u: Array) -> Array:
        """Give the position with the sensor's noise."""
        y = self(u)
        return np.asarray(y + SCATTER * np.ptp(y) * self._noise.normal(size=y.size))


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


def identified() -> dict[str, Identified]:
    """Identify the models from 250 sin(20 pi t) V, one second of it (S3 sec. V-B)."""
    t = np.arange(0.0, 1.0, DT)
    u = 250.0 * np.sin(20.0 * np.pi * t)
    record = Record(u, SimulatedPiezo().measure(u), DT)
    # Play radii evenly spaced, as is usual for a bank of fixed size.
    radii = 250.0 * np.arange(PLAYS) / PLAYS + 0.5 * 250.0 / PLAYS
    return {
        "linear": identify(record, family="linear", delay=0),
        "pi": identify(record, family="pi", radii=radii, delay=0),
        "mpi": identify(record, family="mpi", radii=radii, delay=0),
        "ramberg-osgood": identify(record, family="ramberg-osgood", delay=0),
    }


def feedforward_error(model: Operator) -> float:
    """Give the rms error of a feedforward of eq. 24, nm, its mean taken out.

    Parameters
    ----------
    model
        Its inverse makes the command; the simulated piezo answers.

    Returns
    -------
    float
    """
    y_ref, eq_24 = reference()
    y = SimulatedPiezo(noise_seed=1).measure(model.inverse()(y_ref))
    return float(np.std((y - y_ref)[eq_24]))


def tables() -> tuple[Table, ...]:
    """Compute the tables of the study.

    Returns
    -------
    tuple of Table
    """
    found = identified()
    return (_loops_table(), _feedforward_table(found), _parameters_table(found["ramberg-osgood"]))


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


def _feedforward_table(found: dict[str, Identified]) -> Table:
    errors = {name: feedforward_error(each.model) for name, each in found.items()}
    names = {
        "linear": "linear",
        "pi": f"Prandtl-Ishlinskii, {PLAYS} plays",
        "mpi": f"modified Prandtl-Ishlinskii, {PLAYS} plays",
        "ramberg-osgood": "memory element",
    }
    rows = tuple(
        (
            names[name],
            str(found[name].parameter_values.size - 1),
            number(found[name].metrics["training"].rms, 3),
            number(errors[name], 4),
            number(PAPER[name], 4) if name in PAPER else "-",
        )
        for name in errors
    )
    return Table(
        "Feedforward of eq. 24, rms error [nm]: a simulated piezo, and the paper's measured one",
        ("feedforward", "constants", "misses the record by", "simulated", "paper"),
        rows,
    )


def _parameters_table(found: Identified) -> Table:
    rows = tuple(
        (name, number(float(value), 5), number(float(error), 2))
        for name, value, error in zip(
            found.parameter_names, found.parameter_values, found.standard_errors, strict=True
        )
    )
    return Table("The memory element identified", ("constant", "value", "standard error"), rows)
