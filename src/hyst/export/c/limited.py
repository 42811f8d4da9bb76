"""The C of an inverse whose drive is limited, as the core has it, without chains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hyst.errors import InputError
from hyst.export.c.core_stage import CoreStage
from hyst.export.c.numbers import Precision
from hyst.export.c.stage_code import StageCode
from hyst.export.c.templating import indented

OUT_OF_RANGE = (
    "#define @{NAME}_OUT_OF_RANGE 16u /* the drive asked for was beyond its limits or its rate: "
    "held */\n"
)

# Of the largest drive: a change a sample of 8 units of its last place, by 1/16 off at most.
_LOST = 8.0 * float(np.finfo(np.float32).eps)


def limits_in(
    precision: Precision, low: float, high: float, change: float
) -> tuple[float, float, float]:
    """Give limits in numbers of a precision, none of them wider than they are.

    Parameters
    ----------
    precision
        Of the target.
    low, high, change
        As the core takes them.

    Raises
    ------
    InputError
        If no number of that precision is left between them, or of the change, or the change gets
        lost beside the largest drive.
    """
    if precision == "double":
        return low, high, change
    inner = not_below(low), not_above(high), not_above(change)
    if not inner[0] < inner[1] or (change > 0.0 and inner[2] <= 0.0):
        raise InputError(
            f"the limits {low:.9g} to {high:.9g}, {change:.9g} a sample, leave no number of single "
            "precision; choose double, or wider limits"
        )
    largest = max(abs(low), abs(high))
    # Ends that are a day's motion at a megahertz away, as those of no limits, are never reached.
    if _LOST * largest > change > 1e-12 * largest:
        raise InputError(
            f"a rate of {change:.6g} a sample is lost beside a drive of {largest:.6g} in single "
            "precision, where it would stand still or move too fast; choose double, or a larger "
            "rate or dt"
        )
    return inner


def not_below(value: float) -> float:
    """Give the number of single precision nearest to a ``value`` that is not below it."""
    largest = np.finfo(np.float32).max
    nearest = np.float32(np.clip(value, -float(largest), float(largest)))
    below = float(nearest) < value and nearest < largest
    return float(np.nextafter(nearest, np.float32(np.inf)) if below else nearest)


def not_above(value: float) -> float:
    """Give the number of single precision nearest to a ``value`` that is not above it."""
    return -not_below(-value)


@final
@dataclass(frozen=True)
class LimitedStages:
    """What a sample passes.

    Parameters
    ----------
    linear
        The linear part; None for an inverse alone.
    inverse, forward
        The stages from v to the drive, and back.
    limits
        Lowest and highest drive, and most change in a sample.
    w
        What the states of the linear part take back.
    learning
        What follows every sample and is told the excess, instead of w; None for none.
    """

    linear: CoreStage | None
    inverse: tuple[CoreStage, ...]
    forward: tuple[CoreStage, ...]
    limits: tuple[float, float, float]
    w: tuple[float, ...]
    learning: CoreStage | None = None

    @property
    def all(self) -> tuple[CoreStage, ...]:
        """All of them, in the order of their memory."""
        told = {"forward": outermost(self.forward)} | ({"way": 1} if self.linear is None else {})
        limits = limits_stage(self.limits, told)
        windup = CoreStage(
            kind="anti_windup",
            numbers={},
            tables={"w": self.w},
            choices={},
            form="",
            state_length=0,
            offers={"w": (0, "")},
            feeds_through=True,
            header="hyst/tracking_controller.h",
            structure="",
            call="hyst_tracking_take_back(#w, $w, memory, $signal);",
        )
        if self.linear is None:
            return (*self.inverse, *self.forward, limits)
        after = windup if self.learning is None else self.learning
        return (self.linear, *self.inverse, *self.forward, limits, after)

    def body(self, code: StageCode) -> str:
        """Give the statements that take the inputs and leave the drive in ``v``."""
        if self.linear is None:
            inner = self._inner(code, "", taken_back=False)
            return f"hyst_real v = u;\nif (hyst_is_finite(v)) {{\n{inner}\n}}\n"
        if self.learning is not None:
            return self._learning_body(code)
        inner = self._inner(code, "const hyst_real excess = applied - wanted;", taken_back=True)
        return (
            "hyst_real v = (y_ref - y_ref) + (y - y); /* 0, or NaN if one is not finite */\n"
            + code.calls("v", only=range(1))
            + f"if (hyst_is_finite(v)) {{\n{inner}\n}}\n"
        )

    def _learning_body(self, code: StageCode) -> str:
        """Give the same where all samples are told to what learns, those that are lost too."""
        last = len(self.all) - 1
        inner = self._inner(code, "excess = applied - wanted;", taken_back=False)
        return (
            "hyst_real v = HYST_REAL(0.0);\nhyst_real excess = HYST_REAL(0.0);\n"
            + code.calls("v", only=range(1))
            + f"if (hyst_is_finite(v)) {{\n{inner}\n}}\n"
            + "if (!hyst_is_finite(excess)) {\n    excess = HYST_REAL(0.0);\n}\n"
            + code.calls("excess", only=range(last, last + 1))
        )

    def _inner(self, code: StageCode, excess: str, taken_back: bool) -> str:
        """Give the statements from a v that is finite to its drive."""
        before = 0 if self.linear is None else 1
        first = before + len(self.inverse)
        last = first + len(self.forward)
        memory = sum(each.state_length for each in self.inverse)
        there = f"memory[{sum(each.state_length for each in self.all) - 1}]"
        inverse = range(before, first)
        inner = [
            "const hyst_real wanted = v;",
            "hyst_real drive = v;",
            "hyst_real applied;",
            "int held = 0;",
            *self._copied("before", "memory", memory, declared=True),
            *(["{", indented(code.calls("drive", only=inverse)), "}"] if self.inverse else []),
            "if (!hyst_is_finite(drive)) { /* no drive belongs to v: the last one is kept */",
            "    held = 1;",
            "    state->fault |= @{NAME}_NOT_FINITE;",
            f"    drive = {there};",
            "}",
            "v = drive;",
            code.calls("v", only=range(last, last + 1)).rstrip("\n"),
            "applied = v;",
            code.calls("applied", only=range(first, last)).rstrip("\n"),
            "if (!hyst_is_finite(applied)) {",
            "    state->fault |= @{NAME}_NOT_FINITE;",
            "    applied = wanted;",
            "}",
            "if ((held != 0) || (v < drive) || (v > drive)) { /* on with what belongs to it */",
            *(["    hyst_real again = applied;"] if self.inverse else []),
            f"    {excess}" if excess else "",
            *(f"    {line}" for line in self._copied("memory", "before", memory)),
            indented(code.calls("again", only=inverse)),
            *(["    (void)again;"] if self.inverse else []),
            *([indented(code.calls("excess", only=range(last + 1, last + 2)))] * taken_back),
            "    state->fault |= @{NAME}_OUT_OF_RANGE;",
            "}",
        ]
        return indented("\n".join(line for line in inner if line.strip()))

    def _copied(self, to: str, source: str, count: int, declared: bool = False) -> list[str]:
        """C that copies the memory of the inverse, which stands behind that of the linear part."""
        if count == 0:
            return []
        offset = 0 if self.linear is None else self.linear.state_length
        place = {
            "memory": f"memory[{offset}u + i]" if offset else "memory[i]",
            "before": "before[i]",
        }
        lines = [f"hyst_real before[{count}];", "size_t i;"] if declared else []
        return [
            *lines,
            f"for (i = 0; i < {count}u; ++i) {{",
            f"    {place[to]} = {place[source]};",
            "}",
        ]


def limits_stage(limits: tuple[float, float, float], choices: dict[str, int]) -> CoreStage:
    """Give the limits of a drive as a stage.

    Parameters
    ----------
    limits
        Lowest and highest drive, and most change in a sample, in numbers of the target.
    choices
        What the twin in single precision is told beside them.
    """
    numbers = dict(zip(("low", "high", "change"), limits, strict=True))
    return CoreStage(
        kind="drive_limits",
        numbers=numbers,
        tables={},
        choices=choices,
        form="",
        state_length=1,
        offers=dict.fromkeys(numbers, (0, "")),
        feeds_through=True,
        header="hyst/drive_limits.h",
        structure="hyst_drive_limits $model = {$low, $high, $change};",
        call="$signal = hyst_limited_drive(&$model, $memory, $signal);",
    )


def bank_limits_stage(told: dict[str, float | int]) -> CoreStage:
    """Give the limits of a bank of plays at the end of an inverse as a stage.

    Parameters
    ----------
    told
        As ``LimitedDrive.bank_limits`` gives them.
    """
    choices = {name: int(told[name]) for name in ("moved_low", "moved_high")}
    numbers = {name: float(value) for name, value in told.items() if name not in choices}
    low, high = (
        f"{{#moved_{k}, $slope_{k}, $constant_{k}, $from_{k}, $least_{k}}}" for k in ("low", "high")
    )
    return CoreStage(
        kind="bank_limits",
        numbers=numbers,
        tables={},
        choices=choices,
        form="",
        state_length=1,
        offers=dict.fromkeys(numbers, (0, "")),
        feeds_through=True,
        header="hyst/limited_bank.h",
        structure=f"hyst_bank_limits $model = {{$low, $high, {low}, {high}}};",
        call="",
    )


def outermost(stages: tuple[CoreStage, ...]) -> int:
    """Count ``stages``; those inside another one count with it."""
    count = 0
    for stage in stages:
        count += 1 - stage.inside
    return count
