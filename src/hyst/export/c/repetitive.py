"""The C of a repetitive controller: memory of a period, inverse, and what learns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from hyst.control.drive_limits import stated
from hyst.control.repetitive.controller import RepetitiveController
from hyst.export.c.core_stage import CoreStage, core_stages
from hyst.export.c.limited import LimitedStages, limits_in
from hyst.export.c.numbers import Precision
from hyst.export.c.stage_code import StageCode

REFERENCE_CHANGED = (
    "#define @{NAME}_REFERENCE_CHANGED 32u /* the reference was another one than a period before: "
    "all forgotten */\n"
)

_SIZES = "#period, #half, #lead, #taps, #wait, $compares"


@final
@dataclass(frozen=True)
class RepetitiveStages:
    """What a sample passes.

    Parameters
    ----------
    memory, learning
        The two parts of the memory, before and behind the drive.
    inverse, forward
        The stages from v to the drive, and back; none back without limits.
    limits
        Lowest and highest drive, and most change in a sample; None without limits.
    """

    memory: CoreStage
    learning: CoreStage
    inverse: tuple[CoreStage, ...]
    forward: tuple[CoreStage, ...]
    limits: tuple[float, float, float] | None

    @classmethod
    def of(cls, model: RepetitiveController, precision: Precision) -> RepetitiveStages:
        """Take a ``model`` apart for a ``precision``."""
        inverse = () if model.inverse is None else core_stages(model.inverse)
        parts = _memory_part(model), _learning_part(model)
        if not model.is_limited:
            return cls(*parts, inverse, (), None)
        forward = () if model.forward is None else core_stages(model.forward)
        numbers = limits_in(precision, *stated(model.limits, model.rate, model.dt))
        return cls(*parts, inverse, forward, numbers)

    @property
    def all(self) -> tuple[CoreStage, ...]:
        """All of them, in the order of their memory."""
        if self._limited is not None:
            return self._limited.all
        return (self.memory, *self.inverse, self.learning)

    def body(self, code: StageCode) -> str:
        """Give the statements that take ``y_ref`` and ``y`` and leave the drive in ``v``."""
        told, after = "int changed = 0;\n", "(void)changed;\n"
        if self.memory.choices["compares"]:
            after = "if (changed != 0) {\n    state->fault |= @{NAME}_REFERENCE_CHANGED;\n}\n"
        if self._limited is not None:
            return told + self._limited.body(code) + after
        last = 1 + len(self.inverse)
        return (
            told
            + "hyst_real v = HYST_REAL(0.0);\nhyst_real excess = HYST_REAL(0.0);\n"
            + code.calls("v", only=range(last))
            + code.calls("excess", only=range(last, last + 1))
            + after
        )

    @property
    def _limited(self) -> LimitedStages | None:
        if self.limits is None:
            return None
        return LimitedStages(
            self.memory, self.inverse, self.forward, self.limits, (), self.learning
        )


def _memory_part(model: RepetitiveController) -> CoreStage:
    return _part(
        "repetitive_memory",
        model,
        {"tolerance": 0.0 if model.tolerance is None else model.tolerance},
        {"smooth": tuple(model.smooth.tolist())},
        model.compiled.memory_length,
        f"hyst_repetitive_memory $model = {{{_SIZES}, $tolerance, $smooth, NULL}};",
        "$signal = hyst_repetitive_wanted(&$model, $memory, y_ref, y, &changed);",
    )


def _learning_part(model: RepetitiveController) -> CoreStage:
    return _part(
        "repetitive_learning",
        model,
        {},
        {"learn": tuple(model.learn.tolist())},
        0,
        f"hyst_repetitive_memory $model = {{{_SIZES}, HYST_REAL(0.0), NULL, $learn}};",
        "hyst_repetitive_learn(&$model, memory, $signal);",
    )


def _part(
    kind: str,
    model: RepetitiveController,
    numbers: dict[str, float],
    tables: dict[str, tuple[float, ...]],
    length: int,
    structure: str,
    call: str,
) -> CoreStage:
    sizes = {
        "period": model.period,
        "half": model.smooth.size - 1,
        "lead": model.lead,
        "taps": model.learn.size,
        "wait": model.wait,
        "compares": int(model.tolerance is not None),
    }
    return CoreStage(
        kind=kind,
        numbers=numbers,
        tables=tables,
        choices=sizes,
        form="",
        state_length=length,
        offers=dict.fromkeys((*numbers, *tables), (0, "")),
        feeds_through=True,
        header="hyst/repetitive_memory.h",
        structure=structure,
        call=call,
    )
