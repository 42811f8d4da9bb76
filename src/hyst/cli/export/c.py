"""C, for firmware."""

from __future__ import annotations

import hyst
from hyst.cli.export.order import Done, Order, drive_rows, into_folder

_OF_THE_CORE = ("core/", "hyst_")


def c(order: Order) -> Done:
    """Write a C project."""
    project = hyst.export.c_project(
        order.model,
        order.out,
        precision=order.precision,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
        **order.drive,
        flat=order.flat,
        driver=order.driver,
    )
    own = [each for each in project.files if "/" not in each and not each.startswith("hyst_")]
    folder, there = into_folder(order)
    start = f"{order.name}_init_after" if project.has_start else ""
    rows = (
        ("files", ", ".join(own)),
        ("files of the core", str(sum(each.startswith(_OF_THE_CORE) for each in project.files))),
        ("precision", project.precision),
        ("state", f"{project.state_bytes} bytes, {project.state_length} numbers of memory"),
        ("saved state", f"{project.saved_bytes} bytes"),
        *drive_rows(project.drive, project.history, start),
        *([("codes", project.codes)] if project.codes else []),
    )
    return Done(
        rows,
        f"{there} && cmake -S . -B build && cmake --build build && "
        f"ctest --test-dir build; {folder}/README.md says the rest",
    )
