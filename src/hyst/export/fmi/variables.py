"""The variables of an FMU: inputs, output, fault, and the constants that may be set."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import final

from hyst.export.c.core_stage import CoreStage
from hyst.export.c.stage_code import Constant, StageCode


@final
class Rule(Enum):
    """Who may change a constant; the names and numbers are those of ``hyst_fmu.h``."""

    CONSTANT = 0
    FIXED = 1
    THRESHOLD = 2
    TUNABLE = 3


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
                meaning = stage.offers[constant.field][1]
                yield ParameterVariable(name, place + index, value, rule, meaning)
        place += len(constant.values)


def direct_inputs(stages: tuple[CoreStage, ...], inputs: tuple[str, ...]) -> tuple[bool, ...]:
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
    passes = all(stage.feeds_through for stage in stages)
    if stages and stages[0].kind == "repetitive_memory":  # y counts a period later
        return tuple(passes and name != "y" for name in inputs)
    first = stages[0].numbers if stages and stages[0].kind == "tracking_controller" else {}
    return tuple(passes and first.get(f"d_{name}", 1.0) != 0.0 for name in inputs)


def _rule(stage: CoreStage, constant: Constant) -> Rule:
    return Rule(stage.offers[constant.field][0])
