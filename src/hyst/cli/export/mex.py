"""A MEX function, for MATLAB and Octave."""

from __future__ import annotations

import hyst
from hyst.cli.export.order import Done, Order, drive_rows, into_folder


def mex(order: Order) -> Done:
    """Write a MEX function."""
    written = hyst.export.mex(
        order.model,
        order.out,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
        **order.drive,
    )
    start = "init_after" if written.has_start else ""
    rows = (
        ("files", ", ".join(written.files)),
        ("state", f"{written.saved_bytes} bytes, {written.state_length} numbers of memory"),
        *drive_rows(written.drive, written.history, start),
    )
    _, there = into_folder(order)
    return Done(
        rows,
        f"{there} && mkoctfile --mex {order.name}_mex.c, or in MATLAB mex {order.name}_mex.c; "
        f"then {written.output} = {order.name}({', '.join(written.inputs)})",
    )
