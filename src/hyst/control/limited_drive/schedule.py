"""A model whose constants follow a second signal, or its inverse, with a drive that is limited."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Self, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_state, finite_array, finite_vector, refuse_sample
from hyst.checks.numbers import as_sample_time
from hyst.control.block_file import InModelFile
from hyst.control.drive_limits import Limits, as_rate, stated, within
from hyst.control.limited_drive.checked import NO_LIMITS, range_of_drive
from hyst.control.limited_drive.monotone import require_monotone
from hyst.errors import InputError
from hyst.models import Scheduled
from hyst.models.schedule_run import ScheduledRun
from hyst.models.scheduled_inverse import ScheduledInverse
from hyst.operators.registry import entries

Array = NDArray[np.float64]

LIMITED_SCHEDULE_KIND = "limited-schedule"


@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class LimitedSchedule(InModelFile):
    """``LimitedDrive`` for constants that follow a second signal: ``u = inverse(v, s)`` clipped.

    The memory follows what the actuator really does, at every value of the second signal.

    Parameters
    ----------
    system
        A scheduled model, whose input is the drive, or its inverse, whose output is.
    limits, rate
        As ``LimitedDrive`` takes them.
    dt
        Sample time, s, > 0; needed with a rate where it is not known.

    Raises
    ------
    InputError
        If it is no scheduled model or inverse of one, or limits, rate or sample time cannot be
        used or are not known.
    NotInvertibleError
        If the model of an inverse turns back within the limits at a value of the schedule.

    Examples
    --------
    >>> import hyst
    >>> cold = hyst.PrandtlIshlinskii([0.5], [1.0], 1.0)
    >>> warm = hyst.PrandtlIshlinskii([1.0], [1.0], 1.0)
    >>> safe = LimitedSchedule(hyst.models.Scheduled([cold, warm], [20, 40]).inverse(), (-2, 2))
    >>> safe([1.0, 9.0, 9.0], [20.0, 20.0, 40.0]).tolist()
    [1.0, 2.0, 2.0]
    """

    system: Scheduled | ScheduledInverse
    limits: Limits | None
    rate: float | None
    dt: float | None

    file_kind: ClassVar[str] = LIMITED_SCHEDULE_KIND
    needed: ClassVar[tuple[str, ...]] = ("scheduled", "drive")
    optional: ClassVar[tuple[str, ...]] = ("limits", "rate", "dt")

    def __init__(
        self,
        system: Scheduled | ScheduledInverse,
        limits: Limits | str | None = None,
        rate: float | None = None,
        *,
        dt: float | None = None,
    ) -> None:
        if not isinstance(system, Scheduled | ScheduledInverse):
            raise InputError(
                f"a schedule of {type(system).__name__}; give a Scheduled model or its inverse"
            )
        change, about = as_rate(rate), system.description
        object.__setattr__(self, "system", system)
        object.__setattr__(self, "rate", change)
        object.__setattr__(self, "limits", range_of_drive(limits, change, about, self.drive))
        given = None if dt is None else as_sample_time(dt)
        known = next((each for each in (given, system.dt, about.dt) if each is not None), None)
        if change is not None and known is None:
            raise InputError("a rate is counted in samples, whose time is not known; give dt")
        object.__setattr__(self, "dt", known if change is not None or given is not None else None)
        _ = self.numbers
        if self.drive == "output" and self.limits is not None:
            for each in self._model.models:
                require_monotone(each, self.limits)
        vars(self).update(vars(self.with_description(about)))

    @property
    def drive(self) -> Any:
        """Which signal the drive is: ``"input"`` of a model, ``"output"`` of an inverse."""
        return "input" if isinstance(self.system, Scheduled) else "output"

    def initial_state(self) -> Array:
        """Give the state before the first sample: of the system, of the model beside an inverse.

        The last drive follows, which is the allowed one nearest to 0.
        """
        parts = [self.system.initial_state(), np.array([within(self.limits, 0.0)])]
        if self.drive == "output":
            parts.insert(1, self._model.initial_state())
        return np.concatenate(parts)

    def state_after(self, history: ArrayLike, s: ArrayLike) -> Array:
        """Give the state of an actuator that was driven along a history.

        Parameters
        ----------
        history, s
            Drives in the order of time, shape (N,), within the limits, and the second signal: a
            number, or shape (N,).

        Raises
        ------
        InputError
            If a drive is not finite, out of the limits, or cannot be answered.
        """
        drives, second = self._side_by_side(history, s)
        steps = self.stepper()
        for k, (each, value) in enumerate(zip(drives.tolist(), second.tolist(), strict=True)):
            if each != within(self.limits, each):
                raise InputError(
                    f"history[{k}] = {each:.6g} is outside the limits; give drives that the "
                    "actuator can have had"
                )
            if not steps.lead(each, value):
                raise InputError(f"history[{k}] = {each:.6g} overflows; give smaller drives")
        return np.array(steps.state)

    def __call__(self, x: ArrayLike, s: ArrayLike) -> Array:
        """Give the output for a record from the initial state.

        Parameters
        ----------
        x, s
            As in ``run``.
        """
        return self.run(x, s).y

    def run(self, x: ArrayLike, s: ArrayLike, state: ArrayLike | None = None) -> ScheduledRun:
        """Give the output for a record of input and second signal, and the state after it.

        Parameters
        ----------
        x, s
            Shape (N,), finite, N >= 1: v of an inverse or u of a model, and the second signal,
            which may be a number.
        state
            Shape (m,), float64; the initial state if left out. It is not changed.

        Raises
        ------
        InputError
            If a signal or the state cannot be used, or a sample overflows.
        """
        signal, second = self._side_by_side(x, s)
        steps, y = self.stepper(state), np.empty(signal.size)
        bad, outside = steps.run(signal, second, y)
        if bad >= 0:
            refuse_sample(signal, bad, "x")
        return ScheduledRun(y, np.array(steps.state), outside)

    def stepper(self, state: ArrayLike | None = None) -> _engine.LimitedMovingStepper:
        """Give a callable that takes one sample at a time, ``step(x, s) -> y``, as ``run`` does.

        Parameters
        ----------
        state
            Shape (m,), float64; the initial state if left out. It is copied.

        Returns
        -------
        LimitedMovingStepper
            With the live ``state``, ``fault``, ``limited`` and ``outside``, all three until
            ``clear_fault()``.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        start = self.initial_state()
        memory: Array = as_state(start if state is None else state, start.size, None)[0]
        memory[-1] = within(self.limits, float(memory[-1]))
        is_inverse, at = self.drive == "output", self._model.values.tolist()
        own = self.system.knot_stages
        beside = self._model.knot_stages if is_inverse else [()] * len(at)
        return _engine.LimitedMovingStepper(at, own, beside, is_inverse, *self.numbers, memory)

    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""
        data: dict[str, Any] = {"kind": LIMITED_SCHEDULE_KIND, "drive": self.drive}
        data["limits"] = NO_LIMITS if self.limits is None else list(self.limits)
        data |= {n: getattr(self, n) for n in ("rate", "dt") if getattr(self, n) is not None}
        return data | {"scheduled": self._model.to_dict()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Rebuild from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        given = entries(data, cls.needed, cls.optional)
        model, drive = Scheduled.from_dict(given.pop("scheduled")), given.pop("drive")
        if drive not in ("input", "output"):
            raise InputError(f"drive is {drive!r}; write 'input' or 'output'")
        return cls(model if drive == "input" else model.inverse(), **given)

    @property
    def _model(self) -> Scheduled:
        return self.system if isinstance(self.system, Scheduled) else self.system.scheduled

    @property
    def numbers(self) -> tuple[float, float, float]:
        """Lowest and highest drive, and most change in a sample, as the core takes them."""
        return stated(self.limits, self.rate, 1.0 if self.dt is None else self.dt)

    def _side_by_side(self, x: ArrayLike, s: ArrayLike) -> tuple[Array, Array]:
        name, signal = self._model.name, finite_vector(x, "x")
        second = finite_array(s, name)
        second = np.full(signal.size, second) if second.ndim == 0 else second
        if second.shape != signal.shape:
            raise InputError(
                f"{name} has shape {second.shape} and the signal {signal.shape}; give one value "
                "for each sample, or a number"
            )
        return np.ascontiguousarray(signal), second.copy()

    def __hash__(self) -> int:
        return hash((LIMITED_SCHEDULE_KIND, self.limits, self.rate, self._model.values.tobytes()))

    def __repr__(self) -> str:
        limits = NO_LIMITS if self.limits is None else self.limits
        return f"LimitedSchedule({self.system!r}, limits={limits!r}, rate={self.rate!r})"
