"""Operators: the building blocks of every model."""

from __future__ import annotations

from hyst.operators.affine import Affine
from hyst.operators.base import Operator
from hyst.operators.composition import Chained, Composition
from hyst.operators.dead_zone import DeadZone
from hyst.operators.description import ModelDescription
from hyst.operators.driver.driver import Driver
from hyst.operators.parameters import Parameters
from hyst.operators.play import Play
from hyst.operators.portrait import Portrait
from hyst.operators.provenance import Provenance, data_hash
from hyst.operators.registry import operator_from_dict
from hyst.operators.stepper import Stepper
from hyst.operators.stop import Stop
from hyst.operators.traits import Degree, Traits
from hyst.operators.verdict import Verdict

__all__ = [
    "Affine",
    "Chained",
    "Composition",
    "DeadZone",
    "Degree",
    "Driver",
    "ModelDescription",
    "Operator",
    "Parameters",
    "Play",
    "Portrait",
    "Provenance",
    "Stepper",
    "Stop",
    "Traits",
    "Verdict",
    "data_hash",
    "operator_from_dict",
]


def __dir__() -> list[str]:
    return __all__
