"""Tables of a feedback loop: margins of C and of the whole block, and what each part is worth."""

from __future__ import annotations

from hyst.control import ControllerDesign, LoopComparison, LoopMargins
from hyst.report.table import Table


def margins_table(
    alone: LoopMargins, whole: LoopMargins | None = None, design: ControllerDesign | None = None
) -> Table:
    """List the margins of the controller, and of the block with its observer beside them.

    Parameters
    ----------
    alone
        Of the loop with C alone.
    whole
        Of the loop with C and observer; left out if there is none.
    design
        What C was designed by, if it was.

    Returns
    -------
    Table
    """
    rows = [] if design is None else [_row(*each, whole) for each in design.told()]
    others = [""] * len(alone.rows()) if whole is None else [each for _, each in whole.rows()]
    rows += [
        (what, value) if whole is None else (what, value, other)
        for (what, value), other in zip(alone.rows(), others, strict=True)
    ]
    header = ("what", "controller alone") + (() if whole is None else ("with the observer",))
    return Table("How much does the loop bear? The inverse taken as exact", header, tuple(rows))


def _row(what: str, value: str, whole: LoopMargins | None) -> tuple[str, ...]:
    return (what, value) if whole is None else (what, value, "-")


def parts_table(compared: LoopComparison) -> Table:
    """List inverse, feedback and observer, alone and together; what is not proven is marked.

    Parameters
    ----------
    compared
        Of ``compare_loops``.

    Returns
    -------
    Table
    """
    title = "What is each part worth?"
    if compared.noise:
        title += f" With sensor noise of {compared.noise:g}"
    return Table(title, compared.header, tuple(compared.row_of(row) for row in compared.rows))
