"""The C sources of an FMU: the stage with constants of its own in every instance, and FMI's API."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import final

from hyst.control.limited_drive.schedule import LimitedSchedule
from hyst.errors import InputError
from hyst.export.c.block import Block, Model
from hyst.export.c.c_sources import header, places, source, told
from hyst.export.c.core_copy import CoreCopy
from hyst.export.c.core_sources import core_files
from hyst.export.c.core_stage import CoreStage
from hyst.export.c.drive_options import DriveOptions
from hyst.export.c.numbers import table
from hyst.export.c.one_file import with_own_names
from hyst.export.c.stage_code import StageCode
from hyst.export.c.templating import filled, indented
from hyst.export.fmi.description import FmiVersion
from hyst.export.fmi.variables import (
    ParameterVariable,
    Rule,
    constant_rules,
    direct_inputs,
    parameter_variables,
)
from hyst.export.tool_block import ToolBlock, tool_block
from hyst.models.schedule_run import ScheduledSystem
from hyst.operators import ModelDescription

_TEMPLATES = Path(__file__).resolve().parents[1] / "templates" / "fmu"
_COMMON = ("hyst_fmu.c", "hyst_fmu.h")
_OF_VERSION = {
    "2.0": ("hyst_fmi2.c", "hyst_fmi2.h"),
    "3.0": ("hyst_fmi3.c", "hyst_fmi3.h", "hyst_fmi3_absent.c", "hyst_fmi3_other_kinds.c"),
}
_HELD_BY = "constants->of."
_BESIDE_ITS_MODEL = 1  # the way of limiting a drive, as the twin in single precision is told it


@final
@dataclass(frozen=True)
class FmuModel:
    """A model as an FMU runs it.

    Parameters
    ----------
    tool
        One call of it, with the constants where ``code`` has them.
    code
        Its stages.
    """

    tool: ToolBlock
    code: StageCode

    @property
    def parameters(self) -> tuple[ParameterVariable, ...]:
        """The constants that may be set."""
        return tuple(parameter_variables(self.code))

    @property
    def direct(self) -> tuple[bool, ...]:
        """Of each input, whether the output depends on it in the same sample."""
        return direct_inputs(self.tool.block.stages, self.tool.inputs)

    def values(self) -> tuple[float, ...]:
        """Give all constants, one after the other."""
        return tuple(value for each in self.code.constants() for value in each.values)


def fmu_model(
    model: Model, options: DriveOptions, description: ModelDescription | None = None
) -> FmuModel:
    """Give a model as an FMU runs it.

    Parameters
    ----------
    model
        What ``c_project`` takes.
    options
        What it is told of the drive.
    description
        As given to the export; None for that of the model.

    Returns
    -------
    FmuModel

    Raises
    ------
    InputError
        If it cannot be exported.
    """
    if isinstance(model, ScheduledSystem | LimitedSchedule):
        raise InputError(
            "a scheduled model is no FMU yet: its constants follow a second input, where an FMU "
            "offers them as parameters; export it as C or MEX, or the model at(value) as an FMU"
        )
    tool = tool_block(model, options, description)
    # It starts as it was exported: whoever runs it sets no memory.
    block = replace(tool.block, following=None, before=None)
    tool = replace(tool, block=block)
    fixed = StageCode(block.stages, "double").calls(block.signal)
    code = StageCode(_offered(block), "double", _HELD_BY)
    if block.is_estimator:
        return FmuModel(tool, code)
    body = (
        block.body.replace(fixed, code.calls(block.signal))
        if block.written is None
        else block.written(code)
    )
    return FmuModel(replace(tool, block=replace(block, head="", body=body)), code)


def _offered(block: Block) -> tuple[CoreStage, ...]:
    """Give the stages with those constants as parameters that may change one by one.

    A memory after a history belongs to its constants. Of an inverse with limits, alone or in a
    controller, a model that is kept beside it must be its own, and a bank that is solved for must
    rise.
    """
    held: dict[int, set[Rule]] = {}
    everything = {Rule.FIXED, Rule.THRESHOLD, Rule.TUNABLE}
    for index, stage in enumerate(block.stages):
        if stage.kind == "drive_limits" and _is_beside_its_model(stage):
            held = dict.fromkeys(range(len(block.stages)), everything)
        elif stage.kind == "bank_limits":
            held[index - 1] = everything
    if block.history:
        memory = {Rule.FIXED, Rule.THRESHOLD}
        held = {index: held.get(index, memory) for index in range(len(block.stages))}
    return tuple(
        _held(stage, held[index]) if index in held else stage
        for index, stage in enumerate(block.stages)
    )


def _is_beside_its_model(limits: CoreStage) -> bool:
    """Tell whether the stages that ``limits`` end are an inverse and the model in front of it."""
    return limits.choices["forward"] > 0 or limits.choices.get("way") == _BESIDE_ITS_MODEL


def _held(stage: CoreStage, rules: set[Rule]) -> CoreStage:
    offers = {
        name: (Rule.CONSTANT.value if Rule(rule) in rules else rule, meaning)
        for name, (rule, meaning) in stage.offers.items()
    }
    return replace(stage, offers=offers)


def fmu_sources(
    model: FmuModel, name: str, about: ModelDescription, version: FmiVersion, token: str
) -> dict[str, bytes]:
    """Give the files below ``sources/``.

    Parameters
    ----------
    model
        What is exported.
    name
        The prefix, checked.
    about
        What the numbers mean.
    version
        Of FMI.
    token
        By which the FMU knows its description.

    Returns
    -------
    dict
        Content by path.
    """
    block = model.tool.block
    common = places(block, name, "double", about)
    held = {
        "arguments": f"const fmu_constants *constants, {common['arguments']}",
        "records": f"const fmu_constants *constants, {common['records']}",
        "elements": f"constants, {common['elements']}",
    }
    stage = source(block, common | held, "double")
    if _HELD_BY not in block.body and not block.is_estimator:
        stage = stage.replace(
            "    if (state->ready", "    (void)constants;\n    if (state->ready", 1
        )
    copy = CoreCopy(f"{name}_core", "double")
    core = {
        path: text.decode("ascii")
        for path, text in copy.files(core_files(stage + header(block, common))).items()
    }
    texts = with_own_names(core | {f"{name}.c": copy.own(stage)}) | {
        f"{name}.h": copy.own(header(block, common | held)),
        "hyst_model.h": _model_header(model, common, copy, token),
        "hyst_all.c": _all(core, common, version),
    }
    files = {file: (_TEMPLATES / file).read_bytes() for file in (*_COMMON, *_OF_VERSION[version])}
    return files | {path: text.encode("ascii") for path, text in texts.items()}


def _model_header(model: FmuModel, common: dict[str, str], copy: CoreCopy, token: str) -> str:
    tool, values = model.tool, model.values()
    dt = tool.block.dt
    rules = [rule.value for rule in constant_rules(model.code)]
    members = model.code.declarations() or "double none;\n"
    signals = tuple(f"(input)[{k}]" for k in range(len(tool.inputs)))
    more = {
        "token": token,
        "inputs": str(len(tool.inputs)),
        "estimates": str(len(tool.estimates)),
        "estimate": f"(state)->memory[{common['NAME']}_THETA + (place)]"
        if tool.estimates
        else "0.0",
        "out_of_range": f"({' | '.join(told(tool.block, common['name']))})"
        if tool.block.tells
        else "0u",
        "count": str(len(values)),
        "size": str(max(len(values), 1)),
        "sample_time": "" if dt is None else f"#define HYST_FMU_DT {dt!r} /* seconds */\n",
        "members": indented(copy.own(members), 8),
        "evaluate": copy.own(tool.step(common["name"], "state", signals, "constants, ")),
        "defaults": table(values or (0.0,), "double", "constants"),
        "rules": f"{{{_in_rows(rules or [0])}}}",
    }
    return filled("fmu/hyst_model.h", common | more)


def _in_rows(numbers: Sequence[int], length: int = 24) -> str:
    rows = [numbers[i : i + length] for i in range(0, len(numbers), length)]
    return ",\n    ".join(", ".join(map(str, row)) for row in rows)


def _all(core: Mapping[str, str], common: dict[str, str], version: FmiVersion) -> str:
    interface = _OF_VERSION[version]
    more = {
        "api": interface[0].removesuffix(".c").removeprefix("hyst_"),
        "core": "".join(f'#include "{each}"\n' for each in core if each.endswith(".c")),
        "interface": "".join(f'#include "{each}"\n' for each in interface if each.endswith(".c")),
    }
    return filled("fmu/hyst_all.c", common | more)
