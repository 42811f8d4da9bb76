"""An FMU, for simulation tools."""

from __future__ import annotations

import hyst
from hyst.cli.export.order import Done, Order, drive_rows


def fmu(order: Order) -> Done:
    """Write an FMU."""
    path = order.out
    if path.suffix.lower() != ".fmu":
        if not path.is_dir():
            raise hyst.InputError(f"{path} is no folder; name one, or a file that ends in .fmu")
        path = path / f"{order.name}.fmu"
    written = hyst.export.fmu(
        order.model,
        path,
        version=order.fmi,
        name=order.name,
        force=order.force,
        binary=order.binary,
        despite_verdict=order.despite_verdict,
        **order.drive,
    )
    binaries = [each for each in written.files if each.startswith("binaries/")]
    rows = (
        ("FMI", f"{written.version}, co-simulation"),
        ("variables", f"{', '.join(written.inputs)} -> {written.output}; fault"),
        ("parameters", _shortened(written.parameters)),
        ("communication step", "any" if written.dt is None else f"multiples of {written.dt!r} s"),
        *drive_rows(written.drive, written.history),
        ("binary", ", ".join(binaries) or "none; the importer compiles the sources"),
    )
    return Done(rows, f"import {path} into a simulation tool; docs/fmu.md says what it expects")


def _shortened(names: tuple[str, ...], most: int = 6) -> str:
    if len(names) <= most:
        return ", ".join(names) or "none"
    return f"{', '.join(names[: most - 1])} ... ({len(names)})"
