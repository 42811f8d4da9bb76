"""hyst: from a measured hysteresis loop to a model, its exact inverse and a command.

Names are loaded when they are first used, so that ``import hyst`` stays quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from hyst import (
        compensation,
        control,
        demo,
        errors,
        export,
        files,
        identification,
        io,
        models,
        online,
        operators,
        report,
        signals,
        studies,
    )
    from hyst.errors import (
        HystError,
        InputError,
        MissingExtraError,
        NotIdentifiableError,
        NotInvertibleError,
        SolverError,
    )
    from hyst.identification import Identified, fit, identify
    from hyst.identification.families.registry import families
    from hyst.io import read_record
    from hyst.models import (
        GeneralizedPrandtlIshlinskii,
        LinearDynamics,
        MasingOperator,
        MemoryElement,
        ModifiedPrandtlIshlinskii,
        PrandtlIshlinskii,
        RambergOsgood,
        RateDependentPrandtlIshlinskii,
    )
    from hyst.models.model_loading import load
    from hyst.operators import Affine, Composition, DeadZone, Operator, Play, Stop
    from hyst.signals import Record

_HOME = {
    "HystError": "hyst.errors",
    "InputError": "hyst.errors",
    "MissingExtraError": "hyst.errors",
    "NotIdentifiableError": "hyst.errors",
    "NotInvertibleError": "hyst.errors",
    "SolverError": "hyst.errors",
    "Identified": "hyst.identification",
    "families": "hyst.identification.families.registry",
    "fit": "hyst.identification.fit_model",
    "identify": "hyst.identification",
    "read_record": "hyst.io",
    "GeneralizedPrandtlIshlinskii": "hyst.models",
    "LinearDynamics": "hyst.models",
    "ModifiedPrandtlIshlinskii": "hyst.models",
    "PrandtlIshlinskii": "hyst.models",
    "RateDependentPrandtlIshlinskii": "hyst.models",
    "MasingOperator": "hyst.models",
    "MemoryElement": "hyst.models",
    "RambergOsgood": "hyst.models",
    "load": "hyst.models",
    "Affine": "hyst.operators",
    "Composition": "hyst.operators",
    "DeadZone": "hyst.operators",
    "Operator": "hyst.operators",
    "Play": "hyst.operators",
    "Stop": "hyst.operators",
    "Record": "hyst.signals",
}
_PACKAGES = (
    "compensation",
    "control",
    "demo",
    "errors",
    "export",
    "files",
    "identification",
    "io",
    "models",
    "online",
    "operators",
    "report",
    "signals",
    "studies",
)

__all__ = [
    "Affine",
    "Composition",
    "DeadZone",
    "GeneralizedPrandtlIshlinskii",
    "HystError",
    "Identified",
    "InputError",
    "LinearDynamics",
    "MasingOperator",
    "MemoryElement",
    "MissingExtraError",
    "ModifiedPrandtlIshlinskii",
    "NotIdentifiableError",
    "NotInvertibleError",
    "Operator",
    "Play",
    "PrandtlIshlinskii",
    "RambergOsgood",
    "RateDependentPrandtlIshlinskii",
    "Record",
    "SolverError",
    "Stop",
    "__version__",
    "compensation",
    "control",
    "demo",
    "errors",
    "export",
    "families",
    "files",
    "fit",
    "identification",
    "identify",
    "io",
    "load",
    "models",
    "online",
    "operators",
    "read_record",
    "report",
    "signals",
    "studies",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(importlib.import_module(_HOME[name]), name)
    elif name in _PACKAGES:
        value = importlib.import_module(f"hyst.{name}")
    else:
        raise AttributeError(f"module 'hyst' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
