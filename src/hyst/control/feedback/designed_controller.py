"""What came of the design of a feedback controller."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, final

from hyst.control.feedback.margins import LoopMargins
from hyst.control.feedback.resonances import Resonance
from hyst.control.feedback.structures import Notch, Shape
from hyst.control.linear_system import LinearSystem


@dataclass(frozen=True, eq=False)
class Tried:
    """The best controller of one kind.

    Parameters
    ----------
    kind, shape, ki
        As in ``ControllerDesign``.
    continuous, system
        C(s), and C as the loop has it.
    margins, worst
        Of the loop it was designed for, and of the worst of those with resonances elsewhere.
    """

    kind: str
    shape: Shape
    ki: float
    continuous: LinearSystem
    system: LinearSystem
    margins: LoopMargins
    worst: LoopMargins


@final
@dataclass(frozen=True, eq=False)
class ControllerDesign:
    """A designed feedback controller.

    ``C(s) = ki (1 + Ti s + Ti Td s^2 / (Tf s + 1)) / s`` times its notches.

    Parameters
    ----------
    kind
        ``"i"``, ``"pi"`` or ``"pid"``.
    ki
        Integral gain, units of v per unit of y and second.
    shape
        Its times Ti, Td, Tf, s, and its notches.
    continuous
        C(s); with dt, the one whose trapezoidal sampling is ``sampled``.
    sampled
        C(z), which the block runs; None for a loop in continuous time.
    margins
        Of the loop that it was designed for.
    worst
        Of that loop, or of the one with its resonances off by ``mismatch``, if that is worse.
    mismatch
        Share by which the resonances may be off; 0 where there are none.
    resonances
        Of the plant, lightly damped ones.
    tried
        The best controller of each kind that was tried.
    static_gain
        Of the plant.
    """

    kind: str
    ki: float
    shape: Shape
    continuous: LinearSystem
    sampled: LinearSystem | None
    margins: LoopMargins
    worst: LoopMargins
    mismatch: float
    resonances: tuple[Resonance, ...]
    tried: tuple[Tried, ...]
    static_gain: float

    @property
    def controller(self) -> LinearSystem:
        """C as the loop has it: sampled if that was asked for, else continuous."""
        return self.continuous if self.sampled is None else self.sampled

    @property
    def kp(self) -> float:
        """Proportional gain, ki Ti."""
        return self.ki * self.shape.Ti

    @property
    def kd(self) -> float:
        """Derivative gain, ki Ti Td."""
        return self.ki * self.shape.Ti * self.shape.Td

    @property
    def notches(self) -> tuple[Notch, ...]:
        """Notches; their frequencies are where they act, in the sampled loop too."""
        return self.shape.notches

    def to_control(self) -> Any:
        """Give C as the loop has it, for python-control.

        Raises
        ------
        MissingExtraError
            If python-control is not installed.
        """
        return self.controller.as_control()

    def told(self) -> tuple[tuple[str, str], ...]:
        """Give what it is and what it keeps where resonances are elsewhere, in words."""
        off = f", resonances off by {100.0 * self.mismatch:.3g} %" if self.mismatch else ""
        return (
            ("controller", self._told()),
            *((f"notch {k + 1}", _notch(each)) for k, each in enumerate(self.notches)),
            (f"worst modulus margin{off}", self._worst()),
        )

    def rows(self) -> tuple[tuple[str, str], ...]:
        """Give that, and the margins of its loop."""
        return (*self.told(), *self.margins.rows())

    def _told(self) -> str:
        parts = {"ki": self.ki, "kp": self.kp, "kd": self.kd, "Tf": self.shape.Tf}
        given = ", ".join(f"{name} {value:.6g}" for name, value in parts.items() if value)
        return f"{self.kind.upper()}, {given}"

    def _worst(self) -> str:
        return f"{self.worst.modulus_margin:.4g}, Ms {self.worst.peak_sensitivity:.4g}"

    def summary(self) -> str:
        """Give it as lines of text."""
        others = "; ".join(
            f"{each.kind.upper()} with {len(each.shape.notches)} notches: ki {each.ki:.4g}, "
            f"reduces below {each.margins.rejection / (2.0 * math.pi):.4g} Hz"
            for each in self.tried
        )
        return "\n".join([*(f"{what}: {value}" for what, value in self.rows()), f"tried: {others}"])


def _notch(notch: Notch) -> str:
    return (
        f"{notch.frequency / (2.0 * math.pi):.4g} Hz, dampings {notch.zero_damping:.3g} over "
        f"{notch.pole_damping:.3g}"
    )
