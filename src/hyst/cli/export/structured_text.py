"""A function block of structured text, for PLCs."""

from __future__ import annotations

import hyst
from hyst.cli.export.order import Done, Order, drive_rows, into_folder


def structured_text(order: Order) -> Done:
    """Write a function block."""
    written = hyst.export.structured_text(
        order.model,
        order.out,
        precision=order.precision,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
        **order.drive,
    )
    start = "history with restart" if written.has_start else ""
    rows = (
        ("files", ", ".join(written.files)),
        ("function block", f"{written.name}({', '.join(written.inputs)}) -> {written.output}"),
        ("numbers", "LREAL" if written.precision == "double" else "REAL"),
        ("memory", f"{written.state_length} numbers"),
        *drive_rows(written.drive, written.history, start),
    )
    folder, _ = into_folder(order)
    return Done(
        rows, f"import {order.name}.st into the tool of the PLC; {folder}/README.md tells how"
    )
