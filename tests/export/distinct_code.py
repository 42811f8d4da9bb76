"""Examples of which each is exported as other code: the rest differ from one in numbers alone."""

from __future__ import annotations

from hyst.control.limited_drive.drive import LimitedDrive
from hyst.errors import HystError
from hyst.export.c.core_stage import core_stages
from reference.examples import EXAMPLES


def _code(name: str) -> tuple[object, ...]:
    model = EXAMPLES[name]
    stages = tuple((each.kind, each.form, str(each.choices)) for each in core_stages(model))
    try:
        drive = LimitedDrive(model, "none", 1.0, dt=model.dt or 1.0).drive
    except HystError:
        return *stages, None
    return *stages, drive


def _first_of_each() -> list[str]:
    found: dict[tuple[object, ...], str] = {}
    for name in EXAMPLES:
        found.setdefault(_code(name), name)
    return list(found.values())


DISTINCT = _first_of_each()
