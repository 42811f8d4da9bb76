"""C, for firmware."""

from __future__ import annotations

import re

import hyst
from hyst.cli.export.order import Done, Order, drive_rows, into_folder

_WITH_CMAKE = "cmake -S . -B build && cmake --build build && ctest --test-dir build"


def c(order: Order) -> Done:
    """Write a C project."""
    project = hyst.export.c_project(
        order.model,
        order.out,
        precision=order.precision,
        name=order.name,
        force=order.force,
        despite_verdict=order.despite_verdict,
        layout=order.layout,
        shared_core=order.shared_core,
        **order.drive,
        driver=order.driver,
    )
    of_the_core = re.compile(rf"(core/src/)?({order.name}_core|hystf?)_\w+\.[ch]")
    own = [each for each in project.files if not of_the_core.fullmatch(each)]
    folder, there = into_folder(order)
    start = f"{order.name}_init_after" if project.has_start else ""
    rows = (
        ("files", ", ".join(own)),
        ("files of the core", str(len(project.files) - len(own))),
        ("precision", project.precision),
        ("state", f"{project.state_bytes} bytes, {project.state_length} numbers of memory"),
        ("saved state", f"{project.saved_bytes} bytes"),
        *drive_rows(project.drive, project.history, start),
        *([("codes", project.codes)] if project.codes else []),
    )
    alone = order.layout == "folder" and not order.shared_core
    test = _WITH_CMAKE if alone else project.test_command
    return Done(rows, f"{there} && {test}; {folder}/{project.readme} says the rest")
