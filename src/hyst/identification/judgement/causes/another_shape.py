"""The loop is of another shape than the family's."""

from __future__ import annotations

from hyst.identification.judgement.cause import Cause, Contribution
from hyst.identification.judgement.general_loops import general_loops


def _sentence(found: Contribution) -> str:
    return (
        "The loops are of another shape than the model's, which makes "
        f"{found.size} rms of what is left: they do not close or bend as its loops do."
    )


ANOTHER_SHAPE = Cause(
    "another shape",
    general_loops,
    _sentence,
    "Try other families or more plays (--family auto, --plays); where none leaves less, expect "
    "this error.",
    counts=0.75,
)
