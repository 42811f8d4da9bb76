"""The variables of an FMU: inputs, output, fault, and the constants that may be set."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import final

from hyst.export.stage_code import Constant, StageCode
from hyst.export.stages import Stage


@final
class Rule(Enum):
    """Who may change a constant; the names and numbers are those of ``hyst_fmu.h``."""

    CONSTANT = 0
    FIXED = 1
    THRESHOLD = 2
    TUNABLE = 3


# What is not listed is constant. The memory does not depend on weights, gains and memoryless maps,
# so they may change at any time. It belongs to thresholds and to what widens them: these may change
# until initialization ends. Matrices, sections, loading curves and memory functions must satisfy
# conditions (stability, monotony) that no single entry shows, so they are not offered.
_RULES: dict[str, dict[str, Rule]] = {
    "affine": {"gain": Rule.TUNABLE, "offset": Rule.TUNABLE},
    "play": {"r": Rule.THRESHOLD},
    "stop": {"r": Rule.THRESHOLD},
    "dead_zone": {"weight": Rule.TUNABLE, "threshold": Rule.TUNABLE},
    "direction_dead_zone": {"weight": Rule.TUNABLE, "threshold": Rule.TUNABLE},
    "pi": {"p0": Rule.TUNABLE, "p": Rule.TUNABLE, "r": Rule.THRESHOLD},
    "rate_dependent_pi": {
        "p0": Rule.TUNABLE,
        "p": Rule.TUNABLE,
        "r": Rule.THRESHOLD,
        "growth": Rule.THRESHOLD,
        "power": Rule.FIXED,
        "weight": Rule.FIXED,
        "threshold": Rule.THRESHOLD,
    },
    "state_space": {"c": Rule.TUNABLE, "d": Rule.TUNABLE},
}

_MEANINGS = {
    "gain": "gain",
    "offset": "offset",
    "p0": "weight of the input itself",
    "p": "weight of a play",
    "r": "threshold of a play",
    "weight": "weight of a dead zone",
    "threshold": "threshold of a dead zone",
    "growth": "growth of the thresholds with the change of the input in a sample",
    "power": "further growth of the thresholds with a power of that change",
    "c": "output vector",
    "d": "feedthrough",
}


@final
@dataclass(frozen=True)
class ParameterVariable:
    """A constant of the model that is a variable of the FMU.

    Parameters
    ----------
    name
        For people, as "p[1]" or "pi_2.p[1]".
    place
        Among all constants, from 0.
    value
        Its start value.
    rule
        When it may be changed.
    meaning
        What it is.
    """

    name: str
    place: int
    value: float
    rule: Rule
    meaning: str


def constant_rules(code: StageCode) -> tuple[Rule, ...]:
    """Give the rule of every number of ``code.constants()``.

    Parameters
    ----------
    code
        The stages.

    Returns
    -------
    tuple of Rule
    """
    return tuple(
        _rule(code.stages[constant.stage], constant)
        for constant in code.constants()
        for _ in constant.values
    )


def parameter_variables(code: StageCode) -> Iterator[ParameterVariable]:
    """Give the constants that may be set, in the order of ``code.constants()``.

    Parameters
    ----------
    code
        The stages.

    Yields
    ------
    ParameterVariable
    """
    place = 0
    for constant in code.constants():
        stage = code.stages[constant.stage]
        rule = _rule(stage, constant)
        prefix = f"{stage.kind}_{constant.stage + 1}." if len(code.stages) > 1 else ""
        for index, value in enumerate(constant.values):
            if rule is not Rule.CONSTANT:
                entry = f"[{index + 1}]" if constant.is_table else ""
                name = f"{prefix}{constant.field}{entry}"
                meaning = _MEANINGS[constant.field]
                yield ParameterVariable(name, place + index, value, rule, meaning)
        place += len(constant.values)


def direct_inputs(stages: tuple[Stage, ...], inputs: tuple[str, ...]) -> tuple[bool, ...]:
    """Tell of each input whether the output of a sample depends on it in the same sample.

    Parameters
    ----------
    stages
        In the order the signal passes them.
    inputs
        Their names.

    Returns
    -------
    tuple of bool
        False where a stage has a delay or no feedthrough.
    """
    passes = not any(_is_strictly_causal(stage) for stage in stages)
    first = stages[0].numbers if stages and stages[0].kind == "tracking_controller" else {}
    return tuple(passes and first.get(f"d_{name}", 1.0) != 0.0 for name in inputs)


def _rule(stage: Stage, constant: Constant) -> Rule:
    # Feedthrough cannot be switched on: the dependencies of the output would no longer be true.
    if stage.kind == "state_space" and constant.field == "d" and _is_strictly_causal(stage):
        return Rule.CONSTANT
    return _RULES.get(stage.kind, {}).get(constant.field, Rule.CONSTANT)


def _is_strictly_causal(stage: Stage) -> bool:
    if stage.kind == "state_space":
        return stage.choices["delay"] > 0 or stage.numbers["d"] == 0.0
    if stage.kind == "sections":
        return any(b0 == 0.0 for b0 in stage.tables["coefficient"][::5])
    return False
