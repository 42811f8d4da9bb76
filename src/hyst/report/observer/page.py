"""The page of an observer: verdict first, then why, what it buys, what it is, what to do."""

from __future__ import annotations

from hyst.report.observer.answer import ObserverAnswer
from hyst.report.observer.tables import (
    checks_table,
    feedback_tables,
    filter_table,
    rivals_table,
    tracking_table,
)
from hyst.report.observer.words import SIGNS
from hyst.report.page import Page


def observer_page(answer: ObserverAnswer, bode: bytes, loops: bytes) -> str:
    """Give the page.

    Parameters
    ----------
    answer
        Of ``hyst observer``.
    bode, loops
        Figures, PNG.

    Returns
    -------
    str
        HTML that needs nothing but itself.
    """
    page = Page("Disturbance observer")
    page.banner(answer.verdict())
    page.text(answer.gain_sentence())
    page.text(f"To implement: {answer.implement_sentence()}")
    page.heading("What it does")
    page.table(checks_table(answer))
    page.table(tracking_table(answer))
    page.faint(SIGNS)
    page.picture(loops, "Reference and output, errors and drives of the loops.")
    page.heading("Over frequency")
    page.picture(
        bode,
        "What the block leaves of a disturbance against what was asked, the output over the "
        "disturbance with and without it, and the condition of robust stability, up to half the "
        "sample rate.",
    )
    for table in feedback_tables(answer):
        page.table(table)
    page.heading("Other ways, and the filter")
    page.table(rivals_table(answer))
    page.table(filter_table(answer))
    if answer.safe:
        page.heading("On the target")
        page.text("Each sample it takes reference and measured output, and gives the drive. In C:")
        page.code("hyst export controller.json --target c -o firmware")
        page.text("In Python:")
        page.code(
            "import hyst\n"
            'step = hyst.load("controller.json").stepper()\n'
            f"u = step(y_ref, y)   # every {answer.block.dt:g} s"
        )
    return page.to_html()
