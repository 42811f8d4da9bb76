"""What a diagnosis finds: one thing about a record that its user should know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

Severity = Literal["refusal", "left out", "warning", "remark"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
"""From the worst to the mildest."""

NO_SAMPLES: NDArray[np.intp] = np.empty(0, dtype=np.intp)


@dataclass(frozen=True, eq=False)
class Finding:
    """One thing that records show, in words for their user.

    Parameters
    ----------
    name
        In the registry of findings, as ``"saturated sensor"``.
    severity
        ``"refusal"``: nothing can be identified from the record as it is. ``"left out"``: the
        samples are no measurements of the actuator, and identification leaves them out.
        ``"warning"``: a result would be doubtful, and the sentence says of what. ``"remark"``: what
        the record holds.
    sentence
        What is there, with its size and unit.
    advice
        What to do about it; empty where there is nothing to do.
    record
        Which of the records it concerns, counted from 1; 0 for all of them together.
    samples
        Shape (m,), samples of that record it concerns, ascending; empty where it concerns all.
    amounts
        Its numbers by name, in units of the record, as ``{"rate": 1.5e-6}``.
    """

    name: str
    severity: Severity
    sentence: str
    advice: str = ""
    record: int = 0
    samples: NDArray[np.intp] = field(default_factory=lambda: NO_SAMPLES)
    amounts: Mapping[str, float] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers and text."""
        return {
            "name": self.name,
            "severity": self.severity,
            "sentence": self.sentence,
            "advice": self.advice,
            "record": self.record,
            "samples": self.samples.tolist(),
            "amounts": dict(self.amounts),
        }
