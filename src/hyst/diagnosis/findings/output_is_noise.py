"""Finding: an output that its input does not explain."""

from __future__ import annotations

from collections.abc import Iterable

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.values.measured import values_of_each
from hyst.diagnosis.values.relation import relation_of
from hyst.diagnosis.values.wording import subject

NAME = "output is noise"

_MOSTLY_NOISE = 0.3


def find(evidence: Evidence) -> Iterable[Finding]:
    """Refuse an output without memory and without a relation to the input; tell a weak one."""
    for values in values_of_each(evidence):
        good = values.are_measurements()
        relation = relation_of(values.y[good], values.u[good])
        if relation is None or relation.share >= _MOSTLY_NOISE:
            continue
        begin = subject(evidence, values.number, "output")
        if relation.is_none:
            yield Finding(
                NAME,
                "refusal",
                f"{begin} is noise: no sample tells anything about the next one, and the input "
                "nothing about any.",
                "Look whether it is the right column and whether the sensor was connected.",
                values.number,
                amounts={"explained": max(relation.share, 0.0)},
            )
        else:
            yield Finding(
                NAME,
                "warning",
                f"{begin} is mostly noise: input and direction explain "
                f"{100.0 * relation.share:.2g} % of its variance.",
                "Drive more, or average periods, before constants are believed.",
                values.number,
                amounts={"explained": relation.share},
            )
