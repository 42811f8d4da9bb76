"""Inverse, feedback and observer, alone and together: what each part of a loop is worth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst.checks.arrays import one_record
from hyst.control.closed_loop import ClosedLoop
from hyst.control.discretization import Method
from hyst.control.drive_limits import Limits
from hyst.control.feedback.loop_plant import static_gain
from hyst.control.loop_system import plant_of
from hyst.control.sampled.plant import sampled_plant
from hyst.control.sampled.tried import TriedLoop, try_block
from hyst.control.tracking_controller import TrackingController
from hyst.errors import InputError
from hyst.operators import Affine, Operator

Array = NDArray[np.float64]

Mark: TypeAlias = Literal["proven", "simulated only", "NOT SAFE"]

_MARKS: dict[str, Mark] = {
    "proven": "proven", "simulated": "simulated only", "not safe": "NOT SAFE"
}  # fmt: skip
_HALVINGS = 20  # of a reference that the inverse cannot give


@final
@dataclass(frozen=True, eq=False)
class ComparedLoop:
    """A row: one loop, how well it tracks, and what is known of its safety.

    Parameters
    ----------
    name
        What is in it.
    tried
        The block, its signals, and the judgement.
    mark
        ``"proven"``, ``"simulated only"`` or ``"NOT SAFE"``.
    reason
        Why.
    """

    name: str
    tried: TriedLoop
    mark: Mark
    reason: str

    @property
    def block(self) -> TrackingController:
        """What ran."""
        return self.tried.block

    @property
    def loop(self) -> ClosedLoop:
        """Its signals."""
        return self.tried.loop

    @property
    def rms(self) -> float:
        """Root mean square of the tracking error; infinite if it diverged."""
        return self.loop.rms_error

    @property
    def largest(self) -> float:
        """Largest tracking error, without sign; infinite if it diverged."""
        return self.loop.max_error

    @property
    def jitter(self) -> float:
        """Standard deviation of ``u[k+1] - u[k]`` with the noise; infinite if it diverged."""
        return self.loop.drive_jitter

    @property
    def noise_jitter(self) -> float:
        """The part of it that noise alone makes."""
        return self.tried.noise_jitter


@final
@dataclass(frozen=True, eq=False)
class LoopComparison:
    """Loops side by side.

    Parameters
    ----------
    rows
        One a loop, from the least to the most that is in it.
    noise
        Standard deviation of the sensor's noise that was simulated.
    """

    rows: tuple[ComparedLoop, ...]
    noise: float

    def __getitem__(self, name: str) -> ComparedLoop:
        """Give the row of a name.

        Parameters
        ----------
        name
            Of a loop.

        Raises
        ------
        InputError
            If there is none of this name.
        """
        for row in self.rows:
            if row.name == name:
                return row
        raise InputError(
            f"there is no loop {name!r}; give one of {', '.join(each.name for each in self.rows)}"
        )

    @property
    def header(self) -> tuple[str, ...]:
        """Headings of the table."""
        return ("loop", "rms", "max", "drive jitter", "of noise", "safe?")

    def row_of(self, row: ComparedLoop) -> tuple[str, ...]:
        """Give a row in words, under these headings.

        Parameters
        ----------
        row
            One of the rows.
        """
        return (
            row.name,
            _told(row.rms),
            _told(row.largest),
            _told(row.jitter),
            _told(row.noise_jitter),
            row.mark if row.mark == "proven" else f"{row.mark}: {row.reason}",
        )

    def summary(self) -> str:
        """Give the table as text; what is not proven safe is marked in it."""
        lines = [self.header, *(self.row_of(row) for row in self.rows)]
        widths = [max(len(line[k]) for line in lines) for k in range(len(self.header))]
        return "\n".join(
            "  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip()
            for line in lines
        )


def compare_loops(
    reference: ArrayLike,
    dt: float,
    *,
    plant: Any,
    controller: Any,
    hysteresis: Operator,
    inverse: Operator | None = None,
    feedforward: Any = True,
    observer: Any = None,
    Wu: Any = 0.0,
    noise: float = 0.0,
    method: Method = "tustin",
    limits: Limits | None = None,
    rate: float | None = None,
    despite_verdict: bool = False,
    **options: Any,
) -> LoopComparison:
    """Simulate and judge inverse alone, feedback alone, both, and both with an observer.

    All are blocks as they run. "feedback alone" has a straight line in the place of the inverse,
    the one that fits the hysteresis best over the drives which the reference needs.

    Parameters
    ----------
    reference
        Wanted output, shape (N,), at the block's samples.
    dt
        Sample time, s, > 0.
    plant
        Nominal plant.
    controller
        C, or what ``design_controller`` gave.
    hysteresis
        The true one.
    inverse
        Operator from v to u; the exact one of ``hysteresis`` if left out.
    feedforward
        True for the static one, or F, as ``TrackingController.from_continuous`` takes it.
    observer
        Disturbance observer; no row with one if left out.
    Wu
        Uncertainty of the plant that the marks allow for.
    noise
        Standard deviation of the sensor's noise.
    method
        How continuous blocks are sampled.
    limits, rate
        Of the drive, in all of them.
    despite_verdict
        Take also an inverse of a model whose verdict is ``unfit``.
    options
        What else ``try_block`` takes: true_plant, delay, slope_error, disturbance, seed,
        settle, start.

    Returns
    -------
    LoopComparison

    Raises
    ------
    InputError
        As ``try_block`` and ``TrackingController.from_continuous``, or if ``feedforward`` is None.
    NotInvertibleError
        If ``inverse`` is left out and the hysteresis has none.

    Examples
    --------
    >>> from hyst import PrandtlIshlinskii
    >>> stage = PrandtlIshlinskii([0.3, 0.2], [1.0, 3.0], 0.5)
    >>> r = 10.0 * np.sin(np.arange(2000) * 0.006)
    >>> found = compare_loops(
    ...     r, 1e-3, plant=([50.0], [1.0, 50.0]), controller=([5.0], [1.0, 0.0]), hysteresis=stage
    ... )
    >>> found["inverse + feedback + feedforward"].mark
    'proven'
    """
    if feedforward is None or feedforward is False:
        raise InputError("feedforward is left out, and two of the loops are with it; give True")
    r = one_record(reference, "reference")
    for name, given in (("hysteresis", hysteresis), ("inverse", inverse)):
        if not isinstance(given, Operator) and (given is not None or name == "hysteresis"):
            raise InputError(f"{name} is {type(given).__name__}; give an operator")
    rests = math.isfinite(static_gain(sampled_plant(plant, dt).system))
    cancels = hysteresis.inverse() if inverse is None else inverse
    line = _line(hysteresis, cancels, r / static_gain(plant_of(plant)))
    with_observer = {} if observer is None else {
        "inverse + feedback + observer": (controller, None, cancels, observer),
        "inverse + feedback + feedforward + observer": (controller, feedforward, cancels, observer),
    }  # fmt: skip
    asked = {
        "inverse alone": (0.0, feedforward, cancels, None),
        "feedback alone": (controller, None, line, None),
        "inverse + feedback": (controller, None, cancels, None),
        "inverse + feedback + feedforward": (controller, feedforward, cancels, None),
        **with_observer,
    }
    rows = []
    for name, (C, F, operator, watching) in asked.items():
        block = TrackingController.from_continuous(
            C, dt, observer=watching, inverse=operator, method=method, feedforward=F, plant=plant,
            limits=limits, rate=rate, despite_verdict=despite_verdict,
        )  # fmt: skip
        tried = try_block(
            block, r, plant=plant, Wu=Wu, hysteresis=hysteresis, noise=noise, **options
        )
        rows.append(ComparedLoop(name, tried, *_mark(name == "inverse alone" and rests, tried)))
    return LoopComparison(tuple(rows), noise)


def _mark(open_and_stable: bool, tried: TriedLoop) -> tuple[Mark, str]:
    judged = tried.judgement
    if open_and_stable and tried.loop.diverged_at is None:
        return "proven", "there is no feedback that could make a stable plant unstable"
    return _MARKS[judged.standing], judged.reason


def _line(hysteresis: Operator, inverse: Operator, v: Array) -> Operator:
    """Fit u over w by a straight line, for the drives that the inverse asks for."""
    u, w = _as_far_as_it_goes(hysteresis, inverse, v)
    if np.ptp(w) <= 1e-12 * np.abs(w).max(initial=0.0):
        return Affine(1.0)
    slope, offset = np.polyfit(w, u, 1)
    if slope == 0.0:
        raise InputError("the hysteresis does not follow its drive, so no line stands for it")
    return Affine(float(slope), float(offset))


def _as_far_as_it_goes(hysteresis: Operator, inverse: Operator, v: Array) -> tuple[Array, Array]:
    """Give drives and outputs for v, or for the largest half, quarter .. of it that it can give."""
    for halvings in range(_HALVINGS):
        try:
            u = inverse(v / 2.0**halvings)
            return u, hysteresis(u)
        except InputError:
            # Hysteresis that saturates, as Dahl's does, has no drive for an output beyond.
            continue
    raise InputError("the inverse gives no drive for this reference nor for a part of it; scale it")


def _told(value: float) -> str:
    return "diverges" if math.isinf(value) else f"{value:.4g}"
