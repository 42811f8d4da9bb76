"""A loop that is run clockwise, as the output of no actuator runs behind its input."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.findings.gain_sign import sign_of
from hyst.diagnosis.wording import of_record, percent

NAME = "run direction"
_LEAST_WIDTH = 0.01  # of the height of the loop
_FORCES = frozenset({"N", "kN", "mN", "uN", "lbf", "Nm", "N m", "mNm", "Pa", "kPa", "MPa"})


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn of a clockwise loop: exchanged columns, channels out of step, or friction."""
    for number, record in evidence.numbered():
        loops = evidence.loops(number)
        if not loops:
            continue
        largest = max(loops, key=lambda each: each.high - each.low)
        sign = sign_of(largest) or 1
        alike = [each for each in loops if each.like(largest)]
        opening = sign * np.mean([each.opening for each in alike], axis=0)
        noise = (evidence.noise(number) or 0.0) / np.sqrt(max(largest.samples, 1.0) * len(alike))
        area = float(opening.mean())
        if area >= 0.0 or -area < max(_LEAST_WIDTH * largest.height, 5.0 * noise):
            continue
        force = record.output_unit in _FORCES
        share = float(np.abs(opening).max()) / float(np.ptp(record.y))
        yield Finding(
            NAME,
            "remark" if force else "warning",
            f"{of_record(evidence, number)}the loop is run clockwise ({percent(share)} wide): the "
            "output is ahead of the input.",
            "Of a force over a displacement, as with friction, this is right."
            if force
            else "Of friction, force over displacement, this is right. Of an actuator it is not: "
            "either input and output columns are exchanged, or the channels were not recorded at "
            "the same time.",
            record=number,
            amounts={"share": share},
        )
