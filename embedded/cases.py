"""What is exported, compiled and measured: every example of the contract tests, and more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from embedded.rounding_bound import NoBoundError, controller_bound, single_precision_bound
from hyst import ModifiedPrandtlIshlinskii, Operator, PrandtlIshlinskii, Preisach
from hyst.control import LimitedDrive, RepetitiveController, TrackingController
from hyst.export.c.block import Block, block_of, stepper_of
from hyst.export.c.estimator import estimator_block
from hyst.export.c.numbers import Precision
from hyst.online import JointEstimator
from hyst.operators import DeadZone
from reference.examples import EXAMPLES

Array = NDArray[np.float64]

SAMPLES = 300
HEADLINE = "inverse mpi of 10 plays"
LIMITED = "inverse mpi of 10 plays, limited"


@dataclass(frozen=True)
class Case:
    """A model and the record it is given, shape (N, inputs); some samples are not finite."""

    name: str
    model: Operator | LimitedDrive | TrackingController | RepetitiveController | JointEstimator
    inputs: Array

    @property
    def step(self) -> str:
        """The C that takes inputs u[..] into `model` and returns its output."""
        if isinstance(self.model, JointEstimator):
            return "(void)stage_update(model, u[0], u[1]);\n    return stage_command(model, u[2]);"
        inputs = ", ".join(f"u[{i}]" for i in range(self.inputs.shape[1]))
        return f"return stage_step(model, {inputs});"

    @property
    def steps(self) -> tuple[str, ...]:
        """The functions that a sample calls."""
        is_estimator = isinstance(self.model, JointEstimator)
        return ("stage_update", "stage_command") if is_estimator else ("stage_step",)

    def block(self, precision: Precision) -> Block:
        """Give what is exported."""
        if isinstance(self.model, JointEstimator):
            return estimator_block(self.model, precision)
        return block_of(self.model, precision)

    def expected(self, precision: Precision) -> NDArray[np.floating]:
        """Give Python's outputs in a precision, sample by sample."""
        step = stepper_of(self.block(precision), precision)
        y = np.array([step(*sample) for sample in self.inputs.tolist()])
        return y.astype(np.float32) if precision == "single" else y

    def bound(self) -> float:
        """Give the bound of single precision's error."""
        if isinstance(self.model, JointEstimator):
            raise NoBoundError("an estimate feeds on its own rounding")
        if isinstance(self.model, RepetitiveController):
            raise NoBoundError("what is learned feeds on its own rounding")
        if isinstance(self.model, LimitedDrive):
            raise NoBoundError("which samples are held hangs on rounding")
        finite = self.inputs[np.isfinite(self.inputs).all(axis=1)]
        if isinstance(self.model, TrackingController):
            return controller_bound(self.model, finite)
        return single_precision_bound(self.model, finite[:, 0])


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


def forty_cells_a_side() -> Preisach:
    """Give a smooth density of relays on 40 x 40 cells, as large as identification makes one."""
    edges = np.linspace(-8.0, 8.0, 41)
    middle = 0.5 * (edges[1:] + edges[:-1])
    width, centre = middle[:, None] - middle, 0.5 * (middle[:, None] + middle)
    weights = np.tril(np.exp(-(((width - 3.0) / 4.0) ** 2) - (centre / 3.0) ** 2))
    return Preisach(8.0 * weights / weights.sum(), edges, p0=0.1)


def controller(
    inverse: Operator | None, limits: tuple[float, float] | None = None, rate: float | None = None
) -> TrackingController:
    """Give a proportional-integral controller with an observer of slow disturbances."""
    slow = 20.0  # rad/s
    observer = ([[-slow]], [[-slow, slow]], [[1.0]], [[0.0, 0.0]])
    return TrackingController.from_continuous(
        ([4.0, 8.0], [1.0, 0.0]),
        dt=1e-3,
        observer=observer,
        inverse=inverse,
        limits=limits,
        rate=rate,
    )


def repetitive(inverse: Operator, limits: tuple[float, float] | None) -> RepetitiveController:
    """Give a controller for a period of 100 samples in front of a mode at 100 Hz, at 1 kHz."""
    mode = ([4e5], [1.0, 40.0, 4e5])
    return RepetitiveController.design(
        mode, 100, dt=1e-3, bandwidth=600.0, delay=1e-3, inverse=inverse, limits=limits
    )


def estimator() -> tuple[JointEstimator, Array]:
    """Give an estimator of 5 plays that starts off the truth, and u, y and y_ref for it."""
    p, r = np.array([0.4, 0.3, 0.25, 0.2, 0.15]), np.array([0.5, 1.0, 1.5, 2.5, 3.5])
    u = drive()
    y = PrandtlIshlinskii(p, r, p0=0.6)(np.nan_to_num(u, posinf=0.0, neginf=0.0))
    y = np.round(y * 1024.0) / 1024.0
    y[150] = np.nan
    start = PrandtlIshlinskii(1.1 * p, 0.9 * r, p0=0.5)
    return JointEstimator(start, memory=2000.0), np.column_stack([u, y, np.roll(y, -1)])


def cases() -> Iterator[Case]:
    """Give every case, the ones with a goal first."""
    models: dict[str, Operator | LimitedDrive] = {
        HEADLINE: ten_plays(),
        # Narrower than the record, wider than every play.
        LIMITED: LimitedDrive(ten_plays(), (-3.0, 3.5)),
        "inverse mpi of 10 plays, limited by rate": LimitedDrive(
            ten_plays(), (-3.0, 3.5), 2000.0, dt=1e-3
        ),
        "pi of 31 plays": thirty_one_plays(),
        **EXAMPLES,
    }
    relays = forty_cells_a_side()
    models |= {"preisach 40 x 40": relays, "inverse preisach 40 x 40": relays.inverse()}
    for name, model in models.items():
        yield Case(name, model, drive().reshape(-1, 1))
    both = np.column_stack([drive(), drive(1)[::-1]])
    yield Case("controller and observer", controller(None), both)
    yield Case("controller, observer and inverse mpi", controller(ten_plays()), both)
    limited = controller(ten_plays(), (-20.0, 30.0), 2e4)
    yield Case("controller, observer and inverse mpi, limited", limited, both)
    yield Case("repetitive, 100 samples, inverse mpi", repetitive(ten_plays(), None), both)
    limited = repetitive(ten_plays(), (-4.0, 5.0))
    yield Case("repetitive, 100 samples, inverse mpi, limited", limited, both)
    yield Case("joint estimator of 5 plays", *estimator())
