"""An inverse or a model whose drive is limited."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.checks.arrays import as_state, finite_vector
from hyst.control.block_file import InModelFile
from hyst.control.drive_limits import Limits, as_rate, forward_operator, stated, within
from hyst.control.limited_drive.bank_limits import Bank, bank_of
from hyst.control.limited_drive.checked import (
    NO_LIMITS,
    Drive,
    as_drive,
    range_of_drive,
    sample_time,
)
from hyst.control.limited_drive.monotone import require_monotone
from hyst.errors import InputError
from hyst.operators import Operator

Array = NDArray[np.float64]

LIMITED_KIND = "limited-drive"


@final
@dataclass(frozen=True, eq=False, init=False, repr=False)
class LimitedDrive(InModelFile):
    """An inverse whose command stays within limits, or a model that is driven within them.

    Of an inverse, ``u = inverse(v)`` is clipped, and the memory follows what the actuator really
    does: where u may not be, ``u_a`` is the nearest that may, and the inverse goes on as if it had
    been asked for the ``v_a`` to which ``u_a`` belongs. Within the limits its bits are those of the
    inverse alone. Of a model, ``y = model(u_a)``.

    Parameters
    ----------
    operator
        A model, whose input is the drive, or an inverse, whose output is.
    limits
        Lowest and highest drive; left out, those of the record the model was identified from; or
        ``"none"``, with a rate.
    rate
        The most the drive moves in a second, > 0; any if left out.
    dt
        Sample time, s, > 0; needed with a rate where the operator has none.
    forward
        Operator from u to v of which an inverse is the exact inverse; where left out, its inverse.
    drive
        ``"input"`` or ``"output"``: which signal the drive is. Left out, the description tells:
        that of every ``model.inverse()`` says that it is an inverse.

    Raises
    ------
    InputError
        If it is no operator, the limits are not two ascending numbers or not known, a rate or a
        sample time is not above 0 or missing, or there is no operator of which the inverse is the
        exact inverse.
    NotInvertibleError
        If the output of an inverse's model turns back within the limits.

    Examples
    --------
    >>> import hyst
    >>> stage = hyst.PrandtlIshlinskii([0.5], [1.0], p0=1.0)
    >>> safe = LimitedDrive(stage.inverse(), limits=(-2.0, 2.0))
    >>> safe([1.0, 9.0, 9.0, 2.0]).tolist()
    [1.0, 2.0, 2.0, 1.5]
    """

    operator: Operator
    limits: Limits | None
    rate: float | None
    dt: float | None
    forward: Operator | None
    drive: Drive

    file_kind: ClassVar[str] = LIMITED_KIND
    needed: ClassVar[tuple[str, ...]] = ("operator", "drive")
    optional: ClassVar[tuple[str, ...]] = ("limits", "rate", "dt", "forward")

    def __init__(
        self,
        operator: Operator,
        limits: Limits | str | None = None,
        rate: float | None = None,
        *,
        dt: float | None = None,
        forward: Operator | None = None,
        drive: Drive | None = None,
    ) -> None:
        if not isinstance(operator, Operator):
            raise InputError(f"a drive of {type(operator).__name__}; give an operator")
        change, about = as_rate(rate), operator.description
        which = as_drive(drive, operator, forward)
        if which == "input" and forward is not None:
            raise InputError("forward belongs to an inverse; leave it out for a model")
        ends = range_of_drive(limits, change, about, which)
        time = sample_time(operator, dt, change)
        values: dict[str, Any] = {
            "operator": operator,
            "limits": ends,
            "rate": change,
            "dt": time,
            "drive": which,
            "_given": forward,
            "forward": None,
        }
        if which == "output":
            values["forward"] = forward_operator(operator, forward, ends, time, "forward")
        for name, value in values.items():
            object.__setattr__(self, name, value)
        _ = self.numbers
        if self.forward is not None and ends is not None:
            require_monotone(self.forward, ends)
        vars(self).update(vars(self.with_description(about)))

    @functools.cached_property
    def numbers(self) -> tuple[float, float, float]:
        """Lowest drive, highest drive, and most change in a sample, as the core takes them.

        Where nothing is limited: the largest numbers there are, and no change, 0.
        """
        return stated(self.limits, self.rate, 1.0 if self.dt is None else self.dt)

    @functools.cached_property
    def bank(self) -> Bank | None:
        """The bank of plays that ends an inverse which needs no model beside it, or None."""
        return self._bank_in(np.float64)

    def _bank_in(self, dtype: Any) -> Bank | None:
        if self.drive == "input" or self.limits is None or self.rate is not None:
            return None
        chain = _engine.Chain(self.operator.stages())
        stages = [chain.constants(i) for i in range(len(chain))]
        return bank_of(stages, self.operator.initial_state(), dtype)

    def bank_limits(
        self, low: float, high: float, dtype: Any = np.float64
    ) -> dict[str, float | int]:
        """Give the limits of ``bank`` as the core has them.

        Parameters
        ----------
        low, high
            Lowest and highest drive in numbers of the target.
        dtype
            Its numbers, ``numpy.float64`` or ``numpy.float32``.

        Returns
        -------
        dict
            ``low`` and ``high``, and of each of them ``moved``, ``slope``, ``constant``, ``from``
            and ``least``, as ``moved_low``.

        Raises
        ------
        InputError
            If there is no such bank.
        """
        bank = self._bank_in(dtype)
        if bank is None:
            raise InputError("the inverse keeps the model beside it and has no limits of a bank")
        told: dict[str, float | int] = {"low": low, "high": high}
        for name, end in (("low", bank.end(low, -1)), ("high", bank.end(high, 1))):
            told |= {f"moved_{name}": end.moved, f"slope_{name}": end.slope}
            told |= {f"constant_{name}": end.constant, f"from_{name}": end.start}
            told |= {f"least_{name}": end.least}
        return told

    @property
    def keeps_forward(self) -> bool:
        """Whether the memory of the model is kept beside that of its inverse."""
        return self.drive == "output" and self.bank is None

    def initial_state(self) -> Array:
        """Give the state before the first sample, a fresh array.

        That of the operator; of an inverse that keeps it, that of ``forward``; and the last drive,
        which is the allowed one nearest to 0.
        """
        parts = [self.operator.initial_state()]
        if self.forward is not None and self.keeps_forward:
            parts.append(self.forward.initial_state())
        return np.concatenate([*parts, [within(self.limits, 0.0)]])

    def state_after(self, history: ArrayLike) -> Array:
        """Give the state of an actuator that was driven along a history.

        Parameters
        ----------
        history
            Drives in the order of time, shape (N,), within the limits. Where the operator does not
            depend on rate, those at which the drive turned are enough; else they are samples.

        Returns
        -------
        numpy.ndarray
            Shape (m,).

        Raises
        ------
        InputError
            If a drive is not finite, out of the limits, or cannot be answered.
        """
        drives = finite_vector(history, "history")
        if self.limits is not None:
            outside = (drives < self.limits[0]) | (drives > self.limits[1])
            if outside.any():
                k = int(np.argmax(outside))
                raise InputError(
                    f"history[{k}] = {drives[k]:.9g} is outside the limits {self.limits[0]:.9g} to "
                    f"{self.limits[1]:.9g}; give drives that the actuator can have had"
                )
        state = self.initial_state()
        bad = self.compiled.lead(state, drives)
        if bad >= 0:
            raise InputError(
                f"history[{bad}] = {drives[bad]:.6g} cannot be followed: it overflows, or no "
                "drive belongs to what the model gives there; give smaller drives"
            )
        return state

    def __call__(self, x: ArrayLike) -> Array:
        """Give the output for a whole record that starts from the initial state.

        Parameters
        ----------
        x
            Shape (N,), finite, N >= 1: v of an inverse, u of a model.

        Raises
        ------
        InputError
            If ``x`` cannot be used, or a sample overflows.
        """
        return self.run(x)[0]

    def run(self, x: ArrayLike, state: ArrayLike | None = None) -> tuple[Array, Array]:
        """Give the output for a whole record and the state after it.

        Parameters
        ----------
        x
            Shape (N,), finite, N >= 1: v of an inverse, u of a model.
        state
            Shape (m,), float64; the initial state if left out. It is not changed.

        Returns
        -------
        y : numpy.ndarray
            Shape (N,): the drive of an inverse, the output of a model.
        state : numpy.ndarray
            Shape (m,).

        Raises
        ------
        InputError
            If ``x`` or the state cannot be used, or a sample overflows.
        """
        signal, memory = finite_vector(x, "x"), self._checked_state(state)
        y = np.empty_like(signal)
        bad, _ = self.compiled.run(memory, signal, y)
        if bad >= 0:
            raise InputError(f"x[{bad}] = {signal[bad]:.6g} overflows; give a smaller signal")
        return y, memory

    def stepper(self, state: ArrayLike | None = None) -> _engine.LimitedStepper:
        """Give a callable that takes one sample at a time, with the same numbers as ``run``.

        A sample that is not finite repeats the last output, leaves the state as it is and raises
        ``fault``. Before the first sample the output to repeat is the last drive of the state for
        an inverse, 0 for a model.

        Parameters
        ----------
        state
            Shape (m,), float64; the initial state if left out. It is copied.

        Returns
        -------
        LimitedStepper
            ``step(x) -> y``, with the live ``state``, ``fault`` and ``clear_fault()``, which also
            lowers ``limited``: whether a drive since then has been held at its limits.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        return _engine.LimitedStepper(self.compiled, self._checked_state(state))

    @functools.cached_property
    def compiled(self) -> _engine.LimitedDrive:
        """The block in the engine."""
        chain = _engine.Chain(self.operator.stages())
        if self.bank is not None and self.limits is not None:
            down, up = self.bank.end(self.limits[0], -1), self.bank.end(self.limits[1], 1)
            ends = down.moved, down.numbers, up.moved, up.numbers
            return _engine.LimitedDrive(chain, *self.limits, *ends)
        forward = () if self.forward is None else self.forward.stages()
        is_inverse = self.drive == "output"
        return _engine.LimitedDrive(is_inverse, chain, _engine.Chain(forward), *self.numbers)

    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""
        data: dict[str, Any] = {"kind": LIMITED_KIND, "drive": self.drive}
        data["limits"] = NO_LIMITS if self.limits is None else list(self.limits)
        for name in ("rate", "dt"):
            if getattr(self, name) is not None:
                data[name] = getattr(self, name)
        data["operator"] = self.operator.to_dict()
        given: Operator | None = vars(self)["_given"]
        return data if given is None else data | {"forward": given.to_dict()}

    def _checked_state(self, state: ArrayLike | None) -> Array:
        start = self.initial_state() if state is None else state
        memory: Array = as_state(start, self.compiled.state_length, None)[0]
        # The last drive answers a first sample that is not finite.
        memory[-1] = within(self.limits, float(memory[-1]))
        return memory

    def __hash__(self) -> int:
        ends = self.limits or (-math.inf, math.inf)
        return hash((LIMITED_KIND, self.operator, ends, self.rate, self.drive))

    def __repr__(self) -> str:
        limits = NO_LIMITS if self.limits is None else self.limits
        return (
            f"LimitedDrive({self.operator!r}, limits={limits!r}, rate={self.rate!r}, "
            f"drive={self.drive!r})"
        )
