"""The C sources of an FMU: the stage with constants of its own in every instance, and FMI's API."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import final

from hyst.export.block import Block, Model, block_of
from hyst.export.c_sources import header, places, source
from hyst.export.core_sources import core_files
from hyst.export.fmu_description import FmiVersion
from hyst.export.fmu_variables import (
    ParameterVariable,
    constant_rules,
    direct_inputs,
    parameter_variables,
)
from hyst.export.numbers import table
from hyst.export.stage_code import StageCode
from hyst.export.templating import filled, indented
from hyst.operators import ModelDescription

_TEMPLATES = Path(__file__).resolve().parent / "templates" / "fmu"
_COMMON = ("hyst_fmu.c", "hyst_fmu.h")
_OF_VERSION = {
    "2.0": ("hyst_fmi2.c", "hyst_fmi2.h"),
    "3.0": ("hyst_fmi3.c", "hyst_fmi3.h", "hyst_fmi3_absent.c", "hyst_fmi3_other_kinds.c"),
}
_HELD_BY = "constants->of."
_FUNCTION = re.compile(r"^(?!static)[a-z][\w \*]*?\b(hyst_\w+)\(", re.MULTILINE)


@final
@dataclass(frozen=True)
class FmuModel:
    """A model as an FMU runs it.

    Parameters
    ----------
    block
        One sample of it, with the constants where ``code`` has them.
    code
        Its stages.
    """

    block: Block
    code: StageCode

    @property
    def parameters(self) -> tuple[ParameterVariable, ...]:
        """The constants that may be set."""
        return tuple(parameter_variables(self.code))

    @property
    def direct(self) -> tuple[bool, ...]:
        """Of each input, whether the output depends on it in the same sample."""
        return direct_inputs(self.block.stages, self.block.inputs)

    def values(self) -> tuple[float, ...]:
        """Give all constants, one after the other."""
        return tuple(value for each in self.code.constants() for value in each.values)


def fmu_model(model: Model) -> FmuModel:
    """Give a model as an FMU runs it.

    Parameters
    ----------
    model
        What ``c_project`` takes.

    Returns
    -------
    FmuModel

    Raises
    ------
    InputError
        If it cannot be exported.
    """
    block = block_of(model, "double")
    fixed = StageCode(block.stages, "double").calls(block.signal)
    code = StageCode(block.stages, "double", _HELD_BY)
    if fixed not in block.body:
        # More than stages one after the other: all constants stay those of the file.
        return FmuModel(block, replace(code, stages=()))
    body = block.body.replace(fixed, code.calls(block.signal))
    return FmuModel(replace(block, head="", body=body), code)


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
    block = model.block
    common = places(block, name, "double", about)
    held = {
        "arguments": f"const hyst_fmu_constants *constants, {common['arguments']}",
        "records": f"const hyst_fmu_constants *constants, {common['records']}",
        "elements": f"constants, {common['elements']}",
    }
    stage = source(block, common | held, "double")
    if _HELD_BY not in block.body:
        stage = stage.replace(
            "    if (state->ready", "    (void)constants;\n    if (state->ready", 1
        )
    core = {
        path.replace("include/", "").replace("src/", "hyst_core_"): text
        for path, text in core_files(stage + header(common)).items()
    }
    files = (*_COMMON, *_OF_VERSION[version])
    return core | {file: (_TEMPLATES / file).read_bytes() for file in files} | {
        f"{name}.h": header(common | held).encode("ascii"),
        f"{name}.c": stage.encode("ascii"),
        "hyst_model.h": _model_header(model, common, token).encode("ascii"),
        "hyst_names.h": _names(name, core).encode("ascii"),
        "hyst_all.c": _all(core, common, version).encode("ascii"),
    }  # fmt: skip


def _model_header(model: FmuModel, common: dict[str, str], token: str) -> str:
    block, values = model.block, model.values()
    rules = [rule.value for rule in constant_rules(model.code)]
    members = model.code.declarations() or "hyst_real none;\n"
    elements = [f"(input)[{k}]" for k in range(len(block.inputs))]
    more = {
        "token": token,
        "inputs": str(len(block.inputs)),
        "count": str(len(values)),
        "size": str(max(len(values), 1)),
        "sample_time": ""
        if block.dt is None
        else f"#define HYST_FMU_DT {block.dt!r} /* seconds */\n",
        "members": indented(members, 8),
        "arguments": ", ".join(["state", "constants", *elements]),
        "defaults": table(values or (0.0,), "double", "constants"),
        "rules": f"{{{_in_rows(rules or [0])}}}",
    }
    return filled("fmu/hyst_model.h", common | more)


def _in_rows(numbers: Sequence[int], length: int = 24) -> str:
    rows = [numbers[i : i + length] for i in range(0, len(numbers), length)]
    return ",\n    ".join(", ".join(map(str, row)) for row in rows)


def _names(name: str, core: dict[str, bytes]) -> str:
    """Rename the core's functions, so that several FMUs can be linked into one program."""
    found = {
        function
        for path, content in core.items()
        if path.endswith(".c")
        for function in _FUNCTION.findall(content.decode("ascii"))
    }
    lines = [f"#define {each} {name}_{each}" for each in sorted(found)]
    return "/* The core's functions under names of this FMU's own. */\n" + "\n".join(lines) + "\n"


def _all(core: dict[str, bytes], common: dict[str, str], version: FmiVersion) -> str:
    interface = _OF_VERSION[version]
    more = {
        "api": interface[0].removesuffix(".c").removeprefix("hyst_"),
        "core": "".join(f'#include "{each}"\n' for each in core if each.endswith(".c")),
        "interface": "".join(f'#include "{each}"\n' for each in interface if each.endswith(".c")),
    }
    return filled("fmu/hyst_all.c", common | more)
