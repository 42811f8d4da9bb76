"""A page of what was learnt: how it stands, the repetitions, the pictures, and what is next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hyst.compensation import LearningCompensator
from hyst.operators import Verdict
from hyst.report.learning_tables import learning_notes, learning_table
from hyst.report.page import Page


def learning_page(
    learner: LearningCompensator,
    figure: bytes,
    unit: str,
    *,
    verdict: Verdict | None,
    sources: Sequence[str] = (),
    notes: Sequence[str] = (),
    about: Mapping[str, str] | None = None,
    then: str = "",
) -> str:
    """Write the page.

    Parameters
    ----------
    learner
        With one repetition or more.
    figure
        As ``draw_learning`` gives it.
    unit
        Of the output.
    verdict
        Whether what was learnt is to be used, if that is decided.
    sources
        Where each repetition was measured.
    notes
        What was done to the records, in sentences.
    about
        What was read, by its role.
    then
        What to do next.

    Returns
    -------
    str
        HTML that needs nothing but itself.
    """
    page = Page("Learning from repetition")
    if verdict is None:
        page.banner(learner.status)
    else:
        page.verdict(verdict)
    if then:
        page.text(then)
    page.heading("From repetition to repetition")
    page.table(learning_table(learner, unit, sources))
    page.faint(
        "Errors are measured output minus reference; the marked repetition is the best. Over the "
        "noise: the rms error divided by the sensor's noise, below which nothing can be learnt."
    )
    page.picture(
        figure,
        "Error against repetition; reference, output, error and command of the first, the best and "
        "the last one. The grey band is twice the noise on either side.",
    )
    page.heading("Does it contract?")
    page.text(learner.contraction.sentence)
    page.items([*learning_notes(learner), *notes])
    page.heading("What was read")
    page.items([f"{role}: {file}" for role, file in (about or {}).items()])
    return page.to_html()
