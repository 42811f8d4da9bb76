"""A Rust crate without the standard library."""

from __future__ import annotations

import hyst
from hyst.cli.export.order import Done, Order, drive_rows, into_folder


def rust(order: Order) -> Done:
    """Write a Rust crate."""
    crate = hyst.export.rust(
        order.model,
        order.out,
        precision=order.precision,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
        **order.drive,
    )
    folder, there = into_folder(order)
    rows = (
        ("crate", f"{crate.name}, no_std, no unsafe, no dependencies"),
        ("precision", crate.precision),
        ("memory", f"{crate.state_length} numbers; saved in {crate.saved_bytes} bytes"),
        *drive_rows(crate.drive, crate.history, "init_after" if crate.has_start else ""),
    )
    return Done(rows, f"{there} && cargo test; {folder}/README.md says the rest")
